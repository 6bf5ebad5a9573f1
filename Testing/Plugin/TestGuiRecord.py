"""What ParaView records of a person's work, a Python trace and states of both kinds, gives the same picture in another
process. Needs Xvfb; run by ctest -L gui."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

from guicase import GuiCase, bytes_of

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

# Of a process that has not loaded the plugin, but for an XML state, which ParaView does not let load any. The body's view
# and the flat one, and what a layout sets of them.
DRAW = """
import json, os, sys
from paraview.simple import *
if sys.argv[1].endswith(".pvsm"):
    LoadPlugin(os.environ["SONOVDB_PLUGIN"], remote=False, ns=globals())
    LoadState(sys.argv[1])
else:
    exec(open(sys.argv[1], encoding="utf-8").read(), globals())
found = {}
for view in GetViews():
    if view.GetXMLName() == "RenderView":
        name = "flat" if view.InteractionMode == "2D" else "body" if view.MaximumNumberOfPeels == 2 else "first"
        found[name] = view.LODResolution
        SaveScreenshot(sys.argv[2] + "-" + name + ".png", view, ImageResolution=[300, 300])
print(json.dumps(found))
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

    def draw(self, folder, name):
        """What DRAW prints, the pictures' bytes, and what ParaView calls errors."""
        script, path = pathlib.Path(folder, "draw.py"), pathlib.Path(folder, name)
        script.write_text(DRAW)
        done = subprocess.run(["pvpython", str(script), str(path), str(path)], env=dict(os.environ, DISPLAY=self.display),
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=400)
        self.assertEqual(done.returncode, 0, done.stdout)
        errors = [line for line in done.stdout.splitlines() if "ERR|" in line]
        found = json.loads(next(line for line in done.stdout.splitlines() if line.startswith("{")))
        return found, {view: bytes_of(pathlib.Path(f"{path}-{view}.png"), 270000) for view in found}, errors

    def test_trace_and_states_are_drawn_alike_in_another_process(self):
        """Each loads the plugin by itself, raises nothing, and keeps how the layout draws; an XML state in ParaView, too."""
        with tempfile.TemporaryDirectory() as folder:
            data = self.label_map(folder)
            self.assertEqual(self.play("states.xml", folder, f"--data={data}"), [])
            drawn = {name: self.draw(folder, name) for name in ("shown.pvsm", "shown.py")}
            trace = pathlib.Path(folder, "trace.py")
            # What was there before a trace began is looked up in it; in another process it has to be made.
            trace.write_text(trace.read_text().replace("thoraxvti = FindSource('thorax.vti')",
                                                       f"thoraxvti = XMLImageDataReader(FileName=['{data}'])"))
            drawn["trace.py"] = self.draw(folder, "trace.py")
            self.assertEqual(self.play("load_shown.xml", folder), [])
            state = ElementTree.parse(pathlib.Path(folder, "loaded.pvsm"))
        peels = [p.find("Property[@name='MaximumNumberOfPeels']/Element").get("value") for p in state.iter("Proxy")
                 if p.get("type") == "RenderView"]
        self.assertEqual(peels.count("2"), 1)
        _, reference, _ = drawn["shown.pvsm"]
        for name, (found, pictures, errors) in drawn.items():
            with self.subTest(name=name):
                self.assertEqual(errors, [])
                self.assertEqual(found["body"], 0.1)
                for view in ("body", "flat"):
                    apart = sum(abs(a - b) for a, b in zip(pictures[view], reference[view], strict=True)) / 270000
                    self.assertLess(apart, 2.0, view)  # of 255
                    self.assertGreater(max(pictures[view]) - min(pictures[view]), 150)

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
