"""What may be added to the anatomy: targets and scatterers; and the paths that can be shown."""
import unittest

import numpy as np
from chain import Chain, make
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersSources import vtkCubeSource, vtkSphereSource

DEPTH_MM = 40.0  # of the target's and scatterer's centre


def on_axis(chain):
    """A place on the probe's axis, which the middle lines pass."""
    return np.array(chain.probe.GetPositionMm()) + DEPTH_MM * np.array(chain.probe.GetAxial())


def strings(*values):
    array = vtkStringArray()
    array.SetName("Tissue")
    for value in values:
        array.InsertNextValue(value)
    return array


def intensity(chain):
    chain.tracer.Update()
    return vtk_to_numpy(chain.tracer.GetOutputDataObject(0).GetPointData().GetArray("Intensity")).reshape(12, -1).copy()


class TestTargets(unittest.TestCase):
    def setUp(self):
        self.chain = Chain()
        self.chain.tracer.SetDeterministic(True)  # so that all that differs is the target
        self.bare = intensity(self.chain)
        self.sphere = make(vtkSphereSource, Radius=8.0, Center=tuple(on_axis(self.chain)), ThetaResolution=32,
                           PhiResolution=32)
        self.sphere.Update()

    def with_target(self, target):
        self.chain.tracer.SetInputDataObject(2, target)
        return intensity(self.chain)

    def test_sphere_changes_what_lies_behind_it_alone(self):
        # Fat is slower than what is around it, so nothing is reflected totally, back to where it came from.
        self.chain.tracer.SetTargetTissue("fat")
        traced = self.with_target(self.sphere.GetOutput())
        front, inside = (int((DEPTH_MM + offset) / 0.25) for offset in (-8.5, 4))
        np.testing.assert_array_equal(traced[:, :front], self.bare[:, :front])
        np.testing.assert_array_equal(traced[0], self.bare[0])  # the outermost line passes it
        self.assertTrue(np.all(traced[5:7, inside:inside + 40] != self.bare[5:7, inside:inside + 40]))

    def test_bone_casts_a_shadow(self):
        shadowed = self.with_target(self.sphere.GetOutput())  # 5 dB/(cm MHz) along 16 mm at 2.5 MHz: 20 dB
        behind = int((DEPTH_MM + 12) / 0.25)
        self.assertLess(shadowed[5:7, behind].max(), 0.2 * self.bare[5:7, behind].min())

    def test_tissue_is_named_by_property_field_or_cells(self):
        self.chain.tracer.SetTargetTissue("lung")
        by_property = self.with_target(self.sphere.GetOutput())
        self.chain.tracer.SetTargetTissue("water")
        by_field = vtkPolyData()
        by_field.ShallowCopy(self.sphere.GetOutput())
        by_field.GetFieldData().AddArray(strings("lung"))
        by_cells = vtkPolyData()
        by_cells.ShallowCopy(self.sphere.GetOutput())
        by_cells.GetCellData().AddArray(strings(*["lung"] * by_cells.GetNumberOfCells()))
        np.testing.assert_array_equal(self.with_target(by_field), by_property)
        np.testing.assert_array_equal(self.with_target(by_cells), by_property)
        self.assertFalse(np.array_equal(self.with_target(self.sphere.GetOutput()), by_property))

    def test_two_tissues_in_one_surface_are_two_targets(self):
        other = make(vtkSphereSource, Radius=6.0,
                     Center=tuple(on_axis(self.chain) + 30 * np.array(self.chain.probe.GetAxial())))
        other.Update()
        points, names = np.vstack([vtk_to_numpy(s.GetOutput().GetPoints().GetData()) for s in (self.sphere, other)]), []
        both, offset = vtkPolyData(), 0
        both.SetPoints(vtkPoints())
        both.GetPoints().SetData(numpy_to_vtk(points, deep=True))
        both.Allocate(4096)
        for source, tissue in ((self.sphere, "fat"), (other, "liver")):
            surface = source.GetOutput()
            for cell in range(surface.GetNumberOfCells()):
                ids = surface.GetCell(cell).GetPointIds()
                both.InsertNextCell(5, 3, [ids.GetId(i) + offset for i in range(3)])
                names.append(tissue)
            offset += surface.GetNumberOfPoints()
        both.GetCellData().AddArray(strings(*names))
        traced = self.with_target(both)
        self.chain.tracer.SetTargetTissue("fat")
        first = self.with_target(self.sphere.GetOutput())
        between = int((DEPTH_MM + 20) / 0.25)
        np.testing.assert_array_equal(traced[:, :between], first[:, :between])
        self.assertFalse(np.array_equal(traced, first))

    def test_cube_with_doubled_points_is_closed(self):
        cube = make(vtkCubeSource, XLength=10.0, YLength=10.0, ZLength=10.0, Center=tuple(on_axis(self.chain)))
        cube.Update()
        self.assertEqual(cube.GetOutput().GetNumberOfPoints(), 24)
        self.assertFalse(np.array_equal(self.with_target(cube.GetOutput()), self.bare))

    def test_without_its_target_the_scene_is_bare_again(self):
        self.with_target(self.sphere.GetOutput())
        self.chain.tracer.SetInputConnection(2, None)
        np.testing.assert_array_equal(intensity(self.chain), self.bare)


class TestPaths(unittest.TestCase):
    def test_none_by_default(self):
        chain = Chain()
        chain.tracer.Update()
        self.assertEqual(chain.tracer.GetOutputDataObject(2).GetNumberOfPoints(), 0)

    def test_paths_start_at_the_face_and_fade(self):
        chain = Chain()
        chain.probe.SetApertureMm(0)  # all at one point
        chain.tracer.SetReverberation(False)  # what is reflected weighs more, as it is drawn less often
        chain.tracer.SetNumberOfShownPaths(24)
        chain.tracer.Update()
        paths = chain.tracer.GetOutputDataObject(2)
        self.assertEqual(paths.GetNumberOfLines(), 24)
        lines = vtk_to_numpy(paths.GetCellData().GetArray("Line"))
        self.assertEqual(set(lines), set(range(12)))
        array = {name: vtk_to_numpy(paths.GetPointData().GetArray(name))
                 for name in ("Intensity", "IntensityDb", "Bounce")}
        for cell in range(24):
            ids = [paths.GetCell(cell).GetPointId(i) for i in range(paths.GetCell(cell).GetNumberOfPoints())]
            np.testing.assert_allclose(paths.GetPoint(ids[0]), chain.probe.GetPositionMm(), atol=1e-2)
            self.assertTrue(np.all(np.diff(array["Intensity"][ids]) <= 1e-6))
            self.assertTrue(np.all(np.diff(array["Bounce"][ids]) >= 0))
        bright = array["Intensity"] > 1e-10
        np.testing.assert_allclose(array["IntensityDb"][bright], 20 * np.log10(array["Intensity"][bright]), atol=1e-3)

    def test_showing_them_changes_nothing_else(self):
        chain = Chain()
        before = intensity(chain)
        chain.tracer.SetNumberOfShownPaths(5)
        np.testing.assert_array_equal(intensity(chain), before)


class TestScatterers(unittest.TestCase):
    def test_one_bright_scatterer_shows_at_its_depth(self):
        chain = Chain()
        chain.probe.SetApertureMm(0)  # the same weight at each depth
        chain.tracer.SetInterfaceModel(1)  # no tissue beside it, and no frequency that sinks
        chain.probe.SetLineCount(13)  # the seventh runs along the axis
        chain.formation.SetScattererLevelDb(-200)
        chain.formation.Update()

        def envelope():
            return vtk_to_numpy(chain.formation.GetOutput().GetPointData().GetArray("Envelope")).reshape(13, -1).copy()

        before = envelope()
        points = vtkPolyData()
        points.SetPoints(vtkPoints())
        points.GetPoints().SetDataTypeToDouble()
        points.GetPoints().InsertNextPoint(on_axis(chain))
        amplitude = numpy_to_vtk(np.array([1e3], np.float32), deep=True)
        amplitude.SetName("Amplitude")
        points.GetPointData().AddArray(amplitude)
        chain.formation.SetInputDataObject(1, points)
        chain.formation.Update()
        after = envelope()
        line, sample = np.unravel_index((after - before).argmax(), after.shape)
        self.assertEqual(line, 6)
        self.assertAlmostEqual(sample * chain.formation.GetOutput().GetSpacing()[0], DEPTH_MM, delta=0.02)
        traced = chain.tracer.GetOutputDataObject(0)
        at = vtk_to_numpy(traced.GetPointData().GetArray("Intensity")).reshape(13, -1)[6, int(DEPTH_MM / 0.25)]
        self.assertAlmostEqual(after[line, sample] / (1e3 * at), 1, delta=0.05)


if __name__ == "__main__":
    unittest.main()
