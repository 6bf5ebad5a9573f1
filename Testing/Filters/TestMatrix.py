"""The flat image of a matrix probe's volume, and the planes of a biplane picture."""
import unittest

import numpy as np
from chain import Chain, make
from sonovdb.vtkSonoFilters import vtkSonoErrorMap, vtkSonoProbeSource, vtkSonoUltrasound
from vtkmodules.util.numpy_support import vtk_to_numpy

MATRIX = 3
VOLUME, FIRST, SECOND = vtkSonoProbeSource.WHOLE_VOLUME, vtkSonoProbeSource.FIRST_PLANE, vtkSonoProbeSource.SECOND_PLANE


def array(image, name):
    columns, rows, slices = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetArray(name)).reshape(slices, rows, columns)


class TestMatrix(unittest.TestCase):
    def setUp(self):
        self.chain = Chain()
        # An odd number of elevations has a middle one, and 2 x 90 mm sin(15 degrees) an odd number of voxels.
        for name, value in (("ScanKind", MATRIX), ("LineCount", 24), ("ElevationLineCount", 5), ("ElevationSectorDeg", 30.0),
                            ("ApertureMm", 16.0), ("ElevationApertureMm", 8.0)):
            getattr(self.chain.probe, "Set" + name)(value)
        self.chain.converter.SetPixelMm(2.0)

    def made(self, plane):
        self.chain.probe.SetMatrixPlane(plane)
        self.chain.converter.Update()
        return self.chain.converter.GetOutput(0), self.chain.converter.GetOutput(1)

    def test_the_flat_image_of_a_volume_is_its_plane_in_the_middle(self):
        """Lateral runs to the right and depth down; each pixel is the voxel at its place in the world."""
        volume, flat = self.made(VOLUME)
        self.assertEqual(volume.GetDimensions(), (46, 25, 46))
        self.assertEqual(flat.GetDimensions(), (46, 46, 1))
        np.testing.assert_allclose(flat.GetBounds(), (-45, 45, 0, 90, 0, 0), atol=1e-9)
        position, axial, lateral = (np.array(getattr(self.chain.probe, "Get" + part)())
                                    for part in ("PositionMm", "Axial", "Lateral"))
        for name in ("BMode", "Mask", "Labels"):
            values = vtk_to_numpy(volume.GetPointData().GetArray(name))
            for row, column in np.ndindex(46, 46):
                place = position + (2 * column - 45) * lateral + 2 * row * axial
                at = volume.FindPoint(place + 1e-6 * axial)  # the face itself lies on the border
                self.assertEqual(array(flat, name)[0, row, column], values[at], (name, row, column))
        self.assertGreater(np.unique(array(flat, "Labels")).size, 3)

    def test_it_is_the_plane_of_a_probe_with_one_elevation(self):
        """But for the noise of the paths, which are others, and without the speckle of what reverberates, which is another of
        each line."""
        self.chain.tracer.SetPathsPerLine(2000)
        self.chain.tracer.SetReverberation(False)
        of_volume = {name: array(self.made(VOLUME)[1], name).astype(float) for name in ("BMode", "Mask", "Labels")}
        world, plane = self.made(FIRST)
        self.assertEqual(world.GetDimensions(), (46, 46, 1))
        mask = array(plane, "Mask") == 1
        np.testing.assert_array_equal(of_volume["Mask"], array(plane, "Mask"))
        np.testing.assert_array_equal(of_volume["Labels"], array(plane, "Labels"))
        grey = array(plane, "BMode").astype(float)
        self.assertGreater(np.corrcoef(grey[mask], of_volume["BMode"][mask])[0, 1], 0.99)
        self.assertLess(np.abs(grey - of_volume["BMode"])[mask].mean(), 5)  # of 255

    def test_the_second_plane_is_that_of_a_probe_turned_by_hand(self):
        first, second = (array(self.made(plane)[1], "BMode").astype(float) for plane in (FIRST, SECOND))
        self.assertLess(second.shape[2], first.shape[2])  # 30 degrees
        probe = self.chain.probe
        probe.SetLateral(np.cross(probe.GetAxial(), probe.GetLateral()))
        probe.SetSectorDeg(30.0)
        probe.SetElevationLineCount(1)
        probe.SetApertureMm(8.0)
        probe.SetElevationApertureMm(16.0)
        turned = array(self.made(VOLUME)[1], "BMode").astype(float)
        self.assertEqual(turned.shape, second.shape)
        self.assertLess((np.abs(turned - second) > 1).mean(), 1e-3)  # directions are rounded otherwise
        self.assertGreater(np.unique(second).size, 50)

    def test_other_probes_have_one_plane(self):
        self.chain.probe.SetScanKind(1)
        pictures = [array(self.made(plane)[1], "BMode").copy() for plane in (VOLUME, FIRST, SECOND)]
        np.testing.assert_array_equal(pictures[0], pictures[1])
        np.testing.assert_array_equal(pictures[0], pictures[2])

    def test_one_filter_makes_the_same_at_rest_and_moving(self):
        one = make(vtkSonoUltrasound, BuildSurfaces=False, PathsPerLine=20, PixelMm=2.0, ErrorMap=True)
        one.SetProbe(self.chain.probe)
        one.SetInputConnection(self.chain.thorax.GetOutputPort())
        for plane in (VOLUME, FIRST, SECOND):
            _, flat = self.made(plane)
            one.Update(vtkSonoUltrasound.FLAT_IMAGE)
            picture = one.GetOutputDataObject(vtkSonoUltrasound.FLAT_IMAGE)
            self.assertEqual(picture.GetBounds(), flat.GetBounds())
            np.testing.assert_array_equal(array(picture, "Mask"), array(flat, "Mask"))
            self.assertEqual(array(picture, "ErrorPercent").shape, array(flat, "Mask").shape)
        self.chain.probe.SetPreview(True)
        one.Update(vtkSonoUltrasound.FLAT_IMAGE)
        self.assertEqual(one.GetOutputDataObject(vtkSonoUltrasound.FLAT_IMAGE).GetSpacing()[0], 4.0)

    def test_the_flat_error_map_is_of_the_same_plane(self):
        map = vtkSonoErrorMap()
        map.SetInputConnection(self.chain.tracer.GetOutputPort())
        map.SetPixelMm(2.0)
        map.Update()
        percent, flat = (array(map.GetOutput(port), "ErrorPercent") for port in (0, 1))
        np.testing.assert_array_equal(flat[0], percent[:, 12])
        self.assertGreater(np.nanmax(flat), 5)


if __name__ == "__main__":
    unittest.main()
