"""Whether timers wait while Simulate Ultrasound runs and draws its views, as ParaView's --script: one of a script that fired then
might delete what is worked on. Writes how often one fired within and afterwards into fired.txt in the home folder, and ends
ParaView. Needs python3-pyqt5."""
import pathlib

from paraview import simple
from PyQt5 import QtCore, QtWidgets
from stepping import step_through, window

TICK_MS = 300


class Click(QtCore.QObject):
    """From within an event that was posted, as after Apply: Qt has nothing else to do in between then."""

    begun = ended = False

    def event(self, _):
        self.begun = True
        window().findChild(QtWidgets.QAction, "actionSonoSimulate").trigger()
        self.ended = True
        return True


def fire():
    fired["afterwards" if click.ended else "within" if click.begun else "before"] += 1


def steps():
    simple.SetActiveSource(simple.ThoraxPhantom(Spacingmm=3))
    yield
    window().findChild(QtWidgets.QPushButton, "Accept").click()
    yield
    often.start(0)
    QtWidgets.QApplication.postEvent(click, QtCore.QEvent(QtCore.QEvent.User))
    while not click.ended:
        yield
    yield
    text = f"{fired['within']} {fired['afterwards']} {len(simple.GetSources())}"
    pathlib.Path.home().joinpath("fired.txt").write_text(text, encoding="utf-8")
    QtWidgets.QApplication.instance().quit()


click = Click()
fired = dict.fromkeys(("before", "within", "afterwards"), 0)
often = QtCore.QTimer()
often.timeout.connect(fire)
clock = step_through(steps(), TICK_MS)
