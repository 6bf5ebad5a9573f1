"""Watches whether a window of ParaView answers. Needs python3-xlib.

As a desktop does, it pings the window (_NET_WM_PING of the window managers' specification), and the monkey within notes when the
ping comes through, with all other events, and when its timers fire. A window hangs that has not looked at its events for more
than 5 s, of which the part that the machine spent on other processes (/proc/stat) does not count. A simulation that can be
stopped looks at events as it goes, though no timer fires meanwhile: after 5 s of that Escape is pressed, as a person would,
and a run that is not over 5 s later cannot be stopped, which counts as a hang, too."""
import mmap
import os
import pathlib
import threading
import time

from Xlib import X, XK, display
from Xlib.error import XError
from Xlib.ext import xtest
from Xlib.protocol import event

LONGEST_S = 5.0
PING_S = 0.25


class Clock:
    """Seconds in which the machine could have worked for a process: of each second the part that others had is left out."""

    def __init__(self, pid):
        self.own = pathlib.Path(f"/proc/{pid}/stat")
        self.at = self.seconds = 0.0
        self.others = 0.0
        self.read()

    def others_s(self):
        """Of all processors together, what others and the system had so far."""
        tick = os.sysconf("SC_CLK_TCK")
        user, nice, system, _, _, *rest = map(int, pathlib.Path("/proc/stat").read_text().splitlines()[0].split()[1:9])
        own = self.own.read_text().rsplit(")", 1)[1].split()
        return (user + nice + system + sum(rest) - int(own[11]) - int(own[12])) / tick

    def read(self):
        now, others = time.monotonic(), self.others_s()
        passed = now - self.at
        taken = (others - self.others) / os.cpu_count()
        self.seconds += min(max(passed - taken, 0.0), passed)
        self.at, self.others = now, others
        return self.seconds


class Watchdog:
    def __init__(self, display_name, pid, heart, hung):
        """heart: a file whose first 8 bytes change while timers fire, and whose next 8 are the number of the last ping, both
        little-endian; hung: called with a sentence, once for each hang."""
        self.pid = pid
        with open(heart, "rb") as file:
            self.heart = mmap.mmap(file.fileno(), 16, prot=mmap.PROT_READ)
        self.hung = hung
        self.longest_s = 0.0
        self.stops = 0
        self.ended = threading.Event()
        self.display = display.Display(display_name)
        self.root = self.display.screen().root
        self.thread = threading.Thread(target=self.watch)
        self.thread.start()

    def stop(self):
        self.ended.set()
        self.thread.join()

    def window(self):
        """The largest that says it answers; None while there is none, or only the one that ParaView begins with."""
        best, area = None, 0
        for window in self.root.query_tree().children:
            try:
                size, title = window.get_geometry(), window.get_wm_name() or ""
                shown = window.get_attributes().map_state == X.IsViewable
                answers = self.display.intern_atom("_NET_WM_PING") in window.get_wm_protocols()
            except XError:
                continue  # gone meanwhile
            if shown and answers and title.startswith("ParaView") and size.width * size.height > area:
                best, area = window, size.width * size.height
        return best

    def ping(self, window, number):
        atom = self.display.intern_atom
        window.send_event(event.ClientMessage(window=window, client_type=atom("WM_PROTOCOLS"),
                                              data=(32, [atom("_NET_WM_PING"), number, window.id, 0, 0])))
        self.display.flush()

    def press_escape(self):
        key = self.display.keysym_to_keycode(XK.string_to_keysym("Escape"))
        for kind in (X.KeyPress, X.KeyRelease):
            xtest.fake_input(self.display, kind, key)
        self.display.sync()

    def watch(self):
        number = seen = 0
        answered = beaten = None  # when, by the clock
        clock = Clock(self.pid)
        beat, told, escaped = bytes(8), False, None
        while not self.ended.wait(PING_S):
            try:
                now = clock.read()
            except (FileNotFoundError, ProcessLookupError):
                return
            last, was, beat = seen, beat, self.heart[:8]
            seen = int.from_bytes(self.heart[8:], "little")
            if seen != last or seen == number:
                answered, told = now, False
            if beat != was:
                beaten, escaped = now, None
            window = self.window()
            if window is not None:
                number += 1
                self.ping(window, number)
            if answered is None or beaten is None or not any(beat):
                continue  # the monkey has not begun

            silent, busy = now - answered, now - beaten
            self.longest_s = max(self.longest_s, silent)
            if silent > LONGEST_S:
                if not told:
                    told = True
                    self.hung(f"the window does not answer for {silent:.1f} s")
                    beaten = None  # whoever looks into it with a debugger stops it
            elif busy > LONGEST_S and escaped is None:
                escaped = now
                self.stops += 1
                self.press_escape()
            elif escaped is not None and now - escaped > LONGEST_S:
                self.hung(f"a run of {busy:.1f} s does not stop {now - escaped:.1f} s after Escape")
                beaten = escaped = None
