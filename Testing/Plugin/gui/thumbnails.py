"""The standard views of a small thorax and their pictures, as ParaView's --script: Standard Views is clicked, and when each place
of the list has its picture, these are saved beside thumbnails.json, which has their sentences."""
import json
import pathlib

from paraview.simple import *
from PyQt5 import QtCore, QtWidgets

LONGEST_S = 120
thorax = ThoraxPhantom(registrationName="thorax", Spacingmm=2)
ultrasound = SimulateUltrasound(registrationName="ultrasound", Input=thorax, LineCount=32, PathsPerLine=8)
Show(OutputPort(ultrasound, 7), GetActiveViewOrCreate("RenderView"))
Render()
SetActiveSource(ultrasound)


class Look:
    def __init__(self):
        self.ticks = 0
        self.timer = QtCore.QTimer()
        self.timer.timeout.connect(self.tick)
        self.timer.start(100)

    def tick(self):
        self.ticks += 1
        panel = next(each for each in QtWidgets.QApplication.allWidgets() if each.objectName() == "propertiesPanel")
        places = panel.findChild(QtWidgets.QComboBox, "WindowCandidate")
        if self.ticks == 20:
            panel.findChild(QtWidgets.QPushButton, "StandardViews").click()
        if self.ticks <= 20:
            return
        rows = [row for row in range(places.count()) if places.model().item(row).isEnabled()]
        icons = [places.itemIcon(row) for row in rows]
        if (rows and not any(icon.isNull() for icon in icons)) or self.ticks > 10 * LONGEST_S:
            self.timer.stop()
            for row, icon in zip(rows, icons):
                icon.pixmap(places.iconSize()).save(f"view{row}.png")
            pathlib.Path("thumbnails.json").write_text(json.dumps([places.itemText(row) for row in rows]))
            QtCore.QTimer.singleShot(500, QtWidgets.QApplication.quit)


look = Look()
