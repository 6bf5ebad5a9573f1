# The drag of the one filter as a person makes it: in ParaView's window on a screen without a GPU, the layout with the translucent
# thorax at 1 mm, each picture drawn. Counts what the flat view and the one with the body show; then steps of the gain's slider in the
# scanner's panel until they are in the flat view. Needs Xvfb.
import os
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "Plugin"))
from guicase import GuiCase

MOVES = 40
GAINS = range(52, 72)  # places of the slider, in hundredths of its length
FROM, TO = (0.5625, 0.6426), (0.47, 0.60)  # in the view with the body: where the probe lies at first, and up the chest
BODY = ("pqClientMainWindow/centralwidget/MultiViewWidget/CoreWidget/qt_tabwidget_stackedwidget/MultiViewWidget2/"
        "Container/Frame.1/CentralWidgetFrame/Viewport")
PANEL = "pqClientMainWindow/pqSonoScannerDock/SonoScannerContents/SonoScannerScroll/qt_scrollarea_viewport/SonoScannerControls/"

# Inside ParaView: the thorax, the time at which each view of the layout has been drawn, and when a hand moved what.
SCRIPT = """
from paraview import servermanager, simple
import os, time
thorax = simple.ThoraxPhantom(Spacingmm=1)
simple.SetActiveSource(thorax)
drawn = open(os.environ["SONOVDB_DRAWN"], "w", buffering=1)
watched = set()
turned = []
def watch(*_):
    for view in simple.GetRenderViews():
        if view.SMProxy.GetGlobalIDAsString() not in watched:
            watched.add(view.SMProxy.GetGlobalIDAsString())
            def note(*_, view=view):
                if view.SMProxy.GetClientSideObject().GetSuppressRendering():
                    return  # brought up to date only
                for source in simple.GetSources().values():
                    if source.SMProxy.GetXMLName() == "SonoUltrasound":
                        print(time.perf_counter(), view.InteractionMode, source.Preview, file=drawn)
            view.SMProxy.AddObserver("EndEvent", note)
            view.SMProxy.GetInteractor().AddObserver(
                "LeftButtonPressEvent", lambda *_: print(time.perf_counter(), "press", -1, file=drawn), 1000.0)
    for source in simple.GetSources().values():
        if source.SMProxy.GetXMLName() == "SonoUltrasound" and source not in turned:
            turned.append(source)
            source.SMProxy.GetProperty("GainDb").AddObserver(
                "UncheckedPropertyModifiedEvent",
                lambda gain, _: print(time.perf_counter(), "gain", gain.GetUncheckedElement(0), file=drawn))
servermanager.ProxyManager().SMProxyManager.AddObserver("RegisterEvent", watch)
"""


def event(thing, command, arguments=""):
    return f'  <pqevent object="{thing}" command="{command}" arguments="{arguments}"/>\n'


def playback():
    places = [tuple(a + (b - a) * step / MOVES for a, b in zip(FROM, TO)) for step in range(MOVES + 1)]
    move, press, release = (
        [event(BODY, command, f"({x:.4f},{y:.4f},{button},0)") for x, y in places]
        for command, button in (("mouseMove", "0,1"), ("mousePress", "1,1"), ("mouseRelease", "1,0")))
    pause = 80 * event("pqClientMainWindow", "pause", "100")  # a pause sleeps; in between ParaView goes on
    simulate = event("pqClientMainWindow/SonoToolBar/actionSonoSimulate", "activate")
    hover = move[0].replace(",0,1,0)", ",0,0,0)")
    panel = event("pqClientMainWindow/SonoToolBar/SonoScannerButton", "activate")
    gains = [event(PANEL + "SonoScannerSettings/GainDb/DoubleRangeWidget/Slider", "set_int", place) for place in GAINS]
    return "<pqevents>\n" + "".join([simulate, pause, pause, hover, press[0], *move[1:], release[-1], pause, panel, pause,
                                    *gains, pause]) + "</pqevents>\n"


GuiCase.setUpClass()
try:
    with tempfile.TemporaryDirectory() as folder:
        files = {name: pathlib.Path(folder, name) for name in ("watch.py", "drag.xml", "drawn")}
        files["watch.py"].write_text(SCRIPT)
        files["drag.xml"].write_text(playback())
        os.environ["SONOVDB_DRAWN"] = str(files["drawn"])
        done = GuiCase().paraview(folder, f"--script={files['watch.py']}", f"--test-script={files['drag.xml']}", "--exit")
        if done.returncode:
            raise SystemExit("drawn: ParaView failed:\n" + done.stdout)
        drawn = [line.replace("'", "").split() for line in files["drawn"].read_text().splitlines()]
finally:
    GuiCase.tearDownClass()

moving = [float(time) for time, _, preview in drawn if preview == "1"]
press = [float(time) for time, what, _ in drawn if what == "press"]
flat = [float(time) for time, of, _ in drawn if of == "2D"]
for name, mode in (("flat", "2D"), ("body", "3D")):
    times = [float(time) for time, of, preview in drawn if (of, preview) == (mode, "1")]
    if len(times) < MOVES / 4:
        raise SystemExit(f"drawn: only {len(times)} pictures on the way")
    between = sorted(b - a for a, b in zip(times, times[1:]))
    print(f"drawn_{name}_frames_per_s {(len(times) - 1) / (times[-1] - times[0]):.4g} 1/s")
    print(f"drawn_{name}_median_frame_s {between[len(between) // 2]:.4g} s")
    print(f"drawn_{name}_worst_frame_s {between[-1]:.4g} s")
print(f"drawn_first_frame_s {min(moving) - press[0]:.4g} s")  # from the button's press on
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
