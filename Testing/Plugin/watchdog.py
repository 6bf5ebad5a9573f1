"""Watches whether a window of ParaView answers. Needs python3-xlib.

As a desktop does, it pings the window (_NET_WM_PING of the window managers' specification), and the monkey within notes when the
ping comes through, with all other events, and when its timers fire or a run or a picture has ended. A window hangs that has not
looked at its events for more than 5 s; what its threads waited for a processor that other processes had does not count. A
simulation that can be stopped looks at events as it goes, though no timer fires meanwhile: after 5 s of that Escape is pressed, as
a person would, and a run that is not over 5 s later cannot be stopped, which counts as a hang, too."""
import mmap
import os
import pathlib
import threading
import time

from Xlib import X, display
from Xlib.error import XError
from Xlib.protocol import event

from person import press_keys

LONGEST_S = 5.0  # unless somebody who knows better says more
PING_S = 0.25


class Clock:
    """Seconds in which a process slept or computed: what its threads waited for a processor is left out, as far as it was
    others that had it."""

    def __init__(self, pid):
        self.pid = pid
        self.seconds = 0.0
        self.at = time.monotonic()
        self.waited, self.own, self.all = self.waits_s(), self.own_s(), self.all_s()

    def waits_s(self):
        """Of each thread, how long it has been ready to run while others ran."""
        waits = {}
        for task in pathlib.Path(f"/proc/{self.pid}/task").iterdir():
            try:
                waits[task.name] = int((task / "schedstat").read_text().split()[1]) / 1e9
            except OSError:
                pass  # it has ended
        return waits

    def own_s(self):
        fields = pathlib.Path(f"/proc/{self.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    @staticmethod
    def all_s():
        """Of all processors and processes."""
        user, nice, system, _, _, *rest = pathlib.Path("/proc/stat").read_text().splitlines()[0].split()[1:9]
        return sum(map(int, (user, nice, system, *rest))) / os.sysconf("SC_CLK_TCK")

    def read(self):
        now, waited, own, all_s = time.monotonic(), self.waits_s(), self.own_s(), self.all_s()
        passed = now - self.at
        wait = max((waited[task] - before for task, before in self.waited.items() if task in waited), default=0.0)
        busy = all_s - self.all
        others = min(max(1.0 - (own - self.own) / busy, 0.0), 1.0) if busy > 0.0 else 0.0
        self.seconds += max(passed - wait * others, 0.0)
        self.at, self.waited, self.own, self.all = now, waited, own, all_s
        return self.seconds


class Watchdog:
    def __init__(self, display_name, pid, heart, hung, longest_s=lambda: LONGEST_S):
        """heart: a file whose first 8 bytes change while timers fire, and whose next 8 are the number of the last ping, both
        little-endian; hung: called with a sentence, once for each hang. longest_s: how long is no hang yet, now."""
        self.pid = pid
        with open(heart, "rb") as file:
            self.heart = mmap.mmap(file.fileno(), 16, prot=mmap.PROT_READ)
        self.hung = hung
        self.limit_s = longest_s
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

    def watch(self):
        number = seen = 0
        answered = beaten = None  # when, by the clock
        clock = Clock(self.pid)
        beat, told, escaped = bytes(8), False, None
        while not self.ended.wait(PING_S):
            try:
                now = clock.read()
            except OSError:
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
            if silent > self.limit_s():
                if not told:
                    told = True
                    self.hung(f"the window does not answer for {silent:.1f} s")
                    beaten = None  # whoever looks into it with a debugger stops it
            elif busy > self.limit_s() and escaped is None:
                escaped = now
                self.stops += 1
                press_keys(self.display, "Escape")
            elif escaped is not None and now - escaped > LONGEST_S:
                self.hung(f"a run of {busy:.1f} s does not stop {now - escaped:.1f} s after Escape")
                beaten = escaped = None
