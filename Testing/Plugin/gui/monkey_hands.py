"""What the monkey's actions have in common: finding ParaView's widgets and proxies, a mouse and keys."""
import os

from paraview import simple
from PyQt5 import QtCore, QtTest, QtWidgets
from Xlib import X, XK, display
from Xlib.ext import xtest

# By property, within which numbers a small simulation takes a second or less; a chain of ten is still quick.
LIGHT = {"SpacingMm": (3, 5), "LineCount": (2, 32), "ElevationLineCount": (1, 6), "PathsPerLine": (1, 64),
         "PixelMm": (0.8, 5), "DepthMm": (20, 200), "SamplingMHz": (5, 60), "NumberOfShownPaths": (0, 64),
         "ElementCount": (1, 32), "TransmitCount": (1, 4), "Phases": (1, 3), "MaxCollisions": (0, 8),
         "CompoundFans": (1, 3), "ScattererCellMm": (0.3, 2), "ThicknessMm": (4, 40), "ElementWidthMm": (0.1, 1),
         "TimeBudgetS": (0, 1), "TransmitFocusMm": (20, 300), "ClosingMm": (0, 12), "Candidate": (0, 4), "SphereDiameterMm": (5, 30)}
# Of a pulse-echo field, whose cost grows with the depth.
LIGHT_FIELD = {"DepthMm": (20, 60)}


acts = []  # (weight, generator)


def act(weight):
    """Registers an action: a generator, given the hands and the dialogs, that gives the event loop back at each `yield`."""
    def register(function):
        acts.append((weight, function))
        return function
    return register


class Skip(Exception):
    """There is nothing on which to carry this action out."""


def say(text):
    """Not by Python's output, which ParaView takes for itself."""
    os.write(1, (text + "\n").encode())


class Hands:
    def __init__(self, folder):
        self.folder = folder
        self.app = QtWidgets.QApplication.instance()
        self.main = next(w for w in self.app.topLevelWidgets() if w.objectName() == "pqClientMainWindow")
        self.x = display.Display()
        self.held = []  # keys and buttons that are down
        self.rng = None
        self.number = 0
        self.attempts = 0
        self.heavy = False  # whether what was done last took long
        self.lightened = False  # and was to make it light

    def note(self, text):
        """What is about to be done."""
        say(f"ACT {self.number} {text}")

    # Proxies

    def sources(self):
        """In the order of their names, which does not depend on memory."""
        return [proxy for _, proxy in sorted(simple.GetSources().items())]

    def ours(self, *types):
        return [proxy for proxy in self.sources() if proxy.GetXMLName() in types] if types else \
            [proxy for proxy in self.sources() if proxy.GetXMLName().startswith("Sono")]

    def any_of(self, things):
        things = list(things)
        if not things:
            raise Skip
        return self.rng.choice(things)

    @staticmethod
    def name_of(proxy):
        return f"{proxy.SMProxy.GetLogName() or ''} ({proxy.GetXMLName()})" if proxy else "nothing"

    @staticmethod
    def properties(proxy):
        """Names as in XML; ListProperties makes them of labels, where there are any."""
        iterator = proxy.SMProxy.NewPropertyIterator()
        iterator.Begin()
        while not iterator.IsAtEnd():
            yield iterator.GetKey()
            iterator.Next()

    @staticmethod
    def lighten(proxy):
        """Puts settings that would take long to compute within what is light."""
        limits = dict(LIGHT, **(LIGHT_FIELD if proxy.GetXMLName() == "SonoPulseEchoField" else {}))
        names = set(Hands.properties(proxy))
        for name, (least, most) in limits.items():
            property = proxy.GetProperty(name) if name in names else None
            if property is None or len(property) != 1:
                continue
            value = property[0]
            if not least <= value <= most:
                property[0] = type(value)(min(max(least, value), most) if value == value else least)
        proxy.UpdateVTKObjects()

    # Widgets

    def act_named(self, name):
        """A menu's or a tool bar's; the enabled one where several have the name."""
        found = [act for act in self.main.findChildren(QtWidgets.QAction, name)]
        return next((act for act in found if act.isEnabled()), None)

    def filters(self):
        """By their names, those that ParaView offers for what is selected; it looks when their menu opens."""
        menu = self.main.findChild(QtWidgets.QMenu, "menuFilters")
        menu.aboutToShow.emit()
        return {each.objectName(): each for each in menu.findChild(QtWidgets.QMenu, "Alphabetical").actions()
                if each.isEnabled()}

    def enabled(self, name):
        """As act_named, where there is one: of a screenshot there is none while an empty frame is selected."""
        act = self.act_named(name)
        if act is None:
            raise Skip
        return act

    def trigger(self, name):
        act = self.enabled(name)
        self.note(f"{name}")
        act.trigger()

    def views(self):
        """Where views are drawn, in the order of their places on the screen."""
        found = [w for w in self.main.findChildren(QtWidgets.QWidget)
                 if w.isVisible() and w.metaObject().className() == "pqQVTKWidget" and w.width() > 40 < w.height()]
        return sorted(found, key=lambda w: (self.place(w).x(), self.place(w).y()))

    @staticmethod
    def place(widget):
        return widget.mapToGlobal(QtCore.QPoint(0, 0))

    def dock(self, name):
        return self.main.findChild(QtWidgets.QDockWidget, name)

    def button(self, name, inside=None):
        return next((b for b in (inside or self.main).findChildren(QtWidgets.QAbstractButton, name)
                     if b.isVisible() and b.isEnabled()), None)

    def apply(self):
        accept = self.main.findChild(QtWidgets.QWidget, "propertiesPanel").findChild(
            QtWidgets.QAbstractButton, "Accept")
        if accept.isEnabled():
            accept.click()
            return True
        return False

    def type_into(self, edit, text):
        edit.setFocus()
        edit.selectAll()
        if text.isascii():
            QtTest.QTest.keyClicks(edit, text)
        else:
            edit.insert(text)  # as pasted; there are no keys for it
        QtTest.QTest.keyClick(edit, self.rng.choice([QtCore.Qt.Key_Return, QtCore.Qt.Key_Tab]))

    @staticmethod
    def property_of(widget):
        """Of a widget in a panel of properties, the property's name."""
        while widget is not None and not widget.objectName().endswith("dock"):
            if widget.inherits("pqPropertyWidget") and widget.objectName():
                return widget.objectName()
            widget = widget.parentWidget()
        return ""

    # A mouse and keys, through the X server

    def move(self, x, y):
        xtest.fake_input(self.x, X.MotionNotify, x=int(x), y=int(y))
        self.x.sync()

    def press(self, button):
        xtest.fake_input(self.x, X.ButtonPress, button)
        self.x.sync()
        self.held.append((X.ButtonRelease, button))

    def click(self, x, y, button=1):
        """In steps of an action."""
        self.move(x, y)
        yield
        self.press(button)
        yield
        self.let_go()
        yield

    def press_key(self, name):
        key = self.x.keysym_to_keycode(XK.string_to_keysym(name))
        xtest.fake_input(self.x, X.KeyPress, key)
        self.x.sync()
        self.held.append((X.KeyRelease, key))

    def let_go(self):
        """Of all keys and buttons."""
        while self.held:
            xtest.fake_input(self.x, *self.held.pop())
        self.x.sync()
