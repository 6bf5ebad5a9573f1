"""What the monkey does to views: with the mouse and keys, and to their arrangement."""
import math

from monkey_hands import Skip, act
from paraview import simple
from PyQt5 import QtCore, QtWidgets

SCANNER_KEYS = (("F6",), ("F8",), ("F9",), ("Alt_L", "Prior"), ("Alt_L", "Next"), ("Alt_L", "Shift_L", "Prior"),
                ("Alt_L", "Shift_L", "Next"))
VIEW_KEYS = (("Left",), ("Right",), ("Up",), ("Down",), ("Shift_L", "Left"), ("Shift_L", "Up"), ("Control_L", "Right"),
             ("Control_L", "Down"), ("r",), ("w",), ("Escape",), ("Delete",))
VIEW_ACTS = ("actionResetCamera", "actionPositiveX", "actionNegativeY", "actionPositiveZ", "actionIsometricView",
             "actionRotate90degCW", "actionZoomToData", "actionShowOrientationAxes", "actionToggleInteractionMode",
             "actionScalarBarVisibility", "actionResetRange", "actionShow_All", "actionHide_All", "actionVCRNextFrame",
             "actionVCRFirstFrame", "actionEditCameraUndo", "actionAutoApply")
MOST_VIEWS, MOST_LAYOUTS = 6, 4


def probe_at(hands, view):
    """Where the probe of the selected source is on the screen, or nothing."""
    source, proxy = simple.GetActiveSource(), simple.GetActiveView()
    if not source or not proxy or "PositionMm" not in hands.properties(source) or not hasattr(proxy, "GetRenderer"):
        return None
    renderer = proxy.GetRenderer()
    renderer.SetWorldPoint(*source.GetProperty("PositionMm"), 1)
    renderer.WorldToDisplay()
    x, y, _ = renderer.GetDisplayPoint()
    if not (math.isfinite(x) and math.isfinite(y)):
        return None
    at = view.mapToGlobal(QtCore.QPoint(0, 0))
    x, y = at.x() + x, at.y() + view.height() - y
    inside = at.x() < x < at.x() + view.width() and at.y() < y < at.y() + view.height()
    return (x, y) if inside else None


@act(14)
def drag(hands, _):
    """In a view: the camera, the probe's widget, the flat image's pointer, whatever is there."""
    rng, view = hands.rng, hands.any_of(hands.views())
    at = hands.place(view)

    def anywhere():
        return at.x() + rng.uniform(5, view.width() - 5), at.y() + rng.uniform(5, view.height() - 5)

    x, y = anywhere()
    grip = probe_at(hands, view) if rng.random() < 0.6 else None
    if grip:
        x, y = grip[0] + rng.gauss(0, 15), grip[1] + rng.gauss(0, 15)
    button = rng.choice([1, 1, 1, 1, 2, 3])
    modifier = rng.choice(["", "", "", "Shift_L", "Control_L"])
    steps = rng.choice([0, 1, 4, 10])
    hands.note(f"drags with button {button} {modifier} from {x:.0f}, {y:.0f}{' (the probe)' if grip else ''} in {steps} steps")
    hands.move(x, y)
    yield
    if modifier:
        hands.press_key(modifier)
    hands.press(button)
    yield
    end = anywhere()
    for step in range(1, steps + 1):
        hands.move(x + (end[0] - x) * step / steps, y + (end[1] - y) * step / steps)
        if rng.random() < 0.8:
            yield
    hands.let_go()
    yield
    yield


@act(4)
def wheel(hands, _):
    view = hands.any_of(hands.views())
    at = hands.place(view)
    button, count = hands.rng.choice([4, 5]), hands.rng.randint(1, 4)
    hands.note(f"turns the wheel {count} times, button {button}")
    hands.move(at.x() + hands.rng.uniform(5, view.width() - 5), at.y() + hands.rng.uniform(5, view.height() - 5))
    yield
    for _ in range(count):
        hands.press(button)
        hands.let_go()
        yield


@act(5)
def keys(hands, _):
    """Over a view, where the probe's widget and ParaView take them."""
    view = hands.any_of(hands.views())
    grip = probe_at(hands, view)
    at = view.mapToGlobal(view.rect().center())
    names = hands.rng.choice(VIEW_KEYS + SCANNER_KEYS)
    count = hands.rng.choice([1, 1, 3])
    hands.note(f"presses {'+'.join(names)} {count} times over a view{' (the probe)' if grip else ''}")
    hands.main.activateWindow()
    view.setFocus()
    hands.move(*(grip or (at.x(), at.y())))
    yield
    for _ in range(count):
        for name in names:
            hands.press_key(name)
        hands.let_go()
        yield
    yield


@act(4)
def view_act(hands, _):
    hands.trigger(hands.rng.choice(VIEW_ACTS))
    yield


@act(6)
def arrange(hands, _):
    """Views and layouts: split, closed, filled, another tab, another size of the window."""
    rng = hands.rng
    what = rng.choice(["SplitVertical", "SplitHorizontal", "Maximize", "Minimize", "Close", "fill", "tab", "new tab", "close tab",
                       "resize", "activate"])
    frames = [w for w in hands.main.findChildren(QtWidgets.QWidget)
              if w.isVisible() and w.metaObject().className() == "pqViewFrame"]
    if what.startswith("Split") and len(frames) >= MOST_VIEWS:
        what = "Close"
    tabs = hands.main.findChild(QtWidgets.QWidget, "MultiViewWidget").findChild(QtWidgets.QTabWidget, "CoreWidget")
    if what == "tab":
        index = rng.randrange(tabs.count() - (tabs.count() > MOST_LAYOUTS))  # the last one makes another
        hands.note(f"layout tab {index} of {tabs.count()}")
        tabs.setCurrentIndex(index)
    elif what == "new tab":
        if tabs.count() > MOST_LAYOUTS:
            raise Skip
        hands.note("a new layout")
        simple.CreateLayout()
    elif what == "close tab":
        layouts = simple.GetLayouts()
        if len(layouts) < 2:
            raise Skip
        key = rng.choice(sorted(layouts))
        hands.note(f"removes layout {key[0]} and its views")
        for view in simple.GetViewsInLayout(layouts[key]):
            simple.Delete(view)  # ParaView's Apply (pqApplyBehavior) ends the process where one without a layout is left
        simple.RemoveLayout(layouts[key])
    elif what == "resize":
        width, height = rng.randint(700, 1390), rng.randint(500, 880)
        hands.note(f"the window has {width} x {height} pixels")
        hands.main.resize(width, height)
    elif what == "fill":
        buttons = [b for frame in frames for b in frame.findChildren(QtWidgets.QPushButton)
                   if b.isVisible() and b.text() in ("Render View", "Line Chart View", "SpreadSheet View", "Bar Chart View",
                                                     "Slice View", "Orthographic Slice View")]
        button = hands.any_of(buttons)
        hands.note(f"an empty frame becomes a {button.text()}")
        button.click()
    elif what == "activate":
        view = hands.any_of(simple.GetViews())
        hands.note(f"view {view.GetXMLName()} is the active one")
        simple.SetActiveView(view)
    else:
        usable = [found for frame in frames for found in frame.findChildren(QtWidgets.QAction, what)
                  if found.isEnabled() and found.isVisible()]
        hands.note(f"{what} of a view, {len(frames)} there")
        hands.any_of(usable).trigger()
    yield
    yield


@act(3)
def right_click(hands, _):
    """In a view, which may open a menu."""
    view = hands.any_of(hands.views())
    at = view.mapToGlobal(QtCore.QPoint(hands.rng.randint(5, view.width() - 5), hands.rng.randint(5, view.height() - 5)))
    hands.note(f"right click at {at.x()}, {at.y()}")
    yield from hands.click(at.x(), at.y(), 3)
