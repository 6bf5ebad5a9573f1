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
        lit = fundamental[:, :200].min(axis=1) > 0.0
        share = harmonic[lit] / np.maximum(fundamental[lit], 1e-30)
        self.assertTrue(lit.any())
        self.assertLess(share[:, 0].max(), 0.01)
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
        def grain(envelope):
            power = envelope[:, envelope.shape[1] // 4:] ** 2
            spectrum = (np.abs(np.fft.rfft(power - power.mean(axis=1, keepdims=True), axis=1)) ** 2).sum(axis=0)
            return (spectrum * np.arange(spectrum.size)).sum() / spectrum.sum()
        fundamental = grain(lines_of(self.chain.formation, "Envelope").astype(float))
        self.chain.probe.SetImagingMode(HARMONIC)
        self.assertGreater(grain(lines_of(self.chain.formation, "Envelope").astype(float)), 1.1 * fundamental)

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
