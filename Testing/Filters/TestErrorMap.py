"""The error map shows the standard error of the traced lines, in percent, at their places in the image."""
import unittest

import numpy as np
from chain import Chain, listen, make, shown_deeper
from sonovdb.vtkSonoFilters import vtkSonoErrorMap, vtkSonoUltrasound
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

IMAGE, FLAT_IMAGE, ERROR_MAP = 0, 7, 8


def array(image, name):
    """A point array of an image of one slice, by row and column."""
    columns, rows, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetArray(name)).reshape(rows, columns)


def traced_lines(chain):
    """Intensity and standard error by line and bin."""
    chain.tracer.Update()
    lines = chain.tracer.GetOutput()
    return array(lines, "Intensity").astype(float), array(lines, "StandardError").astype(float)


class TestErrorMap(unittest.TestCase):
    def setUp(self):
        self.chain = Chain()
        self.chain.probe.SetLineCount(13)  # one in the middle
        self.chain.tracer.SetReverberation(False)
        self.map = make(vtkSonoErrorMap, PixelMm=0.5)
        self.map.SetInputConnection(self.chain.tracer.GetOutputPort())

    def test_percentages_lie_where_their_lines_do(self):
        """Each pixel by hand: its angle and range, and the values of the lines beside it, known at every half a bin of
        range by the depth that is shown there."""
        intensity, error = traced_lines(self.chain)
        with np.errstate(invalid="ignore"):
            percent = np.where(intensity > 0, 100 * error / intensity, 100)
        middles = 0.25 * np.arange(percent.shape[1]) + 0.125
        samples = 0.125 * np.arange(2 * percent.shape[1])
        traced = self.chain.tracer.GetOutput()
        percent = np.array([np.interp(samples + shown_deeper(traced, n, samples), middles, of_line)
                            for n, of_line in enumerate(percent)])
        self.map.Update()
        flat = self.map.GetOutputDataObject(1)
        made, mask = array(flat, "ErrorPercent"), array(flat, "Mask")
        rows, columns = made.shape
        x_mm = (flat.GetOrigin()[0] + flat.GetSpacing()[0] * np.arange(columns))[None, :]
        y_mm = (flat.GetOrigin()[1] + flat.GetSpacing()[1] * np.arange(rows))[:, None]
        line = (np.degrees(np.arctan2(x_mm, y_mm)) + 30) / 60 * 12
        halves = np.hypot(x_mm, y_mm) / 0.125
        inside = (line > 0.01) & (line < 11.99) & (halves < 720) & (halves > 5)
        self.assertGreater(inside.sum(), 5000)
        line, halves = line[inside], halves[inside]
        low, near = line.astype(int), halves.astype(int)
        across, along = line - low, halves - near
        by_hand = ((1 - across) * ((1 - along) * percent[low, near] + along * percent[low, near + 1])
                   + across * ((1 - along) * percent[low + 1, near] + along * percent[low + 1, near + 1]))
        np.testing.assert_allclose(made[inside], by_hand, atol=0.05)
        self.assertTrue((mask[inside] == 1).all())
        self.assertTrue(np.isnan(made[mask == 0]).all())
        self.assertGreaterEqual(made[mask == 1].min(), 0)
        self.assertLessEqual(made[mask == 1].max(), 100)

    def test_it_is_the_spread_over_seeds(self):
        """At places down the middle line, the map's error against how much the intensity differs from seed to seed."""
        self.map.SetPixelMm(0.125)
        self.chain.tracer.SetPathsPerLine(200)
        bins = np.arange(60, 340, 20)
        intensities, percents = [], []
        for seed in range(1, 241):
            self.chain.tracer.SetPathSeed(seed)
            intensities.append(traced_lines(self.chain)[0][6, bins])
            self.map.Update()
            percent = array(self.map.GetOutputDataObject(0), "ErrorPercent")
            percents.append(percent[2 * bins + 1, percent.shape[1] // 2])
        mean = np.mean(intensities, axis=0)
        spread = 100 * np.std(intensities, axis=0, ddof=1) / mean
        reported = np.sqrt(np.mean(np.square(np.multiply(percents, intensities)), axis=0)) / mean
        self.assertGreater(spread.max(), 2)
        ratio = reported[spread > 1] / spread[spread > 1]
        self.assertGreater(len(ratio), 8)
        self.assertAlmostEqual(np.median(ratio), 1, delta=0.1)
        self.assertLess(np.abs(ratio - 1).max(), 0.3)

    def test_it_lies_on_the_image(self):
        self.chain.converter.SetPixelMm(0.5)
        for stage in (self.map, self.chain.converter):
            stage.Update()
        for port in (0, 1):
            made, image = (stage.GetOutputDataObject(port) for stage in (self.map, self.chain.converter))
            for place in ("GetOrigin", "GetSpacing", "GetDimensions"):
                self.assertEqual(getattr(made, place)(), getattr(image, place)())
            for row in range(3):
                for column in range(3):
                    self.assertEqual(made.GetDirectionMatrix().GetElement(row, column),
                                     image.GetDirectionMatrix().GetElement(row, column))
            # The last bins end at the depth, the last sample of RF before it.
            differ = array(made, "Mask") != array(image, "Mask")
            self.assertLess(differ.mean(), 1e-3)

    def test_of_a_matrix_it_is_a_volume(self):
        for name, value in (("ScanKind", 3), ("ElevationLineCount", 3), ("ElevationSectorDeg", 40.0)):
            getattr(self.chain.probe, "Set" + name)(value)
        self.map.SetPixelMm(2.0)
        self.map.Update()
        self.assertGreater(min(self.map.GetOutput().GetDimensions()), 10)
        percent = vtk_to_numpy(self.map.GetOutput().GetPointData().GetArray("ErrorPercent"))
        self.assertGreater(np.nanmax(percent), 5)

    def test_lines_without_an_error(self):
        self.map.SetInputConnection(self.chain.formation.GetOutputPort())
        said = listen(self.map)
        self.map.Update()
        self.assertEqual(len(said), 1, said)
        self.assertIn("Intensity", said[0])


class TestOfSimulateUltrasound(unittest.TestCase):
    def setUp(self):
        self.stages = Chain()
        self.filter = make(vtkSonoUltrasound, LineCount=12, DepthMm=90.0, SectorDeg=60.0, PathsPerLine=20,
                           BuildSurfaces=False, PixelMm=0.5)
        for part in ("PositionMm", "Axial", "Lateral"):
            getattr(self.filter.GetProbe(), "Set" + part)(*getattr(self.stages.probe, "Get" + part)())
        self.filter.SetInputConnection(self.stages.thorax.GetOutputPort())
        self.said = listen(self.filter)

    def outputs(self):
        for port in (IMAGE, ERROR_MAP, FLAT_IMAGE):
            self.filter.Update(port)
            extent = self.filter.GetOutputInformation(port).Get(vtkStreamingDemandDrivenPipeline.WHOLE_EXTENT())
            self.assertEqual(tuple(extent), self.filter.GetOutputDataObject(port).GetExtent())
        self.assertEqual(self.said, [])
        return (self.filter.GetOutputDataObject(port) for port in (IMAGE, ERROR_MAP, FLAT_IMAGE))

    def test_nobody_asked(self):
        image, error_map, flat = self.outputs()
        self.assertEqual(error_map.GetNumberOfPoints(), 0)
        for picture in (image, flat):
            self.assertFalse(picture.GetPointData().HasArray("ErrorPercent"))

    def test_it_is_that_of_the_stage(self):
        self.filter.ErrorMapOn()
        image, error_map, flat = self.outputs()
        stage = make(vtkSonoErrorMap, PixelMm=0.5)
        stage.SetInputConnection(self.filter.GetOutputPort(3))
        stage.Update()
        np.testing.assert_array_equal(array(error_map, "ErrorPercent"), array(stage.GetOutput(), "ErrorPercent"))
        self.assertEqual(error_map.GetDimensions(), image.GetDimensions())
        for picture in (image, flat):
            np.testing.assert_array_equal(array(picture, "ErrorPercent"), array(error_map, "ErrorPercent"))
            self.assertEqual(picture.GetPointData().GetScalars().GetName(), "BMode")

    def test_asking_for_it_traces_nothing_again_and_of_a_moving_probe_nothing_is_known(self):
        self.filter.Update(3)
        before = self.filter.GetOutputDataObject(3).GetPointData().GetArray("Intensity").GetMTime()
        self.filter.ErrorMapOn()
        self.filter.Update()
        self.filter.Update(3)
        self.assertEqual(self.filter.GetOutputDataObject(3).GetPointData().GetArray("Intensity").GetMTime(), before)
        self.filter.GetProbe().SetPreview(True)
        for output in self.outputs():
            self.assertTrue(np.isnan(array(output, "ErrorPercent")).all())
        self.filter.GetProbe().SetPreview(False)
        for output in self.outputs():
            self.assertGreater((array(output, "ErrorPercent") >= 0).sum(), 10000)


if __name__ == "__main__":
    unittest.main()
