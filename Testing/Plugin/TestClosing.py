"""Deleting the filter, switching its input, disconnecting or leaving ParaView while a simulation runs ends quietly."""
import subprocess
import unittest

SCRIPT = """
import os, sys
from paraview import simple
simple.LoadPlugin(os.environ["SONOVDB_PLUGIN"], remote=False, ns=vars(simple))
ultrasound = simple.SimulateUltrasound(Input=simple.ThoraxPhantom(Spacingmm=4), BuildSurfaces=0)
events = []

def on_progress(*_):
    events.append(1)
    if len(events) == 10:
        print("in the middle", flush=True)
        {action}

ultrasound.GetClientSideObject().AddObserver("ProgressEvent", on_progress)
ultrasound.UpdatePipeline()
"""


class TestClosing(unittest.TestCase):
    def test_closing_during_a_run(self):
        for action in ("simple.Delete(ultrasound)", "ultrasound.Input = simple.ThoraxPhantom(Spacingmm=5)",
                       "simple.Disconnect()", "sys.exit(0)"):
            with self.subTest(action=action):
                done = subprocess.run(["pvpython", "-c", SCRIPT.format(action=action)], stdout=subprocess.PIPE,
                                      stderr=subprocess.STDOUT, text=True)
                self.assertIn("in the middle", done.stdout)
                self.assertEqual(done.returncode, 0, done.stdout)


if __name__ == "__main__":
    unittest.main()
