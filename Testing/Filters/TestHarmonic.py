"""The harmonic picture differs from the fundamental one as it should; bad input gets a sentence."""
import unittest

import numpy as np
from chain import Chain, listen
from vtkmodules.util.numpy_support import vtk_to_numpy

HARMONIC = 1


def lines_of(stage, name):
    stage.Update()
    image = stage.GetOutput()
    samples, lines, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetArray(name)).reshape(lines, samples)


class TestHarmonic(unittest.TestCase):
    def setUp(self):
        self.chain = Chain()
        self.chain.probe.SetCentreFrequencyMHz(1.8)

    def test_grows_from_nothing_and_is_weaker(self):
        fundamental = lines_of(self.chain.tracer, "Intensity").copy()
        self.chain.probe.SetImagingMode(HARMONIC)
        harmonic = lines_of(self.chain.tracer, "Intensity")
        lit = fundamental > 1e-4
        share = np.where(lit, harmonic / np.where(lit, fundamental, 1.0), 0.0)
        self.assertGreater(lit.mean(), 0.2)
        self.assertLess(share[:, :4].max(), 0.01)
        self.assertLess(share.max(), 1.0)
        self.assertTrue(np.isfinite(harmonic).all())

    def test_grows_with_the_pressure(self):
        self.chain.probe.SetImagingMode(HARMONIC)
        weak = [lines_of(self.chain.tracer, "Intensity").copy()
                for kpa in (10.0, 20.0) if self.chain.probe.SetFacePressureKPa(kpa) is None]
        seen = weak[0] > 1e-12
        np.testing.assert_allclose(weak[1][seen] / weak[0][seen], 2.0, rtol=2e-2)

    def test_the_fundamental_knows_no_pressure(self):
        pictures = []
        for kpa in (500.0, 50.0):
            self.chain.probe.SetFacePressureKPa(kpa)
            pictures.append(lines_of(self.chain.formation, "Envelope").copy())
        np.testing.assert_array_equal(*pictures)

    def test_is_finer_along_the_line(self):
        def steepness(envelope):
            """Of speckle's level along the lines, where there is some."""
            level = np.log(envelope[:, 300:2000].astype(float) + 1e-30)
            return np.median(np.abs(np.diff(level, axis=1))[level[:, 1:] > -30.0])
        self.chain.tracer.SetSamplingMHz(50.0)
        fundamental = steepness(lines_of(self.chain.formation, "Envelope"))
        self.chain.probe.SetImagingMode(HARMONIC)
        # The band is the root of 2 as wide.
        ratio = steepness(lines_of(self.chain.formation, "Envelope")) / fundamental
        self.assertGreater(ratio, 1.2)
        self.assertLess(ratio, 1.6)

    def test_refuses_what_it_cannot_do(self):
        self.chain.probe.SetImagingMode(HARMONIC)
        heard = listen(self.chain.formation)
        self.chain.tracer.SetSamplingMHz(7.0)
        self.chain.formation.Update()
        self.assertEqual(len(heard), 1)
        self.assertIn("second harmonic lies at 3.6 MHz, not below half the sampling frequency of 7 MHz", heard[0])
        self.chain.tracer.SetSamplingMHz(50.0)
        heard = listen(self.chain.tracer)
        self.chain.tracer.SetInterfaceModel(1)
        self.chain.tracer.Update()
        self.assertEqual(len(heard), 1)
        self.assertIn("no second harmonic", heard[0])


if __name__ == "__main__":
    unittest.main()
