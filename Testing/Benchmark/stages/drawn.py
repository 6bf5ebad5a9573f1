# The drag of the one filter as a person makes it: in ParaView's window on a screen without a GPU, the layout with the translucent
# thorax at 1 mm, each picture drawn. Counts what the flat view and the one with the body show while a hand moves at its own pace,
# then steps of the gain's slider in the scanner's panel until they are in the flat view. Mouse and keys are events of the X
# server: ParaView's player of recorded events, which this stage had before, looks through all widgets for 90 ms an event, and waits
# for each picture. Needs Xvfb and python3-xlib.
import math
import os
import pathlib
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "Plugin"))
from guicase import GuiCase
from person import Person

EVENTS_PER_S = 30
SWEEP_S, SWEEPS = 2.0, 6  # one way along the skin, and how many ways there and back
GAIN_STEPS, GAIN_EVERY_S = 20, 0.3
# Where things are on the screen.
FAN = (757, 122)
SCANNER = (974, 122)
GAIN = (994, 517)  # the slider's handle at 0 dB
FROM, TO = (538, 539), (499, 516)  # in the view with the body: where the probe lies at first, and up the chest

first_motion = []  # of the pointer in the drag; time.perf_counter is the machine's, the same in all processes

# Inside ParaView: the thorax, the time at which each view of the layout has been drawn, and when a hand moved what.
SCRIPT = """
from paraview import servermanager, simple
import os, time
thorax = simple.ThoraxPhantom(Spacingmm=1)
simple.SetActiveSource(thorax)
drawn = open(os.environ["SONOVDB_DRAWN"], "w", buffering=1)
watched = {}  # what is observed has to be kept: Python's collector would take the observers with it
turned = []
def noting(view):
    def note(*_):
        if view.SMProxy.GetClientSideObject().GetSuppressRendering():
            return  # brought up to date only
        for source in turned:
            print(time.perf_counter(), view.InteractionMode, source.Preview, file=drawn)
    return note
def watch(*_):
    for view in simple.GetRenderViews():
        if view.SMProxy.GetGlobalIDAsString() not in watched:
            watched[view.SMProxy.GetGlobalIDAsString()] = view
            view.SMProxy.AddObserver("EndEvent", noting(view))
    for source in simple.GetSources().values():
        if source.SMProxy.GetXMLName() == "SonoUltrasound" and source not in turned:
            turned.append(source)
            source.SMProxy.GetProperty("GainDb").AddObserver(
                "UncheckedPropertyModifiedEvent",
                lambda gain, _: print(time.perf_counter(), "gain", gain.GetUncheckedElement(0), file=drawn))
servermanager.ProxyManager().SMProxyManager.AddObserver("RegisterEvent", watch)
"""


def seconds_of(folder):
    """The processor's time that the ParaView of a folder has taken; 0: there is none."""
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if f"--script={folder}/watch.py".encode() in (process / "cmdline").read_bytes().split(b"\0"):
                times = (process / "stat").read_text().rpartition(")")[2].split()[11:13]
                return sum(map(int, times)) / os.sysconf("SC_CLK_TCK")
        except OSError:
            pass  # it has ended
    return 0.0


def await_rest(person):
    """Returns when ParaView has nothing more to do, in the background either."""
    idle = 0
    before = seconds_of(person.folder)
    while idle < 4 and not person.ended.wait(0.5):
        now = seconds_of(person.folder)
        idle = idle + 1 if now - before < 0.05 else 0
        before = now


def drag(person):
    """From the press of the button to its release, there and back, slower where it turns. Tells when the pointer first moved: a
    hand begins so slowly that it takes several steps to the next pixel."""
    person.hold()
    begin = time.perf_counter()
    for step in range(1, round(SWEEPS * SWEEP_S * EVENTS_PER_S) + 1):
        way = 0.5 - 0.5 * math.cos(math.pi * step / (SWEEP_S * EVENTS_PER_S))
        to = tuple(round(a + (b - a) * way) for a, b in zip(FROM, TO))
        if to != FROM and not first_motion:
            first_motion.append(time.perf_counter())
        person.move(*to)
        time.sleep(max(0.0, begin + step / EVENTS_PER_S - time.perf_counter()))
    person.release()


def act(person):
    try:
        person.await_colour(*FAN)
        time.sleep(2)
        person.click(*FAN)
        await_rest(person)
        person.move(*FROM)
        await_rest(person)
        drag(person)
        await_rest(person)
        person.click(*SCANNER)
        await_rest(person)
        person.click(*GAIN)
        await_rest(person)
        for _ in range(GAIN_STEPS):
            person.press("Right")
            time.sleep(GAIN_EVERY_S)
        await_rest(person)
    finally:
        person.press_quit()


GuiCase.setUpClass()
try:
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "watch.py").write_text(SCRIPT)
        drawn = pathlib.Path(folder, "drawn")
        drawn.touch()
        os.environ["SONOVDB_DRAWN"] = str(drawn)
        case = GuiCase()
        person = Person(case, folder)
        acting = threading.Thread(target=act, args=(person,))
        acting.start()
        done = case.paraview(folder, f"--script={folder}/watch.py")
        person.ended.set()
        acting.join()
        if done.returncode:
            raise SystemExit("drawn: ParaView failed:\n" + done.stdout)
        drawn = [line.replace("'", "").split() for line in drawn.read_text().splitlines()]
finally:
    GuiCase.tearDownClass()

moving = [float(time) for time, _, preview in drawn if preview == "1"]
flat = [float(time) for time, of, _ in drawn if of == "2D"]
for name, mode in (("flat", "2D"), ("body", "3D")):
    times = [float(time) for time, of, preview in drawn if (of, preview) == (mode, "1")]
    if len(times) < 5:
        raise SystemExit(f"drawn: only {len(times)} pictures on the way")
    between = sorted(b - a for a, b in zip(times, times[1:]))
    print(f"drawn_{name}_frames_per_s {(len(times) - 1) / (times[-1] - times[0]):.4g} 1/s")
    print(f"drawn_{name}_median_frame_s {between[len(between) // 2]:.4g} s")
    print(f"drawn_{name}_worst_frame_s {between[-1]:.4g} s")
print(f"drawn_first_frame_s {min(moving) - first_motion[0]:.4g} s")  # from the pointer's first motion
gains = {}  # when each was first asked for; at rest the last one is set again
for time, what, gain in drawn:
    if what == "gain" and float(gain) != 0.0:
        gains.setdefault(gain, float(time))
gains = sorted(gains.values())
rest = min(time for time in (float(t) for t, of, preview in drawn if (of, preview) == ("2D", "0")) if time > moving[-1])
print(f"drawn_rest_s {rest - moving[-1]:.4g} s")  # until the full picture of the last pose lies in the flat view
body = min(time for time in (float(t) for t, of, preview in drawn if (of, preview) == ("3D", "0")) if time > moving[-1])
print(f"drawn_body_rest_s {body - moving[-1]:.4g} s")  # the same in the one with the body
# Each step until the flat view has been drawn after it; a step that the next one overtook counts until then as well.
steps = sorted(1e3 * (min(at for at in flat if at > step) - step) for step in gains if any(at > step for at in flat))
print(f"drawn_gain_step_ms {steps[len(steps) // 2]:.4g} ms")
print(f"drawn_gain_worst_ms {steps[-1]:.4g} ms")
