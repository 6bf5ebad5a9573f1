"""A stage takes the result of the stage before as long as the arrays are that result, else what the arrays say."""
import unittest

import numpy as np
from chain import Chain
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkPassThrough


def values(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name)).copy()


class TestHandles(unittest.TestCase):
    def setUp(self):
        self.chain = Chain()
        self.chain.converter.Update()
        self.rf = values(self.chain.formation.GetOutput(), "RF")
        self.picture = values(self.chain.converter.GetOutput(), "BMode")

    def copy(self, stage):
        """A filter that hands on a deep copy of the stage's first output."""
        between = self.between = vtkPassThrough()  # its port alone would not keep it
        between.SetDeepCopyInput(True)
        between.SetInputConnection(stage.GetOutputPort())
        between.Update()
        return between

    def changed_copy(self, stage, name, factor, in_field=False):
        """Such a filter, of whose data one array's values were changed in place."""
        between = self.copy(stage)
        data = between.GetOutputDataObject(0)
        array = (data.GetFieldData() if in_field else data.GetPointData()).GetArray(name)
        vtk_to_numpy(array)[:] *= factor
        array.Modified()
        return between.GetOutputPort()

    def test_a_copy_gives_the_same(self):
        self.chain.formation.SetInputConnection(0, self.copy(self.chain.tracer).GetOutputPort())
        self.chain.converter.Update()
        np.testing.assert_array_equal(values(self.chain.formation.GetOutput(), "RF"), self.rf)
        np.testing.assert_array_equal(values(self.chain.converter.GetOutput(), "BMode"), self.picture)

    def test_changed_intensities_count(self):
        dark = self.changed_copy(self.chain.tracer, "Intensity", 0.0)
        self.chain.formation.SetInputConnection(0, dark)
        self.chain.formation.Update()
        self.assertLess(np.abs(values(self.chain.formation.GetOutput(), "RF")).sum(), np.abs(self.rf).sum())

    def test_changed_echoes_count(self):
        self.chain.tracer.SetInterfaceModel(1)  # the one whose paths bring echoes
        self.chain.formation.Update()
        rf = values(self.chain.formation.GetOutput(), "RF")
        silent = self.changed_copy(self.chain.tracer, "BoundaryEcho", 0.0, in_field=True)
        self.chain.formation.SetInputConnection(0, silent)
        self.chain.formation.Update()
        self.assertFalse(np.array_equal(values(self.chain.formation.GetOutput(), "RF"), rf))

    def test_changed_envelopes_count(self):
        black = self.changed_copy(self.chain.formation, "Envelope", 0.0)
        self.chain.bmode.SetInputConnection(black)
        self.chain.converter.Update()
        self.assertEqual(values(self.chain.converter.GetOutput(), "BMode").max(), 1)

    def test_changed_grey_levels_count(self):
        white = self.changed_copy(self.chain.bmode, "BMode", 1e6)
        self.chain.converter.SetInputConnection(0, white)
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
