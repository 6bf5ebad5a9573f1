"""The scanner's panel: each control changes a property and the picture, as one step of undo and without Apply. Needs Xvfb and
python3-xlib; run by ctest -L gui."""
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time
import unittest

from guicase import PLAYBACKS, GuiCase, save_screen
from person import Person, while_acting

WINDOW = "1152x762+0+0"
RELOAD = """
import json
LoadState(sys.argv[1])
(name,) = [name for name, _ in GetSources() if name.startswith("ultrasound")]
found = FindSource(name)
found.UpdatePipeline()
picture = found.SMProxy.GetClientSideObject().GetOutputDataObject(7)
grey = picture.GetPointData().GetArray("BMode")
with open(sys.argv[2], "w", encoding="utf-8") as file:
    json.dump({"Tgc8Db": found.Tgc8Db, "bounds": picture.GetBounds(),
               "mean": sum(grey.GetValue(i) for i in range(grey.GetNumberOfValues())) / grey.GetNumberOfValues()}, file)
"""

# Beside the scene: how often the flat image's scale ran, and what of it is drawn.
SCALE = """
exec(open(SCENE, encoding="utf-8").read())
shown = Show(FlatImageScale(Input=OutputPort(ultrasound, FLAT_IMAGE)), view)
drawn = shown.SMProxy.GetClientSideObject().GetActiveRepresentation()
runs = []
drawn.AddObserver("UpdateDataEvent", lambda *_: runs.append(1), 1e6)  # before anybody who might keep it from the others
SetActiveSource(thorax)


def note_scale(*_):
    scale = drawn.GetActor().GetMapper().GetInputDataObject(0, 0)
    line = {"GainDb": value("GainDb"), "DynamicRangeDb": value("DynamicRangeDb"), "ran": len(runs),
            "points": scale.GetNumberOfPoints()}
    with open("scale.jsonl", "a", encoding="utf-8") as file:
        file.write(json.dumps(line) + chr(10))


view.SMProxy.AddObserver("EndEvent", note_scale)
Render()
"""


class TestGuiScanner(GuiCase):
    def play_panel(self, name, folder, scene="scanner.py", act=lambda person: None):
        """Plays a script on the scene, while a person may act; what was drawn, a dictionary a picture."""
        errors, failures = while_acting(Person(self, folder), act,
                                        lambda: self.play(name, folder, f"--script={PLAYBACKS / scene}"))
        self.assertEqual(failures, [])
        self.assertEqual(errors, [])
        return [json.loads(line) for line in pathlib.Path(folder, "scanner.jsonl").read_text().splitlines()]

    def assert_step(self, drawn, setting, at_first, then):
        """Pictures with another value of a setting lie between two with the first, which are the same. The first of them."""
        values = [round(line[setting], 6) if isinstance(line[setting], float) else line[setting] for line in drawn]
        changed = values.index(then)
        self.assertIn(at_first, values[changed:], f"{setting} was not undone")
        before, after = drawn[changed - 1], drawn[values.index(at_first, changed)]
        self.assertEqual(before[setting], at_first)
        self.assertEqual(after["picture"], before["picture"], setting)
        self.assertNotEqual(drawn[changed]["picture"], before["picture"], setting)
        return before, drawn[changed]

    def test_what_is_behind_the_lines_is_shown_with_each_step(self):
        with tempfile.TemporaryDirectory() as folder:
            drawn = self.play_panel("scanner_display.xml", folder)
            state = pathlib.Path(folder, "tgc.pvsm")
            found = pathlib.Path(folder, "found.json")
            self.run_script(RELOAD, folder, state, found)
            reloaded = json.loads(found.read_text())
        gains = [line["GainDb"] for line in drawn]
        # Steps of the slider, one undo and one redo for all; beyond the slider, typed; two undos.
        self.assertEqual([round(b) for a, b in zip(gains, gains[1:]) if a != b], [8, 12, 16, 0, 16, 120, 16, 0])
        means = [line["mean"] for line in drawn[:4]]
        self.assertEqual(means, sorted(means))
        before, after = self.assert_step(drawn, "DynamicRangeDb", 60, 36)
        self.assertLess(after["mean"], before["mean"])  # weak echoes are black
        before, after = self.assert_step(drawn, "GreyMap", "Linear", "Square Root")
        self.assertGreater(after["mean"], before["mean"] + 20)
        before, after = self.assert_step(drawn, "TgcDbPerCm", 3, 6)
        self.assertGreater(self.deep(after), self.deep(before))
        before, after = self.assert_step(drawn, "Tgc1Db", 0, 32)
        self.assertGreater(self.near(after) - self.deep(after), self.near(before) - self.deep(before) + 20)
        self.assertEqual(drawn[-1]["Tgc8Db"], 32)
        self.assertGreater(self.deep(drawn[-1]) - self.near(drawn[-1]), self.deep(before) - self.near(before) + 20)
        self.assertEqual(reloaded["Tgc8Db"], 32)
        self.assertGreater(reloaded["mean"], 0)

    def test_the_scale_runs_for_what_it_shows(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder, "scene.py")
            scene.write_text(f"SCENE = {str(PLAYBACKS / 'scanner.py')!r}\n{SCALE}")
            self.play_panel("scanner_display.xml", folder, scene)
            drawn = [json.loads(line) for line in pathlib.Path(folder, "scale.jsonl").read_text().splitlines()]
        gains = [round(line["GainDb"]) for line in drawn]
        first = gains.index(8)
        stepped = drawn[first:gains.index(12, first) + 1]
        self.assertGreater(drawn[first - 1]["ran"], 0)
        self.assertEqual({line["ran"] for line in stepped}, {drawn[first - 1]["ran"]})
        ranges = [round(line["DynamicRangeDb"]) for line in drawn]
        narrow = ranges.index(36)
        self.assertGreater(drawn[narrow]["ran"], drawn[narrow - 1]["ran"])
        self.assertNotEqual(drawn[narrow]["points"], drawn[narrow - 1]["points"])

    @staticmethod
    def near(line):
        return statistics.mean(block for block in line["blocks"][0] if block)

    @staticmethod
    def deep(line):
        return statistics.mean(block for block in line["blocks"][-2] if block)

    def test_what_is_scanned_anew_is_scanned_at_rest(self):
        with tempfile.TemporaryDirectory() as folder:
            drawn = self.play_panel("scanner_scan.xml", folder)
            found = pathlib.Path(folder, "found.json")
            self.run_script(RELOAD, folder, pathlib.Path(folder, "depth.pvsm"), found)
            reloaded = json.loads(found.read_text())
        depths = [line["DepthMm"] for line in drawn]
        self.assertNotIn(104, depths)  # a step of the slider on the way
        before, after = self.assert_step(drawn, "DepthMm", 160, 76)
        self.assertLess(abs(after["bounds"][3] - 76), 0.5)
        before, after = self.assert_step(drawn, "SectorDeg", 90, 43)
        self.assertLess(after["bounds"][1], 0.6 * before["bounds"][1])
        self.assert_step(drawn, "TransmitFocusMm", 65, 150)
        before, after = self.assert_step(drawn, "CentreFrequencyMHz", 2.5, 4.8)
        self.assertLess(self.deep(after) - self.near(after), self.deep(before) - self.near(before))  # attenuated more
        self.assert_step(drawn, "ImagingMode", "Fundamental", "Harmonic")
        self.assert_step(drawn, "TargetErrorDb", 0, 0.6)
        before, after = self.assert_step(drawn, "ScanKind", "Phased Sector", "Curvilinear")
        self.assertLess(after["bounds"][2], -5)  # a round face
        self.assertEqual(drawn[-1]["DepthMm"], 120)
        self.assertLess(abs(reloaded["bounds"][3] - 120), 0.5)

    def test_freeze_and_cine_loop(self):
        with tempfile.TemporaryDirectory() as folder:
            drawn = self.play_panel("scanner_cine.xml", folder)
        moving = [line for line in drawn if line["Preview"] == 1]
        dragged, scrubbed = moving[:6], moving[6:]
        # The scrubber at its third and second place shows the third and the second picture of the drag as they were.
        self.assertEqual([line["picture"] for line in scrubbed], [dragged[2]["picture"], dragged[1]["picture"]])
        self.assertEqual(scrubbed[1]["Lateral"], dragged[1]["Lateral"])
        resting = drawn[len(drawn) - drawn[::-1].index(scrubbed[1]):]
        self.assertEqual(resting[0]["Preview"], 0)
        self.assertEqual(resting[0]["Lateral"], scrubbed[1]["Lateral"])
        self.assertEqual(resting[1]["Lateral"], scrubbed[0]["Lateral"])  # undone
        resting = resting[1:]
        self.assertEqual(resting[1]["Lateral"], dragged[5]["Lateral"])  # undone
        # Frozen: the probe turned and the depth was changed; only the gain is seen.
        self.assertEqual(resting[2]["Lateral"], dragged[5]["Lateral"])
        self.assertEqual(resting[2]["DepthMm"], 160)
        self.assertEqual(resting[2]["GainDb"], 8)
        self.assertEqual(resting[2]["bounds"], resting[1]["bounds"])
        self.assertGreater(resting[2]["mean"], resting[1]["mean"] + 10)
        # Unfrozen: both are.
        self.assertEqual(len(resting), 4, [(line["Lateral"], line["DepthMm"], line["GainDb"]) for line in resting])
        self.assertEqual((resting[3]["DepthMm"], resting[3]["GainDb"]), (104, 8))
        self.assertNotEqual(resting[3]["Lateral"], dragged[5]["Lateral"])

    def test_flip_and_store(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "other").mkdir()
            drawn = self.play_panel("scanner_buttons.xml", folder)
            (flipped,) = pathlib.Path(folder).glob("ultrasound_*.png")
            (restored,) = pathlib.Path(folder, "other").glob("ultrasound_*.png")
            left, right = (self.halves(picture) for picture in (flipped, restored))
        full = [line for line in drawn if line["Preview"] == 0]
        self.assertEqual(len(full), 3)
        for one, other in zip(full[0]["Lateral"], full[1]["Lateral"]):
            self.assertAlmostEqual(one, -other, places=9)
        self.assertEqual(full[2]["picture"], full[0]["picture"])  # one undo, and storing is none

        def flat(line, mirrored=False):
            return [block for row in line["blocks"] for block in (row[::-1] if mirrored else row)]

        mirrored = statistics.correlation(flat(full[1], True), flat(full[0]))
        self.assertGreater(mirrored, 0.9)
        self.assertGreater(mirrored, statistics.correlation(flat(full[1]), flat(full[0])))
        for upper, lower in (left, right):  # the fan's apex is on top: more of the upper half is black
            self.assertLess(upper, lower)
        self.assertNotEqual(left, right)

    @staticmethod
    def halves(picture):
        """What part of the upper and of the lower half of a picture is not black."""
        def part(cut):
            done = subprocess.run(["oiiotool", str(picture), "--cut", cut, "--printstats"],
                                  stdout=subprocess.PIPE, text=True, check=True)
            (mean,) = [line.split(":")[1].split()[0] for line in done.stdout.splitlines() if "Stats Avg" in line]
            return float(mean)

        done = subprocess.run(["oiiotool", "--info", str(picture)], stdout=subprocess.PIPE, text=True, check=True)
        columns, rows = (int(number) for number in done.stdout.split(":")[-1].split(",")[0].split("x"))
        return part(f"{columns}x{rows // 2}+0+0"), part(f"{columns}x{rows // 2}+0+{rows - rows // 2}")

    def test_the_other_plane_of_a_matrix_probe(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder, "matrix.py")
            scene.write_text((PLAYBACKS / "scanner.py").read_text().replace(
                "LineCount=24, PathsPerLine=512",
                "LineCount=8, PathsPerLine=10, ScanKind=3, ElevationLineCount=8, PixelMm=4"))
            drawn = self.play_panel("scanner_planes.xml", folder, scene)
        full = [line["Lateral"] for line in drawn if line["Preview"] == 0]
        turns = [full[0]] + [b for a, b in zip(full, full[1:]) if abs(sum(x * y for x, y in zip(a, b))) < 0.9]
        self.assertEqual(len(turns), 5)  # there and back, there, and undone
        for one, other in zip(turns, turns[1:]):
            self.assertLess(abs(sum(a * b for a, b in zip(one, other))), 1e-6)
        for one, other in zip(turns, turns[2:]):
            self.assertGreater(sum(a * b for a, b in zip(one, other)), 0.999)

    def test_grey_without_a_filter(self):
        """With one sentence, when it is deleted."""
        with tempfile.TemporaryDirectory() as folder:
            self.play_panel("scanner_grey.xml", folder)

    def test_keys(self):
        """Gain, depth, flip and freeze by keys while the panel is open, wherever the focus is; not while it is shut."""
        def act(person):
            person.await_file("begun.pvsm")
            person.click(1000, 227)  # a label of the panel: the window has the keys then
            person.move(600, 450)
            for keys in (("F8",), ("Alt_L", "Prior"), ("Alt_L", "Prior"), ("Alt_L", "Shift_L", "Next"), ("F6",),
                         ("Alt_L", "Shift_L", "Next"), ("Alt_L", "Next")):
                time.sleep(2.5)
                person.press(*keys)
            time.sleep(2)
            save_screen(pathlib.Path.cwd() / "scanner_keys.png", self.frame_buffer, WINDOW, "100%")
            person.press("F6")
            person.await_file("shut.pvsm")
            person.press("Alt_L", "Prior")

        with tempfile.TemporaryDirectory() as folder:
            drawn = self.play_panel("scanner_keys.xml", folder, act=act)
        steps = [(round(line["Lateral"][0] / abs(line["Lateral"][0])), line["GainDb"], line["DepthMm"])
                 for line in drawn if line["Preview"] == 0]
        steps = [steps[0]] + [b for a, b in zip(steps, steps[1:]) if a != b]
        self.assertEqual(steps, [(1, 0, 160), (-1, 0, 160), (-1, 1, 160), (-1, 2, 160), (-1, 2, 170), (-1, 1, 170),
                                 (-1, 1, 180)])


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
