"""What a user may click that is hard: mirrors on both sides, tissues of odd speeds, no tissue at all, too high a harmonic.
Each ends soon, with finite arrays, and what a person should know is one sentence."""
import pathlib
import tempfile
import time
import unittest

import numpy as np
from chain import label_image, listen, make
from sonovdb.vtkSonoFilters import (vtkSonoProbeSource, vtkSonoRayTracer, vtkSonoScanDetail, vtkSonoThoraxSource,
                                    vtkSonoUltrasound)
from vtkmodules.util.numpy_support import vtk_to_numpy

TABLE = """tissue,impedance_MRayl,sound_speed_m_per_s,attenuation_dB_per_cm_MHz,mu0,sigma0,mu1,tau,gamma,roughness_mm,source
air,0.0004,330,1.2,0,0,0,1,0,0,test
near,1.6,{speed},0,0.5,0.1,0.5,1,0,0,test
far,{impedance},1540,0.3,0.5,0.1,0.5,1,0,0,test
"""
SETTINGS = {"ScanKind": 0, "LineCount": 16, "WidthMm": 16.0, "DepthMm": 50.0, "CentreFrequencyMHz": 3.0,
            "PositionMm": (20.0, 20.0, -0.5), "Axial": (0.0, 0.0, 1.0), "Lateral": (1.0, 0.0, 0.0),
            "PathsPerLine": 64, "PixelMm": 0.25, "BuildSurfaces": False, "FillBody": 0, "DynamicRangeDb": 90.0}
HARMONIC = 1


class TestHardInput(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tissues = pathlib.Path(folder.name, "tissues.csv")
        self.names = pathlib.Path(folder.name, "labels.csv")
        self.names.write_text("pattern,tissue\nbackground,air\nfront,near\nback,far\n")
        self.table = pathlib.Path(folder.name, "table.csv")
        self.table.write_text("id,name\n1,front\n2,back\n")

    def simulated(self, wall_mm, speed=1540.0, impedance=3.2, labels=(1, 2), **settings):
        """A wall behind as much of a tissue."""
        self.tissues.write_text(TABLE.format(speed=speed, impedance=impedance))
        voxels = np.full((60, 40, 40), labels[1], np.uint16)
        voxels[:wall_mm] = labels[0]
        filter_ = make(vtkSonoUltrasound, **{**SETTINGS, "TissueTableFile": str(self.tissues), "OutsideTissue": "air",
                                             "LabelTissueFile": str(self.names), "LabelTableFile": str(self.table),
                                             "FallbackTissue": "near", **settings})
        filter_.SetInputData(label_image(voxels))
        return filter_, listen(filter_), listen(filter_, "WarningEvent")

    def run_all(self, filter_):
        """All outputs; their arrays are finite. How long it took, s."""
        start = time.monotonic()
        for port in (vtkSonoUltrasound.IMAGE, vtkSonoUltrasound.RF_LINES, vtkSonoUltrasound.TRACED_LINES):
            filter_.Update(port)
            data = filter_.GetOutputDataObject(port)
            self.assertGreater(data.GetNumberOfPoints(), 0)
            for where in (data.GetPointData(), data.GetFieldData()):
                for array in filter(None, (where.GetArray(i) for i in range(where.GetNumberOfArrays()))):
                    self.assertTrue(np.isfinite(vtk_to_numpy(array).astype(float)).all(), array.GetName())
        return time.monotonic() - start

    def test_what_is_not_connected_is_named(self):
        """In one sentence, not by the pipeline's own, which repeat while a window draws."""
        probe, thorax = vtkSonoProbeSource(), make(vtkSonoThoraxSource, SpacingMm=5.0)
        for kind, port, given, missing in ((vtkSonoRayTracer, 1, probe, "No anatomy"), (vtkSonoRayTracer, 0, None, "No anatomy"),
                                           (vtkSonoScanDetail, 0, thorax, "No scan"),
                                           (vtkSonoScanDetail, 1, thorax, "No label map")):
            with self.subTest(filter=kind.__name__, missing=missing):
                filter_ = kind()
                if given:
                    filter_.SetInputConnection(port, given.GetOutputPort())
                said, pipeline = listen(filter_), listen(filter_.GetExecutive())
                for _ in range(2):
                    filter_.Update()
                self.assertEqual((len(said), pipeline), (1, []))
                self.assertIn(missing + " is connected", said[0])
                self.assertEqual(filter_.GetOutput().GetNumberOfPoints(), 0)

    def test_mirrors_on_both_sides(self):
        """The work ends with the time that is shown, whatever the number of boundaries that a path may meet."""
        for most, said in ((7, 1), (20, 0), (1000, 0)):
            with self.subTest(boundaries=most):
                filter_, errors, warnings = self.simulated(8, impedance=9999.0, Reverberation=True, FaceReflection=1.0,
                                                           MaxCollisions=most)
                self.assertLess(self.run_all(filter_), 20.0)
                self.assertEqual((errors, len(warnings)), ([], said), warnings)
                if said:
                    self.assertRegex(warnings[0], r"^Max Collisions is 7, .* % of the sound: .* raise it")

    def test_odd_speeds(self):
        for speed, wall in ((300.0, 8), (4000.0, 30)):
            for settings in ({}, {"Reverberation": True}, {"ImagingMode": HARMONIC}):
                with self.subTest(speed=speed, **settings):
                    filter_, errors, _ = self.simulated(wall, speed=speed, **settings)
                    self.assertLess(self.run_all(filter_), 20.0)
                    self.assertEqual(errors, [])
                    lines = filter_.GetOutputDataObject(vtkSonoUltrasound.RF_LINES)
                    line = vtk_to_numpy(lines.GetPointData().GetArray("Envelope")).reshape(16, -1)[8]
                    mm = lines.GetSpacing()[0] * np.arange(line.size)
                    # 0.012 mm of depth are 0.06 of range in the slow one; in the fast one the corner is within a bin.
                    self.assertAlmostEqual(mm[line.argmax()], wall * 1540.0 / speed, delta=0.06)

    def test_a_speed_in_other_units_names_tissue_line_and_range(self):
        filter_, errors, _ = self.simulated(30, speed=1.54)
        filter_.Update()
        self.assertEqual(len(errors), 1)
        for words in ("tissues.csv' line 3", "tissue 'near' has 1.54 in column 'sound_speed_m_per_s'", "10 to 100000"):
            self.assertIn(words, errors[0])

    def test_no_tissue_at_all(self):
        for settings in ({}, {"Reverberation": True}, {"ImagingMode": HARMONIC},
                         {"ImagingMode": HARMONIC, "Reverberation": True}, {"InterfaceModel": 1}):
            with self.subTest(**settings):
                filter_, errors, warnings = self.simulated(30, labels=(0, 0), **settings)
                self.assertLess(self.run_all(filter_), 20.0)
                self.assertEqual(errors, [])
                self.assertEqual(len(warnings), 1, warnings)
                self.assertIn("nothing but what lies outside of a body (air)", warnings[0])

    def test_a_harmonic_above_half_the_sampling(self):
        for mode, frequency, words in ((HARMONIC, 13.0, ("second harmonic lies at 26 MHz", "above 52", "Fundamental")),
                                       (0, 26.0, ("sampling frequency of 50 MHz is not above twice the centre frequency of 26 MHz", "above 52"))):
            filter_, errors, _ = self.simulated(30, ImagingMode=mode, CentreFrequencyMHz=frequency, SamplingMHz=50.0)
            filter_.Update()
            self.assertEqual(len(errors), 1)
            for part in (*words, "Sampling (MHz)", "Centre Frequency"):
                self.assertIn(part, errors[0])
            self.assertEqual(filter_.GetOutput().GetNumberOfPoints(), 0)

    def test_the_tracer_alone_says_what_it_leaves_out(self):
        whole, _, _ = self.simulated(8, impedance=9999.0)
        tracer = make(vtkSonoRayTracer, Reverberation=True, FaceReflection=1.0, MaxCollisions=7, PathsPerLine=64)
        for port, output in ((0, vtkSonoUltrasound.ANATOMY), (1, vtkSonoUltrasound.PROBE)):
            whole.Update(output)
            tracer.SetInputConnection(port, whole.GetOutputPort(output))
        warnings = listen(tracer, "WarningEvent")
        tracer.Update()
        self.assertEqual(len(warnings), 1)
        self.assertIn("Max Collisions is 7", warnings[0])


if __name__ == "__main__":
    unittest.main()
