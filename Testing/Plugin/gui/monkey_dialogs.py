"""Answers the dialogs and menus that the monkey's actions open, so that none stays."""
import random

from monkey_hands import say
from PyQt5 import QtCore, QtWidgets

PATIENCE = 3  # ticks that a dialog is there before it is answered
STUBBORN = 60  # after so many ticks it counts as one that cannot be closed
# Of menus: what leaves ParaView, or leads to the outside.
NEVER = ("exit", "quit", "help", "web", "guide", "tutorial", "connect", "record", "play test", "full screen", "customi",
         "plugin", "favorites", "rename", "copy", "paste", "clipboard", "python", "script", "catalyst", "title")


def is_harmless(act):
    words = (act.objectName() + " " + act.text()).replace("&", "").lower()
    return act.isEnabled() and not act.isSeparator() and act.menu() is None and not any(w in words for w in NEVER)


class Dialogs:
    def __init__(self, hands):
        self.hands = hands
        self.plan = None  # what the action does with its dialog: f(dialog) -> whether it was the one
        self.open = None
        self.ticks = 0
        self.seen = 0
        self.rng = None

    def serve(self):
        """At each tick: looks what is open, and answers it from the event loop."""
        current = self.hands.app.activePopupWidget() or self.hands.app.activeModalWidget()
        if current is not self.open:
            self.open, self.ticks = current, 0
            self.seen += 1
            self.rng = random.Random(f"{self.hands.number}/{self.seen}")
            return
        if current is None:
            return
        self.ticks += 1
        if self.ticks == STUBBORN:
            say(f"STUBBORN {self.describe(current)}")
        if self.ticks % PATIENCE == 0:
            # As an event of its own: the answer may open another dialog.
            QtCore.QTimer.singleShot(0, lambda: self.answer(current))

    @staticmethod
    def describe(dialog):
        text = dialog.text() if isinstance(dialog, QtWidgets.QMessageBox) else ""
        return f"{dialog.metaObject().className()} {dialog.objectName()} '{dialog.windowTitle()}' {text}"

    def answer(self, dialog):
        if dialog is not (self.hands.app.activePopupWidget() or self.hands.app.activeModalWidget()):
            return
        if self.ticks <= PATIENCE:
            say(f"DIALOG {self.describe(dialog)}")
        elif self.ticks > STUBBORN // 2:
            dialog.close()
            return
        if self.plan and self.plan(dialog):
            return
        if isinstance(dialog, QtWidgets.QMenu):
            self.answer_menu(dialog)
        elif isinstance(dialog, QtWidgets.QMessageBox):
            self.answer_message(dialog)
        elif isinstance(dialog, QtWidgets.QDialog):
            sure = dialog.metaObject().className() != "pqFileDialog" and self.rng.random() < 0.5
            dialog.accept() if sure else dialog.reject()
        else:
            dialog.close()

    def answer_menu(self, menu):
        acts = [act for act in menu.actions() if is_harmless(act)]
        act = self.rng.choice(acts) if acts and self.rng.random() < 0.6 else None
        menu.close()
        if act:
            say(f"DIALOG chooses {act.objectName()} '{act.text()}'")
            act.trigger()

    def answer_message(self, box):
        if box.icon() in (QtWidgets.QMessageBox.Warning, QtWidgets.QMessageBox.Critical):
            say(f"MESSAGE {box.text()} {box.informativeText()}".replace("\n", " "))
        self.rng.choice(box.buttons()).click()

    def choose_file(self, path):
        """A plan: names a file in ParaView's dialog, and says yes to what comes after it."""
        def plan(dialog):
            if dialog.metaObject().className() == "pqFileDialog":
                line = dialog.findChild(QtWidgets.QLineEdit, "EntityName")
                line.setText(str(path))
                dialog.findChild(QtWidgets.QAbstractButton, "OK").click()
                return True
            if dialog.metaObject().className() == "pqSelectReaderDialog":
                self.choose_reader(dialog)
                return True
            if isinstance(dialog, QtWidgets.QDialog) and not isinstance(dialog, QtWidgets.QMessageBox):
                dialog.accept()
                return True
            return False
        return plan

    @staticmethod
    def choose_reader(dialog):
        """Ours: ParaView's own of NRRD ends the process when a header promises more than there is memory."""
        names = dialog.findChild(QtWidgets.QListWidget)
        ours = [names.item(row) for row in range(names.count()) if "Label Map Reader" in names.item(row).text()]
        if ours:
            names.setCurrentItem(ours[0])
            dialog.accept()
        else:
            dialog.reject()

    @staticmethod
    def accept(dialog):
        """A plan."""
        if isinstance(dialog, QtWidgets.QDialog) and not isinstance(dialog, QtWidgets.QMessageBox):
            dialog.accept()
            return True
        return False
