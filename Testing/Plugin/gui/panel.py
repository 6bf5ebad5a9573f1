"""Controls of the panels and of the views, one after the other, as ParaView's --script: a person's clicks and keys, in its process.
PANEL_SCENE names which; what was found after each is in panel.json."""
import json
import os
import pathlib
import sys
import time
import traceback

import numpy as np
from paraview.simple import *
from PyQt5 import QtCore, QtWidgets

sys.path.insert(0, os.environ["PANEL_SCRIPTS"])
from panel_hands import (FLAT_IMAGE, begin, child, found, hands, hands_at, knob, looks, main, note, picture_with,  # noqa: E402
                         press, settle, trigger, ultrasounds, watch)


def pose():
    """The buttons below the pose, the two boxes, and what waits for Apply without Live."""
    ultrasound = yield from begin()
    note("first", ultrasound)
    child(QtWidgets.QDoubleSpinBox, "Step").setValue(10)
    for name in ("RotatePlus", "RotateMinus", "TiltPlus", "TiltMinus", "RockPlus", "RockMinus", "SnapToSkin"):
        press(name)
        yield from settle()
        note(name, ultrasound)
    trigger("actionEditUndo")
    yield from settle()
    note("undone", ultrasound)
    body = max(hands.views(), key=lambda each: each.height())
    seen = [looks(body)]
    for _ in range(2):
        press("ShowProbe")
        yield 700
        seen.append(looks(body))
    found["shown"] = [seen[0] != seen[1], seen[0] == seen[2]]
    press("Live")
    press("RotatePlus")
    yield 2500
    note("not live", ultrasound)
    press("Accept")
    yield from settle()
    note("applied", ultrasound)
    press("Live")
    press("RotatePlus")
    yield from settle()
    note("live again", ultrasound)


def scanner():
    """What else the scanner's panel has: the sliders of each depth, the width, the rate, freeze, store."""
    ultrasound = yield from begin()
    dock = hands.dock("pqSonoScannerDock")
    dock.show()
    yield 500
    for i in range(2, 8):
        slider = child(QtWidgets.QSlider, "Slider", knob(f"Tgc{i}Db"))
        note(f"before {i}", ultrasound)
        slider.setValue(90)
        yield from settle()
        note(f"set {i}", ultrasound, value=ultrasound.GetProperty(f"Tgc{i}Db")[0])
        trigger("actionEditUndo")
        yield from settle()
        note(f"undone {i}", ultrasound, value=ultrasound.GetProperty(f"Tgc{i}Db")[0])
    yield from picture_with(ultrasound, ScanKind=0)
    widths = []
    for place in (None, 80):
        if place is not None:
            child(QtWidgets.QSlider, "Slider", knob("WidthMm")).setValue(place)
            yield from settle()
        bounds = ultrasound.SMProxy.GetClientSideObject().GetOutputDataObject(FLAT_IMAGE).GetBounds()
        widths.append([ultrasound.GetProperty("WidthMm")[0], bounds[1] - bounds[0]])
    found["widths"] = widths
    times = []
    view = next(each for each in GetViews() if each.GetXMLName() == "RenderView" and each.InteractionMode == "2D")
    drawn = view.SMProxy.AddObserver("EndEvent", lambda *_: times.append((time.monotonic(), ultrasound.Preview)))
    for _ in range(12):
        press("RotatePlus")
        yield 120
    found["rate"] = [child(QtWidgets.QLabel, "Rate").text(), [at for at, moving in times if moving]]
    view.SMProxy.RemoveObserver(drawn)
    yield from settle()
    freeze = child(QtWidgets.QAbstractButton, "Freeze")
    frozen = [[ultrasound.Freeze, freeze.isChecked()]]
    for act in (freeze.click, lambda: trigger("actionEditUndo"), lambda: trigger("actionEditRedo")):
        act()
        yield 700
        frozen.append([ultrasound.Freeze, freeze.isChecked()])
    found["frozen"] = frozen
    note("before frozen", ultrasound)
    press("RotatePlus")
    yield 2500
    note("frozen picture", ultrasound)
    SaveState("frozen.pvsm")
    freeze.click()
    yield from settle()
    note("unfrozen", ultrasound)
    ultrasound.StoreFolder = os.getcwd()
    ultrasound.SMProxy.UpdateVTKObjects()
    yield 300
    place = hands.place(child(QtWidgets.QLabel, "Rate"))
    yield from hands_at(hands.click(place.x() + 2, place.y() + 2))  # the window has the keys then
    hands.press_key("F7")
    yield 50
    hands.let_go()
    yield 1500
    found["stored"] = child(QtWidgets.QLabel, "SonoScannerMessage").text()
    planes = [main.findChild(QtWidgets.QAction, f"actionSono{name}") for name in ("Plane", "Biplane")]
    found["planes"] = [[act.shortcut().toString(), act.isEnabled()] for act in planes]


def fits(view, ultrasound):
    """The flat view: mm from top to bottom, its size in pixels, and the image's in mm."""
    bounds = ultrasound.SMProxy.GetClientSideObject().GetOutputDataObject(FLAT_IMAGE).GetBounds()
    return [2 * view.CameraParallelScale, list(view.ViewSize), [bounds[1] - bounds[0], bounds[3] - bounds[2]]]


def split(ultrasound):
    """Into two screens: it and the other one."""
    trigger("actionSonoSplit")
    yield from settle()
    return sorted(ultrasounds(), key=lambda each: each.SMProxy is not ultrasound.SMProxy)


def bodies():
    """The views with a body."""
    return [each for each in GetViews() if each.GetXMLName() == "RenderView" and each.InteractionMode == "3D"
            and len(each.Representations) > 1]


def views():
    """The flat view in a window of other sizes, and a split screen of two probes."""
    ultrasound = yield from begin()
    view = next(each for each in GetViews() if each.GetXMLName() == "RenderView" and each.InteractionMode == "2D")
    sizes = [fits(view, ultrasound)]
    whole = main.size()
    for width, height in ((900, 850), (1250, 560), (whole.width(), whole.height())):
        main.resize(width, height)
        yield 1500
        sizes.append(fits(view, ultrasound))
    found["sizes"] = sizes
    first, second = yield from split(ultrasound)
    for name, number in (("shared", None), ("apart", 0)):
        if number is not None:
            second.SharedProbe = number
            second.SMProxy.UpdateVTKObjects()
            yield 500
        before = [list(each.Lateral) for each in (first, second)]
        press("RotatePlus")
        yield from settle()
        found[name] = [list(each.Lateral) != was for each, was in zip((first, second), before)]
    trigger("actionSonoVentricle")
    yield 1500
    (volume,) = [source for _, source in GetSources().items() if source.GetXMLName() == "SonoVentricleVolume"]
    chambers = [volume.Input, volume.TwoChamber]
    found["chambers"] = [next(i for i, each in enumerate((first, second)) if each.SMProxy is port.SMProxy) for port in chambers]


def on_screen(view, widget, point):
    """Where a place of the world is."""
    renderer = view.SMProxy.GetRenderer()
    renderer.SetWorldPoint(*point, 1.0)
    renderer.WorldToDisplay()
    x, y, _ = renderer.GetDisplayPoint()
    corner = hands.place(widget)
    return corner.x() + x, corner.y() + widget.height() - 1 - y


def choose_target(name):
    """In ParaView's dialog, once it is open."""
    dialog = QtWidgets.QApplication.activeModalWidget()
    if dialog is None:
        return QtCore.QTimer.singleShot(100, lambda: choose_target(name))
    next(each for each in dialog.findChildren(QtWidgets.QRadioButton) if "Targets" in each.text()).click()
    # ParaView's tree is no widget that PyQt knows; its selection is.
    chosen = next(each for each in dialog.findChildren(QtCore.QItemSelectionModel) if each.parent().objectName() == "pipelineView")
    everywhere = QtCore.Qt.MatchExactly | QtCore.Qt.MatchRecursive
    (place,) = chosen.model().match(chosen.model().index(0, 0), QtCore.Qt.DisplayRole, name, 1, everywhere)
    chosen.setCurrentIndex(place, QtCore.QItemSelectionModel.ClearAndSelect)
    dialog.accept()


def needle():
    """A needle that is made a target by the dialog, moved by its handles and put back by an undo."""
    ultrasound = yield from begin()
    note("without", ultrasound)
    position, axial = np.array(ultrasound.PositionMm), np.array(ultrasound.Axial)
    middle, lateral = position + 40 * axial, np.array(ultrasound.Lateral)
    hub, tip = list(middle - 15 * lateral), list(middle + 15 * lateral)
    trigger("SonoNeedle")
    yield 500
    name, stick = next((name, source) for (name, _), source in GetSources().items() if source.GetXMLName() == "SonoNeedle")
    stick.Hubmm, stick.Tipmm, stick.Diametermm = hub, tip, 3
    press("Accept")
    yield 1000
    SetActiveSource(ultrasound)
    yield 500
    QtCore.QTimer.singleShot(300, lambda: choose_target(name))
    trigger("actionChangeInput")
    yield from settle()
    note("with", ultrasound, targets=ultrasound.Targets is not None)
    view = bodies()[0]
    SetActiveView(view)
    SetActiveSource(stick)
    yield 700
    child(QtWidgets.QCheckBox, "show3DWidget").setChecked(True)  # ParaView hides a line's ends when another source is selected
    yield 700
    widget = max(hands.views(), key=lambda each: each.height())
    x, y = on_screen(view, widget, stick.Tipmm)
    on_the_way = watch(ultrasound)
    for step in range(5):
        hands.move(x + 8 * step, y + 4 * step)
        yield 200
        if step == 0:
            hands.press(1)
            yield 300
        yield 700  # of which a picture needs some
    found["on the way"] = [picture for picture, *_ in on_the_way]
    hands.let_go()
    yield from settle()
    note("moved", ultrasound, hub=[hub, list(stick.Hubmm)], tip=[tip, list(stick.Tipmm)])
    trigger("actionEditUndo")
    yield from settle()
    note("put back", ultrasound, tip=list(stick.Tipmm))


def needles():
    return [source for source in GetSources().values() if source.GetXMLName() == "SonoNeedle"]


def added():
    """A needle by one click, which an undo takes out again."""
    ultrasound = yield from begin()
    note("without", ultrasound, width=ultrasound.GetProperty("WidthMm").GetElement(0))
    SetActiveView(next(each for each in GetViews() if each.GetXMLName() == "RenderView" and each.InteractionMode == "2D"))
    yield 500
    trigger("actionSonoNeedle")
    yield from settle()
    (stick,) = needles()
    body = GetActiveView()
    note("with", ultrasound, ends=[list(stick.Hubmm), list(stick.Tipmm)], isActive=GetActiveSource() == stick,
         handles=child(QtWidgets.QCheckBox, "show3DWidget").isChecked(), isSolid=body.InteractionMode == "3D",
         shown=int(GetRepresentation(stick, body).Visibility), depth=ultrasound.GetProperty("DepthMm").GetElement(0))
    SetActiveSource(ultrasound)
    yield 500
    trigger("actionSonoNeedle")
    yield from settle()
    note("again", ultrasound, needles=len(needles()), isActive=GetActiveSource() == stick,
         handles=child(QtWidgets.QCheckBox, "show3DWidget").isChecked())
    for name, act in (("undone", "actionEditUndo"), ("redone", "actionEditRedo")):
        trigger(act)
        yield from settle()
        note(name, ultrasound, needles=len(needles()), targets=ultrasound.Targets is not None)
    SetActiveSource(needles()[0])
    yield 500
    note("chosen", ultrasound)
    # An instrument of another shape, from a file.
    middle = np.array(ultrasound.PositionMm) + 40 * np.array(ultrasound.Axial)
    SaveData("ball.stl", Sphere(Center=list(middle), Radius=6))
    ball = OpenDataFile("ball.stl")
    SetActiveSource(ultrasound)
    yield from picture_with(ultrasound, Targets=ball)
    note("instrument", ultrasound, takesNeedle=hands.act_named("actionSonoNeedle") is not None)


def placed():
    """A needle by its button while the picture is frozen, and for one of two probes side by side."""
    ultrasound = yield from begin()
    hands.dock("pqSonoScannerDock").show()
    yield 500
    press("Freeze")
    yield 700
    note("frozen", ultrasound)
    trigger("actionSonoNeedle")
    yield from settle()
    note("frozen with it", ultrasound, needles=len(needles()))
    trigger("actionEditUndo")
    yield from settle()
    SetActiveSource(ultrasound)
    yield 500
    press("Freeze")
    yield from settle()
    first, second = yield from split(ultrasound)
    for name, each in (("first", first), ("second", second)):
        note(name, each)
    SetActiveSource(second)
    yield 500
    trigger("actionSonoNeedle")
    yield from settle()
    for name, each in (("first with it", first), ("second with it", second)):
        note(name, each, needles=len(needles()), targets=each.Targets is not None)
    (stick,) = needles()
    found["bodies"] = [int(GetRepresentation(stick, view).Visibility) for view in bodies()]


def cache():
    """What is kept of a label map, the button that removes it, and the same picture asked for anew."""
    folder = pathlib.Path(os.environ["XDG_CACHE_HOME"], "sonovdb")
    SetActiveSource(LabelMapReader(FileName=[str(pathlib.Path("given", "map.nii").resolve())]))
    yield 500
    trigger("actionSonoSimulate")
    yield from settle()
    (ultrasound,) = ultrasounds()

    def files():
        return sorted(each.name for each in folder.rglob("*") if each.is_file())

    note("kept", ultrasound, files=files())
    main.findChild(QtWidgets.QWidget, "ClearCache").findChild(QtWidgets.QPushButton).click()
    yield from settle()
    note("cleared", ultrasound, files=files())
    lines = ultrasound.LineCount
    for name, count in (("other", lines // 2), ("anew", lines)):
        yield from picture_with(ultrasound, LineCount=count)
        note(name, ultrasound)


def cine():
    """A loop of a turned probe and then of a heart that beats, played and gone back to."""
    ultrasound = yield from begin()
    FindSource("thorax").Phases = 3
    RenderAllViews()
    yield from settle()
    hands.dock("pqSonoScannerDock").show()
    yield 500
    shown = watch(ultrasound)
    for _ in range(4):
        press("RotatePlus")
        yield 400
    yield from settle()
    found["turned"] = list(shown)
    press("Freeze")
    yield 700
    shown.clear()
    press("CinePlay")
    yield 6000
    press("CinePlay")
    found["played"] = list(shown)
    yield from settle()
    note("stopped", ultrasound)
    press("Freeze")
    yield from settle()
    SetActiveSource(ultrasound)
    shown.clear()
    press("Beat")
    while len({moment for _, _, moment in shown}) < 3:
        yield 200
    press("Freeze")
    yield from settle()
    found["beat"], found["beats on"] = list(shown), child(QtWidgets.QAbstractButton, "Beat").isChecked()
    shown.clear()
    scrubber = child(QtWidgets.QSlider, "Scrubber")
    for back in (1, 2, 3):
        scrubber.setValue(scrubber.maximum() - back)
        yield 1500
    found["back"] = list(shown)


def type_keys(*names):
    """Together."""
    for name in names:
        hands.press_key(name)
    hands.let_go()


def go_down_to(name):
    """To an entry of the menu that is open."""
    menu = QtWidgets.QApplication.activePopupWidget()
    for _ in range(20):
        if menu.activeAction() is not None and name in (menu.activeAction().objectName(), menu.activeAction().text()):
            return
        type_keys("Down")
        yield 150
    raise ValueError(f"no key leads to {name}")


def keys():
    """From a label map to a picture and a caliper without the mouse."""
    thorax = ThoraxPhantom(registrationName="thorax", Spacingmm=4)
    SetActiveSource(thorax)
    yield 500
    place = hands.place(child(QtWidgets.QDockWidget, "propertiesDock"))
    yield from hands_at(hands.click(place.x() + 30, place.y() + 10))  # the window has the keys then
    type_keys("Alt_L", "u")
    yield 500
    menu = QtWidgets.QApplication.activePopupWidget()
    found["menu"] = [act.objectName() or act.text() for act in menu.actions() if not act.isSeparator()]
    yield from go_down_to("actionSonoSimulate")
    type_keys("Return")
    yield 500
    yield from settle()
    (ultrasound,) = ultrasounds()
    note("simulated", ultrasound)
    type_keys("Alt_L", "u")
    yield 500
    yield from go_down_to("&Flat View")
    type_keys("Right")
    yield 300
    yield from go_down_to("actionSonoDistance")
    type_keys("Return")
    yield 1500
    found["calipers"] = [source.GetXMLName() for source in GetSources().values()].count("SonoCaliper")
    SetActiveSource(ultrasound)
    hands.dock("pqSonoScannerDock").show()
    yield 700
    drawn = next(each for each in max(hands.views(), key=lambda view: view.height()).findChildren(QtWidgets.QWidget)
                 if each.focusPolicy() & QtCore.Qt.TabFocus)
    drawn.setFocus(QtCore.Qt.TabFocusReason)  # the pointer is elsewhere
    for name in ("once", "walked"):  # the first step leads onto the skin of so coarse a body
        type_keys("Right")
        yield from settle()
        note(name, ultrasound)
    hands.dock("pqSonoTissueDock").show()
    yield 700
    ours = {"propertiesDock": "SonoProbe", "pqSonoScannerDock": "SonoScannerControls", "pqSonoTissueDock": "pqSonoTissueDock"}
    nameless = [each.objectName() for dock, part in ours.items()
                for each in hands.dock(dock).findChildren((QtWidgets.QLineEdit, QtWidgets.QSlider, QtWidgets.QAbstractSpinBox))
                if each.isVisible() and each.focusPolicy() & QtCore.Qt.TabFocus
                and not (each.accessibleName() or each.parentWidget().accessibleName())
                and any(above.objectName() == part for above in ancestors(each))]
    found["nameless"] = nameless


def ancestors(widget):
    while widget is not None:
        yield widget
        widget = widget.parentWidget()


class Play:
    """A scene is a generator that says how many milliseconds ParaView goes on by itself."""

    def __init__(self, scene):
        self.scene = scene
        QtCore.QTimer.singleShot(1000, self.step)

    def step(self):
        try:
            QtCore.QTimer.singleShot(next(self.scene), self.step)
        except StopIteration:
            pathlib.Path("panel.json").write_text(json.dumps(found), encoding="utf-8")
            QtCore.QTimer.singleShot(0, QtWidgets.QApplication.quit)


def fail(*failure):
    """PyQt would end the process."""
    pathlib.Path("failed.txt").write_text("".join(traceback.format_exception(*failure)), encoding="utf-8")
    os._exit(1)


sys.excepthook = fail
scenes = (pose, scanner, views, needle, added, placed, cache, cine, keys)
play = Play({scene.__name__: scene for scene in scenes}[os.environ["PANEL_SCENE"]]())
