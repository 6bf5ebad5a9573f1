"""Several label maps are the phases of a motion: the reader has a time step for each."""
import pathlib
import tempfile
import unittest

import numpy as np
from chain import listen, write_labels
from sonovdb.vtkSonoFilters import vtkSonoLabelMapReader
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

TIME_STEPS = vtkStreamingDemandDrivenPipeline.TIME_STEPS()


class TestPhases(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, voxels):
        return write_labels(self.folder / name, voxels)

    def reader(self, *files):
        reader = vtkSonoLabelMapReader()
        for file in files:
            reader.AddFileName(file)
        return reader

    def test_each_file_is_a_time_step(self):
        phases = [np.full((2, 3, 4), label, np.uint16) for label in (1, 2, 3)]
        reader = self.reader(*(self.write(f"phase{i}.vti", voxels) for i, voxels in enumerate(phases)))
        reader.UpdateInformation()
        self.assertEqual(reader.GetOutputInformation(0).Get(TIME_STEPS), (0, 1, 2))
        for time, label in ((0, 1), (2, 3), (1, 2), (1.9, 2), (-5, 1), (99, 3), (0, 1)):
            with self.subTest(time=time):
                reader.UpdateTimeStep(time)
                self.assertEqual(set(vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())), {label})

    def test_one_file_has_no_time(self):
        reader = self.reader(self.write("only.vti", np.ones((2, 2, 2), np.uint16)))
        reader.Update()
        self.assertFalse(reader.GetOutputInformation(0).Has(TIME_STEPS))

    def test_phases_of_another_size_are_refused(self):
        reader = self.reader(self.write("a.vti", np.ones((2, 2, 2), np.uint16)),
                             self.write("b.vti", np.ones((2, 2, 3), np.uint16)))
        said = listen(reader)
        reader.UpdateTimeStep(1)
        self.assertEqual(len(said), 1, said)
        self.assertIn("b.vti", said[0])
        self.assertIn("same grid", said[0])

    def test_phases_that_are_missing(self):
        reader = self.reader(self.write("a.vti", np.ones((2, 2, 2), np.uint16)), "nowhere/b.vti")
        said = listen(reader)
        reader.UpdateTimeStep(1)
        self.assertEqual(len(said), 1, said)
        self.assertIn("nowhere/b.vti", said[0])


if __name__ == "__main__":
    unittest.main()
