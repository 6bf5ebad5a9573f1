"""Does at random what a person may do, as ParaView's --script: each action is drawn from a generator of its own, seeded by
MONKEY_SEED and the action's number, and said on the standard output before it is done. Ends ParaView after MONKEY_ACTIONS
of them. Needs python3-pyqt5 and python3-xlib. TestGuiMonkey.py starts it and judges."""
import mmap
import os
import pathlib
import random
import sys
import traceback

from paraview import simple
from paraview.modules.vtkRemotingViews import vtkPVRepresentedArrayListSettings
from PyQt5 import QtCore, QtWidgets
from Xlib import X

sys.path.insert(0, os.environ["MONKEY_SCRIPTS"])
import monkey_acts  # noqa: E402
import monkey_dialogs  # noqa: E402
from monkey_hands import Hands, Skip, say  # noqa: E402

TICK_MS = 30
SETTLING_TICKS = 3  # after an action: renders and updates that ParaView puts off are done
HEAVY_MS = 4000  # after an action that took longer, settings are made lighter


class Pings(QtCore.QAbstractNativeEventFilter):
    """Notes the pings of the watchdog, which come with the window's other events."""

    def __init__(self, heart, atom):
        super().__init__()
        self.heart = heart
        self.atom = atom

    def nativeEventFilter(self, kind, message):
        event = bytes(message.asarray(32))
        if event[0] & 0x7f == X.ClientMessage and int.from_bytes(event[12:16], "little") == self.atom:
            self.heart[8:] = event[16:20] + bytes(4)
        return False, 0


class Driver:
    """Carries actions out one after the other, from the event loop; what an action opens is closed from within."""

    def __init__(self):
        self.seed = os.environ["MONKEY_SEED"]
        self.count = int(os.environ["MONKEY_ACTIONS"])
        self.number = 0
        self.hands = Hands(pathlib.Path.cwd())
        self.running = None
        self.inside = False  # an action, which may have opened an event loop of its own
        self.settling = 0
        self.since = QtCore.QElapsedTimer()
        with open("heart", "r+b") as file:
            self.heart = mmap.mmap(file.fileno(), 16)
        self.beats = 0
        # The end of a run or of a picture is a beat, too: none of them alone may last.
        self.runs = simple.servermanager.ActiveConnection.Session.GetProgressHandler()
        self.ended = self.runs.AddObserver("EndEvent", lambda *_: self.note_beat())
        self.pings = Pings(self.heart, self.hands.x.intern_atom("_NET_WM_PING"))
        self.hands.app.installNativeEventFilter(self.pings)
        self.dialogs = monkey_dialogs.Dialogs(self.hands)
        # A timer does not fire within what it has begun: another one beats and closes dialogs there.
        self.timers = []
        for act in (self.step, self.beat):
            timer = QtCore.QTimer()
            timer.timeout.connect(act)
            timer.start(TICK_MS)
            self.timers.append(timer)

    def beat(self):
        """The event loop turns."""
        self.note_beat()
        self.dialogs.serve()

    def note_beat(self):
        self.beats += 1
        self.heart[:8] = self.beats.to_bytes(8, "little")

    def step(self):
        """One step of the action, or the next one."""
        if self.inside or self.dialogs.open:
            return
        if self.settling:
            self.settling -= 1
            return
        self.inside = True
        try:
            if self.running is None:
                self.begin()
            next(self.running)
        except StopIteration:
            self.end()
        except Skip:
            self.running = None  # another one, of the same number
        except Exception:
            # What the script's own calls are refused is no crash: the text says whether it is explained.
            say("RAISED " + traceback.format_exc().strip().replace("\n", "\n  "))
            self.end()
        finally:
            self.inside = False

    def begin(self):
        if self.hands.attempts == 0:
            self.hands.rng = random.Random(f"{self.seed}/{self.number}")
        self.hands.attempts += 1
        self.hands.number = self.number
        self.dialogs.plan = None
        # In software each layer that is peeled off takes as long as a picture. A session that was reset peels again.
        settings = simple.GetSettingsProxy("RenderViewSettings")
        if settings.DepthPeeling:
            settings.DepthPeeling = 0
        # ParaView 5.11 leaves the observers of representations that are gone with its list of hidden arrays, 126 of each, and a
        # new one walks past them all: after a thousand actions a state would load for ten seconds.
        vtkPVRepresentedArrayListSettings.GetInstance().RemoveAllObservers()
        self.since.start()
        self.running = monkey_acts.choose(self.hands)(self.hands, self.dialogs)

    def end(self):
        self.running = None
        self.hands.let_go()
        self.hands.heavy = self.since.elapsed() > HEAVY_MS
        say(f"DONE {self.number} in {self.since.elapsed()} ms")
        self.hands.attempts = 0
        self.number += 1
        self.settling = SETTLING_TICKS
        if self.number >= self.count:
            say("END")
            self.runs.RemoveObserver(self.ended)
            for timer in self.timers:
                timer.stop()
            QtCore.QTimer.singleShot(0, QtWidgets.QApplication.instance().quit)


def tell(kind, value, trace):
    """Of what fails in an answer to a signal, which would end ParaView."""
    say("RAISED " + "".join(traceback.format_exception(kind, value, trace)).strip().replace("\n", "\n  "))


sys.excepthook = tell
driver = Driver()
