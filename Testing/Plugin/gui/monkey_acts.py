"""What the monkey does to sources, settings and files, and what it does next."""
import monkey_views  # noqa: F401 registers its own
from monkey_dialogs import is_harmless
from monkey_hands import LIGHT, Skip, act, acts
from paraview import simple
from PyQt5 import QtCore, QtWidgets

SOURCES = ("SonoThoraxSource", "SonoThoraxSource", "SonoPhantomSource", "SonoProbeSource", "SonoProbeSource", "SonoNeedle",
           "SonoCaliper", "SonoProbePresets", "SonoPulseEchoField", "SonoDataSet", "SphereSource", "RTAnalyticSource")
FILTERS = ("SonoUltrasound", "SonoUltrasound", "SonoSceneBuilder", "SonoRayTracer", "SonoImageFormation", "SonoBMode",
           "SonoScanConverter", "SonoErrorMap", "SonoSweep", "SonoStandardViews", "SonoAcousticWindow", "SonoChannelData",
           "SonoALine", "SonoMMode", "SonoFlatScale", "SonoFlatText", "SonoFlatLabels", "SonoFlatPixel", "SonoScanDetail",
           "SonoLabelTable", "SonoLiveLink", "Slice", "Threshold", "Contour")
TOOLS = ("actionSonoSimulate", "actionSonoSimulate", "actionSonoLayout", "actionSonoLayout", "actionSonoFlatText",
         "actionSonoFlatLabels", "actionSonoDistance", "actionSonoEllipse", "actionSonoAngle", "actionSonoAnnotation",
         "actionSonoSplit", "actionSonoNeedle", "actionSonoTissues", "actionSonoScanner", "actionSonoScanner")
MOST_SOURCES = 14
OUTSIDE = (-1, 0, 1e9, -1e30, float("nan"))  # of most ranges
# The third hides all but what is sought. The fourth ends ParaView 5.11, without SonoVDB too, when a background's texture was to be
# loaded and was not: vtkSMSettings writes a property's proxy where there is none. The last two are ParaView's axes, whose words
# it makes anew one by one: after many an undo it takes more than five seconds to draw them.
UNTOUCHED = ("Help", "AdvancedButton", "SearchLineEdit", "ViewSaveAsDefaults", "AxesGrid", "DataAxesGrid")


def choose(hands):
    # Not twice in a row: what stays slow may be what no setting makes lighter.
    hands.lightened = hands.heavy and not hands.lightened
    if hands.lightened:
        return lighten
    if hands.number % 200 == 150:
        return start_anew
    if not hands.ours("SonoThoraxSource", "SonoLabelMapReader", "SonoPhantomSource"):
        return begin
    if len(hands.sources()) > MOST_SOURCES:
        return delete
    return hands.rng.choices([function for _, function in acts], [weight for weight, _ in acts])[0]


def lighten(hands, _):
    hands.note("makes settings lighter")
    for proxy in hands.sources():
        hands.lighten(proxy)
    yield
    hands.apply()
    yield


def begin(hands, _):
    """What most sessions begin with."""
    hands.note("a thorax, and Simulate Ultrasound by the tool bar")
    thorax = simple.ThoraxPhantom(Spacingmm=hands.rng.choice([3, 4, 5]))
    simple.SetActiveSource(thorax)
    yield
    yield
    hands.apply()
    yield
    button = hands.act_named("actionSonoSimulate")
    if button:
        button.trigger()
    yield


@act(1)
def start_anew(hands, dialogs):
    dialogs.plan = say_yes
    hands.trigger("actionDelete_All")
    yield


def say_yes(dialog):
    if isinstance(dialog, QtWidgets.QMessageBox):
        button = dialog.button(QtWidgets.QMessageBox.Yes) or dialog.button(QtWidgets.QMessageBox.Ok)
        if button:
            button.click()
            return True
    return False


# Sources and filters

def made(hands, known):
    """After a menu has made something: light, and applied mostly."""
    yield
    new = [proxy for proxy in hands.sources() if proxy.SMProxy.GetGlobalID() not in known]
    for proxy in new:
        hands.lighten(proxy)
    yield
    if hands.rng.random() < 0.85:
        hands.apply()
    yield


def known(hands):
    return {proxy.SMProxy.GetGlobalID() for proxy in hands.sources()}


@act(5)
def add_source(hands, dialogs):
    before, name = known(hands), hands.rng.choice(SOURCES)
    hands.trigger(name)
    yield from made(hands, before)


@act(10)
def add_filter(hands, dialogs):
    before, source = known(hands), hands.any_of(hands.sources())
    simple.SetActiveSource(simple.OutputPort(source, hands.rng.randrange(source.SMProxy.GetNumberOfOutputPorts())))
    yield
    yield
    offered = hands.filters()
    name = hands.any_of(name for name in FILTERS if name in offered)
    dialogs.plan = dialogs.accept if hands.rng.random() < 0.9 else None
    hands.note(f"{name} on {hands.name_of(source)}")
    offered[name].trigger()
    yield from made(hands, before)


@act(6)
def activate(hands, _):
    source = hands.any_of([*hands.sources(), None])
    port = hands.rng.randrange(source.SMProxy.GetNumberOfOutputPorts()) if source else 0
    hands.note(f"selects {hands.name_of(source)}, port {port}")
    simple.SetActiveSource(simple.OutputPort(source, port) if source else None)
    yield


@act(6)
def delete(hands, dialogs):
    source = hands.any_of(hands.sources())
    name = hands.rng.choice(["panel", "actionPBDelete", "actionPBDeleteTree", "script"])
    hands.note(f"deletes {hands.name_of(source)} by {name}")
    dialogs.plan = say_yes if hands.rng.random() < 0.7 else None
    if name == "script":
        simple.Delete(source)
        yield
        return
    simple.SetActiveSource(source)
    yield
    if name == "panel":
        button = hands.button("Delete", hands.dock("propertiesDock"))
        if button:
            button.click()
    else:
        found = hands.act_named(name)
        if found:
            found.trigger()
    yield


@act(5)
def click_browser(hands, _):
    """Somewhere in the pipeline browser: on a name, an eye, or what folds a source up."""
    rows = hands.dock("pipelineBrowserDock").findChild(QtWidgets.QAbstractScrollArea, "pipelineBrowser").viewport()
    x, y = hands.rng.choice([12, 28, 45, 70, 100]), hands.rng.randrange(rows.height())
    hands.note(f"clicks in the pipeline browser at {x}, {y}")
    at = rows.mapToGlobal(QtCore.QPoint(x, y))
    yield from hands.click(at.x(), at.y())


# Settings

@act(2)
def apply_or_reset(hands, _):
    name = hands.rng.choice(["Accept", "Accept", "Reset"])
    hands.note(f"clicks {name}")
    button = hands.button(name, hands.dock("propertiesDock"))
    if button is None:
        raise Skip
    button.click()
    yield


def number_for(hands, name, text):
    """A number for a property, by what it was and is allowed; sometimes outside all of that."""
    rng = hands.rng
    if rng.random() < 0.06:
        return str(rng.choice(OUTSIDE))
    if name in LIGHT:
        least, most = LIGHT[name]
        return str(rng.randint(least, most)) if isinstance(least, int) and rng.random() < 0.7 else \
            f"{rng.uniform(least, most):.3g}"
    try:
        was = float(text)
    except ValueError:
        return rng.choice(["heart", "liver", "", "none.csv", "Skin", "\u00e4\u00f6"])
    if rng.random() < 0.4:
        return str(rng.randint(0, 3))
    return f"{was * rng.uniform(0.5, 1.6) + rng.choice([0, 0, 1, -1]):.4g}"


def poke(hands, container):
    """Changes one of the widgets in a panel as a person does."""
    kinds = (QtWidgets.QLineEdit, QtWidgets.QAbstractSlider, QtWidgets.QComboBox, QtWidgets.QCheckBox,
             QtWidgets.QAbstractSpinBox, QtWidgets.QToolButton, QtWidgets.QPushButton)
    found = [w for kind in kinds for w in container.findChildren(kind)
             if w.isVisible() and w.isEnabled() and w.objectName() not in UNTOUCHED and
             not isinstance(w, QtWidgets.QScrollBar)]
    # By their names, in an order that does not depend on memory.
    rng = hands.rng
    named = {(hands.property_of(w) or w.objectName(), w.metaObject().className()): w for w in found}
    property, kind = hands.any_of(sorted(named))
    widget = named[property, kind]
    what = f"{container.objectName()}: {property} ({kind})"
    if isinstance(widget, QtWidgets.QLineEdit):
        text = number_for(hands, property, widget.text())
        hands.note(f"{what} = {text!r}")
        hands.type_into(widget, text)
    elif isinstance(widget, QtWidgets.QAbstractSlider):
        least, most = widget.minimum(), widget.maximum()
        if property in LIGHT:  # a slider reaches over more than is quick
            hands.note(f"{what} steps")
            widget.triggerAction(rng.choice([QtWidgets.QAbstractSlider.SliderSingleStepAdd,
                                             QtWidgets.QAbstractSlider.SliderSingleStepSub]))
        else:
            value = rng.randint(least, most)
            hands.note(f"{what} = {value} of {least} to {most}")
            widget.setValue(value)
    elif isinstance(widget, QtWidgets.QComboBox):
        if widget.count() == 0:
            raise Skip
        index = rng.randrange(widget.count())
        hands.note(f"{what} = '{widget.itemText(index)}'")
        widget.setCurrentIndex(index)
        widget.activated[int].emit(index)
    elif isinstance(widget, QtWidgets.QAbstractSpinBox):
        hands.note(f"{what} steps")
        widget.stepBy(rng.choice([-1, 1, 3]))
    else:
        hands.note(f"{what} clicked, '{widget.text()}'")
        widget.click()


@act(26)
def set_property(hands, _):
    """In the properties panel, of the selected source or another."""
    if hands.rng.random() < 0.6:
        simple.SetActiveSource(hands.any_of(hands.sources()))
        yield
        yield
    panel = hands.main.findChild(QtWidgets.QWidget, "propertiesPanel")
    advanced = hands.button("AdvancedButton", panel)
    if advanced and hands.rng.random() < 0.1:
        advanced.click()
        yield
    for _ in range(hands.rng.choice([1, 1, 1, 2, 3])):
        poke(hands, panel)
        yield
    if hands.rng.random() < 0.8:
        hands.apply()
        yield


@act(6)
def set_by_script(hands, _):
    """As a macro or the Python shell does, past the panel."""
    proxy = hands.any_of(hands.ours())
    numbers = [name for name in sorted(hands.properties(proxy))
               if not name.endswith("Info") and proxy.GetProperty(name) is not None and
               "VectorProperty" in type(proxy.GetProperty(name)).__name__ or name in LIGHT]
    name = hands.any_of(numbers)
    property = proxy.GetProperty(name)
    if not hasattr(property, "__len__") or len(property) == 0:
        raise Skip
    index = hands.rng.randrange(len(property))
    was = property[index]
    if isinstance(was, str):
        raise Skip
    text = number_for(hands, name, str(was))
    hands.note(f"script: {hands.name_of(proxy)}.{name}[{index}] = {text}")
    try:
        property[index] = type(was)(float(text))
    except (TypeError, ValueError, OverflowError):
        raise Skip
    proxy.UpdateVTKObjects()
    yield
    simple.RenderAllViews()
    yield


@act(16)
def set_scanner(hands, _):
    """In the scanner's panel, which is opened for it."""
    dock = hands.dock("pqSonoScannerDock")
    ultrasound = hands.any_of(hands.ours("SonoUltrasound"))
    if not dock.isVisible():
        dock.toggleViewAction().trigger()
        yield
    if hands.rng.random() < 0.7:
        simple.SetActiveSource(ultrasound)
        yield
        yield
    for _ in range(hands.rng.choice([1, 1, 2, 3])):
        poke(hands, dock)
        yield
        yield


@act(3)
def set_tissues(hands, _):
    dock = hands.dock("pqSonoTissueDock")
    if not dock.isVisible():
        dock.toggleViewAction().trigger()
        yield
    table = dock.findChild(QtWidgets.QAbstractItemView)
    if table and table.isVisible() and table.model() and table.model().rowCount() and hands.rng.random() < 0.6:
        model = table.model()
        cell = model.index(hands.rng.randrange(model.rowCount()), hands.rng.randrange(model.columnCount()))
        if not cell.flags() & QtCore.Qt.ItemIsEditable:
            raise Skip
        text = hands.rng.choice([number_for(hands, "", str(cell.data())), "blood", "nothing known"])
        hands.note(f"tissues: '{cell.data()}' = '{text}'")
        model.setData(cell, text)
    else:
        poke(hands, dock)
    yield
    yield


@act(5)
def use_tool(hands, dialogs):
    name = hands.rng.choice(TOOLS)
    if name in ("actionSonoSimulate", "actionSonoLayout", "actionSonoNeedle"):
        types = ("SonoThoraxSource", "SonoLabelMapReader", "SonoPhantomSource", "SonoSceneBuilder")
        simple.SetActiveSource(hands.any_of(hands.ours(*types) if name == "actionSonoSimulate" else
                                            hands.ours("SonoUltrasound")))
        yield
        yield
    before = known(hands)
    hands.trigger(name)
    yield
    for proxy in hands.sources():
        if proxy.SMProxy.GetGlobalID() not in before:
            hands.lighten(proxy)
    yield


@act(9)
def undo(hands, _):
    name = hands.rng.choice(["actionEditUndo", "actionEditUndo", "actionEditRedo"])
    for _ in range(hands.rng.choice([1, 1, 2, 4])):
        hands.trigger(name)
        yield
        yield


@act(4)
def tool_bar(hands, _):
    bar = hands.main.findChild(QtWidgets.QToolBar, "SonoToolBar")
    button = hands.any_of(b for b in bar.findChildren(QtWidgets.QToolButton) if b.isVisible() and b.isEnabled())
    menu = button.menu()
    if menu:
        menu.aboutToShow.emit()
        chosen = hands.any_of(each for each in menu.actions() if is_harmless(each))
        hands.note(f"the tool bar's menu: {chosen.objectName()} '{chosen.text()}'")
        chosen.trigger()
    else:
        hands.note(f"the tool bar: {button.objectName()} '{button.text()}'")
        button.click()
    yield
    for proxy in hands.ours():
        hands.lighten(proxy)
    yield


# Files

@act(3)
def open_file(hands, dialogs):
    path = hands.any_of(sorted(hands.folder.glob("given/*")))
    before, opens = known(hands), hands.enabled("actionFileOpen")
    hands.note(f"opens {path.name}")
    dialogs.plan = dialogs.choose_file(path)
    opens.trigger()
    yield from made(hands, before)


@act(2)
def save_state(hands, dialogs):
    name = f"state{hands.rng.randrange(3)}.{hands.rng.choice(['pvsm', 'pvsm', 'py'])}"
    saves = hands.enabled("actionFileSaveServerState")
    hands.note(f"saves {name}")
    dialogs.plan = dialogs.choose_file(hands.folder / name)
    saves.trigger()
    yield


@act(2)
def load_state(hands, dialogs):
    path = hands.any_of(sorted(hands.folder.glob("state?.*")))
    loads = hands.enabled("actionFileLoadServerState")
    hands.note(f"loads {path.name}")
    dialogs.plan = dialogs.choose_file(path)
    loads.trigger()
    yield
    yield


@act(1)
def save_screenshot(hands, dialogs):
    saves = hands.enabled("actionFileSaveScreenshot")
    hands.note("saves a screenshot")
    dialogs.plan = dialogs.choose_file(hands.folder / "shot.png")
    saves.trigger()
    yield


@act(2)
def save_data(hands, dialogs):
    simple.SetActiveSource(hands.any_of(hands.sources()))
    yield
    button = hands.act_named("actionFileSaveData")
    if button is None:
        raise Skip
    name = "data." + hands.rng.choice(["vti", "vtm", "vtp", "csv", "dcm", "igs.mha", "png", "nvdb", "zea.h5", "exr", "pvd"])
    hands.note(f"saves {hands.name_of(simple.GetActiveSource())} as {name}")
    dialogs.plan = dialogs.choose_file(hands.folder / name)
    button.trigger()
    yield
