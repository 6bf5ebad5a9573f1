"""The beam of an array as a filter, and what a field and a pulse of one's own change in the echoes."""
import json
import pathlib
import tempfile
import unittest

import numpy as np
from chain import Chain, count_runs, listen, make
from sonovdb.vtkSonoFilters import vtkSonoPulseEchoField
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData

PRESET = pathlib.Path(__file__).resolve().parents[2] / "Data" / "probes" / "phased_p4-2.json"

NRRD = """NRRD0004
type: float
encoding: ascii
dimension: 3
sizes: 2 3 2
labels: "lateral" "elevational" "depth"
units: "mm" "mm" "mm"
axis mins: 0 -2 10
spacings: {step} 2 80

1 2 3 4 5 8 1 1 1 1 1 {last}
"""


def field_image(weights, origin, spacing, name="PulseEchoWeight"):
    """A field by hand; weights are indexed [depth, elevational, lateral]."""
    image = vtkImageData()
    image.SetDimensions(weights.shape[::-1])
    image.SetOrigin(origin)
    image.SetSpacing(spacing)
    array = numpy_to_vtk(np.ascontiguousarray(weights, np.float32).ravel(), deep=True)
    array.SetName(name)
    image.GetPointData().SetScalars(array)
    return image


def weights(image):
    return vtk_to_numpy(image.GetPointData().GetArray("PulseEchoWeight")).reshape(image.GetDimensions()[::-1])


def envelope(chain):
    chain.formation.Update()
    return vtk_to_numpy(chain.formation.GetOutput().GetPointData().GetArray("Envelope")).reshape(12, -1).copy()


def small_field(**settings):
    return make(vtkSonoPulseEchoField, ElementCount=8, ElementHeightMm=3.0, TransmitFocusMm=20.0, ElevationFocusMm=20.0,
                FractionalBandwidth=0.0, DepthMm=90.0, **settings)


class TestPulseEchoField(unittest.TestCase):
    def test_defaults_are_the_bundled_phased_array(self):
        preset, field = json.loads(PRESET.read_text()), vtkSonoPulseEchoField()
        for name in ("elementCount", "elementWidthMm", "elementHeightMm", "kerfMm", "transmitFocusMm",
                     "elevationFocusMm", "centreFrequencyMHz", "fractionalBandwidth", "depthMm"):
            with self.subTest(setting=name):
                self.assertEqual(getattr(field, "Get" + name[0].upper() + name[1:])(), preset[name]["value"])

    def test_beam_narrows_towards_its_focus(self):
        """On axis, a boxcar aperture's two-way field falls to half at 0.886 lambda F# from side to side."""
        field = make(vtkSonoPulseEchoField, FractionalBandwidth=0.0)
        field.Update()
        image = field.GetOutput()
        at_focus = weights(image)[round(65.0 / image.GetSpacing()[2]), 0]
        lateral = np.arange(at_focus.size) * image.GetSpacing()[0]
        half = np.interp(-0.5, -at_focus[:12] / at_focus[0], lateral[:12])
        self.assertAlmostEqual(2.0 * half, 0.886 * 1.54 / 3.6 * 65.0 / (64 * 0.295 + 63 * 0.025), delta=0.05)

    def test_kept_until_a_number_changes(self):
        field = small_field()
        field.Update()
        first = weights(field.GetOutput()).copy()
        progress = count_runs(field)
        heard = []
        field.AddObserver("ProgressEvent", lambda *_: heard.append(1))
        field.Modified()
        field.Update()
        again = len(heard)
        field.SetTransmitFocusMm(30.0)
        field.Update()
        self.assertEqual(len(progress), 2)
        self.assertGreater(len(heard) - again, again)  # only the second computes
        self.assertFalse(np.array_equal(weights(field.GetOutput()), first))

    def test_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "field.nrrd"
            path.write_text(NRRD.format(step=1.5, last=1))
            field = make(vtkSonoPulseEchoField, FileName=str(path))
            field.Update()
        image = field.GetOutput()
        self.assertEqual(image.GetDimensions(), (2, 3, 2))
        self.assertEqual(image.GetOrigin(), (0.0, -2.0, 10.0))
        self.assertEqual(image.GetSpacing(), (1.5, 2.0, 80.0))
        np.testing.assert_array_equal(weights(image).ravel() * 8, [1, 2, 3, 4, 5, 8, 1, 1, 1, 1, 1, 1])

    def test_bad_files_and_settings(self):
        def said(field):
            heard = listen(field)
            field.Update()
            self.assertEqual(len(heard), 1, heard)
            return heard[0]

        self.assertIn("nowhere.nrrd", said(make(vtkSonoPulseEchoField, FileName="nowhere.nrrd")))
        for values, word in (({"step": -1.5, "last": 1}, "lateral"), ({"step": 1.5, "last": "nan"}, "nan")):
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder) / "field.nrrd"
                path.write_text(NRRD.format(**values))
                sentence = said(make(vtkSonoPulseEchoField, FileName=str(path)))
                self.assertIn("field.nrrd", sentence)
                self.assertIn(word, sentence.lower())
        for name, value in (("ElementCount", 0), ("KerfMm", -1.0), ("DepthMm", 0.0), ("Apodization", 2)):
            with self.subTest(setting=name):
                self.assertIn(name.lower(), said(make(vtkSonoPulseEchoField, **{name: value})).lower())


class TestFieldInTheImage(unittest.TestCase):
    def setUp(self):
        self.chain = Chain()
        self.chain.tracer.SetDeterministic(True)
        self.chain.probe.SetApertureMm(0)  # one width, that of the table

    def with_field(self, image):
        self.chain.formation.SetInputDataObject(2, image)

    def test_gaussian_table_gives_the_gaussians_image(self):
        self.chain.tracer.SetInterfaceModel(1)  # surfaces are narrower for a Gaussian than for a table's beam
        gaussian = envelope(self.chain)
        x, depths = np.arange(-80, 81) * 0.05, np.ones(2)
        profile = np.exp(-x**2 / 2.0)
        self.with_field(field_image(depths[:, None, None] * profile[:, None] * profile, (-4, -4, 0), (0.05, 0.05, 100)))
        tabled = envelope(self.chain)
        # The table ends at 4 sigma and is linear between its values: an error of at most 0.05^2 / 8 of the peak.
        self.assertLess(np.linalg.norm(tabled - gaussian), 1e-3 * np.linalg.norm(gaussian))

    def test_computed_field_changes_the_image(self):
        gaussian = envelope(self.chain)
        field = small_field()
        self.chain.formation.SetInputConnection(2, field.GetOutputPort())
        shaped = envelope(self.chain)
        self.assertEqual(shaped.shape, gaussian.shape)
        self.assertTrue(np.all(np.isfinite(shaped)))
        self.assertLess(np.corrcoef(shaped.ravel(), gaussian.ravel())[0, 1], 0.99)

    def test_bad_fields(self):
        ones = np.ones((2, 3, 3))
        turned = field_image(ones, (-1, -1, 0), (1, 1, 90))
        turned.SetDirectionMatrix(0, 1, 0, 1, 0, 0, 0, 0, 1)
        holed = ones.copy()
        holed[1, 2, 0] = np.nan
        cases = ((field_image(ones, (-1, -1, 0), (1, 1, 90), "Weight"), "'PulseEchoWeight'"),
                 (turned, "turned axes"),
                 (field_image(ones, (1, -1, 0), (1, 1, 90)), "lateral axis"),
                 (field_image(ones, (-1, -1, -5), (1, 1, 95)), "depth axis"),
                 (field_image(holed, (-1, -1, 0), (1, 1, 90)), "nan"),
                 (field_image(ones, (-1, -1, 0), (1, 1, 30)), "depth"))
        heard = listen(self.chain.formation)
        for image, words in cases:
            with self.subTest(words=words):
                heard.clear()
                self.with_field(image)
                self.chain.formation.Update()
                self.assertEqual(len(heard), 1, heard)
                self.assertIn(words, heard[0])

    def test_pulse_file(self):
        gaussian = envelope(self.chain)
        time_us = np.arange(-100, 101) * 0.02
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "pulse.csv"
            # Four times as long as the probe's pulse: its echoes run into each other.
            long = np.exp(-((time_us / 0.5)**2)) * np.cos(2 * np.pi * 2.5 * time_us)
            path.write_text("time_us,amplitude\n" + "".join(f"{t:.6f},{a:.8f}\n" for t, a in zip(time_us, long)))
            self.chain.formation.SetPulseFileName(str(path))
            shaped = envelope(self.chain)
            rough = [np.abs(np.diff(e[:, 200:], axis=1)).sum() / e[:, 200:].sum() for e in (gaussian, shaped)]
            self.assertLess(rough[1], 0.8 * rough[0])
            path.write_text("time_us,amplitude\n0,1\n1,zwei\n")
            heard = listen(self.chain.formation)
            self.chain.formation.Modified()
            self.chain.formation.Update()
            self.assertEqual(len(heard), 1, heard)
            self.assertIn("pulse.csv", heard[0])


if __name__ == "__main__":
    unittest.main()
