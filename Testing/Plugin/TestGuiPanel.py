"""Each control that no other test touches: what is turned, set, shown or made is what the control says, and nothing else is. Needs
Xvfb, python3-pyqt5 and python3-xlib; run by ctest -L gui."""
import json
import math
import os
import pathlib
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from unittest import mock

from guicase import PLAYBACKS, GuiCase, write_label_maps


def angle(a, b):
    """In degrees."""
    cosine = sum(x * y for x, y in zip(a, b)) / math.hypot(*a) / math.hypot(*b)
    return math.degrees(math.acos(max(-1, min(1, cosine))))


class TestGuiPanel(GuiCase):
    def play_scene(self, name, folder):
        os.environ.update(PANEL_SCENE=name, PANEL_SCRIPTS=str(PLAYBACKS))
        done = self.paraview(folder, f"--script={PLAYBACKS / 'panel.py'}")
        failed = pathlib.Path(folder, "failed.txt")
        self.assertFalse(failed.exists(), failed.exists() and failed.read_text())
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertEqual([line for line in done.stdout.splitlines() if "ERR|" in line or "Traceback" in line], [])
        return json.loads(pathlib.Path(folder, "panel.json").read_text(encoding="utf-8"))

    def test_pose(self):
        with tempfile.TemporaryDirectory() as folder:
            found = self.play_scene("pose", folder)
        first = found["first"]
        for name, kept, turned in (("Rotate", "axial", "lateral"), ("Tilt", "lateral", "axial"), ("Rock", None, "axial")):
            there, back = found[name + "Plus"], found[name + "Minus"]
            with self.subTest(control=name):
                self.assertAlmostEqual(angle(there[turned], first[turned]), 10, delta=0.01)
                if kept:
                    self.assertAlmostEqual(angle(there[kept], first[kept]), 0, delta=0.01)
                else:  # in the image plane
                    self.assertAlmostEqual(angle(there["lateral"], first["lateral"]), 10, delta=0.01)
                self.assertNotEqual(there["picture"], first["picture"])
                self.assertFalse(there["waits"])
                self.assertAlmostEqual(angle(back[turned], first[turned]), 0, delta=0.01)
        self.assertEqual(found["undone"]["position"], found["RockMinus"]["position"])
        self.assertEqual(found["shown"], [True, True])
        self.assertTrue(found["not live"]["waits"])
        self.assertEqual(found["not live"]["picture"], found["undone"]["picture"])
        self.assertFalse(found["applied"]["waits"])
        self.assertNotEqual(found["applied"]["picture"], found["undone"]["picture"])
        self.assertAlmostEqual(angle(found["applied"]["lateral"], found["undone"]["lateral"]), 10, delta=0.01)
        self.assertFalse(found["live again"]["waits"])
        self.assertAlmostEqual(angle(found["live again"]["lateral"], found["undone"]["lateral"]), 20, delta=0.01)

    def test_scanner(self):
        with tempfile.TemporaryDirectory() as folder:
            found = self.play_scene("scanner", folder)
            frozen = [element.get("value") for element in ElementTree.parse(pathlib.Path(folder, "frozen.pvsm")).iterfind(
                ".//Proxy[@type='SonoUltrasound']/Property[@name='Freeze']/Element")]
            stored = [path.name for path in pathlib.Path(folder).glob("ultrasound_*.png")]
        for i in range(2, 8):
            before, after, undone = (found[f"{what} {i}"] for what in ("before", "set", "undone"))
            gained = [b - a for a, b in zip(before["bands"], after["bands"])]
            with self.subTest(depth=i):
                self.assertEqual([after["value"], undone["value"]], [32, 0])
                self.assertEqual(undone["picture"], before["picture"])
                self.assertGreater(max(gained), 5)
                self.assertIn(gained.index(max(gained)), (i - 2, i - 1, i))
        (width, seen), (other, then) = found["widths"]
        self.assertNotEqual(width, other)
        self.assertAlmostEqual(then - seen, other - width, delta=1.5)
        text, times = found["rate"]
        rate, _, unit = text.partition(" ")
        self.assertEqual(unit, "pictures/s")
        recent = [at for at in times if at > times[-1] - 2]
        self.assertAlmostEqual(float(rate), (len(recent) - 1) / (recent[-1] - recent[0]), delta=0.4 * float(rate))
        self.assertEqual(found["frozen"], [[0, False], [1, True], [0, False], [1, True]])
        self.assertEqual(found["before frozen"]["picture"], found["frozen picture"]["picture"])
        self.assertNotEqual(found["unfrozen"]["picture"], found["before frozen"]["picture"])
        self.assertFalse(found["unfrozen"]["waits"])
        self.assertEqual(frozen, ["1"])
        self.assertEqual(len(stored), 1)
        self.assertIn(stored[0], found["stored"])
        self.assertEqual(found["planes"], [["F9", False], ["Shift+F9", False]])  # of a matrix probe alone

    def test_views(self):
        with tempfile.TemporaryDirectory() as folder:
            found = self.play_scene("views", folder)
        self.assertGreater(len({tuple(pixels) for _, pixels, _ in found["sizes"]}), 2)
        for height_mm, (columns, rows), (width, height) in found["sizes"]:
            spare = min(height_mm / height, height_mm * columns / rows / width)
            self.assertGreater(spare, 1.0)
            self.assertLess(spare, 1.35)
        self.assertEqual(found["sizes"][-1], found["sizes"][0])
        self.assertEqual(found["shared"], [True, True])
        self.assertEqual(sorted(found["apart"]), [False, True])
        self.assertEqual(sorted(found["chambers"]), [0, 1])

    def test_needle(self):
        with tempfile.TemporaryDirectory() as folder:
            found = self.play_scene("needle", folder)
        self.assertTrue(found["with"]["targets"])
        self.assertNotEqual(found["with"]["picture"], found["without"]["picture"])
        moved = found["moved"]
        self.assertLess(math.dist(*moved["hub"]), 1e-6)
        self.assertGreater(math.dist(*moved["tip"]), 2)
        self.assertNotEqual(moved["picture"], found["with"]["picture"])
        # The picture follows the hand, nothing waits for Apply, and one undo takes the needle back.
        self.assertGreaterEqual(len(set(found["on the way"])), 3)
        self.assertFalse(moved["waits"])
        self.assertLess(math.dist(found["put back"]["tip"], moved["tip"][0]), 1e-6)
        self.assertEqual(found["put back"]["picture"], found["with"]["picture"])

    def test_needle_is_added_by_one_click_and_an_instrument_from_a_file(self):
        with tempfile.TemporaryDirectory() as folder:
            found = self.play_scene("added", folder)
        without, with_it = found["without"], found["with"]
        self.assertNotEqual(with_it["picture"], without["picture"])
        self.assertTrue(with_it["isActive"] and with_it["handles"] and with_it["shown"])
        self.assertTrue(with_it["isSolid"])
        self.assertFalse(with_it["waits"])
        elevation = [a * b - c * d for a, b, c, d in (
            (with_it["axial"][(i + 1) % 3], with_it["lateral"][(i + 2) % 3],
             with_it["axial"][(i + 2) % 3], with_it["lateral"][(i + 1) % 3]) for i in range(3))]
        axes = {"side": with_it["lateral"], "depth": with_it["axial"], "off": elevation}
        hub, tip = ({name: sum((x - y) * a for x, y, a in zip(end, with_it["position"], axis)) for name, axis in axes.items()}
                    for end in with_it["ends"])
        for end in (hub, tip):
            self.assertAlmostEqual(end["off"], 0, delta=1e-3)  # mm out of the plane
            self.assertGreater(end["depth"], 0)
        self.assertGreater(hub["side"], without["width"] / 2)  # beside the probe, and not as deep as the tip
        self.assertLess(hub["depth"], tip["depth"])
        self.assertLess(abs(tip["side"]), without["width"] / 2)
        self.assertLess(tip["depth"], with_it["depth"])
        self.assertEqual(found["again"]["needles"], 1)
        self.assertTrue(found["again"]["isActive"] and found["again"]["handles"])
        self.assertEqual((found["undone"]["needles"], found["undone"]["targets"]), (0, False))
        self.assertEqual(found["undone"]["picture"], without["picture"])
        self.assertEqual((found["redone"]["needles"], found["redone"]["targets"]), (1, True))
        self.assertEqual(found["redone"]["picture"], with_it["picture"])
        self.assertFalse(found["chosen"]["waits"])
        instrument = found["instrument"]
        self.assertFalse(instrument["takesNeedle"])
        self.assertNotIn(instrument["picture"], (without["picture"], with_it["picture"]))

    def test_needle_of_a_frozen_picture_and_of_one_of_two(self):
        with tempfile.TemporaryDirectory() as folder:
            found = self.play_scene("placed", folder)
        self.assertEqual(found["frozen with it"]["needles"], 1)
        self.assertNotEqual(found["frozen with it"]["picture"], found["frozen"]["picture"])
        self.assertEqual(found["first with it"]["needles"], 1)
        self.assertEqual([found[f"{name} with it"]["targets"] for name in ("first", "second")], [False, True])
        self.assertEqual(found["first with it"]["picture"], found["first"]["picture"])
        self.assertNotEqual(found["second with it"]["picture"], found["second"]["picture"])
        self.assertIn(1, found["bodies"])

    def test_clear_cache_is_clicked(self):
        with tempfile.TemporaryDirectory() as folder:
            write_label_maps(pathlib.Path(folder, "given"))
            with mock.patch.dict(os.environ, XDG_CACHE_HOME=str(pathlib.Path(folder, "cache"))):
                found = self.play_scene("cache", folder)
        self.assertNotEqual(found["kept"]["files"], [])
        self.assertEqual(found["cleared"]["files"], [])
        self.assertEqual(found["cleared"]["picture"], found["kept"]["picture"])
        self.assertNotEqual(found["other"]["picture"], found["kept"]["picture"])
        self.assertEqual(found["anew"]["picture"], found["kept"]["picture"])  # computed, not kept

    def test_cine_loop_is_played(self):
        """Again and again, the pictures as they were, of a probe that was turned; and of a heart that beat, at each moment."""
        with tempfile.TemporaryDirectory() as folder:
            found = self.play_scene("cine", folder)
        loop = [picture for picture, *_ in found["turned"]]
        played = [picture for picture, *_ in found["played"]]
        self.assertEqual(len(set(loop)), len(loop))
        self.assertGreater(len(played), len(loop))
        for one, other in zip(played, played[1:]):
            self.assertIn(one, loop)
            self.assertEqual(loop.index(other), (loop.index(one) + 1) % len(loop))
        self.assertFalse(found["stopped"]["waits"])
        self.assertFalse(found["beats on"])
        beat = [one for one, other in zip(found["beat"], [None, *found["beat"]]) if other is None or one[1:] != other[1:]]
        self.assertGreater(len({moment for *_, moment in beat}), 2)
        self.assertEqual(found["back"], [beat[-1 - back] for back in (1, 2, 3)])

    def test_keys(self):
        """Alt+U, arrows and Return do what the tool bar's buttons do; what takes keys in our panels has a name to be read out."""
        with tempfile.TemporaryDirectory() as folder:
            found = self.play_scene("keys", folder)
        for name in ("actionSonoSimulate", "actionSonoLayout", "actionSonoNeedle", "&Flat View", "&Examples", "actionSonoScanner",
                     "actionSonoFreeze"):
            self.assertIn(name, found["menu"])
        self.assertGreater(max(found["simulated"]["bands"]), 10)
        self.assertEqual(found["calipers"], 1)
        self.assertAlmostEqual(math.dist(found["walked"]["position"], found["once"]["position"]), 1, delta=0.2)
        self.assertEqual(found["nameless"], [])


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
