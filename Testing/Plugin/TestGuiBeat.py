"""A heart's first beat leaves the window responsive: its phases are made in the background. Needs Xvfb, python3-pyqt5 and
python3-xlib; run by ctest -L gui."""
import json
import os
import pathlib
import sys
import tempfile
import unittest

from guicase import PLAYBACKS, GuiCase

LONGEST_S = 0.5
# The picture of a moving probe at each phase, of a filter that makes them one after the other.
PLAIN = """
import hashlib, json
from paraview.vtk.util.numpy_support import vtk_to_numpy
ultrasound = SimulateUltrasound(Input=ThoraxPhantom(Spacingmm=2, Phases=6), Preview=1)
flat = OutputPort(ultrasound, 7)
pictures = {}
for phase in range(6):
    flat.UpdatePipeline(phase / 6)
    grey = ultrasound.SMProxy.GetClientSideObject().GetOutputDataObject(7).GetPointData().GetArray("BMode")
    pictures[phase] = hashlib.md5(vtk_to_numpy(grey).tobytes()).hexdigest()
with open(sys.argv[1], "w", encoding="utf-8") as file:
    json.dump(pictures, file)
"""


class TestGuiBeat(GuiCase):
    def test_the_window_answers_while_phases_are_made(self):
        with tempfile.TemporaryDirectory() as folder:
            os.environ["BEAT_SCRIPTS"] = str(PLAYBACKS.parent)
            done = self.paraview(folder, f"--script={PLAYBACKS / 'beat.py'}")
            self.assertEqual(done.returncode, 0, done.stdout)
            self.assertEqual([line for line in done.stdout.splitlines() if "ERR|" in line or "Traceback" in line], [])
            said = json.loads(pathlib.Path(folder, "beat.json").read_text(encoding="utf-8"))
            plain = pathlib.Path(folder, "plain.json")
            self.run_script(PLAIN, folder, plain)
            expected = json.loads(plain.read_text(encoding="utf-8"))
        print(f"longest silence {max(said['silences']):.2f} s; first picture {said['pictures'][0]['clock'] - said['began']:.2f} s, "
              f"all phases {said['readyAt'] - said['began']:.2f} s after the click")
        self.assertLess(max(said["silences"]), LONGEST_S)
        # It plays what is ready, says how many are, and then nothing.
        self.assertIn("2 of 6 phases are ready.", said["sentences"])
        self.assertEqual(said["sentences"][-1], "")
        # At 20 beats a minute a phase lasts half a second; none is left out.
        self.assertEqual(said["property"], 20)
        slow = [(at, round(6 * time)) for at, time in said["slow"] if at > said["readyAt"] + 1.5]  # the first came of the other rate
        self.assertGreater(len(slow), 8)
        self.assertEqual({(b - a) % 6 for (_, a), (_, b) in zip(slow, slow[1:])}, {1})
        self.assertAlmostEqual((slow[-1][0] - slow[0][0]) / (len(slow) - 1), 0.5, delta=0.1)
        self.assertNotEqual(said["undone"][0], 20)
        self.assertTrue(said["pictures"][0]["said"].endswith("of 6 phases are ready."), said["pictures"][0])
        seen = {round(6 * picture["time"]): picture["picture"] for picture in said["pictures"]}
        self.assertEqual({str(phase): picture for phase, picture in seen.items()}, expected)
        self.assertEqual(len(set(seen.values())), 6)


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
