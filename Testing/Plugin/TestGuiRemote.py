"""ParaView's window at one end of a link whose bytes are counted, a pvserver at the other: the abort button, and what crosses the link
when a probe is dragged. Needs Xvfb and python3-xlib; run by ctest -L gui."""
import pathlib
import sys
import tempfile
import time
import unittest

from guicase import PLAYBACKS, GuiCase
from link import Server
from person import Person, while_acting

FAN = (757, 122)  # in the toolbar
FROM, TO = (538, 539), (499, 516)  # in the view with the body: where the probe lies at first, and up the chest
STEPS = 12
SCRIPT = """
from paraview.simple import *
SetActiveSource(ThoraxPhantom(Spacingmm=2))
"""


class TestGuiRemote(GuiCase):
    def setUp(self):
        self.pvserver = Server(display=self.display)
        self.addCleanup(self.pvserver.close)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def play_with(self, act, script, *arguments):
        """ParaView as the server's client, with a person before it."""

        def act_or_quit(person):
            try:
                act(person)
            except Exception:
                person.press_quit()
                raise

        done, failures = while_acting(Person(self, self.folder), act_or_quit, lambda: self.paraview(
            self.folder, f"--server-url=cs://127.0.0.1:{self.pvserver.port}", f"--script={script}", *arguments))
        self.assertEqual(failures, [], done.stdout)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertNotIn("ERR|", done.stdout)
        return done

    def test_abort_button(self):
        """The same as in ParaView's own process, by the same clicks."""
        seen = {}

        def act(person):
            person.await_file("begun.pvsm")
            person.move(1390, 890)  # so that the pointer is in no picture
            seen["before"] = person.picture()
            person.click(*person.await_button())
            begin = time.perf_counter()
            person.await_file("stopped.pvsm")
            seen["seconds"] = time.perf_counter() - begin
            time.sleep(1.5)
            seen["kept"] = person.picture()
            person.await_file("whole.pvsm")
            time.sleep(1.5)
            seen["after"] = person.picture()
            person.await_file("begun_anew.pvsm")
            person.click(*person.await_button())

        done = self.play_with(act, PLAYBACKS / "stop.py", f"--test-script={PLAYBACKS / 'stop.xml'}", "--exit")
        self.assertEqual(done.stdout.count("Stopped: ultrasound."), 2, done.stdout)
        print(f"stopped, and a state written, in {seen['seconds']:.1f} s")
        self.assertLess(seen["seconds"], 8)  # the run takes more than ten times as long
        self.assertEqual(seen["kept"], seen["before"])
        self.assertNotEqual(seen["after"], seen["before"])

    def await_rest(self, person, seconds=3):
        """Returns when nothing has crossed the link for a while: the bytes that came down since it was last called."""
        quiet, last = time.perf_counter(), self.pvserver.crossed()
        while time.perf_counter() - quiet < seconds and not person.ended.wait(0.1):
            now = self.pvserver.crossed()
            if now != last:
                quiet, last = time.perf_counter(), now
        before, self.before = getattr(self, "before", 0), last[0]
        return self.before - before

    def test_pictures_cross_the_link_and_no_labels_or_meshes(self):
        down = {}

        def act(person):
            person.await_colour(*FAN)
            down["connect"] = self.await_rest(person)
            person.click(*FAN)
            down["fan"] = self.await_rest(person, 8)
            person.move(*FROM)
            self.await_rest(person)
            person.hold()
            down["press"] = self.await_rest(person)
            for which in ("drag", "second drag"):
                down[which] = []
                for step in range(1, STEPS + 1):
                    person.move(*(round(a + (b - a) * step / STEPS) for a, b in zip(FROM, TO)))
                    down[which].append(self.await_rest(person, 1))
                person.release()
                down[f"rest after {which}"] = self.await_rest(person, 6)
                person.move(*FROM) if which == "second drag" else person.move(*TO)
                self.await_rest(person)
                person.hold()
                down["second press"] = self.await_rest(person)
            person.release()
            self.await_rest(person)
            person.press_quit()

        script = pathlib.Path(self.folder, "script.py")
        script.write_text(SCRIPT)
        self.play_with(act, script)
        print(down)
        # The body's triangles once, few of them; half a picture and none when the button is pressed again.
        self.assertLess(down["press"], 4e6)
        self.assertLess(down["second press"], 1e6)
        views = 3 * (408 * 508 + 411 * 307)  # bytes of the two views' pixels
        for which in ("drag", "second drag"):
            self.assertGreater(sum(down[which]), 100_000 * STEPS)  # of a step on a busy machine it may come in the next one
            self.assertLess(max(down[which]), 2 * views)  # a hand may be seen at two places in a step
            self.assertLess(sum(down[which]) / STEPS, views)
            self.assertLess(down[f"rest after {which}"], 4 * views)


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
