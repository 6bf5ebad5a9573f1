"""Guided to a view, a path that is recorded by hand, and a heart that beats while its probe moves. Needs Xvfb; run by
ctest -L gui."""
import html
import json
import math
import pathlib
import re
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import numpy as np
from events import MAIN, PROBE, SCANNER, check, click, event, pause, play_on, save_state, select, undo, view, write
from guicase import PLAYBACKS, GuiCase

WINDOW = f"{PROBE}/SonoWindow"
PATH = f"{SCANNER}/SonoPath"
BEAT = f"{SCANNER}/SonoBeat/Beat"
VIEWS = """
import json
views = StandardViews(Input=ThoraxPhantom(Spacingmm=4))
views.UpdatePipeline()
views.SMProxy.UpdatePropertyInformation()
rows = views.SMProxy.GetProperty("Rows")
found = {}
for i in range(rows.GetNumberOfElements()):
    sentence, preset, depth, *pose = rows.GetElement(i).split("\\t")
    found[sentence.split(",")[0]] = {"sentence": sentence, "pose": [float(number) for number in pose]}
with open(sys.argv[1], "w", encoding="utf-8") as file:
    json.dump(found, file)
"""
DATA_SET = """
import json
made = UltrasoundDataSet(FileName=sys.argv[1])
said = []
for number in range(int(sys.argv[2])):
    made.ImageNumber = number
    made.UpdatePipeline()
    image = made.SMProxy.GetClientSideObject().GetOutputDataObject(0)
    info = json.loads(image.GetFieldData().GetAbstractArray("Info").GetValue(0))
    said.append(info["pose"]["axial"] + info["pose"]["lateral"])
with open(sys.argv[3], "w", encoding="utf-8") as file:
    json.dump(said, file)
"""


def numbers(proxy, name):
    return [float(element.get("value")) for element in proxy.findall(f"Property[@name='{name}']/Element")]


def proxies(state, kind):
    return [proxy for proxy in ElementTree.parse(state).iter("Proxy") if proxy.get("type") == kind]


def pose_of(state):
    (ultrasound,) = proxies(state, "SonoUltrasound")
    return [number for name in ("PositionMm", "Axial", "Lateral") for number in numbers(ultrasound, name)]


def frame(pose):
    """Position, and lateral, elevation and axial as columns."""
    axial = np.array(pose[3:6]) / np.linalg.norm(pose[3:6])
    lateral = np.array(pose[6:9]) - axial * np.dot(axial, pose[6:9])
    lateral /= np.linalg.norm(lateral)
    return np.array(pose[:3]), np.stack([lateral, np.cross(axial, lateral), axial], axis=1)


class TestGuiNavigate(GuiCase):
    def play_events(self, scene, folder, *events):
        return self.play(write(pathlib.Path(folder, "events.xml"), *events), folder, f"--script={PLAYBACKS / scene}")

    def said_at(self, scene, folder, widget, *events):
        """The text of a label when all has been done: a check that fails tells it."""
        script = write(pathlib.Path(folder, "events.xml"), *events, check(widget, "text", "nothing of the kind"))
        done = self.paraview(folder, f"--test-script={script}", f"--script={PLAYBACKS / scene}", "--exit")
        said = re.search(r"property value is: (.*)\. Expecting", done.stdout)
        self.assertIsNotNone(said, done.stdout)
        return html.unescape(re.sub("<[^>]*>", "", said.group(1).replace("<br>", "\n")))

    def found_views(self, folder):
        path = pathlib.Path(folder, "views.json")
        self.run_script(VIEWS, folder, path)
        return json.loads(path.read_text(encoding="utf-8"))

    def test_a_guide_says_the_way_to_a_view_and_that_it_is_reached(self):
        label = view(1, 0) + "/SonoGuide"
        with tempfile.TemporaryDirectory() as folder:
            views = self.found_views(folder)
            goal = views["SC4C"]
            begin = (select(0, 0), pause(1000), click(f"{WINDOW}/StandardViews"), pause(2500))
            wanted = event(f"{WINDOW}/Guide", "set_boolean", "true")
            choose = event(f"{WINDOW}/WindowCandidate", "set_string", goal["sentence"])
            away = self.said_at("window.py", folder, label, *begin, wanted, choose, pause(1000), save_state("guided"))
            at = pose_of(pathlib.Path(folder, "guided.pvsm"))
            # Off, the same choice goes there.
            there = self.said_at("window.py", folder, label, *begin, choose, pause(2500), wanted, pause(500))
            turned = self.said_at("window.py", folder, label, *begin, choose, pause(2500), wanted,
                                  click(f"{PROBE}/RotatePlus"), click(f"{PROBE}/RotatePlus"), pause(1500))
        self.assertLess(math.dist(at[:3], [87.8, -86.5, -45]), 0.1)  # nobody moved it
        position, axes = frame(at)
        goal_position, goal_axes = frame(goal["pose"])
        lateral, across, _ = axes.T @ (goal_position - position)
        first, *lines = away.split("\n")
        self.assertEqual(first, f"SC4C: {np.linalg.norm(goal_position - position):.0f} mm away")
        self.assertEqual(lines[0], f"← Slide {abs(lateral):.0f} mm to the patient's right")  # it lies on the left
        self.assertLess(lateral, 0)
        self.assertEqual(lines[1], f"⇅ Slide across {abs(across):.0f} mm to the feet")
        # The beam of the one in the axes of the other.
        rock, tilt = np.degrees([math.asin(axes[:, 0] @ goal_axes[:, 2]),
                                 math.atan2(axes[:, 1] @ goal_axes[:, 2], axes[:, 2] @ goal_axes[:, 2])])
        self.assertIn(f"Tilt (fan) {abs(tilt):.0f}°, beam to ", away)
        self.assertIn(f"→ Rock {abs(rock):.0f}°, beam to the patient's left", away)
        self.assertGreater(rock, 0)
        self.assertEqual(there, "SC4C reached")
        self.assertEqual(turned, "SC4C: 0 mm away\n↺ Rotate 10° counterclockwise")  # back, by what was turned

    def test_a_path_is_recorded_played_swept_and_made_a_data_set(self):
        turn = (click(f"{PROBE}/RotatePlus"), pause(200))
        with tempfile.TemporaryDirectory() as folder:
            errors = self.play_events(
                "scanner.py", folder, select(0, 0), pause(1000), click(f"{MAIN}/SonoToolBar/SonoScannerButton"), pause(500),
                check(f"{PATH}/Play", "enabled", "false"), click(f"{PATH}/Record"), *turn * 4, pause(1500),
                click(f"{PATH}/Record"), pause(500), click(f"{PROBE}/TiltPlus"), pause(1500),
                save_state("recorded"), check(f"{PATH}/Play", "enabled", "true"), click(f"{PATH}/Play"), play_on(4000), pause(2000), save_state("played"),
                undo(), pause(1500), save_state("undone"),
                click(f"{PATH}/DataSet"),
                event(f"{MAIN}/SonoPathDataSetDialog", "filesSelected", "$PARAVIEW_TEST_ROOT/path.json"), pause(500),
                click(f"{PATH}/Sweep"), pause(500),
                click(f"{MAIN}/propertiesDock/propertiesPanel/Accept"), pause(4000), save_state("swept"))
            self.assertEqual(errors, [])
            states = {name: pathlib.Path(folder, name + ".pvsm") for name in ("recorded", "played", "undone", "swept")}
            poses = {name: pose_of(state) for name, state in states.items()}
            (path,) = proxies(states["recorded"], "SonoProbePath")
            recorded = np.array(numbers(path, "Poses")).reshape(-1, 10)
            (sweep,) = proxies(states["swept"], "SonoSweep")
            drawn = [json.loads(line) for line in pathlib.Path(folder, "scanner.jsonl").read_text().splitlines()]
            declared = json.loads(pathlib.Path(folder, "path.json").read_text(encoding="utf-8"))
            asked = pathlib.Path(folder, "asked.json")
            self.run_script(DATA_SET, folder, folder + "/path.json", len(recorded), asked)
            images = json.loads(asked.read_text(encoding="utf-8"))
        # Four turns by 5 degrees, with what was between them.
        first, last = frame(recorded[0, 1:])[1], frame(recorded[-1, 1:])[1]
        self.assertAlmostEqual(math.degrees(math.acos(first[:, 0] @ last[:, 0])), 20, places=3)
        self.assertEqual(recorded[0, 0], 0)
        self.assertTrue((np.diff(recorded[:, 0]) > 0).all())
        self.assertGreater(recorded[-1, 0], 0.6)
        # Played: from its beginning to its end, in between as well; undone at once.
        self.assertEqual(poses["undone"], poses["recorded"])
        np.testing.assert_allclose(frame(poses["played"])[1], last, atol=1e-6)
        tilted = frame(poses["recorded"])[1][:, 2]
        rested = max(i for i, line in enumerate(drawn) if line["Preview"] == 0 and np.allclose(line["Axial"], tilted, atol=1e-6)
                     and np.allclose(line["Lateral"], poses["recorded"][6:], atol=1e-6) and i < len(drawn) - 3)
        moved = [line["Lateral"] for line in drawn[rested:] if line["Preview"] == 1]
        angles = np.degrees(np.arccos(np.clip(moved @ first[:, 0], -1, 1)))
        self.assertGreater(len(set(angles.round(3))), 3)
        self.assertTrue((np.diff(angles[:angles.argmax() + 1]) > -1e-3).all(), angles)
        # The sweep has the filter's settings, the data set each pose, as it was.
        self.assertEqual(numbers(sweep, "PathsPerLine"), [512])
        self.assertEqual(len(declared["patients"][0]["views"]), len(recorded))
        self.assertEqual(declared["probe"]["lineCount"], 24)
        np.testing.assert_allclose(images, recorded[:, 4:], atol=1e-6)

    def test_a_heart_beats_while_its_probe_moves(self):
        turn = (click(f"{PROBE}/RotatePlus"), play_on(500))
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder, "beating.py")
            scene.write_text((PLAYBACKS / "scanner.py").read_text().replace("Spacingmm=4", "Spacingmm=4, Phases=4"))
            errors = self.play_events(
                scene, folder, select(0, 0), pause(1000), click(f"{MAIN}/SonoToolBar/SonoScannerButton"), pause(500),
                save_state("before"), click(BEAT), play_on(6000), *turn * 3, play_on(2000),
                click(BEAT), pause(4000),
                save_state("after"), undo(), pause(2500), save_state("undone"))
            self.assertEqual(errors, [])
            drawn = [json.loads(line) for line in pathlib.Path(folder, "scanner.jsonl").read_text().splitlines()]
            before, after, undone = (pose_of(pathlib.Path(folder, name + ".pvsm")) for name in ("before", "after", "undone"))
        beating = [line for line in drawn if line["Preview"] == 1]
        # Phases of one second of 4, in turn but for those that are left out.
        self.assertEqual({line["ViewTime"] for line in beating}, {0.0, 0.25, 0.5, 0.75})
        # As at rest and turned by 15 degrees, each phase is another picture, and the same one in each beat.
        for lateral in (before[6:], after[6:]):
            seen = {}
            for line in beating:
                if np.allclose(line["Lateral"], lateral, atol=1e-6):
                    seen.setdefault(line["ViewTime"], set()).add(line["picture"])
            self.assertTrue(all(len(pictures) == 1 for pictures in seen.values()), seen)
            self.assertEqual(len(set().union(*seen.values())), len(seen))
            self.assertGreater(len(seen), 2)
        turns = np.degrees(np.arccos(np.clip(np.array([line["Lateral"] for line in beating]) @ frame(before)[1][:, 0], -1, 1)))
        self.assertEqual(sorted(set(turns.round())), [0, 5, 10, 15])
        # Then it rests, in full, and one undo turns it back.
        resting = [line for line in drawn[drawn.index(beating[-1]):] if line["Preview"] == 0]
        self.assertEqual(resting[0]["ViewTime"], beating[-1]["ViewTime"])
        self.assertEqual(resting[0]["Lateral"], beating[-1]["Lateral"])
        self.assertEqual(undone, before)


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
