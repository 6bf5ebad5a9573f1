"""What is drawn, written and measured beside a flat image."""
import math
import unittest

import numpy as np
from chain import Chain, listen, make
from sonovdb.vtkSonoFilters import (vtkSonoCaliper, vtkSonoFlatLabels, vtkSonoFlatPixel, vtkSonoFlatScale,
                                    vtkSonoFlatText, vtkSonoUltrasound)
from vtkmodules.util.numpy_support import vtk_to_numpy

LINEAR, SECTOR, CURVILINEAR, MATRIX = range(4)


class Flat(unittest.TestCase):
    def setUp(self):
        self.chain = Chain()

    def on_flat(self, kind):
        filter = kind()
        filter.SetInputConnection(self.chain.converter.GetOutputPort(1))
        filter.Update()
        return filter


def text_of(filter):
    filter.Update()
    return filter.GetOutput().GetColumn(0).GetValue(0).split("\n")


class TestFlatText(Flat):
    def test_it_says_what_the_picture_was_made_with(self):
        """Pictures per second: c / (2 depth lines), by hand."""
        text = self.on_flat(vtkSonoFlatText)
        self.assertEqual(text_of(text), ["Phased array P4-2", "2.5 MHz", "Depth 90 mm", "Gain 0 dB", "Range 60 dB",
                                         f"{round(1540e3 / (2 * 90 * 12), 1):g} Hz", "20 paths a line"])

    def test_it_follows_gain_depth_and_mode(self):
        text = self.on_flat(vtkSonoFlatText)
        self.chain.bmode.SetGainDb(7.5)
        self.chain.bmode.SetDynamicRangeDb(48)
        self.assertEqual(text_of(text)[3:5], ["Gain 7.5 dB", "Range 48 dB"])
        self.chain.probe.SetDepthMm(120)
        self.chain.probe.SetImagingMode(1)
        self.chain.probe.SetCentreFrequencyMHz(1.7)
        said = text_of(text)
        self.assertEqual(said[1:3], ["1.7 / 3.4 MHz harmonic", "Depth 120 mm"])
        self.assertEqual(said[5], f"{round(1540e3 / (2 * 120 * 12), 1):g} Hz")

    def test_another_array_has_no_preset_s_name(self):
        self.chain.probe.SetScanKind(LINEAR)
        self.assertEqual(text_of(self.on_flat(vtkSonoFlatText))[0], "Linear")

    def test_one_filter_says_the_same_and_what_error_was_reached(self):
        one = make(vtkSonoUltrasound, LineCount=12, DepthMm=90.0, SectorDeg=60.0, PathsPerLine=20, BuildSurfaces=False,
                   PositionMm=self.chain.probe.GetPositionMm(), Axial=self.chain.probe.GetAxial(),
                   Lateral=self.chain.probe.GetLateral(), GainDb=3.0)
        one.SetInputConnection(self.chain.thorax.GetOutputPort())
        text = vtkSonoFlatText()
        text.SetInputConnection(one.GetOutputPort(vtkSonoUltrasound.FLAT_IMAGE))
        self.chain.bmode.SetGainDb(3.0)
        self.assertEqual(text_of(text), text_of(self.on_flat(vtkSonoFlatText)))
        one.GetRayTracer().SetPathsPerLine(512)
        one.GetRayTracer().SetTargetErrorDb(2.0)
        said = text_of(text)
        error = one.GetOutput().GetFieldData().GetArray("ErrorDb").GetValue(0)
        self.assertEqual(said[-1], f"Error {round(error, 1):g} dB")

    def test_it_never_says_what_the_field_data_hold_besides(self):
        words = " ".join(text_of(self.on_flat(vtkSonoFlatText)))
        self.assertNotIn("heart", words)
        self.assertNotIn("Labels", words)


class TestFlatScaleBeside(Flat):
    def part(self, scale, number):
        """Number of points, bounds and colour of each cell."""
        data = scale.GetOutput()
        parts = vtk_to_numpy(data.GetCellData().GetArray("Part"))
        colors = vtk_to_numpy(data.GetCellData().GetArray("Color"))
        return [(data.GetCell(int(i)).GetNumberOfPoints(), data.GetCell(int(i)).GetBounds(), colors[i])
                for i in np.flatnonzero(parts == number)]

    def test_the_lateral_ruler_counts_from_the_middle(self):
        scale = self.on_flat(vtkSonoFlatScale)
        lines = [bounds for count, bounds, _ in self.part(scale, 2) if count == 2]
        self.assertEqual([round(b[0], 4) for b in lines[1:]], [10.0 * cm for cm in range(-4, 5)])  # 90 mm sin(30)
        self.assertGreater(lines[0][2], 90)

    def test_the_grey_bar_runs_from_white_to_black(self):
        bars = [(bounds, color) for count, bounds, color in self.part(self.on_flat(vtkSonoFlatScale), 3)
                if count == 4][:32]
        greys = [int(color[0]) for _, color in bars]
        tops = [bounds[2] for bounds, _ in bars]
        self.assertEqual((greys[0], greys[-1]), (255, 0))
        self.assertEqual(greys, sorted(greys, reverse=True))
        self.assertEqual(tops, sorted(tops))
        self.assertGreater(min(bounds[0] for bounds, _ in bars), 45)  # beyond the fan


class TestFlatLabels(Flat):
    def test_strokes_lie_between_pixels_of_other_labels(self):
        """As many as a brute-force count of neighbours, each in the middle between two; coloured by the table."""
        outlines = self.on_flat(vtkSonoFlatLabels).GetOutput()
        image = self.chain.converter.GetOutput(1)
        width, height, _ = image.GetDimensions()
        labels = vtk_to_numpy(image.GetPointData().GetArray("Labels")).reshape(height, width).astype(int)
        mask = vtk_to_numpy(image.GetPointData().GetArray("Mask")).reshape(height, width) != 0
        across = (labels[:, 1:] != labels[:, :-1]) & mask[:, 1:] & mask[:, :-1]
        down = (labels[1:] != labels[:-1]) & mask[1:] & mask[:-1]
        self.assertEqual(outlines.GetNumberOfCells(), across.sum() + down.sum())
        self.assertGreater(outlines.GetNumberOfCells(), 100)
        points = vtk_to_numpy(outlines.GetPoints().GetData()).reshape(-1, 2, 3)
        which = vtk_to_numpy(outlines.GetCellData().GetArray("Label"))
        colors = vtk_to_numpy(outlines.GetCellData().GetArray("Color"))
        field = image.GetFieldData()
        table = {int(field.GetArray("LabelIds").GetValue(i)): field.GetArray("LabelColors").GetTuple3(i)
                 for i in range(field.GetArray("LabelIds").GetNumberOfTuples())}
        (x0, y0, _), step = image.GetOrigin(), image.GetSpacing()[0]
        for i in range(0, len(points), 37):
            centre = points[i].mean(axis=0)[:2]
            run = points[i, 1, :2] - points[i, 0, :2]
            normal = np.array([run[1], run[0]]) / 2
            sides = [np.rint((centre + sign * normal - (x0, y0)) / step).astype(int) for sign in (-1, 1)]
            found = {labels[y, x] for x, y in sides}
            self.assertEqual(len(found), 2)
            self.assertIn(which[i], found)
            self.assertEqual(which[i], min(found, key=lambda label: (labels[mask] == label).sum()))
            np.testing.assert_allclose(colors[i] / 255, table[which[i]], atol=1 / 254)

    def test_an_image_without_labels_is_named(self):
        outlines = vtkSonoFlatLabels()
        outlines.SetInputConnection(self.chain.bmode.GetOutputPort())
        said = listen(outlines)
        outlines.Update()
        self.assertEqual(len(said), 1)


class TestFlatPixel(Flat):
    def test_it_is_the_label_and_grey_of_the_array(self):
        reading = self.on_flat(vtkSonoFlatPixel)
        image = self.chain.converter.GetOutput(1)
        field = image.GetFieldData()
        names = {int(field.GetArray("LabelIds").GetValue(i)): field.GetAbstractArray("LabelNames").GetValue(i)
                 for i in range(field.GetArray("LabelIds").GetNumberOfTuples())}
        seen = set()
        for x, y in ((0, 20), (0, 50), (10, 70), (-20, 60), (5.1, 85.3)):
            reading.SetPlaceMm(x, y)
            reading.Update()
            table = reading.GetOutput()
            at = image.FindPoint(x, y, 0)
            label = int(image.GetPointData().GetArray("Labels").GetValue(at))
            grey = int(image.GetPointData().GetArray("BMode").GetValue(at))
            self.assertEqual(table.GetValueByName(0, "Structure").ToString(), names[label])
            self.assertEqual(table.GetValueByName(0, "Label").ToInt(), label)
            self.assertEqual(table.GetValueByName(0, "Grey").ToInt(), grey)
            self.assertAlmostEqual(table.GetValueByName(0, "Depth (mm)").ToDouble(), math.hypot(x, y), places=3)
            sentence = reading.GetSentence()
            self.assertTrue(sentence.startswith(names[label]), sentence)
            self.assertTrue(sentence.endswith(f"{math.hypot(x, y):.1f} mm, grey {grey}"), sentence)
            self.assertTrue(table.GetValueByName(0, "Tissue").ToString(), sentence)
            seen.add(label)
        self.assertGreater(len(seen), 2)

    def test_outside_of_the_fan_there_is_nothing(self):
        reading = self.on_flat(vtkSonoFlatPixel)
        for place in ((80, 10), (0, 95), (-500, 0)):
            reading.SetPlaceMm(*place)
            reading.Update()
            self.assertEqual(reading.GetOutput().GetNumberOfRows(), 0)
            self.assertEqual(reading.GetSentence(), "")

    def test_the_sentence_starts_no_simulation(self):
        reading = vtkSonoFlatPixel()
        reading.SetInputConnection(self.chain.converter.GetOutputPort(1))
        self.assertEqual(reading.GetSentence(), "")
        self.assertEqual(self.chain.converter.GetOutput(1).GetNumberOfPoints(), 0)


class TestCaliper(unittest.TestCase):
    def measured(self, kind, *points):
        caliper = vtkSonoCaliper()
        caliper.SetKind(kind)
        for number, point in enumerate(points, 1):
            getattr(caliper, f"SetPoint{number}Mm")(*point)
        caliper.Update()
        field = caliper.GetOutput().GetFieldData()
        return field.GetArray("Value").GetValue(0), field.GetAbstractArray("Text").GetValue(0), caliper.GetOutput()

    def test_distance(self):
        value, text, drawn = self.measured(vtkSonoCaliper.Distance, (10, 20, 0), (40, 60, 0))
        self.assertAlmostEqual(value, 50, places=9)
        self.assertEqual(text, "50.0 mm")
        self.assertGreater(drawn.GetNumberOfPolys(), 3)  # letters

    def test_ellipse_in_mm2_and_cm2(self):
        value, text, _ = self.measured(vtkSonoCaliper.Ellipse, (0, 0, 0), (10, 0, 0), (5, 2, 0))
        self.assertAlmostEqual(value, math.pi * 5 * 2, places=9)
        self.assertEqual(text, "31.4 mm^2")
        value, text, drawn = self.measured(vtkSonoCaliper.Ellipse, (-20, 60, 0), (20, 60, 0), (0, 72, 0))
        self.assertAlmostEqual(value, math.pi * 20 * 12, places=9)
        self.assertEqual(text, "7.54 cm^2")
        border = next(drawn.GetCell(i) for i in range(drawn.GetNumberOfCells()) if drawn.GetCell(i).GetNumberOfPoints() > 60)
        np.testing.assert_allclose(border.GetBounds()[:4], (-20, 20, 48, 72), atol=1e-4)

    def test_angle(self):
        value, text, _ = self.measured(vtkSonoCaliper.Angle, (0, 50, 0), (30, 50, 0), (10, 60, 0))
        self.assertAlmostEqual(value, 45, places=9)
        self.assertEqual(text, "45.0 deg")

    def test_it_has_no_depth(self):
        value, _, _ = self.measured(vtkSonoCaliper.Distance, (0, 0, 5), (3, 4, -70))
        self.assertAlmostEqual(value, 5, places=9)


if __name__ == "__main__":
    unittest.main()
