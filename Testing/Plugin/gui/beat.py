"""A heart that beats for the first time, as ParaView's --script: clicks Beat, sets another rate once all phases were ready and had
been shown, clicks Beat again, and undoes. beat.json says how long the event loop was silent meanwhile, what the panel said when, and each picture."""
import hashlib
import json
import os
import pathlib
import sys

from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy
from PyQt5 import QtCore, QtWidgets

sys.path.insert(0, os.environ["BEAT_SCRIPTS"])
from watchdog import Clock  # noqa: E402

FLAT_IMAGE = 7
PHASES = 6
TICK_MS = 20
RATE_PER_MIN = 20
SLOW_MS = 7000  # two beats and more
view = GetActiveViewOrCreate("RenderView")
thorax = ThoraxPhantom(registrationName="thorax", Spacingmm=2, Phases=PHASES)
ultrasound = SimulateUltrasound(registrationName="ultrasound", Input=thorax)
Show(OutputPort(ultrasound, FLAT_IMAGE), view)
view.InteractionMode = "2D"
view.CameraPosition, view.CameraViewUp, view.CameraFocalPoint = (0, 0, -1), (0, -1, 0), (0, 0, 0)
ResetCamera(view)
Render()
SetActiveSource(ultrasound)
main = next(widget for widget in QtWidgets.QApplication.topLevelWidgets() if isinstance(widget, QtWidgets.QMainWindow))
main.findChild(QtWidgets.QDockWidget, "pqSonoScannerDock").show()
button = main.findChild(QtWidgets.QPushButton, "Beat")
rate = main.findChild(QtWidgets.QDoubleSpinBox, "HeartRate")
message = main.findChild(QtWidgets.QLabel, "SonoScannerMessage")
clock = Clock(os.getpid())
said = {"silences": [], "sentences": [], "pictures": []}


def note(*_):
    image = ultrasound.SMProxy.GetClientSideObject().GetOutputDataObject(FLAT_IMAGE)
    if button.isChecked() and ultrasound.Preview:
        picture = vtk_to_numpy(image.GetPointData().GetArray("BMode"))
        said["pictures"].append({"time": view.ViewTime, "picture": hashlib.md5(picture.tobytes()).hexdigest(),
                                 "said": message.text(), "clock": clock.read()})


class Play:
    def __init__(self):
        self.last = clock.read()
        self.ticks = 0
        self.slow = 0  # the tick from which on it beats slowly
        self.timer = QtCore.QTimer()
        self.timer.timeout.connect(self.tick)
        self.timer.start(TICK_MS)

    def tick(self):
        now = clock.read()
        self.ticks += 1
        if button.isChecked():
            said["silences"].append(now - self.last)
            if not said["sentences"] or said["sentences"][-1] != message.text():
                said["sentences"].append(message.text())
        self.last = now
        if self.ticks == 50:  # all is drawn by then
            said["began"] = now
            button.click()
        shown_since = {picture["time"] for picture in said["pictures"] if not picture["said"]}
        if button.isChecked() and len(shown_since) == PHASES and not self.slow:
            said["readyAt"] = now
            rate.setValue(RATE_PER_MIN)
            said["property"] = ultrasound.HeartRate
            self.slow = self.ticks
        if self.slow and self.ticks == self.slow + SLOW_MS // TICK_MS:
            button.click()
            said["slow"] = [[picture["clock"], picture["time"]] for picture in said["pictures"] if picture["clock"] > said["readyAt"]]
            next(act for act in main.findChildren(QtWidgets.QAction, "actionEditUndo")).trigger()
        if self.slow and self.ticks == self.slow + 2 * SLOW_MS // TICK_MS:
            said["undone"] = [ultrasound.HeartRate, rate.value()]
            pathlib.Path("beat.json").write_text(json.dumps(said), encoding="utf-8")
            QtCore.QTimer.singleShot(1000, QtWidgets.QApplication.quit)


view.SMProxy.AddObserver("EndEvent", note)
play = Play()
