"""How tissue moves, found in the labels of the phases alone, against the motion that drew them."""
import os
import pathlib
import tempfile
import unittest
from unittest import mock

import numpy as np
from chain import label_image, make, write_labels
from sonovdb import elastix, register_phases
from sonovdb.vtkSonoFilters import vtkSonoLabelMapReader, vtkSonoThoraxSource
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter
from wallerror import wall_errors

WALL = (12, 13)  # the left ventricle's myocardium, and the septum


def write(path, image):
    writer = vtkXMLImageDataWriter()
    writer.SetInputData(image)
    writer.SetFileName(str(path))
    writer.Write()
    return str(path)


def arrays(image):
    points = image.GetPointData()
    size = image.GetDimensions()[::-1]
    return (vtk_to_numpy(points.GetArray("Labels")).reshape(size),
            vtk_to_numpy(points.GetArray("DisplacementMm")).reshape(size + (3,)))


class TestRegistration(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def read(self, paths, time):
        reader = vtkSonoLabelMapReader()
        for path in paths:
            reader.AddFileName(path)
        reader.UpdateTimeStep(time)
        return reader.GetOutput()

    def refused(self, *arguments, **keywords):
        with self.assertRaises(ValueError) as caught:
            register_phases(*arguments, **keywords)
        return str(caught.exception)

    @unittest.skipUnless(elastix.is_there(), "elastix is not installed")
    def test_the_walls_of_a_beating_heart(self):
        spacing = 2.0
        source = make(vtkSonoThoraxSource, SpacingMm=spacing, Phases=24)
        source.UpdateInformation()
        files = []
        for phase in (0, 8):  # the ends of diastole and of systole
            source.UpdateTimeStep(phase / 24)
            only = vtkImageData()
            only.ShallowCopy(source.GetOutput())
            only.GetPointData().RemoveArray("DisplacementMm")
            only.GetFieldData().RemoveArray("MovingLabels")
            files.append(write(self.folder / f"{phase}.vti", only))
        labels, known = arrays(source.GetOutput())
        paths = register_phases(files, self.folder / "cine", say=lambda _: None)
        made = self.read(paths, 1)
        self.assertEqual(set(vtk_to_numpy(made.GetFieldData().GetArray("MovingLabels"))),
                         set(vtk_to_numpy(source.GetOutput().GetFieldData().GetArray("MovingLabels"))))
        self.assertEqual(np.abs(arrays(self.read(paths, 0))[1]).max(), 0)
        found = arrays(made)[1]
        wall = np.isin(labels, WALL)
        still, _ = wall_errors(np.zeros_like(known), known, wall, (spacing,) * 3)
        along, across = wall_errors(found, known, wall, (spacing,) * 3)
        print("mean and 95 %, mm: along the normal {:.2f} {:.2f}, along the surface {:.2f} {:.2f}; normal of no motion {:.2f}".format(
            along.mean(), np.percentile(along, 95), across.mean(), np.percentile(across, 95), still.mean()))
        # Labels say where a surface is to half a voxel.
        self.assertLess(along.mean(), 0.5 * spacing)
        self.assertLess(np.percentile(along, 95), spacing)
        # Not how it turns within itself: by up to 8 degrees at a radius of up to 33 mm.
        self.assertLess(np.percentile(across, 95), np.radians(8) * 33)

    @unittest.skipUnless(elastix.is_there(), "elastix is not installed")
    def test_a_ball_goes_where_it_goes_in_the_world(self):
        turn = np.radians(30)
        direction = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
        direction = direction @ np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
        spacing, origin, way = np.array([1.5, 1.0, 2.0]), np.array([20.0, -30.0, 5.0]), np.array([3.0, -2.0, 4.0])
        index = np.stack(np.meshgrid(*(np.arange(n) for n in (40, 60, 30)), indexing="ij"), -1)  # x, y, z
        world = origin + (index * spacing) @ direction.T
        files = []
        for phase in range(2):
            ball = np.linalg.norm(world - world[20, 30, 15] - phase * way, axis=-1) < 12
            image = label_image(np.where(ball, 5, 1).astype(np.uint16).transpose(2, 1, 0))
            image.SetSpacing(spacing)
            image.SetOrigin(origin)
            image.SetDirectionMatrix(direction.ravel())
            files.append(write(self.folder / f"{phase}.vti", image))
        paths = register_phases(files, self.folder / "cine", moving={5}, say=lambda _: None)
        labels, found = arrays(self.read(paths, 1))
        np.testing.assert_allclose(found[labels == 5].mean(axis=0), way, atol=0.25)

    def test_what_cannot_be_registered(self):
        voxels = np.ones((4, 5, 6), np.uint16)
        still = [write_labels(self.folder / f"{phase}.vti", voxels) for phase in range(2)]
        with mock.patch.dict(os.environ, PATH=""):
            self.assertIn("apt install elastix", self.refused(still, self.folder))
        with mock.patch.object(elastix, "is_there", return_value=True):
            self.assertIn("nothing moves", self.refused(still, self.folder))
            self.assertIn("one phase", self.refused(still[:1], self.folder))
            self.assertIn("0 to 1", self.refused(still, self.folder, reference=2))
            self.assertIn("nowhere.vti", self.refused([still[0], "nowhere.vti"], self.folder))
            voxels[2:] = 2
            moved = write_labels(self.folder / "moved.vti", voxels)
            self.assertIn("no label 7", self.refused([moved, still[0]], self.folder, moving={7}))
            elsewhere = label_image(voxels)
            elsewhere.SetOrigin(0, 0, 1)
            elsewhere = write(self.folder / "elsewhere.vti", elsewhere)
            self.assertIn("same grid", self.refused([still[0], elsewhere], self.folder))


if __name__ == "__main__":
    unittest.main()
