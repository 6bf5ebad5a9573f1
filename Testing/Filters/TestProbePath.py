"""A probe's path, as a sweep takes it."""
import math
import unittest

from chain import listen
from sonovdb.vtkSonoFilters import vtkSonoProbePath


def refusal_of(path):
    said = listen(path)
    path.Update()
    return " ".join(said)


class TestProbePath(unittest.TestCase):
    def test_its_points_carry_unit_directions_and_times(self):
        path = vtkSonoProbePath()
        path.SetPose(0, 0.0, 1, 2, 3, 0, 0, 2, 5, 0, 5)  # a lateral direction that is not at right angles
        path.SetPose(1, 0.25, 4, 2, 3, 0, 3, 0, 0, 0, -1)
        path.Update()
        line = path.GetOutput()
        self.assertEqual(line.GetNumberOfPoints(), 2)
        self.assertEqual(line.GetNumberOfLines(), 1)
        self.assertEqual(line.GetPoint(1), (4, 2, 3))
        data = line.GetPointData()
        self.assertEqual(data.GetArray("Axial").GetTuple(0), (0, 0, 1))
        for a, b in zip(data.GetArray("Lateral").GetTuple(0), (1, 0, 0)):
            self.assertAlmostEqual(a, b)
        self.assertEqual(data.GetArray("Axial").GetTuple(1), (0, 1, 0))
        self.assertEqual([data.GetArray("TimeS").GetValue(i) for i in range(2)], [0, 0.25])
        self.assertTrue(math.isclose(line.GetBounds()[1] - line.GetBounds()[0], 3))

    def test_fewer_poses(self):
        path = vtkSonoProbePath()
        for i in range(3):
            path.SetPose(i, i, i, 0, 0, 0, 0, 1, 1, 0, 0)
        path.SetNumberOfPoses(2)
        path.Update()
        self.assertEqual(path.GetOutput().GetNumberOfPoints(), 2)

    def test_what_is_no_path_is_refused(self):
        self.assertIn("has no poses", refusal_of(vtkSonoProbePath()))
        back = vtkSonoProbePath()
        back.SetPose(0, 1.0, 0, 0, 0, 0, 0, 1, 1, 0, 0)
        back.SetPose(1, 0.5, 0, 0, 0, 0, 0, 1, 1, 0, 0)
        self.assertIn("must not go back", refusal_of(back))
        parallel = vtkSonoProbePath()
        parallel.SetPose(0, 0.0, 0, 0, 0, 0, 0, 1, 0, 0, 1)
        self.assertIn("Pose 0", refusal_of(parallel))


if __name__ == "__main__":
    unittest.main()
