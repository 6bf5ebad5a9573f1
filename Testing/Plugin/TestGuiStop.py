"""Stops a simulation in ParaView by the abort button and by closing the window, or clicks elsewhere meanwhile, with the
events of a real mouse and keyboard. Needs Xvfb and python3-xlib; run by ctest -L gui."""
import pathlib
import sys
import tempfile
import threading
import time
import unittest
import xml.etree.ElementTree as ElementTree

from Xlib import X, XK, display
from Xlib.ext import xtest
from Xlib.protocol import event

from guicase import PLAYBACKS, GuiCase, read_screen

VIEW = (300, 205, 720, 520)  # left, top, width, height of the inside of the 3-D view
THORAX = (85, 197)  # its row in the pipeline browser


class Person:
    """Watches the screen and acts while ParaView plays a script."""

    def __init__(self, case, folder):
        self.frame_buffer = case.frame_buffer
        self.folder = pathlib.Path(folder)
        self.display = display.Display(case.display)
        self.ended = threading.Event()  # ParaView has

    def await_file(self, name):
        """Returns when a file was written."""
        path = self.folder / name
        for _ in range(3000):
            ended = self.ended.wait(0.1)
            if path.exists():
                return
            if ended:
                break
        raise TimeoutError(f"{name} was not written")

    def picture(self):
        """The 3-D view's pixels."""
        width, _, pixels = read_screen(self.frame_buffer)
        left, top, columns, rows = VIEW
        return [bytes(pixels[3 * (width * y + left):3 * (width * y + left + columns)]) for y in range(top, top + rows)]

    def find_button(self):
        """The abort button: the red cross below the view. It is grey when there is nothing to abort."""
        width, height, pixels = read_screen(self.frame_buffer)
        for y in range(VIEW[1] + VIEW[3], height):
            for x in range(width):
                red, green, blue = pixels[3 * (width * y + x):3 * (width * y + x) + 3]
                if red > 180 and green < 80 and blue < 80:
                    return x, y
        return None

    def sees_progress(self):
        """Whether the status bar is filled, in blue, to the right of the abort button."""
        button = self.find_button()
        width, _, pixels = read_screen(self.frame_buffer)
        filled = 0
        for x in range(button[0] + 20, button[0] + 200) if button else ():
            red, _, blue = pixels[3 * (width * button[1] + x):3 * (width * button[1] + x) + 3]
            filled += blue > 150 and red < 110
        return filled > 20

    def await_button(self):
        """On a busy machine it takes a while until it is drawn."""
        for _ in range(50):
            time.sleep(0.2)
            button = self.find_button()
            if button:
                return button
        raise TimeoutError("the abort button is not red")

    def move(self, x, y):
        xtest.fake_input(self.display, X.MotionNotify, x=x, y=y)
        self.display.sync()

    def click(self, x, y, seconds=0):
        """Seconds between press and release."""
        self.move(x, y)
        xtest.fake_input(self.display, X.ButtonPress, 1)
        self.display.sync()
        time.sleep(seconds)
        xtest.fake_input(self.display, X.ButtonRelease, 1)
        self.display.sync()

    def press_quit(self):
        control, q = (self.display.keysym_to_keycode(XK.string_to_keysym(name)) for name in ("Control_L", "q"))
        for kind, key in ((X.KeyPress, control), (X.KeyPress, q), (X.KeyRelease, q), (X.KeyRelease, control)):
            xtest.fake_input(self.display, kind, key)
        self.display.sync()

    def close_window(self):
        """As the cross in a window's frame does."""
        atom = self.display.intern_atom
        for window in self.display.screen().root.query_tree().children:
            if (window.get_wm_name() or "").startswith("ParaView 5"):
                window.send_event(event.ClientMessage(window=window, client_type=atom("WM_PROTOCOLS"),
                                                      data=(32, [atom("WM_DELETE_WINDOW"), 0, 0, 0, 0])))
        self.display.sync()


class TestGuiStop(GuiCase):
    def play_with(self, name, folder, act):
        """Plays a script on the scene of stop.py while a person acts; what ParaView wrote, and its return code."""
        failures = []
        person = Person(self, folder)

        def act_alone():
            try:
                act(person)
            except Exception as failure:  # to be told by the test, not by the thread
                failures.append(failure)

        acting = threading.Thread(target=act_alone)
        acting.start()
        done = self.paraview(folder, f"--script={PLAYBACKS / 'stop.py'}", f"--test-script={PLAYBACKS / name}", "--exit")
        person.ended.set()
        acting.join()
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
