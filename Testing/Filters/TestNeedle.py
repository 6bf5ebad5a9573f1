"""A needle is a closed body of its own volume, and a picture shows its shaft, its tip and its shadow where they are."""
import math
import pathlib
import tempfile
import unittest

import numpy as np
from chain import listen, make, write_labels
from sonovdb.vtkSonoFilters import (vtkSonoLabelMapReader, vtkSonoNeedle,
                                    vtkSonoUltrasound)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkFeatureEdges, vtkMassProperties


def needle_of(**settings):
    needle = make(vtkSonoNeedle, **settings)
    needle.Update()
    return needle


class TestShape(unittest.TestCase):
    def test_it_is_closed_and_as_large_as_a_cylinder_without_what_was_ground_off(self):
        """A plane cuts a straight column so that its volume is that of its height in the middle."""
        for hub, tip in (((-30, 0, 0), (0, 0, 30)), ((5, 5, 0), (5, 5, 40)), ((0, 20, 10), (3, -15, 12))):
            for roll in (0.0, 77.0):
                needle = needle_of(HubMm=hub, TipMm=tip, DiameterMm=1.2, BevelDeg=25.0, RollDeg=roll)
                edges = make(vtkFeatureEdges, BoundaryEdges=True, NonManifoldEdges=True, FeatureEdges=False,
                             ManifoldEdges=False)
                edges.SetInputConnection(needle.GetOutputPort())
                edges.Update()
                self.assertEqual(edges.GetOutput().GetNumberOfCells(), 0)
                properties = vtkMassProperties()
                properties.SetInputConnection(needle.GetOutputPort())
                corner = 0.6 * math.sqrt(2 * math.pi / 24 / math.sin(2 * math.pi / 24))
                height = math.dist(hub, tip) - corner / math.tan(math.radians(25.0))
                self.assertAlmostEqual(properties.GetVolume() / (math.pi * 0.36 * height), 1, places=9)
                points = vtk_to_numpy(needle.GetOutput().GetPoints().GetData())
                along = np.subtract(tip, hub) / math.dist(hub, tip)
                # Nothing lies beyond the tip, and the point touches its plane.
                self.assertAlmostEqual(((points - tip) @ along).max(), 0, places=9)

    def test_bad_input_gets_one_sentence(self):
        for settings, word in ((dict(DiameterMm=0.0), "diameter"), (dict(BevelDeg=2.0), "bevel"),
                               (dict(HubMm=(0, 0, 29.5)), "no longer than its bevel"),
                               (dict(HubMm=(0, 0, 30)), "no longer than its bevel")):
            needle = make(vtkSonoNeedle, **settings)
            said = listen(needle)
            needle.Update()
            self.assertEqual(len(said), 1, said)
            self.assertIn(word, said[0])


class TestPicture(unittest.TestCase):
    """A linear probe over gel of 1540 m/s, a needle across its lines 20 mm deep from one side to 4 mm beyond the middle."""
    DEPTH, TIP, DIAMETER = 20.0, 4.0, 1.2

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = write_labels(pathlib.Path(folder.name, "gel.vti"), np.full((45, 12, 48), 1, np.uint16))
        pathlib.Path(folder.name, "labels.csv").write_text("id,name\n1,phantom_gel\n")
        reader = make(vtkSonoLabelMapReader)
        reader.AddFileName(path)
        reader.Update()
        x, y, z = (n * s for n, s in zip(reader.GetOutput().GetDimensions(), reader.GetOutput().GetSpacing()))
        self.face = np.array([0.5 * x, 0.5 * y, 0.0]) + reader.GetOutput().GetOrigin()
        self.ultrasound = make(vtkSonoUltrasound, LineCount=96, PathsPerLine=200, FillBody=False, BuildSurfaces=False,
                               PixelMm=0.1)
        self.ultrasound.SetInputConnection(reader.GetOutputPort())
        self.said = listen(self.ultrasound)
        probe = self.ultrasound.GetProbe()
        for name, value in dict(ScanKind=0, WidthMm=38.0, DepthMm=40.0, CentreFrequencyMHz=7.2, FractionalBandwidth=0.7,
                                ApertureMm=12.0, ElevationApertureMm=4.0, ElevationFocusMm=18.0,
                                TransmitFocusMm=20.0, PositionMm=tuple(self.face + (0, 0, 0.1)), Axial=(0, 0, 1),
                                Lateral=(1, 0, 0)).items():
            getattr(probe, "Set" + name)(*(value if isinstance(value, tuple) else (value,)))

    def envelope(self, with_needle):
        """Lines x samples, the lines' places and the samples' depths in mm."""
        if with_needle:
            self.needle = needle_of(HubMm=tuple(self.face + (-22.0, 0, self.DEPTH)), DiameterMm=self.DIAMETER,
                                    TipMm=tuple(self.face + (self.TIP, 0, self.DEPTH)), BevelDeg=90.0)
            self.ultrasound.SetInputConnection(1, self.needle.GetOutputPort())
        self.ultrasound.Update(self.ultrasound.RF_LINES)
        image = self.ultrasound.GetOutputDataObject(self.ultrasound.RF_LINES)
        samples, lines, _ = image.GetDimensions()
        iq = vtk_to_numpy(image.GetPointData().GetArray("IQ")).reshape(lines, samples, 2)
        return np.hypot(iq[..., 0], iq[..., 1]), np.linspace(-19, 19, lines), np.arange(samples) * image.GetSpacing()[0]

    def test_shaft_tip_and_shadow(self):
        bare, x, z = self.envelope(False)
        shown, _, _ = self.envelope(True)
        over = (x > -15) & (x < 1)  # well on the shaft
        near = (z > self.DEPTH - 3) & (z < self.DEPTH + 3)
        top = z[near][shown[:, near].argmax(axis=1)]
        np.testing.assert_allclose(top[over], self.DEPTH - 0.1 - 0.5 * self.DIAMETER, atol=0.3)
        # Along the array the echo falls to half of the shaft's where the tip is.
        strength = shown[:, near].max(axis=1)
        half = 0.5 * np.median(strength[over])
        last = np.flatnonzero(strength > half).max()
        self.assertAlmostEqual(x[last], self.TIP, delta=0.8)  # a line's pitch and half a beam's width
        behind = (z > self.DEPTH + 13) & (z < self.DEPTH + 18)  # what rings ends at 12
        beside = x > self.TIP + 6
        rms = lambda e, lines: np.sqrt((e[lines][:, behind] ** 2).mean())
        self.assertLess(rms(shown, over) / rms(bare, over), 0.5)
        self.assertAlmostEqual(rms(shown, beside) / rms(bare, beside), 1, delta=0.15)
        # A solid needle rings: what follows its echo falls from there, slowly (TestRodRing says how much).
        mean = np.sqrt((shown[over] ** 2).mean(axis=0))
        first = mean[near].max()
        tail = [20 * math.log10(mean[(z > self.DEPTH + a) & (z <= self.DEPTH + a + 1)].max() / first) for a in (0.5, 1.5, 2.5, 4.5)]
        for level, (low, high) in zip(tail, ((-25, -12), (-31, -19), (-36, -23), (-40, -27))):
            self.assertTrue(low < level < high, tail)
        print(f"shaft {np.mean(top[over]):.2f} mm, tip {x[last]:.2f} mm, shadow {rms(shown, over) / rms(bare, over):.2f}, "
              f"tail {', '.join(f'{level:.0f}' for level in tail)} dB")


if __name__ == "__main__":
    unittest.main()
