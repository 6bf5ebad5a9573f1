"""The scene of drag_ultrasound.py, as ParaView's --script. Writes down with each drawn picture how often the anatomy's
representation ran and when its data were made, how often that of the image ran, and how often their proxies learnt of it, into
drawn.jsonl in the home folder. Three seconds after the drag the label map becomes another one."""
import json
import pathlib
import time

from paraview.simple import *

FIRST = 1e6  # before anybody who might keep an event from the others

view = GetActiveViewOrCreate("RenderView")
thorax = ThoraxPhantom(registrationName="thorax", Spacingmm=4)
ultrasound = SimulateUltrasound(registrationName="ultrasound", Input=thorax, LineCount=48, PathsPerLine=300)
counts = {}


def count(thing, name):
    counts[name] = 0

    def add(*_):
        counts[name] += 1

    thing.AddObserver("UpdateDataEvent", add, FIRST)


shown = {"image": Show(OutputPort(ultrasound, 0), view).SMProxy, "anatomy": Show(OutputPort(ultrasound, 4), view).SMProxy}
for name, proxy in shown.items():
    count(proxy.GetClientSideObject().GetActiveRepresentation(), name + " ran")
    count(proxy, name + " was told")
anatomy = shown["anatomy"].GetClientSideObject().GetActiveRepresentation()
drawn = open(pathlib.Path.home() / "drawn.jsonl", "w", encoding="utf-8", buffering=1)
phase = "before"
rested = None


def write(*_):
    global phase
    moving = ultrasound.Preview == 1
    phase = "moving" if moving else "rested" if phase == "moving" else phase
    actor = anatomy.GetActor()
    of = {"made": actor.GetMapper(), "light made": actor.GetLODMapper()}
    made = {name: mapper.GetInputDataObject(0, 0).GetMTime() if mapper.GetInputDataObject(0, 0) else 0
            for name, mapper in of.items()}
    print(json.dumps({"phase": phase, "place": list(ultrasound.PositionMm), **made, **counts}), file=drawn)


def change(*_):
    global phase, rested
    if phase == "rested":
        rested = rested or time.monotonic()
        if time.monotonic() - rested > 3:
            phase = "changed"
            thorax.Spacingmm = 5
            Render(view)


view.SMProxy.AddObserver("EndEvent", write)
view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = (250, -650, 330), (20, 0, 0), (0, 0, 1)
view.OrientationAxesVisibility = 0
SetActiveSource(thorax)
Render()
interactor = view.SMProxy.GetInteractor()
interactor.AddObserver("TimerEvent", change)
interactor.CreateRepeatingTimer(200)
