"""What ParaView records of a person's work, a Python trace and states of both kinds, gives the same picture in another
process. Needs Xvfb; run by ctest -L gui."""
import json
import pathlib
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

from guicase import GuiCase

REPLAY = """
import json
if sys.argv[1].endswith(".pvsm"):
    LoadState(sys.argv[1])
else:
    exec(open(sys.argv[1], encoding="utf-8").read(), globals())
(name,) = [name for name, _ in GetSources() if name.startswith("SimulateUltrasound")]
simulated = FindSource(name)
made = servermanager.Fetch(OutputPort(simulated, 0)).GetPointData().GetArray("BMode")
reader = OpenDataFile(sys.argv[2])
shown = servermanager.Fetch(reader).GetPointData().GetArray("BMode")
count = max(made.GetNumberOfTuples(), shown.GetNumberOfTuples())
pairs = [(made.GetTuple1(i), shown.GetTuple1(i)) for i in range(count)]
with open(sys.argv[3], "w", encoding="utf-8") as file:
    json.dump({"PositionMm": list(simulated.PositionMm), "Axial": list(simulated.Axial),
               "Lateral": list(simulated.Lateral), "brightest": max(one for one, _ in pairs),
               "different": sum(one != other for one, other in pairs)}, file)
"""


class TestGuiRecord(GuiCase):
    def test_trace_and_states_give_the_same_picture(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(self.play("record.xml", folder), [])
            state = pathlib.Path(folder, "state.pvsm")
            (probe,) = (p for p in ElementTree.parse(state).iter("Proxy") if p.get("type") == "SonoUltrasound")
            pose = {name: [float(e.get("value")) for e in probe.findall(f"Property[@name='{name}']/Element")]
                    for name in ("PositionMm", "Axial", "Lateral")}
            for name in ("trace.py", "state.pvsm", "state.py"):
                with self.subTest(name=name):
                    found = pathlib.Path(folder, "found.json")
                    self.run_script(REPLAY, folder, pathlib.Path(folder, name), pathlib.Path(folder, "picture.vti"),
                                    found)
                    replayed = json.loads(found.read_text(encoding="utf-8"))
                    self.assertEqual(replayed.pop("different"), 0)
                    self.assertGreater(replayed.pop("brightest"), 200)
                    for part, values in pose.items():
                        for one, other in zip(replayed.pop(part), values, strict=True):
                            self.assertAlmostEqual(one, other, places=12)
                    self.assertEqual(replayed, {})
        # The buttons turned the probe, so that none of these numbers was there from the start.
        self.assertNotAlmostEqual(pose["Axial"][0], -0.529887, places=3)
        self.assertNotAlmostEqual(pose["Lateral"][0], 0.842892, places=3)

    def test_the_trace_keeps_how_the_layout_looks(self):
        """Black behind the flat image, seen in 2D; the axes' names and the curves' colours; plain lines."""
        with tempfile.TemporaryDirectory() as folder:
            errors = self.play("record_layout.xml", folder, f"--data={self.label_map(folder)}")
            self.assertEqual(errors, [])
            trace = pathlib.Path(folder, "trace.py").read_text(encoding="utf-8")
        for words in ("Background = [0.0, 0.0, 0.0]", "InteractionMode = '2D'", "BottomAxisTitle = 'Depth (mm)'",
                      "RightAxisTitle = 'Envelope (dB)'", "SeriesColor = ", "AmbientColor = [1.0, 0.85, 0.2]"):
            with self.subTest(words=words):
                self.assertIn(words, trace)


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
