"""Random actions in ParaView, without a crash, a hang (see watchdog.py) or an error that is not explained. Needs Xvfb,
python3-pyqt5 and python3-xlib; run by ctest -L gui.

MONKEY_ACTIONS says how many, MONKEY_SEED which: `MONKEY_SEED=7 MONKEY_ACTIONS=2000 ctest -R TestGuiMonkey -V`. Without, the
same ones each time, as many as a test has time for. An action depends on the seed, on its number and on what ParaView shows
then, so that the same ones follow, as far as no clock counts; a failure prints the last ones before it. MONKEY_LOG names a file
for all that ParaView writes."""
import collections
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

from guicase import PLAYBACKS, PLUGIN, GuiCase, write_label_maps
from watchdog import LONGEST_S, Watchdog

ROOT = PLAYBACKS.parents[2]
LAST = 20
LEAVING_S = 60

DANGLING = r"Input port 0 of algorithm vtkSono\w+ \(0x[0-9a-f]+\) has 0 connections but is not optional"
# What follows it, where the filter is shown.
AFTER_DANGLING = r"vtkPVGeometryFilter .* returned failure for request.*REQUEST_DATA_OBJECT"
# What ParaView itself says, each with its reason. Ours comes from Filters/SonoStage.cxx and need not be here.
KNOWN = {
    # So says the Slice of a Wavelet, too, when somebody clicks on it with the right button after its source was changed and
    # before it was drawn again: the picking draws without updating.
    r"vtkPVImageSliceMapper.*Mapper has no vtkImageData input",
    # A filter of a state that was saved after what it depends on was deleted, by a script. An Elevation of a deleted Wavelet
    # fails, too. ParaView connects the first port of whatever its menus make.
    DANGLING,
    # The same of ParaView's own Threshold, where it finds no input: that of a deleted Wavelet, saved and loaded, says so.
    r"vtkPVThreshold .* returned failure for request.*REQUEST_DATA_OBJECT",
    # The same, split into two screens.
    r"Some proxy is added as input but was not registered",
    # The same, saved as Python.
    r"smstate.py.*Untraceable: .* is not 'known' at this point",
    # An image under a name whose ending is none of its writers': ParaView's dialog falls back on CGNS, which it cannot hold.
    r"vtkPCGNSWriter.*(Unable to write data object of class vtkImageData|returned failure for request)",
    # The same of a surface or a table, or of an image under .vtp, for which it falls back on PVD, whose folder would have the
    # name of a file that is there.
    r"vtkXMLPVDWriter.*Sorry unable to create directory",
    r'vtkXMLWriter.*(Error opening output file "[^"]*/(\w+\.\w+)/\2_\d+\.vt[ipt]"|Error code "Not a directory")',
    # VTK 9.2's selector compares the number of a prop before it has one, with what lies in the memory by chance: its constructor
    # leaves that number (PropID) out.
    r"vtkPVHardwareSelector.*Too many props",
    # The display of an image, pasted to what is no image: ParaView pastes its kind as well.
    r"vtkPVCompositeRepresentation .*No representation was found with Name: ",
    # A question, which ParaView's dialog for a file's name asks with the sign of a warning.
    r"^MESSAGE .* already exists\. Do you want to replace it",
}


# Of ParaView's own, what may take longer than the window may be silent, while others have the machine, too: making all proxies of
# a state; taking those of ten outputs in several views apart (vtkSMProxy::~vtkSMProxy, 2 to 5 s); and, with Python in the process,
# the classes of all proxies after a reset.
SLOW = re.compile(r"ACT \d+ (loads state|deletes|actionDelete_All)")
SLOW_S = 15.0
# And how long while nothing of ours is on the main thread's stack. A state of eight views takes an empty ParaView 10 to 12 s on a
# slow machine, and one in which much was done the longer: VTK looks through all weak pointers to the session one by one for
# each property that is made, of which there were 45,000 after 590 actions. What a debugger takes is included.
SLOWEST_MS = 90_000
# No more than a window may take, except where nothing of ours is on that stack: undoing, and a state as Python, for which ParaView
# asks every property of every proxy; 5.1 s on that machine after some hundred actions.
PARAVIEWS = re.compile(r"ACT \d+ (actionEdit(Undo|Redo)|saves state\d\.py)")
OURS = re.compile(r"SonoVDB\.so|vtkSono\w+\.so")
JUDGED = ("RAISED ", "MESSAGE ", "Traceback ", "critical: ", "fatal: ")  # beside what VTK logs as errors


def explained(sources):
    """Parts of the sentences by which our filters refuse bad input: the literals of four words and more in the sources."""
    parts = set()
    for path in sources:
        for literal in re.findall(r'"((?:[^"\\\n]|\\.)*)"', path.read_text(encoding="utf-8")):
            if len(literal.split()) >= 4:
                parts.add(literal.replace('\\"', '"').strip())
    return parts


class Judge:
    """Collects what ParaView writes, and tells errors that are not explained."""

    def __init__(self):
        self.ours = explained(path for floor in ("Simulation", "Filters") for path in sorted((ROOT / floor).rglob("*"))
                              if path.suffix in (".h", ".cpp", ".cxx"))
        self.acts = collections.deque(maxlen=LAST)
        self.done = 0
        self.ended = False
        self.waits = 0  # longer than the watchdog allows, for ParaView alone
        self.faults = []
        self.stack = []
        self.kinds = collections.Counter()
        self.open = None  # lines of a message that may go on
        self.explained = collections.Counter()

    def place(self):
        """Where something happens."""
        return f"action {self.done}: ", "\n  after " + (self.acts[-1] if self.acts else "the start")

    def is_slow(self):
        """Whether what happens now may take ParaView long."""
        return bool(self.acts) and bool(SLOW.match(self.acts[-1]))

    def may_be_alone(self):
        """Whether a hang now may be ParaView's own."""
        return self.is_slow() or bool(self.acts) and bool(PARAVIEWS.match(self.acts[-1]))

    def hang(self, sentence, stack, place, may_be_alone):
        """A fault, unless ParaView alone takes that long."""
        if may_be_alone and "#0" in stack and not OURS.search(stack):
            self.waits += 1
            print("ParaView's own:", place[0] + sentence + place[1], flush=True)
        else:
            self.fault(f"hang: {sentence}\n{stack}", place)

    def fault(self, sentence, place=None):
        """Once, however often a filter is asked again."""
        before, after = place or self.place()
        kind = re.sub(r"0x[0-9a-f]+|[\d.]+s\)|Time: \d+", "", sentence)
        self.kinds[kind] += 1
        if self.kinds[kind] == 1:
            self.faults.append(before + sentence + after)
            print("FAULT", self.faults[-1], flush=True)

    def read(self, line):
        line = re.sub(r"\x1b\[[\d;]*m", "", line)  # colours
        begins = re.match(r"\(\s*[\d.]+s\)|ACT |DONE |RAISED |MESSAGE |DIALOG |STUBBORN |END$|critical: In |fatal: In ", line)
        if begins or not line.startswith(" ") and self.open and self.open[0].startswith("RAISED"):
            self.close()
        if line.startswith("ACT "):
            self.acts.append(line)
        elif line.startswith("DONE "):
            if int(line.split()[3]) > SLOWEST_MS and self.may_be_alone():
                self.fault(f"hang: {line}")
            self.done = int(line.split()[1]) + 1
        elif re.match(r"\d+ +0x", line):
            self.stack.append(line)
        elif line == "END":
            self.ended = True
        elif line.startswith("STUBBORN "):
            self.fault(f"a dialog cannot be closed: {line}")
        elif " ERR| " in line or line.startswith(JUDGED) and not self.open:
            self.open = [line]
        elif self.open is not None:
            self.open.append(line)

    def close(self):
        """The message is complete."""
        text, self.open = "\n".join(self.open or []), None
        if text:
            reason = self.reason(text)
            if reason:
                self.explained[reason] += 1
            else:
                self.fault(f"an error that is not explained: {text}")

    def reason(self, text):
        for pattern in KNOWN | ({AFTER_DANGLING} if self.explained[DANGLING] else set()):
            if re.search(pattern, text, re.DOTALL):
                return pattern
        if "SonoStage.cxx" in text or "vtkSono" in text:
            return next((part for part in self.ours if part in text), None)
        return None


# A monkey that does what must not be.
SPOILT = """
import os, signal, sys, time
sys.path.insert(0, os.environ["MONKEY_SCRIPTS"])
import monkey_acts
from vtkmodules.vtkCommonCore import vtkLogger

def spoil(hands, _):
    hands.note("loads state, as slowly as ParaView" if hands.number == 0 else "spoils")
    yield
    if hands.number == 0:
        time.sleep(20)
    elif hands.number == 1:
        time.sleep(15)
    elif hands.number == 2:
        vtkLogger.Log(vtkLogger.VERBOSITY_ERROR, "spoilt.py", 1, "nobody knows why")
    elif hands.number == 3:
        os.kill(os.getpid(), signal.SIGSEGV)
    yield

monkey_acts.choose = lambda hands: spoil
exec(open(os.path.join(os.environ["MONKEY_SCRIPTS"], "monkey.py"), encoding="utf-8").read())
"""


class TestGuiMonkey(GuiCase):
    def test_a_hang_an_error_and_a_crash_are_told(self):
        judge = Judge()
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            script = folder / "spoilt.py"
            script.write_text(SPOILT)
            code = self.run_monkey(folder, judge, "1", 10, script)
            self.tell_crash(judge, code)
        self.assertEqual(judge.waits, 1)
        faults = sorted(judge.faults)  # a debugger may take until the next one
        self.assertEqual([fault.split(":")[0] for fault in faults], ["action 1", "action 2", "action 3"])
        for fault, part in zip(faults, ("does not answer", "nobody knows why", "SIGSEGV")):
            self.assertIn(part, fault)
        self.assertFalse(judge.ended)

    def test_auto_apply_waits_while_something_is_undone(self):
        """It looked at views that had not been put back yet, and ParaView crashed."""
        with tempfile.TemporaryDirectory() as folder:
            done = self.paraview(folder, f"--script={PLAYBACKS / 'undoing.py'}")
            self.assertEqual(done.returncode, 0, done.stdout)
            rang = pathlib.Path(folder, "rang.txt").read_text(encoding="utf-8").split("\n")
        self.assertEqual(rang, ["let through", "another", "end", "ParaView's"])

    def test_apply_passes_over_a_view_without_a_place(self):
        """Its layout was removed, and its widget with it; ParaView crashed at the next Apply."""
        with tempfile.TemporaryDirectory() as folder:
            done = self.paraview(folder, f"--script={PLAYBACKS / 'lost_view.py'}")
            self.assertEqual(done.returncode, 0, done.stdout)
            drawn = pathlib.Path(folder, "drawn.txt").read_text(encoding="utf-8").split("\n")
        self.assertEqual(drawn, ["3.0", "4.0"])  # in the view that has one

    def test_timers_wait_while_a_layout_is_made(self):
        """One of a script deleted what was simulated and drawn, and ParaView crashed."""
        with tempfile.TemporaryDirectory() as folder:
            done = self.paraview(folder, f"--script={PLAYBACKS / 'timers_wait.py'}")
            self.assertEqual(done.returncode, 0, done.stdout)
            within, afterwards, sources = map(int, pathlib.Path(folder, "fired.txt").read_text(encoding="utf-8").split())
        self.assertEqual(within, 0)
        self.assertGreater(afterwards, 0)
        self.assertEqual(sources, 5)  # the body, its simulation, a line, and what stands beside the flat picture

    def test_random_actions(self):
        seed, count = os.environ.get("MONKEY_SEED", "1"), int(os.environ.get("MONKEY_ACTIONS", "300"))
        print(f"seed {seed}, {count} actions", flush=True)
        judge = Judge()
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            write_label_maps(folder / "given")
            code = self.run_monkey(folder, judge, seed, count)
            if code < 0:
                self.tell_crash(judge, code)
        if judge.faults or code != 0 or not judge.ended:
            text = "\n".join([f"seed {seed}: ParaView ended with {code} in action {judge.done} of {count}",
                              "The last actions:", *judge.acts, "Faults:", *judge.faults])
            self.fail(text)
        self.assertEqual(judge.done, count)

    def run_monkey(self, folder, judge, seed, count, script=PLAYBACKS / "monkey.py"):
        """Until it ends by itself; the return code."""
        heart = folder / "heart"
        heart.write_bytes(bytes(16))
        # Shaders that were compiled for one view are there for the next. Memory that is given back is filled: who still uses it
        # is found out.
        environment = dict(os.environ, DISPLAY=self.display, HOME=str(folder), XDG_RUNTIME_DIR=str(folder),
                           XDG_CACHE_HOME=str(folder / "cache"), MONKEY_SEED=seed, MONKEY_ACTIONS=str(count),
                           MONKEY_SCRIPTS=str(PLAYBACKS), MALLOC_PERTURB_="165")
        begun = time.monotonic()
        process = subprocess.Popen(
            ["paraview", "--dr", f"--plugin-search-paths={PLUGIN.parent}", "--plugins=SonoVDB",
             f"--script={script}"], env=environment, cwd=folder, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, text=True, errors="replace")

        def hung(sentence):
            place, may_be_alone = judge.place(), judge.may_be_alone()  # by now: a debugger takes a while
            judge.hang(sentence, self.backtrace(process.pid), place, may_be_alone)

        def longest_s():
            if judge.ended:
                return LEAVING_S / 2  # the window goes, and all behind it is taken apart
            return SLOW_S if judge.is_slow() else LONGEST_S

        dog = Watchdog(self.display, process.pid, heart, hung, longest_s)
        log = os.environ.get("MONKEY_LOG")
        with open(log, "w", encoding="utf-8") if log else open(os.devnull, "w", encoding="utf-8") as record:
            killer = None
            for line in process.stdout:
                record.write(line)
                record.flush()
                judge.read(line.rstrip("\n"))
                if judge.ended and not killer:
                    killer = threading.Timer(LEAVING_S, process.kill)
                    killer.start()
        process.stdout.close()
        judge.close()
        code = process.wait()
        dog.stop()
        if killer:
            killer.cancel()
        print(f"{judge.done} actions in {time.monotonic() - begun:.0f} s; the window was silent for {dog.longest_s:.1f} s at "
              f"most, {judge.waits} times ParaView alone for long; {dog.stops} runs stopped after 5 s; "
              f"{sum(judge.explained.values())} errors that are explained, of {len(judge.explained)} kinds", flush=True)
        return code

    @staticmethod
    def backtrace(pid):
        """Of the main thread, where there is a debugger."""
        if not shutil.which("gdb"):
            return "  (without gdb there is no backtrace)"
        done = subprocess.run(["gdb", "-batch", "-nx", "-iex", "set debuginfod enabled off", "-ex", "bt 300", "-p", str(pid)],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, errors="replace", timeout=300)
        return "\n".join("  " + line for line in done.stdout.splitlines() if line.startswith("#"))

    @staticmethod
    def tell_crash(judge, code):
        """With the stack that ParaView writes, innermost last."""
        judge.fault("\n  ".join([f"ended by {signal.Signals(-code).name}", *judge.stack]))


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
