"""Whether ParaView's own timers wait while something is undone, as ParaView's --script: events are let through in the middle
of it, as they are where a layout is put back. Writes what rang, and when, into rang.txt in the home folder, and ends
ParaView. Needs python3-pyqt5."""
import pathlib
import time

from paraview import servermanager, simple
from PyQt5 import QtCore, QtWidgets
from stepping import step_through, window

TICK_MS = 300


class pqTimer(QtCore.QTimer):  # Qt knows it by its name, as ParaView's
    pass


def undo():
    return next((a for a in window().findChildren(QtWidgets.QAction, "actionEditUndo") if a.isEnabled()), None)


rang = []
inside = []


def let_events_through(*_):
    if inside and "let through" not in rang:
        rang.append("let through")
        time.sleep(0.1)
        QtWidgets.QApplication.processEvents()
        rang.append("end")


def steps():
    simple.SetActiveSource(simple.ThoraxPhantom(Spacingmm=5))
    manager = servermanager.ProxyManager().SMProxyManager
    manager.AddObserver("UnRegisterEvent", let_events_through)
    yield
    yield
    timers = []  # due by the time that events are let through
    for kind, name in ((pqTimer, "ParaView's"), (QtCore.QTimer, "another")):
        timer = kind()
        timer.setSingleShot(True)
        timer.timeout.connect(lambda name=name: rang.append(name))
        timer.start(0)
        timers.append(timer)
    inside.append(True)
    while undo() and not rang:  # to where the source was made
        undo().trigger()
    inside.clear()
    yield
    yield
    pathlib.Path.home().joinpath("rang.txt").write_text("\n".join(rang), encoding="utf-8")
    QtWidgets.QApplication.instance().quit()


clock = step_through(steps(), TICK_MS)
