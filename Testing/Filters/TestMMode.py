"""M-mode shows a line over the phases of a label map, in s and mm."""
import tempfile
import unittest

import numpy as np
from chain import Chain, listen, make, moving_plane
from sonovdb.vtkSonoFilters import vtkSonoMMode, vtkSonoUltrasound
from vtkmodules.util.numpy_support import vtk_to_numpy

PLANES = (12, 16, 24, 30, 27, 20)  # mm, less half a voxel
SETTINGS = {"LineCount": 16, "ScanKind": 0, "WidthMm": 16.0, "DepthMm": 40.0, "PathsPerLine": 20,
            "PositionMm": (20.0, 20.0, -0.5), "Axial": (0.0, 0.0, 1.0), "Lateral": (1.0, 0.0, 0.0),
            "AutomaticReference": False, "ReferenceAmplitude": 1.0, "DynamicRangeDb": 90.0, "BuildSurfaces": False,
            "FillBody": 0}


class TestMMode(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        # 1540 m/s in front, so that depths are those of the label map; bone shines.
        self.reader = moving_plane(folder.name, PLANES, (44, 40, 40), ("soft_tissue", "rib"))
        self.ultrasound = make(vtkSonoUltrasound, **SETTINGS)
        self.ultrasound.SetInputConnection(self.reader.GetOutputPort())

    def mode(self, **settings):
        mode = make(vtkSonoMMode, **{"Line": 8, **settings})
        mode.SetInputConnection(self.ultrasound.GetOutputPort(vtkSonoUltrasound.BMODE_LINES))
        return mode

    def test_an_interface_is_where_it_is_in_each_phase(self):
        mode = self.mode(SecondsPerStep=0.04)
        mode.Update()
        image = mode.GetOutput()
        self.assertEqual(image.GetDimensions()[0], len(PLANES))
        self.assertAlmostEqual(image.GetSpacing()[0], 0.04)
        self.assertEqual(image.GetOrigin()[:2], (0.0, 0.0))
        grey = vtk_to_numpy(image.GetPointData().GetArray("BMode")).reshape(image.GetDimensions()[1::-1])
        depths = np.arange(grey.shape[0]) * image.GetSpacing()[1]
        for column, plane in enumerate(PLANES):
            with self.subTest(phase=column):
                bright = depths[grey[:, column] >= grey[:, column].max()]
                # Voxel k spans k - 0.5 to k + 0.5 mm, and the face lies at -0.5 mm.
                self.assertAlmostEqual(bright.mean(), plane, delta=0.3)

    def test_columns_are_the_lines_of_the_time_steps(self):
        mode = self.mode(Line=3)
        mode.Update()
        image = mode.GetOutput()
        grey = vtk_to_numpy(image.GetPointData().GetArray("BMode")).reshape(image.GetDimensions()[1::-1]).copy()
        self.assertAlmostEqual(image.GetSpacing()[0], 1.0)  # files are 0, 1, 2, ...
        for time in (0, 4):
            self.ultrasound.UpdateInformation()
            lines = self.ultrasound.GetOutputDataObject(vtkSonoUltrasound.BMODE_LINES)
            self.ultrasound.GetOutputInformation(vtkSonoUltrasound.BMODE_LINES).Set(
                self.ultrasound.GetExecutive().UPDATE_TIME_STEP(), float(time))
            self.ultrasound.Update(vtkSonoUltrasound.BMODE_LINES)
            line = vtk_to_numpy(lines.GetPointData().GetArray("BMode")).reshape(16, -1)[3]
            np.testing.assert_allclose(grey[:, time], np.maximum(1, 255 * line), atol=0.51)

    def test_another_line_runs_again(self):
        mode = self.mode(Line=3)
        mode.Update()
        before = vtk_to_numpy(mode.GetOutput().GetPointData().GetArray("BMode")).copy()
        mode.SetLine(12)
        mode.Update()
        after = vtk_to_numpy(mode.GetOutput().GetPointData().GetArray("BMode"))
        self.assertEqual(before.shape, after.shape)
        self.assertFalse((before == after).all())

    def test_an_input_without_time_is_refused(self):
        chain = Chain()
        mode = vtkSonoMMode()
        mode.SetInputConnection(chain.bmode.GetOutputPort())
        said = listen(mode)
        mode.Update()
        self.assertEqual(len(said), 1, said)
        self.assertIn("4-D NIfTI", said[0])

    def test_what_makes_no_sense_is_refused(self):
        for settings, word in (({"Line": -1}, "Line"), ({"SecondsPerStep": -1.0}, "SecondsPerStep")):
            mode = self.mode(**settings)
            said = listen(mode)
            mode.Update()
            self.assertEqual(len(said), 1, said)
            self.assertIn(word, said[0])


if __name__ == "__main__":
    unittest.main()
