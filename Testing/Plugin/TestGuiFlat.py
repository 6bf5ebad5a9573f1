"""What a scanner has beside its picture, by clicks: text, names under the pointer, outlines of labels, calipers and a
split screen. Needs Xvfb; run by ctest -L gui."""
import json
import math
import pathlib
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

from events import MAIN, PROBE, check, click, event, menu, pause, save_state, select, undo, view, write
from guicase import PLAYBACKS, GuiCase, bytes_of

ACCEPT = f"{MAIN}/propertiesDock/propertiesPanel/Accept"
FLAT_MENU = f"{MAIN}/SonoToolBar/SonoFlatButton/SonoFlatMenu"
SPLIT = event(FLAT_MENU, "activate", "actionSonoSplit")
REDO = menu("menu_Edit", "actionEditRedo")
TRACE = menu("menuTools", "actionToolsStartStopTrace")
EDITOR = f"{MAIN}/0pqPythonScriptEditor0"

# What a trace of a split screen began with, the trace, and the depths that both have after one got another.
AGAIN = """
import json
Show(OpenDataFile(sys.argv[1], registrationName="thorax.vti"), CreateView("RenderView"))
exec(open(sys.argv[2], encoding="utf-8").read(), globals())
both = [source for source in GetSources().values() if source.GetXMLName() == "SonoUltrasound"]
both[0].DepthMm = 130
with open(sys.argv[3], "w", encoding="utf-8") as file:
    json.dump([source.DepthMm for source in both], file)
"""

# What a state's filters say, what its flat image has at a place, and its flat view as a picture.
ASK = """
import json
LoadState(sys.argv[1])
said = {}


def made(source, port=0):
    # What is fetched loses the strings of field data.
    source.UpdatePipeline()
    return source.SMProxy.GetClientSideObject().GetOutputDataObject(port)


for (name, _), source in GetSources().items():
    if source.GetXMLName() == "SonoFlatText":
        said["text"] = made(source).GetColumn(0).GetValue(0).split(chr(10))
    if source.GetXMLName() == "SonoCaliper":
        field = made(source).GetFieldData()
        said["caliper"] = [field.GetArray("Value").GetValue(0), field.GetAbstractArray("Text").GetValue(0)]
    if source.GetXMLName() == "SonoUltrasound":
        image = made(source, 7)
        x, y = float(sys.argv[3]), float(sys.argv[4])
        at, field = image.FindPoint(x, y, 0), image.GetFieldData()
        label = int(image.GetPointData().GetArray("Labels").GetValue(at))
        ids = field.GetArray("LabelIds")
        row = next(i for i in range(ids.GetNumberOfTuples()) if ids.GetValue(i) == label)
        said["pixel"] = [field.GetAbstractArray("LabelNames").GetValue(row),
                         field.GetAbstractArray("LabelTissues").GetValue(row),
                         int(image.GetPointData().GetArray("BMode").GetValue(at))]
view = next(v for v in GetViews() if v.GetXMLName() == "RenderView" and v.InteractionMode == "2D")
SaveScreenshot(sys.argv[2] + ".png", view, ImageResolution=[416, 313], FontScaling="Do not scale fonts")
SaveAnimation(sys.argv[2] + "-clip.png", view, ImageResolution=[416, 313], FontScaling="Do not scale fonts", FrameWindow=[0, 0])
with open(sys.argv[2] + ".json", "w", encoding="utf-8") as file:
    json.dump(said, file)
"""

# Of each caliper of a state, what it measures and says.
ASK_CALIPERS = """
import json
LoadState(sys.argv[1])
said = []
for (name, _), source in sorted(GetSources().items()):
    if source.GetXMLName() == "SonoCaliper":
        source.UpdatePipeline()
        field = source.SMProxy.GetClientSideObject().GetOutputDataObject(0).GetFieldData()
        said.append([source.SMProxy.GetProperty("Kind").GetElement(0),
                     [list(source.GetProperty(f"Point{i}Mm").GetData()) for i in (1, 2, 3)],
                     field.GetArray("Value").GetValue(0), field.GetAbstractArray("Text").GetValue(0)])
with open(sys.argv[2], "w", encoding="utf-8") as file:
    json.dump(sorted(said, key=lambda one: one[0]), file)
"""


def texts(proxy, name):
    return [element.get("value") for element in proxy.findall(f"Property[@name='{name}']/Element")]


def numbers(proxy, name):
    return [float(text) for text in texts(proxy, name)]


def proxies(state, kind):
    return [proxy for proxy in ElementTree.parse(state).iter("Proxy") if proxy.get("type") == kind]


def place_in_flat_view(state, across, down):
    """Where the pixel at a part of the flat view's width and height is in its image: lateral and depth in mm."""
    view = next(v for v in proxies(state, "RenderView") if numbers(v, "InteractionMode") == [1])
    width, height = numbers(view, "ViewSize")
    across, down = math.floor(across * width) / width, (math.floor(down * height) + 1) / height
    centre, scale = numbers(view, "CameraFocalPoint"), numbers(view, "CameraParallelScale")[0]
    return centre[0] + (across - 0.5) * 2 * scale * width / height, centre[1] + (down - 0.5) * 2 * scale


def pixels(path):
    """Rows of three bytes a pixel."""
    data = bytes_of(path, 3 * 416 * 313)
    return [data[3 * 416 * y:3 * 416 * (y + 1)] for y in range(313)]


def bright(rows, left, right, top, bottom):
    return sum(row[3 * x] > 150 for row in rows[top:bottom] for x in range(left, right))


def coloured(rows):
    return sum(max(row[3 * x:3 * x + 3]) - min(row[3 * x:3 * x + 3]) > 60 for row in rows for x in range(416))


class TestGuiFlat(GuiCase):
    def ask(self, state, folder, place=(0.0, 50.0)):
        to = pathlib.Path(folder, state.stem + "-asked")
        self.run_script(ASK, folder, state, to, *place)
        (clip,) = pathlib.Path(folder).glob(f"{to.name}-clip.*.png")
        self.assertEqual(pixels(clip), pixels(to.with_suffix(".png")))  # exported clips have what screenshots have
        return json.loads(to.with_suffix(".json").read_text(encoding="utf-8")), pixels(to.with_suffix(".png"))

    def test_text_outlines_and_caliper(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(self.play("flat.xml", folder, f"--data={self.label_map(folder)}"), [])
            states = {name: pathlib.Path(folder, name + ".pvsm") for name in ("labels", "plain", "placed", "dragged")}
            said, with_text = self.ask(states["labels"], folder)
            _, plain = self.ask(states["plain"], folder)
            measured, _ = self.ask(states["dragged"], folder)
            before, after = (proxies(states[name], "SonoCaliper")[0] for name in ("placed", "dragged"))
            ends = [numbers(after, f"Point{i}Mm") for i in (1, 2)]
            wanted = place_in_flat_view(states["dragged"], 0.387, 0.7)
        # The text follows the gain, and is in what is exported, in the upper right corner.
        self.assertIn("Gain 12 dB", said["text"])
        self.assertIn("Depth 160 mm", said["text"])
        corner = (300, 416, 0, 100)
        self.assertGreater(bright(with_text, *corner), 300)
        self.assertLess(bright(plain, *corner), 50)
        # Outlines have colours where the picture is grey, but for the scan line.
        self.assertGreater(coloured(with_text), 3 * coloured(plain) + 500)
        # One end was dragged, the other one stayed, and the value is theirs.
        self.assertEqual(ends[1], numbers(before, "Point2Mm"))
        self.assertNotEqual(ends[0], numbers(before, "Point1Mm"))
        self.assertLess(math.dist(ends[0][:2], wanted), 2.5)
        self.assertAlmostEqual(measured["caliper"][0], math.dist(*ends), places=3)
        self.assertEqual(measured["caliper"][1], f"{math.dist(*ends):.1f} mm")

    def test_its_colour_map_opens_in_the_editor(self):
        """Which crashes where a map has no opacity function."""
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            played = write(folder / "editor.xml", click(ACCEPT), click(f"{MAIN}/SonoToolBar/actionSonoSimulate"), pause(1000),
                           click(f"{MAIN}/variableToolbar/actionEditColorMap"), pause(1000),
                           check(f"{MAIN}/colorMapEditorDock", "visible", "true"), save_state("edited"))
            self.assertEqual(self.play(played, folder, f"--data={self.label_map(folder)}"), [])
            maps = proxies(folder / "edited.pvsm", "SonoColorTable")
            opacities = [texts(one, "ScalarOpacityFunction") or
                         [element.get("value") for element in one.findall("Property[@name='ScalarOpacityFunction']/Proxy")]
                         for one in maps]
        self.assertEqual(len(opacities), 2)  # of the body and of the flat view
        self.assertEqual(len({opacity for each in opacities for opacity in each}), 2)

    def test_an_annotation_is_written_dragged_and_undone(self):
        """What is cancelled or empty writes nothing. An ellipse and an angle beside it have values of their own."""
        flat = view(2, 5)

        def annotate(words, button):
            dialog = f"{MAIN}/SonoAnnotation"
            return "\n".join((event(FLAT_MENU, "activate", "actionSonoAnnotation"),
                              event(f"{dialog}/1QLineEdit0", "set_string", words),
                              click(f"{dialog}/1QDialogButtonBox0/1QPushButton{button}"), pause(500)))

        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            drag = [event(flat, kind, f"({x},{y},{button},{held},0)") for kind, x, y, button, held in (
                ("mouseMove", 0.14, 0.18, 0, 0), ("mousePress", 0.14, 0.18, 1, 1), ("mouseMove", 0.24, 0.28, 0, 1),
                ("mouseMove", 0.44, 0.48, 0, 1), ("mouseRelease", 0.44, 0.48, 1, 0))]
            played = write(folder / "annotate.xml", click(ACCEPT), click(f"{MAIN}/SonoToolBar/actionSonoSimulate"), pause(1000),
                           annotate("nothing", 1), annotate("  ", 0), save_state("none"), annotate("Right lobe", 0),
                           save_state("written"), undo(), pause(500), save_state("undone"), REDO, pause(500), *drag, pause(500),
                           save_state("dragged"),
                           event(FLAT_MENU, "activate", "actionSonoEllipse"), event(FLAT_MENU, "activate", "actionSonoAngle"),
                           pause(1000), save_state("measured"))
            self.assertEqual(self.play(played, folder, f"--data={self.label_map(folder)}"), [])
            states = {name: folder / f"{name}.pvsm" for name in ("none", "written", "undone", "dragged", "measured")}
            words = {name: [texts(one, "Text")[0] for one in proxies(state, "TextSource")] for name, state in states.items()}
            at = {name: [numbers(one, "Position") for one in proxies(states[name], "TextSourceRepresentation")
                         if numbers(one, "WindowLocation") == [0]] for name in ("written", "dragged")}
            kinds = [numbers(one, "Kind") for one in proxies(states["measured"], "SonoCaliper")]
            self.run_script(ASK_CALIPERS, folder, states["measured"], folder / "values.json")
            values = json.loads((folder / "values.json").read_text(encoding="utf-8"))
            _, shown = self.ask(states["dragged"], folder)
        self.assertEqual(words, {"none": [], "written": ["Right lobe"], "undone": [], "dragged": ["Right lobe"],
                                 "measured": ["Right lobe"]})
        moved = [after - before for before, after in zip(at["written"][0], at["dragged"][0])]
        self.assertAlmostEqual(moved[0], 0.3, delta=0.02)
        self.assertAlmostEqual(moved[1], -0.3, delta=0.02)
        yellow = sum(row[3 * x] > 180 and row[3 * x + 2] < 120 for row in shown[130:180] for x in range(160, 320))
        self.assertGreater(yellow, 60)
        self.assertEqual(kinds, [[1], [2]])
        self.assertEqual([kind for kind, *_ in values], [1, 2])
        for kind, points, value, text in values:
            one, other, third = ([p - q for p, q in zip(point, points[0])] for point in points)
            across = math.dist(points[0], points[1])
            if kind == 1:  # its second half axis is the third point's distance from the first axis
                height = abs(other[0] * third[1] - other[1] * third[0]) / across
                self.assertAlmostEqual(value, math.pi * 0.5 * across * height, delta=1e-3 * value)
                self.assertEqual(text, f"{value / 100:.2f} cm^2")
            else:
                turn = math.degrees(math.atan2(other[0] * third[1] - other[1] * third[0], other[0] * third[0] + other[1] * third[1]))
                self.assertAlmostEqual(value, abs(turn), places=2)
                self.assertEqual(text, f"{value:.1f} deg")

    def test_clicks_trace_a_ventricle(self):
        """One point each, where the picture was clicked; undo takes one back, and no scan line is picked meanwhile."""
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(self.play("ventricle.xml", folder, f"--data={self.label_map(folder)}"), [])
            states = [pathlib.Path(folder, name + ".pvsm") for name in ("four", "five", "again")]
            four, five, again = (numbers(proxies(state, "SonoVentricleVolume")[0], "FourChamberPoints") for state in states)
            line = numbers(proxies(states[1], "SonoALine")[0], "Line")
            wanted = [place_in_flat_view(states[1], x, y) for x, y in
                      ((0.45, 0.6), (0.47, 0.4), (0.5, 0.25), (0.53, 0.4), (0.55, 0.6))]
        self.assertEqual(five[:8], four)
        self.assertEqual(again, four)
        self.assertEqual(line, [64])
        for i, place in enumerate(wanted):
            self.assertLess(math.dist(five[2 * i:2 * i + 2], place), 1.0)

    def test_the_name_under_the_pointer_is_that_of_its_pixel(self):
        with tempfile.TemporaryDirectory() as folder:
            data = self.label_map(folder)
            self.assertEqual(self.play("rested.xml", folder, f"--data={data}"), [])
            state = pathlib.Path(folder, "rested.pvsm")
            place = place_in_flat_view(state, 0.5, 0.45)
            name, tissue, grey = self.ask(state, folder, place)[0]["pixel"]
            sentence = f"{name}, {tissue}, {math.hypot(*place):.1f} mm, grey {grey}"
            script = pathlib.Path(folder, "pointer.xml")
            script.write_text((PLAYBACKS / "pointer.xml").read_text().replace("SENTENCE", sentence))
            done = self.paraview(folder, f"--test-script={script}", f"--data={data}", "--exit")
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertNotIn("property value is", done.stdout)

    def test_a_split_screen_has_one_probe_and_two_settings(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(self.play("split.xml", folder, f"--data={self.label_map(folder)}"), [])
            state = pathlib.Path(folder, "split.pvsm")
            both = proxies(state, "SonoUltrasound")
            views = [view for view in proxies(state, "RenderView") if numbers(view, "InteractionMode") == [1]]
        self.assertEqual(len(both), 2)
        for name in ("PositionMm", "Axial", "Lateral", "DepthMm"):
            self.assertEqual(numbers(both[0], name), numbers(both[1], name))
        self.assertEqual(numbers(both[0], "DepthMm"), [120])
        self.assertEqual(sorted(numbers(one, "GainDb")[0] for one in both), [0, 12])
        self.assertEqual(len(views), 3)  # that of the layout, and two

    def test_a_split_screen_is_undone_and_loaded(self):
        """With the steps before it, and what is made again or loaded shares the probe again; a trace's, too."""
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            data = f"--data={self.label_map(folder)}"

            def typed(depth, name):
                return "\n".join((event(f"{PROBE}/DepthMm", "set_string", depth), click(ACCEPT), pause(2000), save_state(name)))

            made = write(folder / "made.xml", click(ACCEPT), pause(500), TRACE, click("TraceOptionsDialog/widget/OKButton"),
                         click(f"{MAIN}/SonoToolBar/actionSonoSimulate"), pause(1000), save_state("first"),
                         typed(140, "before"), SPLIT, pause(2000), TRACE, pause(500),
                         event(f"{EDITOR}/PythonScriptEditorMenuBar/File", "activate", "Save &As..."),
                         event(f"{EDITOR}/FileOpenDialog", "filesSelected", "$PARAVIEW_TEST_ROOT/trace.py"),
                         save_state("split"), undo(), pause(2000), save_state("undone"), undo(), pause(2000),
                         save_state("earlier"), REDO, REDO, pause(2000), select(0, 0), pause(500), typed(100, "redone"))
            self.assertEqual(self.play(made, folder, data), [])
            load = write(folder / "load.xml", menu("menu_File", "actionFileLoadServerState"),
                         event(f"{MAIN}/FileLoadServerStateDialog", "filesSelected", "$PARAVIEW_TEST_ROOT/redone.pvsm"),
                         click("LoadStateOptionsDialog/widget/OKButton"), pause(3000), select(0, 0), pause(500),
                         typed(110, "loaded"))
            self.assertEqual(self.play(load, folder), [])
            depths = {name: [numbers(one, "DepthMm")[0] for one in proxies(folder / f"{name}.pvsm", "SonoUltrasound")]
                      for name in ("first", "before", "split", "undone", "earlier", "redone", "loaded")}
            self.run_script(AGAIN, folder, data.partition("=")[2], folder / "trace.py", folder / "again.json")
            again = json.loads((folder / "again.json").read_text())
        self.assertEqual(depths, {"first": depths["first"], "before": [140], "split": [140, 140], "undone": [140],
                                  "earlier": depths["first"], "redone": [100, 100], "loaded": [110, 110]})
        self.assertEqual(again, [130, 130])


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
