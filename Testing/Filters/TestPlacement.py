"""Where things stand in the world: label maps, the probe's outline and the picture. Positions are worked out by hand."""
import pathlib
import tempfile
import unittest

import numpy as np
from chain import Chain, make
from sonovdb.vtkSonoFilters import vtkSonoLabelMapReader, vtkSonoProbeSource
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

AT_ORIGIN = {"PositionMm": (0, 0, 0), "Axial": (0, 0, 1), "Lateral": (1, 0, 0)}

OBLIQUE_NRRD = b"""NRRD0004
type: uint8
dimension: 3
space: left-posterior-superior
sizes: 4 3 2
space directions: (0,2,0) (-1.5,0,0) (0,0,3)
kinds: domain domain domain
endian: little
encoding: raw
space origin: (10,20,30)
Segment0_Name:=liver
Segment0_LabelValue:=5
Segment0_Color:=1 0.5 0.25

"""

OBLIQUE_MHA = b"""ObjectType = Image
NDims = 3
BinaryData = True
BinaryDataByteOrderMSB = False
CompressedData = False
TransformMatrix = 0 1 0 -1 0 0 0 0 1
Offset = 10 20 30
ElementSpacing = 2 1.5 3
DimSize = 4 3 2
ElementType = MET_UCHAR
ElementDataFile = LOCAL
"""


class TestLabelMap(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        voxels = np.zeros((2, 3, 4), np.uint8)
        voxels[1, 2, 3] = 5
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "oblique.seg.nrrd")
            path.write_bytes(OBLIQUE_NRRD + voxels.tobytes())
            reader = make(vtkSonoLabelMapReader, FileName=str(path))
            reader.Update()
            cls.image = reader.GetOutput()

    def test_voxel_stands_where_the_header_says(self):
        labels = vtk_to_numpy(self.image.GetPointData().GetScalars())
        self.assertEqual((labels.dtype, labels.size), (np.uint16, 24))
        (index,) = np.flatnonzero(labels == 5)
        # (10,20,30) + 3 (0,2,0) + 2 (-1.5,0,0) + 1 (0,0,3)
        np.testing.assert_allclose(self.image.GetPoint(int(index)), (7, 26, 33), atol=1e-12)

    def test_names_and_colours_come_along(self):
        field = self.image.GetFieldData()
        self.assertEqual([field.GetArray("LabelIds").GetValue(i) for i in range(2)], [0, 5])
        self.assertEqual(field.GetAbstractArray("LabelNames").GetValue(1), "liver")
        np.testing.assert_allclose(field.GetArray("LabelColors").GetTuple3(1), (1, 0.5, 0.25), atol=1e-6)

    def test_reader_knows_its_files_by_their_names(self):
        can_read = vtkSonoLabelMapReader.CanReadFile
        self.assertEqual([can_read(name) for name in ("a.nii", "a.NII.GZ", "a.seg.nrrd", "a.nrrd", "a.mha", "a.mhd", "a.vti", "a.vtu", "nii")],
                         [1, 1, 1, 1, 1, 1, 1, 0, 0])

    def test_vtk_image_keeps_its_place_and_names(self):
        with tempfile.TemporaryDirectory() as folder:
            path = str(pathlib.Path(folder, "oblique.vti"))
            writer = make(vtkXMLImageDataWriter, FileName=path)
            writer.SetInputData(self.image)
            writer.Write()
            reader = make(vtkSonoLabelMapReader, FileName=path)
            reader.Update()
        image = reader.GetOutput()
        labels = vtk_to_numpy(image.GetPointData().GetScalars())
        (index,) = np.flatnonzero(labels == 5)
        np.testing.assert_allclose(image.GetPoint(int(index)), (7, 26, 33), atol=1e-12)
        self.assertEqual(image.GetFieldData().GetAbstractArray("LabelNames").GetValue(1), "liver")

    def test_meta_image_stands_where_its_header_says(self):
        voxels = np.zeros((2, 3, 4), np.uint8)
        voxels[1, 2, 3] = 5
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "oblique.mha")
            path.write_bytes(OBLIQUE_MHA + voxels.tobytes())
            reader = make(vtkSonoLabelMapReader, FileName=str(path))
            reader.Update()
        image = reader.GetOutput()
        (index,) = np.flatnonzero(vtk_to_numpy(image.GetPointData().GetScalars()) == 5)
        np.testing.assert_allclose(image.GetPoint(int(index)), (7, 26, 33), atol=1e-12)


class TestProbe(unittest.TestCase):
    @staticmethod
    def cell(probe, index):
        probe.Update()
        return vtk_to_numpy(probe.GetOutput().GetCell(index).GetPoints().GetData())

    def test_linear_outline_is_a_rectangle(self):
        probe = make(vtkSonoProbeSource, ScanKind=0, WidthMm=40.0, DepthMm=50.0)
        probe.SetPositionMm(1, 2, 3)
        probe.SetAxial(0, 2, 0)  # of any length
        probe.SetLateral(1, 5, 0)  # made orthogonal: x
        fan, face = self.cell(probe, 0), self.cell(probe, 1)
        np.testing.assert_allclose(fan.min(axis=0), (-19, 2, 3), atol=1e-5)
        np.testing.assert_allclose(fan.max(axis=0), (21, 52, 3), atol=1e-5)
        np.testing.assert_allclose([face[0], face[-1]], [(-19, 2, 3), (21, 2, 3)], atol=1e-5)

    def test_matrix_volume_reaches_across_the_plane(self):
        probe = make(vtkSonoProbeSource, ScanKind=3, DepthMm=100.0, SectorDeg=60.0, ElevationSectorDeg=60.0, **AT_ORIGIN)
        border = self.cell(probe, 0)
        np.testing.assert_allclose(np.linalg.norm(border, axis=1), 100, atol=1e-4)
        np.testing.assert_allclose(border.max(axis=0)[:2], (50, 50), atol=0.1)  # elevation is axial x lateral: +y

    def test_sector_is_an_arc_about_its_apex(self):
        probe = make(vtkSonoProbeSource, DepthMm=100.0, SectorDeg=60.0, **AT_ORIGIN)
        fan = self.cell(probe, 0)
        distance = np.linalg.norm(fan, axis=1)
        arc = fan[distance > 1]
        np.testing.assert_allclose(np.linalg.norm(arc, axis=1), 100, atol=1e-4)
        np.testing.assert_allclose(arc[arc[:, 0].argmin()], (-50, 0, 100 * np.cos(np.pi / 6)), atol=1e-4)
        np.testing.assert_allclose(arc[:, 2].max(), 100, atol=0.02)
        np.testing.assert_allclose(fan[distance <= 1], 0, atol=1e-4)

    def test_curvilinear_face_is_convex(self):
        probe = make(vtkSonoProbeSource, ScanKind=2, RadiusMm=60.0, SectorDeg=60.0, DepthMm=100.0, **AT_ORIGIN)
        face = self.cell(probe, 1)
        np.testing.assert_allclose(np.linalg.norm(face - (0, 0, -60), axis=1), 60, atol=1e-4)
        np.testing.assert_allclose(face[-1], (30, 0, 60 * np.cos(np.pi / 6) - 60), atol=1e-4)


class TestPicture(unittest.TestCase):
    def test_picture_stands_in_the_probes_plane(self):
        chain = Chain()
        chain.converter.Update()
        picture = chain.converter.GetOutput()
        axial, lateral = np.array(chain.probe.GetAxial()), np.array(chain.probe.GetLateral())
        matrix = picture.GetDirectionMatrix()
        columns = [[matrix.GetElement(row, column) for row in range(3)] for column in range(3)]
        np.testing.assert_allclose(columns, [lateral, axial, np.cross(axial, lateral)], atol=1e-6)

        # The sector's apex lies in the middle of the first row, its deepest point straight below.
        width, height, _ = picture.GetDimensions()
        middle, position = (width - 1) / 2, np.array(chain.probe.GetPositionMm())
        world = [0.0] * 3
        picture.TransformContinuousIndexToPhysicalPoint(middle, 0, 0, world)
        np.testing.assert_allclose(world, position, atol=1e-6)
        picture.TransformContinuousIndexToPhysicalPoint(middle, height - 1, 0, world)
        self.assertLess(np.linalg.norm(world - position - 90 * axial), 0.23)


if __name__ == "__main__":
    unittest.main()
