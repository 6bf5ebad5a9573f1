"""What Apply does where a view's layout is gone, and its widget with it, as ParaView's --script. Writes what another view has drawn
into drawn.txt in the home folder, and ends ParaView. Needs python3-pyqt5."""
import pathlib

from paraview import simple
from PyQt5 import QtWidgets
from stepping import step_through, window

TICK_MS = 500


def apply_spacing(text):
    """As if typed."""
    widget = window().findChild(QtWidgets.QWidget, "SpacingMm")
    edit = widget.findChild(QtWidgets.QLineEdit)
    edit.setFocus()
    edit.setText(text)
    edit.textEdited.emit(text)
    edit.editingFinished.emit()
    window().findChild(QtWidgets.QPushButton, "Accept").click()


def steps():
    thorax = simple.ThoraxPhantom(Spacingmm=5)
    simple.SetActiveSource(thorax)
    lost = simple.GetActiveView()
    simple.Show(thorax, lost)
    simple.CreateLayout()
    kept = simple.CreateView("RenderView")
    simple.AssignViewToLayout(kept)
    simple.Show(thorax, kept)
    simple.Render(kept)
    yield
    layout = simple.GetLayout(lost)
    simple.RemoveLayout(layout)
    del layout
    yield
    drawn = []
    kept.SMProxy.AddObserver("EndEvent", lambda *_: drawn.append(str(thorax.Spacingmm)))
    for text in ("4", "3"):
        apply_spacing(text)
        yield
        yield
    pathlib.Path.home().joinpath("drawn.txt").write_text("\n".join(sorted(set(drawn))), encoding="utf-8")
    QtWidgets.QApplication.instance().quit()


clock = step_through(steps(), TICK_MS)
