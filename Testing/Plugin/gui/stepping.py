"""What ParaView's --scripts have in common that do one thing after the other within its event loop. Needs python3-pyqt5."""
from PyQt5 import QtCore, QtWidgets


def window():
    """ParaView's."""
    return next(w for w in QtWidgets.QApplication.topLevelWidgets() if isinstance(w, QtWidgets.QMainWindow))


def step_through(steps, tick_ms):
    """Goes on with the steps, a generator, at each tick. The clock, which goes as long as it is kept."""
    def step():
        try:
            next(steps)
        except StopIteration:
            clock.stop()

    clock = QtCore.QTimer()
    clock.timeout.connect(step)
    clock.start(tick_ms)
    return clock
