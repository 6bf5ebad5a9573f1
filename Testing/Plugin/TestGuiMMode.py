"""M-mode by click: a wall that moves, seen along the scan line that was clicked. Needs Xvfb; run by ctest -L gui."""
import math
import pathlib
import sys
import tempfile
import unittest

import numpy as np
from events import MAIN, click, event, pause, play_on, save_state, select, view, write
from guicase import GuiCase
from TestGuiFlat import numbers, place_in_flat_view, proxies

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "Filters"))
from chain import moving_plane  # noqa: E402

# 1540 m/s in front, so that depths are those of the label map; bone shines.
MOVING = """
from paraview.simple import *
labels = LabelMapReader(registrationName="labels", FileName={files})
ultrasound = SimulateUltrasound(registrationName="ultrasound", Input=labels, LineCount=16, ScanKind="Linear", WidthMm=16, DepthMm=40,
                                PathsPerLine=20, PositionMm=[20, 20, -0.5], Axial=[0, 0, 1], Lateral=[1, 0, 0],
                                AutomaticReference=0, ReferenceAmplitude=1, DynamicRangeDb=90, BuildSurfaces=0, FillBody="Off")
GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
SetActiveSource(ultrasound)
"""
SHOWN = """
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
LoadState(sys.argv[1])
mode = next(source for source in GetSources().values() if source.GetXMLName() == "SonoMMode")
mode.UpdatePipeline()
image = mode.SMProxy.GetClientSideObject().GetOutputDataObject(0)
columns, rows, _ = image.GetDimensions()
np.savez(sys.argv[2], grey=vtk_to_numpy(image.GetPointData().GetArray("BMode")).reshape(rows, columns),
         spacing=image.GetSpacing()[:2])
"""


class TestGuiMMode(GuiCase):
    def test_m_mode_of_a_click_follows_a_wall_that_moves(self):
        """A plane of bone that goes to and fro twice: the line that was clicked shows it at its depth, with its period."""
        planes = [round(24 + 7 * math.sin(2 * math.pi * phase / 8)) for phase in range(16)]
        with tempfile.TemporaryDirectory() as folder:
            moving_plane(folder, planes, (44, 40, 40), ("soft_tissue", "rib"))
            scene = pathlib.Path(folder, "moving.py")
            scene.write_text(MOVING.format(files=[f"{folder}/phase{phase}.vti" for phase in range(len(planes))]))
            at = view(2, 5)
            press = [event(at, what, f"(0.4500,0.6000,{button},{held},0)") for what, button, held in
                     (("mouseMove", 0, 0), ("mousePress", 1, 1), ("mouseRelease", 1, 0))]
            script = write(pathlib.Path(folder, "mode.xml"), pause(1000), click(f"{MAIN}/SonoToolBar/actionSonoLayout"),
                           pause(2000), *press, pause(1000), save_state("picked"),
                           event(f"{MAIN}/SonoToolBar/SonoFlatButton/SonoFlatMenu", "activate", "actionSonoMMode"),
                           play_on(6000), save_state("mode"))
            self.assertEqual(self.play(script, folder, f"--script={scene}"), [])
            state = pathlib.Path(folder, "mode.pvsm")
            (mode,) = proxies(state, "SonoMMode")
            across, _ = place_in_flat_view(pathlib.Path(folder, "picked.pvsm"), 0.45, 0.6)
            line = numbers(mode, "Line")[0]
            array = pathlib.Path(folder, "mode.npz")
            self.run_script(SHOWN, folder, state, array)
            with np.load(array) as shown:
                grey, (columnS, rowMm) = shown["grey"], shown["spacing"]
        # Of 16 lines across 16 mm.
        self.assertAlmostEqual(line, (across + 8) / 16 * 15, delta=1)
        self.assertEqual((grey.shape[1], columnS), (16, 1.0))
        depths = [rowMm * np.flatnonzero(column >= column.max()).mean() for column in grey.T]
        for phase, (depth, plane) in enumerate(zip(depths, planes)):
            self.assertAlmostEqual(depth, plane, delta=0.3, msg=f"phase {phase}")
        self.assertEqual(np.abs(np.fft.rfft(np.array(depths) - np.mean(depths))).argmax(), 2)  # beats of 8 phases


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
