"""What a person does in ParaView, as the events of its test files."""
from xml.sax.saxutils import quoteattr

MAIN = "pqClientMainWindow"
PANEL = f"{MAIN}/propertiesDock/propertiesPanel/scrollArea/qt_scrollarea_viewport/scrollAreaWidgetContents/PropertiesFrame/ProxyPanel"
PROBE = f"{PANEL}/SonoProbe"
SCANNER = f"{MAIN}/pqSonoScannerDock/SonoScannerContents/SonoScannerScroll/qt_scrollarea_viewport/SonoScannerControls"
BROWSER = f"{MAIN}/pipelineBrowserDock/pipelineBrowser"


def event(widget, command, arguments=""):
    return f"  <pqevent object={quoteattr(widget)} command={quoteattr(command)} arguments={quoteattr(str(arguments))}/>"


def click(widget):
    return event(widget, "activate")


def check(widget, name, value):
    return f"  <pqcheck object={quoteattr(widget)} property={quoteattr(name)} arguments={quoteattr(str(value))}/>"


def pause(milliseconds):
    return event(MAIN, "pause", milliseconds)


def play_on(milliseconds):
    """Lets ParaView work on: a pause alone keeps timers from firing, but not what is between two of them."""
    return "\n".join([pause(50)] * (milliseconds // 50))


def select(*rows):
    """A source in the pipeline browser, by its row among its siblings, from the outermost on."""
    path = "/".join(f"{row}:0" for row in rows)
    return "\n".join(event(BROWSER, "mouse" + what, f"1,{held},0,60,5,/0:0/{path}") for what, held in (("Press", 1), ("Release", 0)))


def menu(name, action):
    return "\n".join((event(f"{MAIN}/menubar", "activate", name), click(f"{MAIN}/menubar/{name}").replace('arguments=""', f'arguments="{action}"')))


def save_state(name):
    return "\n".join((menu("menu_File", "actionFileSaveServerState"),
                      event(f"{MAIN}/FileSaveServerStateDialog", "filesSelected", f"$PARAVIEW_TEST_ROOT/{name}.pvsm")))


def undo():
    return menu("menu_Edit", "actionEditUndo")


def view(tab, frame):
    """A view by its layout's tab and its place in it."""
    return (f"{MAIN}/centralwidget/MultiViewWidget/CoreWidget/qt_tabwidget_stackedwidget/MultiViewWidget{tab}/Container/"
            f"Frame.{frame}/CentralWidgetFrame/Viewport")


def write(path, *events):
    path.write_text("<pqevents>\n" + "\n".join(events) + "\n</pqevents>\n", encoding="utf-8")
    return path
