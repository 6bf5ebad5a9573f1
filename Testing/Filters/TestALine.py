"""One scan line as a table, where it lies, and which one is nearest to a place; and the scale beside the flat image."""
import unittest

import numpy as np
from chain import Chain, listen, make
from sonovdb.vtkSonoFilters import vtkSonoALine, vtkSonoFlatScale
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkFieldData

LINEAR, SECTOR, CURVILINEAR, MATRIX, RADIAL = range(5)


class TestALine(unittest.TestCase):
    def setUp(self):
        self.chain = Chain()
        self.line = make(vtkSonoALine, Line=3)
        self.line.SetInputConnection(self.chain.formation.GetOutputPort())

    def ends(self, port):
        self.line.Update()
        return vtk_to_numpy(self.line.GetOutputDataObject(port).GetPoints().GetData())

    def test_flat_line_of_a_sector(self):
        """Twelve lines over 60 degrees; the fourth points to -30 + 3 * 60 / 11 degrees."""
        angle = np.radians(-30 + 3 * 60 / 11)
        start, end = self.ends(1)
        np.testing.assert_allclose(start[:2], 0, atol=1e-9)
        np.testing.assert_allclose(end[:2], [90 * np.sin(angle), 90 * np.cos(angle)], atol=1e-5)
        self.assertLess(end[2], 0)  # in front of the image
        self.assertGreater(end[2], -1)

    def test_the_line_in_the_world_is_the_flat_one_at_the_probes_place(self):
        for kind in (LINEAR, SECTOR, CURVILINEAR, RADIAL):
            with self.subTest(kind=kind):
                self.chain.probe.SetScanKind(kind)
                flat, world = self.ends(1), self.ends(2)
                position, axial, lateral = (np.array(getattr(self.chain.probe, "Get" + name)())
                                            for name in ("PositionMm", "Axial", "Lateral"))
                axial /= np.linalg.norm(axial)
                lateral -= (lateral @ axial) * axial
                lateral /= np.linalg.norm(lateral)
                np.testing.assert_allclose(position + flat[:, :1] * lateral + flat[:, 1:2] * axial, world, atol=1e-6)
                self.assertAlmostEqual(np.linalg.norm(world[1] - world[0]), 90, places=6)

    def test_a_place_on_a_line_is_that_lines(self):
        for kind in (LINEAR, SECTOR, CURVILINEAR, RADIAL):
            self.chain.probe.SetScanKind(kind)
            for number in (0, 3, 7, 11):
                with self.subTest(kind=kind, line=number):
                    self.line.SetLine(number)
                    flat = self.ends(1)
                    field = self.line.GetInputDataObject(0, 0).GetFieldData()
                    for along in (0.2, 0.9):
                        x, y = (flat[0] + along * (flat[1] - flat[0]))[:2]
                        self.assertEqual(vtkSonoALine.LineAt(field, x, y), number)

    def test_places_beside_the_scan_are_no_lines(self):
        self.line.Update()
        field = self.line.GetInputDataObject(0, 0).GetFieldData()
        for x, y in ((80, 20), (0, -5), (0, 95), (-60, 60)):
            self.assertEqual(vtkSonoALine.LineAt(field, x, y), -1)
        self.assertEqual(vtkSonoALine.LineAt(vtkFieldData(), 0, 10), -1)

    def test_a_matrix_has_no_plane_to_pick_in(self):
        self.chain.probe.SetScanKind(MATRIX)
        self.chain.probe.SetElevationLineCount(3)
        self.line.Update()
        self.assertEqual(vtkSonoALine.LineAt(self.line.GetInputDataObject(0, 0).GetFieldData(), 0, 10), -1)


class TestFlatScale(unittest.TestCase):
    def setUp(self):
        self.chain = Chain()
        self.scale = vtkSonoFlatScale()
        self.scale.SetInputConnection(self.chain.probe.GetOutputPort())

    def drawn(self):
        """The strokes, as pairs of points, and the centre of the marker's dot."""
        self.scale.Update()
        data = self.scale.GetOutput()
        points = vtk_to_numpy(data.GetPoints().GetData())
        parts = vtk_to_numpy(data.GetCellData().GetArray("Part"))
        strokes = np.array([[cell.GetPointId(0), cell.GetPointId(1)] for i in np.flatnonzero(parts == 0)
                            for cell in [data.GetCell(int(i))] if cell.GetNumberOfPoints() == 2])
        (dot,) = (int(i) for i in np.flatnonzero(parts == 1) if data.GetCell(i).GetNumberOfPoints() > 20)
        corners = [data.GetPoint(data.GetCell(dot).GetPointId(i)) for i in range(data.GetCell(dot).GetNumberOfPoints())]
        return points[strokes], np.mean(corners, axis=0)

    def test_a_tick_each_centimetre_left_of_the_fan_and_the_marker_right_of_the_face(self):
        for kind, half_width, face, offset in ((SECTOR, 45, 0, 0), (LINEAR, 19, 19, 0), (RADIAL, 75, 30, 60)):
            with self.subTest(kind=kind):
                self.chain.probe.SetScanKind(kind)
                strokes, marker = self.drawn()
                ruler, ticks = strokes[0], strokes[1:]
                np.testing.assert_allclose(ruler[:, 1], [offset, offset + 90], atol=1e-4)
                np.testing.assert_allclose(ticks[:, :, 1], 10 * np.arange(10)[:, None] + [offset, offset], atol=1e-4)
                self.assertLess(ruler[0, 0], -half_width)
                lengths = ticks[:, 0, 0] - ticks[:, 1, 0]
                self.assertEqual([i for i in range(10) if lengths[i] > 1.5 * lengths.min()], [0, 5])
                self.assertGreater(marker[0], face)
                self.assertAlmostEqual(marker[1], 0, places=5)

    def test_the_marker_is_a_dot_clear_of_a_curved_array_s_fan(self):
        """Of 60 mm radius and 70 degrees: the distance to the outermost line, and to the face, in closed form."""
        self.chain.probe.SetScanKind(CURVILINEAR)
        self.chain.probe.SetRadiusMm(60)
        self.chain.probe.SetSectorDeg(70)
        self.chain.probe.SetDepthMm(150)
        _, marker = self.drawn()
        data = self.scale.GetOutput()
        parts = vtk_to_numpy(data.GetCellData().GetArray("Part"))
        self.assertEqual(np.count_nonzero(parts == 1), 1)  # no letter
        dot = data.GetCell(int(np.flatnonzero(parts == 1)[0])).GetBounds()
        radius = (dot[1] - dot[0]) / 2
        half = np.radians(35)
        to_line = marker[0] * np.cos(half) - (marker[1] + 60) * np.sin(half)
        self.assertGreater(to_line, 1.5 * radius)
        self.assertLess(to_line, 10 * radius)

    def test_a_matrix_has_that_of_its_middle_plane(self):
        self.chain.probe.SetScanKind(MATRIX)
        of_matrix, _ = self.drawn()
        self.chain.probe.SetScanKind(SECTOR)
        of_sector, _ = self.drawn()
        np.testing.assert_array_equal(of_matrix, of_sector)

    def test_what_carries_no_probe(self):
        self.scale.SetInputConnection(self.chain.thorax.GetOutputPort())
        said = listen(self.scale)
        self.scale.Update()
        self.assertEqual(len(said), 1)


if __name__ == "__main__":
    unittest.main()
