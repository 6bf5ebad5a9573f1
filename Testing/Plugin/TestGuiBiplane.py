"""Both planes of a matrix probe side by side: two flat pictures of one probe, live, and back to the volume. Needs Xvfb and
python3-xlib; run by ctest -L gui."""
import json
import pathlib
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree as ElementTree

import numpy as np
from events import MAIN, PANEL, PROBE, SCANNER, check, click, event, menu, pause, play_on, save_state, select, undo, write
from guicase import PLAYBACKS, GuiCase, save_screen
from person import Person, while_acting

WINDOW = "1152x762+0+0"
BIPLANE = f"{SCANNER}/Biplane"
VOLUME, FIRST, SECOND = "0", "1", "2"
NAMES = ("First Plane", "Second Plane")
# What the flat images of a state or a trace show, and, as another way to the same, those of probes of one plane that stand as
# the matrix stands and as it is turned by 90 degrees about its axis. Then the first one gets another gain.
PLANES = """
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
if sys.argv[1].endswith(".pvsm"):
    LoadState(sys.argv[1])
else:
    exec(open(sys.argv[1], encoding="utf-8").read(), globals())


def flat(source):
    OutputPort(source, 7).UpdatePipeline()
    image = source.SMProxy.GetClientSideObject().GetOutputDataObject(7)
    width, height, depth = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetArray("BMode")).reshape(depth, height, width).astype(float)


made = {source.GetProperty("MatrixPlane").GetData(): source for source in GetSources().values()
        if source.GetXMLName() == "SonoUltrasound"}
shown = {name: flat(source) for name, source in made.items()}
one = list(made.values())[0]
names = ("PositionMm", "DepthMm", "LineCount", "PathsPerLine", "PixelMm", "GainDb")
alike = {name: one.GetProperty(name).GetData() for name in names}
axial, lateral = np.array(one.Axial), np.array(one.Lateral)
width, height = one.ApertureMm, one.ElevationApertureMm
for name, sector, along, size, across in (
        ("alone", one.SectorDeg, lateral, width, height),
        ("turned", one.ElevationSectorDeg, np.cross(axial, lateral), height, width)):
    single = SimulateUltrasound(Input=one.Input, ScanKind="Matrix", ElevationLineCount=1, SectorDeg=sector, ApertureMm=size,
                                ElevationApertureMm=across, Axial=list(axial), Lateral=list(along), **alike)
    shown[name] = flat(single)
if "First Plane" in made:
    made["First Plane"].GainDb = 20
    shown["gains"] = np.array([source.GainDb for source in made.values()])
    shown["kinds"] = np.array(sorted(made))
np.savez(sys.argv[2], **shown)
"""


def value(proxy, name):
    return [element.get("value") for element in proxy.findall(f"Property[@name='{name}']/Element")]


def probes(state):
    return [proxy for proxy in ElementTree.parse(state).iter("Proxy") if proxy.get("type") == "SonoUltrasound"]


def layouts(state):
    return sorted(item.get("name") for group in ElementTree.parse(state).iter("ProxyCollection")
                  if group.get("name") == "layouts" for item in group)


class TestGuiBiplane(GuiCase):
    def play_on_matrix(self, folder, *events, act=lambda person: None):
        """What was made, a dictionary a picture."""
        script = write(folder / "biplane.xml", select(0, 0), pause(1000), click(f"{MAIN}/SonoToolBar/SonoScannerButton"),
                       pause(500), check(BIPLANE, "enabled", "true"), *events)
        errors, failures = while_acting(Person(self, folder), act,
                                        lambda: self.play(script, folder, f"--script={PLAYBACKS / 'biplane.py'}"))
        self.assertEqual(failures, [])
        self.assertEqual(errors, [])
        return [json.loads(line) for line in (folder / "biplane.jsonl").read_text().splitlines()]

    def planes_of(self, folder, name):
        self.run_script(PLANES, folder, folder / name, folder / "planes.npz")
        with np.load(folder / "planes.npz") as found:
            return dict(found)

    def assert_planes(self, planes):
        """Both are those of probes of one plane, and not the same; depth runs down: the apex is narrow."""
        for name, alone in (("First Plane", "alone"), ("Second Plane", "turned")):
            self.assertEqual(planes[name].shape, planes[alone].shape)
            self.assertEqual(planes[name].shape[0], 1)
            # Directions are rounded otherwise.
            self.assertLess((np.abs(planes[name] - planes[alone]) > 2).mean(), 0.002, name)
            seen = (planes[name][0] > 0).sum(axis=1)
            self.assertLess(seen[5], seen[30])
        self.assertGreater(planes["First Plane"].shape[2], planes["Second Plane"].shape[2])  # 80 and 50 degrees
        self.assertEqual(list(planes["kinds"]), list(NAMES))

    def test_both_planes_are_live_until_it_is_off(self):
        turns = [part for _ in range(6) for part in (click(f"{PROBE}/RotatePlus"), pause(150))]
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)

            def look(person):
                for name in ("both", "moved"):
                    person.await_file(f"{name}.pvsm")
                    time.sleep(1)
                    save_screen(pathlib.Path.cwd() / f"biplane_{name}.png", self.frame_buffer, WINDOW, "100%")

            made = self.play_on_matrix(
                folder, save_state("before"), click(BIPLANE), play_on(3000), check(BIPLANE, "checked", "true"),
                save_state("both"), play_on(2000),
                event(f"{PANEL}/GainDb/DoubleRangeWidget/DoubleLineEdit", "set_string", 12), play_on(2500), *turns, play_on(3000),
                save_state("moved"), play_on(2000), click(BIPLANE), play_on(2000), check(BIPLANE, "checked", "false"),
                save_state("ended"), act=look)
            for name in ("both", "moved"):
                with self.subTest(name=name):
                    self.assert_planes(self.planes_of(folder, f"{name}.pvsm"))
            load = (menu("menu_File", "actionFileLoadServerState"),
                    event(f"{MAIN}/FileLoadServerStateDialog", "filesSelected", "$PARAVIEW_TEST_ROOT/moved.pvsm"),
                    click("LoadStateOptionsDialog/widget/OKButton"), play_on(3000), select(0, 0), pause(1000),
                    event(f"{PANEL}/GainDb/DoubleRangeWidget/DoubleLineEdit", "set_string", 7), play_on(2500))
            self.assertEqual(self.play(write(folder / "load.xml", *load, save_state("loaded")), folder), [])
            loaded = probes(folder / "loaded.pvsm")
            before, both, moved, ended = (probes(folder / f"{name}.pvsm") for name in ("before", "both", "moved", "ended"))
            tabs = [layouts(folder / f"{name}.pvsm") for name in ("before", "both", "ended")]
            links = list(ElementTree.parse(folder / "ended.pvsm").iter("ProxyLink"))
        self.assertEqual([value(each, "MatrixPlane") for each in before + ended], [[VOLUME], [VOLUME]])
        self.assertEqual(sorted(value(each, "MatrixPlane") for each in both), [[FIRST], [SECOND]])
        for name in ("GainDb", "Axial", "Lateral", "PositionMm"):
            self.assertEqual(value(moved[0], name), value(moved[1], name))
        self.assertEqual(value(moved[0], "GainDb"), ["12"])
        self.assertEqual([value(each, "GainDb") for each in loaded], [["7"], ["7"]])
        self.assertEqual(sorted(value(each, "MatrixPlane") for each in loaded), [[FIRST], [SECOND]])
        self.assertNotEqual(value(moved[0], "Lateral"), value(both[0], "Lateral"))
        self.assertEqual(tabs, [["Layout #1"], ["Biplane", "Layout #1"], ["Layout #1"]])
        self.assertEqual(links, [])
        # While it was turned, both followed with coarse pictures, each at the same poses.
        coarse = [{tuple(line["Lateral"]): line["picture"] for line in made if line["preview"] and line["plane"] == plane}
                  for plane in NAMES]
        self.assertGreaterEqual(len(coarse[0]), 3)
        self.assertEqual(set(coarse[0]), set(coarse[1]))
        for each in coarse:
            self.assertEqual(len(set(each.values())), len(each))
        self.assertEqual(made[-1]["plane"], "Volume")
        self.assertEqual(made[-1]["size"][2], 1)

    def test_undo_and_a_trace(self):
        """The trace of another process makes both planes, and the second one follows there, too."""
        trace = menu("menuTools", "actionToolsStartStopTrace")
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            self.play_on_matrix(
                folder, click(BIPLANE), play_on(3000), undo(), play_on(2000), check(BIPLANE, "checked", "false"),
                menu("menu_Edit", "actionEditRedo"), play_on(3000), check(BIPLANE, "checked", "true"), undo(), play_on(2000),
                check(BIPLANE, "checked", "false"), save_state("undone"), select(0, 0), pause(1000), trace,
                click("TraceOptionsDialog/widget/OKButton"), click(BIPLANE), play_on(3000),
                check(BIPLANE, "checked", "true"), click(f"{PROBE}/TiltPlus"), play_on(3000), trace, pause(500),
                event(f"{MAIN}/0pqPythonScriptEditor0/PythonScriptEditorMenuBar/File", "activate", "Save &As..."),
                event(f"{MAIN}/0pqPythonScriptEditor0/FileOpenDialog", "filesSelected", "$PARAVIEW_TEST_ROOT/trace.py"),
                save_state("traced"))
            (undone,), traced = probes(folder / "undone.pvsm"), probes(folder / "traced.pvsm")
            scene = (PLAYBACKS / "biplane.py").read_text().split("log = ")[0]
            (folder / "again.py").write_text(scene + (folder / "trace.py").read_text())
            planes = self.planes_of(folder, "again.py")
            self.assert_planes(planes)
            self.assertEqual(list(planes["gains"]), [20, 20])
        self.assertEqual(value(undone, "MatrixPlane"), [VOLUME])
        self.assertEqual(value(traced[0], "Axial"), value(traced[1], "Axial"))
        self.assertNotEqual(value(traced[0], "Axial"), value(undone, "Axial"))


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
