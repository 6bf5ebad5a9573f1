"""Stops a simulation in ParaView by the abort button and by closing the window, or clicks elsewhere meanwhile, with the
events of a real mouse and keyboard. Needs Xvfb and python3-xlib; run by ctest -L gui."""
import pathlib
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree as ElementTree

from guicase import PLAYBACKS, GuiCase, bytes_of
from person import Person, while_acting

THORAX = (85, 197)  # its row in the pipeline browser
WIDTH, HEIGHT = 416, 313
# The flat view of a state, and the fullest other one, as pictures.
DRAW = f"""
LoadState(sys.argv[1])
views = [v for v in GetViews() if v.GetXMLName() == "RenderView"]
for name, mode in (("flat", "2D"), ("body", "3D")):
    view = max((v for v in views if v.InteractionMode == mode), key=lambda v: sum(r.Visibility for r in v.Representations))
    SaveScreenshot(sys.argv[2] + name + ".png", view, ImageResolution=[{WIDTH}, {HEIGHT}])
"""


class TestGuiStop(GuiCase):
    def play_with(self, name, folder, act, scene="stop.py"):
        """Plays a script on a scene while a person acts; what ParaView wrote, and its return code."""
        done, failures = while_acting(Person(self, folder), act, lambda: self.paraview(
            folder, f"--script={PLAYBACKS / scene}", f"--test-script={PLAYBACKS / name}", "--exit"))
        self.assertEqual(failures, [], done.stdout)
        return done

    def test_abort_button(self):
        seen = {}

        def act(person):
            person.await_file("begun.pvsm")
            person.move(1390, 890)  # so that the pointer is in no picture
            seen["before"] = person.picture()
            self.assertIsNone(person.find_button())
            button = person.await_button()
            person.click(600, 450, 1)  # a hand is slower than ParaView looks, and impatient
            person.click(*button)
            person.await_file("stopped.pvsm")
            time.sleep(1.5)
            seen["kept"] = person.picture()
            person.await_file("whole.pvsm")
            time.sleep(1.5)
            seen["after"] = person.picture()
            person.await_file("begun_anew.pvsm")
            person.click(*person.await_button())
            person.await_file("typed.pvsm")
            for name in ("undone", "typed"):
                seen[name] = {setting: self.setting(person.folder / f"{name}.pvsm", setting)
                              for setting in ("PathsPerLine", "GainDb")}

        with tempfile.TemporaryDirectory() as folder:
            done = self.play_with("stop.xml", folder, act)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertNotIn("ERR|", done.stdout)
        self.assertEqual(done.stdout.count("Stopped: ultrasound."), 2, done.stdout)
        self.assertEqual(seen["kept"], seen["before"])
        self.assertNotEqual(seen["after"], seen["before"])
        self.assertEqual(seen["undone"], {"PathsPerLine": "100", "GainDb": "0"})
        self.assertEqual(seen["typed"], {"PathsPerLine": "100", "GainDb": "7"})

    def test_a_first_run_that_was_stopped_is_laid_out_by_apply(self):
        """Not before: views of what is not there would keep the colours and the camera of nothing."""
        def act(person):
            person.await_file("begun.pvsm")
            person.click(*person.await_button())

        with tempfile.TemporaryDirectory() as folder:
            done = self.play_with("first_run.xml", folder, act, "first_run.py")
            stopped, whole = ([p.get("type") for p in ElementTree.parse(pathlib.Path(folder, name)).iter("Proxy")
                               if p.get("group") in ("views", "sources", "filters")]
                              for name in ("stopped.pvsm", "whole.pvsm"))
            self.run_script(DRAW, folder, pathlib.Path(folder, "whole.pvsm"), f"{folder}/")
            flat, body = (bytes_of(pathlib.Path(folder, f"{name}.png"), 3 * WIDTH * HEIGHT) for name in ("flat", "body"))
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertNotIn("ERR|", done.stdout)
        self.assertIn("SonoUltrasound", stopped)
        self.assertEqual([types.count("XYChartView") for types in (stopped, whole)], [0, 1])
        self.assertEqual(whole.count("RenderView"), stopped.count("RenderView") + 2)
        # The flat image is grey, and the body is there.
        bright, coloured = self.shares(flat)
        self.assertGreater(bright, 0.05)
        self.assertLess(coloured, 0.01)
        side = 3 * WIDTH * HEIGHT // 2  # the middle of the left border
        filled = sum(max(abs(a - b) for a, b in zip(body[i:i + 3], body[side:side + 3])) > 10 for i in range(0, len(body), 3))
        self.assertGreater(filled, 0.08 * WIDTH * HEIGHT)

    @staticmethod
    def shares(picture):
        """Of the pixels that are not dark, and of those that have a colour."""
        pixels = [picture[i:i + 3] for i in range(0, len(picture), 3)]
        return (sum(max(each) > 60 for each in pixels) / len(pixels),
                sum(max(each) - min(each) > 60 for each in pixels) / len(pixels))

    @staticmethod
    def setting(state, name):
        """Of the only Simulate Ultrasound in a state file."""
        (proxy,) = (p for p in ElementTree.parse(state).iter("Proxy") if p.get("type") == "SonoUltrasound")
        return proxy.find(f"Property[@name='{name}']/Element").get("value")

    def test_clicks_wait_for_the_end_of_the_run(self):
        """Another source is clicked on: the run goes on, its picture appears, then the panel is the other source's."""
        seen = {}

        def act(person):
            person.await_file("begun.pvsm")
            person.move(1390, 890)
            seen["before"] = person.picture()
            person.await_button()
            person.click(*THORAX)
            person.move(1390, 890)
            time.sleep(1.5)
            seen["goes on"] = person.sees_progress()
            seen["meanwhile"] = person.picture()
            person.await_file("ended.pvsm")
            time.sleep(1.5)
            seen["after"] = person.picture()

        with tempfile.TemporaryDirectory() as folder:
            done = self.play_with("click.xml", folder, act)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertNotIn("ERR|", done.stdout)
        self.assertNotIn("Stopped", done.stdout)
        self.assertTrue(seen["goes on"])
        self.assertEqual(seen["meanwhile"], seen["before"])
        self.assertNotEqual(seen["after"], seen["before"])

    def test_leaving_during_a_run(self):
        """ParaView ends before the run does, and quietly, by its key and by the window's cross."""
        for leave in (Person.press_quit, Person.close_window):
            with self.subTest(leave=leave.__name__), tempfile.TemporaryDirectory() as folder:
                def act(person):
                    person.await_file("begun.pvsm")
                    person.move(600, 450)  # where the keys go
                    time.sleep(1.5)
                    leave(person)

                done = self.play_with("stop.xml", folder, act)
                self.assertFalse(pathlib.Path(folder, "stopped.pvsm").exists())  # the run did not go on to its end
                self.assertGreaterEqual(done.returncode, 0, done.stdout)  # no signal
                self.assertNotIn("ERR|", done.stdout)


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
