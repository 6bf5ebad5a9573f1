"""A sweep's images are those of its poses one by one; bad input gets a sentence."""
import unittest

import numpy as np
from chain import Chain, listen, make
from sonovdb.vtkSonoFilters import vtkSonoProbeSource, vtkSonoSweep
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkTable

PARTS = ("Position", "Axial", "Lateral")


def stack(image, name):
    width, height, count = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetArray(name)).reshape(count, height, width)


def poses_around(probe, count=3):
    """Rows of position, axial and lateral: the probe walks and turns."""
    position, axial, lateral = (np.array(probe.GetPositionMm()), np.array(probe.GetAxial()),
                                np.array(probe.GetLateral()))
    return [(position + 2.0 * n * lateral, axial + 0.1 * n * lateral, lateral) for n in range(count)]


def as_points(poses):
    data = vtkPolyData()
    points = vtkPoints()
    points.SetDataTypeToDouble()
    for position, _, _ in poses:
        points.InsertNextPoint(position)
    data.SetPoints(points)
    for name, vectors in (("Axial", [p[1] for p in poses]), ("Lateral", [p[2] for p in poses])):
        array = numpy_to_vtk(np.array(vectors), deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    return data


def as_table(poses):
    table = vtkTable()
    for part, name in enumerate(PARTS):
        for axis in range(3):
            array = numpy_to_vtk(np.array([p[part][axis] for p in poses]), deep=True)
            array.SetName(name + "XYZ"[axis])
            table.AddColumn(array)
    return table


class TestSweep(unittest.TestCase):
    def setUp(self):
        self.chain = Chain()
        self.sweep = make(vtkSonoSweep, PixelMm=0.6)
        self.sweep.SetInputConnection(0, self.chain.scene.GetOutputPort())
        self.sweep.SetInputConnection(1, self.chain.probe.GetOutputPort())
        tracer, own = self.chain.tracer, self.sweep.GetRayTracer()
        own.SetPathsPerLine(tracer.GetPathsPerLine())
        for name in ("MaxCollisions", "CoherenceMm", "LobeSigmaDeg"):
            getattr(tracer, "Set" + name)(getattr(own, "Get" + name)())
        self.chain.bmode.SetTgcDbPerCm(self.sweep.GetBMode().GetTgcDbPerCm())
        self.chain.converter.SetPixelMm(0.6)

    def expect_sentence(self, *words):
        said = listen(self.sweep)
        self.sweep.Update()
        self.assertEqual(len(said), 1, said)
        for word in words:
            self.assertIn(word.lower(), said[0].lower())
        self.assertEqual(self.sweep.GetOutputDataObject(0).GetNumberOfPoints(), 0)

    def test_images_are_those_of_the_poses(self):
        poses = poses_around(self.chain.probe)
        self.sweep.SetInputData(2, as_points(poses))
        self.sweep.Update()
        images = self.sweep.GetOutputDataObject(0)
        for n, (position, axial, lateral) in enumerate(poses):
            self.chain.probe.SetPositionMm(position)
            self.chain.probe.SetAxial(axial)
            self.chain.probe.SetLateral(lateral)
            self.chain.converter.Update()
            flat = self.chain.converter.GetOutputDataObject(1)
            for name in ("BMode", "Mask", "Labels"):
                np.testing.assert_array_equal(stack(images, name)[n], stack(flat, name)[0], f"{name} of pose {n}")
        self.assertEqual(images.GetDimensions(), flat.GetDimensions()[:2] + (3,))
        np.testing.assert_allclose(images.GetSpacing()[:2], flat.GetSpacing()[:2])
        np.testing.assert_allclose(images.GetOrigin()[:2], flat.GetOrigin()[:2], atol=1e-9)
        self.assertEqual(images.GetPointData().GetScalars().GetName(), "BMode")
        self.assertFalse(np.array_equal(stack(images, "BMode")[0], stack(images, "BMode")[1]))
        self.assertTrue(images.GetFieldData().HasArray("LabelNames"))

    def test_poses_come_out_as_they_were_used(self):
        poses = poses_around(self.chain.probe)
        self.sweep.SetInputData(2, as_points(poses))
        self.sweep.Update()
        table = self.sweep.GetOutputDataObject(1)
        self.assertEqual(table.GetNumberOfRows(), 3)
        for n, (position, axial, _) in enumerate(poses):
            row = {name: np.array([table.GetValueByName(n, name + x).ToDouble() for x in "XYZ"]) for name in PARTS}
            np.testing.assert_allclose(row["Position"], position)
            np.testing.assert_allclose(row["Axial"], axial / np.linalg.norm(axial))
            self.assertAlmostEqual(float(row["Axial"] @ row["Lateral"]), 0.0)
        # They are poses themselves.
        first = stack(self.sweep.GetOutputDataObject(0), "BMode").copy()
        again = vtkTable()
        again.DeepCopy(table)
        self.sweep.SetInputData(2, again)
        self.sweep.Update()
        np.testing.assert_array_equal(stack(self.sweep.GetOutputDataObject(0), "BMode"), first)

    def test_a_label_map_is_as_good_as_its_scene(self):
        poses = as_table(poses_around(self.chain.probe, 2))
        self.sweep.SetInputData(2, poses)
        self.sweep.Update()
        of_scene = stack(self.sweep.GetOutputDataObject(0), "BMode").copy()
        self.sweep.SetInputConnection(0, self.chain.thorax.GetOutputPort())
        self.sweep.Update()
        np.testing.assert_array_equal(stack(self.sweep.GetOutputDataObject(0), "BMode"), of_scene)

    def test_settings_are_the_stages(self):
        self.sweep.SetInputData(2, as_points(poses_around(self.chain.probe, 2)))
        self.sweep.Update()
        before = stack(self.sweep.GetOutputDataObject(0), "BMode").copy()
        self.sweep.GetBMode().SetGainDb(6.0)
        self.sweep.Update()
        self.assertGreater(int(stack(self.sweep.GetOutputDataObject(0), "BMode").sum()), int(before.sum()))
        self.sweep.WithLabelsOff()
        self.sweep.Update()
        self.assertFalse(self.sweep.GetOutputDataObject(0).GetPointData().HasArray("Labels"))

    def test_more_poses_make_a_larger_stack(self):
        for count in (1, 4, 2):
            self.sweep.SetInputData(2, as_points(poses_around(self.chain.probe, count)))
            self.sweep.Update()
            self.assertEqual(self.sweep.GetOutputDataObject(0).GetDimensions()[2], count)

    def test_progress_and_abort(self):
        self.sweep.SetInputData(2, as_points(poses_around(self.chain.probe, 4)))
        seen = []
        self.sweep.AddObserver("ProgressEvent", lambda *_: seen.append(self.sweep.GetProgress()))
        self.sweep.Update()
        self.assertEqual(seen, sorted(seen))
        self.assertGreater(len(set(seen)), 3)
        self.sweep.Modified()
        self.sweep.AddObserver("ProgressEvent", lambda *_: self.sweep.SetAbortExecuteAndUpdateTime())
        said = listen(self.sweep)
        self.sweep.Update()
        self.assertEqual(said, [])
        self.assertEqual(self.sweep.GetOutputDataObject(0).GetNumberOfPoints(), 0)

    def test_missing_inputs(self):
        self.expect_sentence("no poses")
        self.sweep.SetInputData(2, vtkPolyData())
        self.expect_sentence("Axial")
        self.sweep.SetInputData(2, as_points(poses_around(self.chain.probe)))
        self.sweep.RemoveAllInputConnections(1)
        self.expect_sentence("no probe")
        self.sweep.SetInputConnection(1, self.chain.probe.GetOutputPort())
        self.sweep.RemoveAllInputConnections(0)
        self.expect_sentence("no label map")

    def test_bad_poses(self):
        table = as_table(poses_around(self.chain.probe))
        table.RemoveColumnByName("AxialY")
        self.sweep.SetInputData(2, table)
        self.expect_sentence("'AxialY'")
        poses = poses_around(self.chain.probe)
        poses[1] = (poses[1][0], poses[1][1], poses[1][1])
        self.sweep.SetInputData(2, as_points(poses))
        self.expect_sentence("pose 1")
        poses = poses_around(self.chain.probe)
        poses[2] = (poses[2][0] + 5000.0, poses[2][1], poses[2][2])
        self.sweep.SetInputData(2, as_points(poses))
        self.expect_sentence("pose 2", "label map")
        self.sweep.SetInputData(2, as_table(poses[:0]))
        self.expect_sentence("no poses")

    def test_a_matrix_fills_no_image(self):
        matrix = make(vtkSonoProbeSource, ScanKind=3, LineCount=4, ElevationLineCount=3, DepthMm=90.0)
        self.sweep.SetInputConnection(1, matrix.GetOutputPort())
        self.sweep.SetInputData(2, as_points(poses_around(self.chain.probe)))
        self.expect_sentence("volume")


if __name__ == "__main__":
    unittest.main()
