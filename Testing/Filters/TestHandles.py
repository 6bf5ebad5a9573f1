"""A stage takes the result of the stage before as long as the arrays are that result, else what the arrays say."""
import unittest

import numpy as np
from chain import Chain
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData


def values(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name)).copy()


class TestHandles(unittest.TestCase):
    def setUp(self):
        self.chain = Chain()
        self.chain.converter.Update()
        self.rf = values(self.chain.formation.GetOutput(), "RF")
        self.picture = values(self.chain.converter.GetOutput(), "BMode")

    def changed_copy(self, data, name, factor, in_field=False):
        """The same data, of which one array's values were changed in place."""
        copy = vtkImageData()
        copy.DeepCopy(data)
        array = (copy.GetFieldData() if in_field else copy.GetPointData()).GetArray(name)
        vtk_to_numpy(array)[:] *= factor
        array.Modified()
        return copy

    def test_a_copy_gives_the_same(self):
        copy = vtkImageData()
        copy.DeepCopy(self.chain.tracer.GetOutputDataObject(0))
        self.chain.formation.SetInputData(0, copy)
        self.chain.converter.Update()
        np.testing.assert_array_equal(values(self.chain.formation.GetOutput(), "RF"), self.rf)
        np.testing.assert_array_equal(values(self.chain.converter.GetOutput(), "BMode"), self.picture)

    def test_changed_intensities_count(self):
        dark = self.changed_copy(self.chain.tracer.GetOutputDataObject(0), "Intensity", 0.0)
        self.chain.formation.SetInputData(0, dark)
        self.chain.formation.Update()
        self.assertLess(np.abs(values(self.chain.formation.GetOutput(), "RF")).sum(), np.abs(self.rf).sum())

    def test_changed_echoes_count(self):
        silent = self.changed_copy(self.chain.tracer.GetOutputDataObject(0), "BoundaryEcho", 0.0, in_field=True)
        self.chain.formation.SetInputData(0, silent)
        self.chain.formation.Update()
        self.assertFalse(np.array_equal(values(self.chain.formation.GetOutput(), "RF"), self.rf))

    def test_changed_envelopes_count(self):
        black = self.changed_copy(self.chain.formation.GetOutput(), "Envelope", 0.0)
        self.chain.bmode.SetInputData(black)
        self.chain.converter.Update()
        self.assertEqual(values(self.chain.converter.GetOutput(), "BMode").max(), 1)

    def test_changed_grey_levels_count(self):
        white = self.changed_copy(self.chain.bmode.GetOutput(), "BMode", 1e6)
        self.chain.converter.SetInputData(0, white)
        self.chain.converter.Update()
        picture = values(self.chain.converter.GetOutput(), "BMode")
        self.assertGreater((picture == 255).sum(), (self.picture == 255).sum())

    def test_a_change_in_place_counts(self):
        array = self.chain.tracer.GetOutputDataObject(0).GetPointData().GetArray("Intensity")
        vtk_to_numpy(array)[:] = 0.0
        array.Modified()
        self.chain.formation.Modified()
        self.chain.formation.Update()
        self.assertLess(np.abs(values(self.chain.formation.GetOutput(), "RF")).sum(), np.abs(self.rf).sum())


if __name__ == "__main__":
    unittest.main()
