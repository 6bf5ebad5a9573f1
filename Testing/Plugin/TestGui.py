"""Plays what a new user clicks in ParaView, on a display of its own, and looks at what is left: the saved state and the
messages. Needs Xvfb; run by ctest -L gui."""
import contextlib
import csv
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import xml.etree.ElementTree as ElementTree

from guicase import PLAYBACKS, GuiCase, save_screen

ROOT = PLAYBACKS.parents[2]
BASELINE = PLAYBACKS / "baseline"
GONE = """
view = GetActiveViewOrCreate("RenderView")
ultrasound = SimulateUltrasound(Input=LabelMapReader(FileName=sys.argv[2]), LineCount=12, PathsPerLine=20)
for port in (0, 4):  # the image and the anatomy
    Show(OutputPort(ultrasound, port), view)
Show(OutputPort(ALine(Input=OutputPort(ultrasound, 2)), 2), view)
Render()
SaveState(sys.argv[1])
"""
ELSEWHERE = """
image = servermanager.Fetch(ThoraxPhantom(Spacingmm=4))
image.SetOrigin(image.GetOrigin()[0] + 300, *image.GetOrigin()[1:])
for name in ("A4CPositionMm", "A4CAxial", "A4CLateral"):
    image.GetFieldData().RemoveArray(name)
moved = TrivialProducer()
moved.GetClientSideObject().SetOutput(image)
SaveData(sys.argv[1], proxy=moved)
"""
# What the third place for the liver is, by the filter behind the panel.
THIRD_WINDOW = """
import json
window = AcousticWindow(Input=ThoraxPhantom(Spacingmm=4), Target="liver")
window.UpdatePipeline()
window.SMProxy.UpdatePropertyInformation()
sentence, preset, depth, *pose = window.SMProxy.GetProperty("Rows").GetElement(2).split("\\t")
with open(sys.argv[1], "w", encoding="utf-8") as file:
    json.dump({"sentence": sentence, "place": [float(number) for number in pose[:3]]}, file)
"""
# What the two-chamber view is, likewise.
TWO_CHAMBERS = """
import json
views = StandardViews(Input=ThoraxPhantom(Spacingmm=4))
views.UpdatePipeline()
views.SMProxy.UpdatePropertyInformation()
rows = views.SMProxy.GetProperty("Rows")
row = next(row for row in (rows.GetElement(i) for i in range(rows.GetNumberOfElements())) if row.startswith("A2C"))
sentence, preset, depth, *pose = row.split("\\t")
with open(sys.argv[1], "w", encoding="utf-8") as file:
    json.dump({"sentence": sentence, "place": [float(number) for number in pose[:3]]}, file)
"""
# A rib, something of which nobody knows what it is, and skin, so that nothing is filled.
THREE_LABELS = (b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\nSegment0_Name:=left rib 6\n"
                b"Segment1_Name:=thing\nSegment2_Name:=skin\n\n" + bytes([0, 1, 2, 3] * 16))


class TestGui(GuiCase):
    def compare(self, picture, *tolerance):
        """With the picture of this name in baseline, by OpenImageIO; where they differ, all three are left behind."""
        baseline, left = BASELINE / picture.name, pathlib.Path.cwd() / "gui-differences"
        difference = picture.with_name("difference.png")
        done = subprocess.run(["idiff", *tolerance, "-abs", "-scale", "4", "-o", str(difference), str(picture),
                               str(baseline)], stdout=subprocess.PIPE, text=True)
        if done.returncode > 1:  # 1 is a warning
            left.mkdir(exist_ok=True)
            shutil.copy(picture, left / f"{picture.stem}-image.png")
            for file, name in ((baseline, "reference"), (difference, "difference")):
                if file.exists():
                    shutil.copy(file, left / f"{picture.stem}-{name}.png")
            self.fail(f"{done.stdout}\nThe image, the reference and their difference lie in {left}.")

    def test_chain_with_plain_apply(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(self.play("chain.xml", folder), [])
            state = ElementTree.parse(pathlib.Path(folder, "chain.pvsm"))
        proxies = {proxy.get("id"): proxy for proxy in state.iter("Proxy")}

        def values(proxy, name):
            elements = proxy.findall(f"Property[@name='{name}']/Element")
            return [element.get("value") for element in elements]

        def inputs(proxy):
            return [proxies.get(p.get("value")) for p in proxy.findall("Property[@name='Input']/Proxy")]

        shown = {}
        for proxy in proxies.values():
            if proxy.get("group") == "representations" and values(proxy, "Visibility") == ["1"]:
                for source in inputs(proxy):
                    shown[source.get("type")] = proxy
        # No image of lines lies across the anatomy.
        self.assertEqual(set(shown), {"SonoProbeSource", "SonoSceneBuilder", "SonoScanConverter"})

        picture = shown["SonoScanConverter"]
        self.assertEqual(values(picture, "Representation"), ["Slice"])
        self.assertEqual(values(picture, "ColorArrayName")[-1], "BMode")
        (table,) = (proxies[p.get("value")] for p in picture.findall("Property[@name='LookupTable']/Proxy"))
        colours = [float(value) for value in values(table, "RGBPoints")]
        self.assertEqual(colours[1:4], [0, 0, 0])
        self.assertEqual(colours[-3:], [1, 1, 1])

        scene = shown["SonoSceneBuilder"]
        self.assertEqual(values(scene, "ColorArrayName")[-1], "Color")
        self.assertEqual(values(scene, "MapScalars"), ["0"])
        self.assertLess(float(values(scene, "Opacity")[0]), 0.5)

    def test_layout_at_one_click(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(self.play("layout.xml", folder, f"--data={self.label_map(folder)}"), [])
            picture = pathlib.Path(folder, "layout.png")
            # So many paths that chance hardly shows: processors of another vector width round otherwise, and paths part.
            self.run_script("LoadState(sys.argv[1])\n"
                            "for source in GetSources().values():\n"
                            "    if 'PathsPerLine' in source.ListProperties():\n"
                            "        source.PathsPerLine = 4096\n"
                            "layout = next(l for (name, _), l in GetLayouts().items() if name.startswith('Ultrasound'))\n"
                            "SaveScreenshot(sys.argv[2], layout, SaveAllViews=1, ImageResolution=[600, 340],\n"
                            "               FontScaling='Do not scale fonts')",
                            folder, pathlib.Path(folder, "layout.pvsm"), picture)
            # Fonts and triangles are drawn a little differently from driver to driver.
            self.compare(picture, "-fail", "0.1", "-failpercent", "1")

    def test_the_fan_applies_what_waits(self):
        """So that no later Apply shows a slice of the labels in the body's view."""
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(self.play("fan_first.xml", folder), [])
            state = pathlib.Path(folder, "fan_first.pvsm")
            self.assertEqual(self.values_of(state, "SonoThoraxSource", "SpacingMm"), [4])

    def test_a_click_in_the_flat_image_picks_its_scan_line(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(self.play("pick_line.xml", folder, f"--data={self.label_map(folder)}"), [])
            states = [pathlib.Path(folder, name + ".pvsm") for name in ("picked", "undone", "dragged")]
            picked, undone, dragged = ([self.values_of(state, "SonoALine", "Line") for state in states])
            in_body = pathlib.Path(folder, "in_body.pvsm")
            picked_in_body = self.values_of(in_body, "SonoALine", "Line")
            expected_in_body = self.line_at(*self.place_in_body(in_body, 0.5, 0.47))
            expected = self.line_at(*self.place_in_flat_view(states[0], 0.4, 0.6))
        self.assertAlmostEqual(picked[0], expected, delta=1)  # lines are as narrow as a pixel or two
        self.assertLess(picked[0], 60)
        self.assertEqual(undone, [64])
        self.assertEqual(dragged, picked)
        self.assertAlmostEqual(picked_in_body[0], expected_in_body, delta=1)
        self.assertNotEqual(picked_in_body, picked)

    def test_the_flat_view_fits_itself_until_somebody_zooms(self):
        """To the fan and its ruler at each depth and of each probe; the probe in space stays out of it, and its layout
        is not made twice."""
        with tempfile.TemporaryDirectory() as folder:
            clicked = pathlib.Path(folder, "clicked.pvsm")
            screen = pathlib.Path(folder, "clicked.ppm")
            with self.look_after(clicked, screen, "400x280+735+210", "100%"):
                self.assertEqual(self.play("fit.xml", folder, f"--data={self.label_map(folder)}"), [])
            names = ("first", "deep", "linear", "zoomed", "kept", "reset")
            scales = {name: self.flat_camera(pathlib.Path(folder, name + ".pvsm"))[2] for name in names}
            (width, height), _, _ = self.flat_camera(clicked)
            again = ElementTree.parse(pathlib.Path(folder, "again.pvsm"))
            pixels = screen.read_bytes()[-3 * 400 * 280:]
        chord = 2 * math.sin(math.pi / 4)
        for name, depth, fan in (("first", 160, 160 * chord), ("deep", 300, 300 * chord), ("linear", 40, 38.7),
                                 ("reset", 60, 38.7)):
            seen = max(depth / 2, fan / 2 * height / width)
            self.assertTrue(seen < scales[name] < 1.35 * seen, (name, seen, scales))
        self.assertGreater(abs(scales["zoomed"] / scales["linear"] - 1), 0.05)
        self.assertEqual(scales["kept"], scales["zoomed"])
        # Grey, and the scan line in yellow; nothing as blue or as green as the probe's handles.
        self.assertFalse(any(max(pixels[i + 1], pixels[i + 2]) > pixels[i] + 60 for i in range(0, len(pixels), 3)))
        layouts = [item.get("name") for group in again.iter("ProxyCollection") if group.get("name") == "layouts"
                   for item in group]
        self.assertEqual(layouts, ["Layout #1", "Ultrasound"])

    def test_the_eye_of_the_error_map_shows_it(self):
        """In the body instead of the image, in the flat view as the flat image's colours, and each back again."""
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(self.play("error_eye.xml", folder, f"--data={self.label_map(folder)}"), [])
            states = {name: pathlib.Path(folder, name + ".pvsm") for name in ("map", "image", "flat_map", "flat_image")}
            shown = {name: self.shown_of_ultrasound(state) for name, state in states.items()}
            made = [self.values_of(state, "SonoUltrasound", "ErrorMap") for state in states.values()]
        self.assertEqual(made, [[1]] * 4)
        self.assertEqual([("0" in each, "8" in each) for each in shown.values()], [(False, True)] + [(True, False)] * 3)
        self.assertEqual([each["7"] for each in shown.values()], ["BMode", "BMode", "ErrorPercent", "BMode"])

    def shown_of_ultrasound(self, state):
        """By which array each visible output of Simulate Ultrasound is coloured, by the output's number."""
        tree = ElementTree.parse(state)
        (ultrasound,) = (p for p in tree.iter("Proxy") if p.get("type") == "SonoUltrasound")
        shown = {}
        for proxy in tree.iter("Proxy"):
            for source in proxy.findall("Property[@name='Input']/Proxy"):
                if proxy.get("group") == "representations" and source.get("value") == ultrasound.get("id") and \
                        self.texts(proxy, "Visibility") == ["1"]:
                    shown[source.get("output_port")] = self.texts(proxy, "ColorArrayName")[-1]
        return shown

    def test_what_is_behind_the_camera_or_plots_other_lines_is_left_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(self.play("behind.xml", folder, f"--script={PLAYBACKS / 'behind.py'}"), [])
            clicked, laid_out = (pathlib.Path(folder, name + ".pvsm") for name in ("clicked", "laid_out"))
            self.assertEqual(self.values_of(clicked, "SonoALine", "Line"), [3])
            plots = [p for p in ElementTree.parse(laid_out).iter("Proxy") if p.get("type") == "SonoALine"]
        ports = {proxy.get("output_port") for plot in plots for proxy in plot.findall("Property[@name='Input']/Proxy")}
        self.assertEqual(ports, {"2", "3"})  # RF and traced lines

    @staticmethod
    def line_at(lateral, axial):
        """Of 128 lines over 90 degrees."""
        return round((math.degrees(math.atan2(lateral, axial)) + 45) / 90 * 127)

    def place_in_body(self, state, across, down):
        """Where the image plane is seen at a part of the solid view's width and height: lateral and axial in mm."""
        def dot(a, b):
            return sum(x * y for x, y in zip(a, b))

        def cross(a, b):
            return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]

        def unit(a):
            return [x / math.sqrt(dot(a, a)) for x in a]

        def minus(a, b):
            return [x - y for x, y in zip(a, b)]

        (view,) = (p for p in ElementTree.parse(state).iter("Proxy")
                   if p.get("type") == "RenderView" and self.values(p, "CameraPosition")[1] < -100)
        width, height = self.values(view, "ViewSize")
        camera = self.values(view, "CameraPosition")
        ahead = unit(minus(self.values(view, "CameraFocalPoint"), camera))
        right = unit(cross(ahead, self.values(view, "CameraViewUp")))
        up = cross(right, ahead)
        half = math.tan(math.radians(self.values(view, "CameraViewAngle")[0] / 2))
        x, y = (2 * across - 1) * half * width / height, (1 - 2 * down) * half
        sight = [a + x * r + y * u for a, r, u in zip(ahead, right, up)]
        position, axial, lateral = (self.values_of(state, "SonoUltrasound", name)
                                    for name in ("PositionMm", "Axial", "Lateral"))
        normal = cross(axial, lateral)
        along = dot(minus(position, camera), normal) / dot(sight, normal)
        at = minus([c + along * s for c, s in zip(camera, sight)], position)
        return dot(at, unit(lateral)), dot(at, unit(axial))

    def place_in_flat_view(self, state, across, down):
        """Where a part of the flat view's width and height is in its image: lateral and depth in mm."""
        (width, height), centre, scale = self.flat_camera(state)
        return centre[0] + (across - 0.5) * 2 * scale * width / height, centre[1] + (down - 0.5) * 2 * scale

    def flat_camera(self, state):
        """The flat view's size, and at what it looks with half of which height, in mm."""
        (view,) = (view for view in ElementTree.parse(state).iter("Proxy")
                   if view.get("type") == "RenderView" and self.values(view, "InteractionMode") == [1] and
                   self.values(view, "OrientationAxesVisibility") == [0])
        return (self.values(view, "ViewSize"), self.values(view, "CameraFocalPoint"),
                self.values(view, "CameraParallelScale")[0])

    @staticmethod
    def texts(proxy, name):
        return [e.get("value") for e in proxy.findall(f"Property[@name='{name}']/Element")]

    @classmethod
    def values(cls, proxy, name):
        return [float(text) for text in cls.texts(proxy, name)]

    def texts_of(self, state, kind, name):
        """A property of the only proxy of a kind in a state file."""
        (proxy,) = (p for p in ElementTree.parse(state).iter("Proxy") if p.get("type") == kind)
        return self.texts(proxy, name)

    def values_of(self, state, kind, name):
        return [float(text) for text in self.texts_of(state, kind, name)]

    def test_a_segmentation_is_opened_by_its_own_reader(self):
        """Not by ParaView's for NRRD, which knows neither its segments nor where it lies."""
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "thing.seg.nrrd").write_bytes(THREE_LABELS)
            self.assertEqual(self.play("open_segmentation.xml", folder), [])
            readers = {p.get("type") for p in ElementTree.parse(pathlib.Path(folder, "opened.pvsm")).iter("Proxy")
                       if p.get("group") == "sources"}
        self.assertIn("SonoLabelMapReader", readers)
        self.assertFalse(readers & {"NrrdReader", "PNrrdReader"})

    def test_tissue_editor(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(self.play("tissues.xml", folder, f"--data={self.label_map(folder)}"), [])
            with open(pathlib.Path(folder, "mine_tissues.csv"), encoding="utf-8", newline="") as file:
                tissues = {row["tissue"]: row for row in csv.DictReader(file)}
            with open(pathlib.Path(folder, "mine_labels.csv"), encoding="utf-8", newline="") as file:
                labels = list(csv.DictReader(file))
            state = pathlib.Path(folder, "tissues.pvsm").read_text()
        self.assertEqual(tissues["skin"]["impedance_MRayl"], "1.95")
        self.assertEqual(tissues["fat"]["impedance_MRayl"], "1.38")  # as it was
        self.assertEqual([label["tissue"] for label in labels[:3]], ["air", "skin", "muscle"])
        self.assertEqual([labels[2][column] for column in ("name", "r", "g", "b")], ["belly fat", "10", "200", "30"])
        for file in ("mine_labels.csv", "mine_tissues.csv"):
            self.assertIn(file, state)

    def test_tissues_are_tried_without_files_and_follow_undo(self):
        with tempfile.TemporaryDirectory() as folder:
            errors = self.play("try_tissues.xml", folder, f"--data={self.label_map(folder)}")
            self.assertEqual(errors, [])
            self.assertEqual(list(pathlib.Path(folder).glob("**/*.csv")), [])
            tried, undone, again = (self.texts_of(pathlib.Path(folder, name + ".pvsm"), "SonoSceneBuilder",
                                                  "TissueTableText")[0] for name in ("tried", "undone", "again"))
        skins = [next(csv.DictReader(row for row in text.splitlines() if row.startswith(("tissue,", "skin,"))))
                 for text in (tried, again)]
        self.assertEqual([skin["impedance_MRayl"] == "1.95" for skin in skins], [True, False])
        self.assertEqual(undone, "")

    def test_the_tissue_editor_lists_guesses_first(self):
        with tempfile.TemporaryDirectory() as folder:
            labels, image = (str(pathlib.Path(folder, name)) for name in ("two.nrrd", "two.vti"))
            pathlib.Path(labels).write_bytes(THREE_LABELS)
            script = "SaveData(sys.argv[1], proxy=LabelMapReader(FileName=[sys.argv[2]]))"
            self.run_script(script, folder, image, labels)
            self.assertEqual(self.play("guesses.xml", folder, f"--data={image}"), [])
            with open(pathlib.Path(folder, "mine_labels.csv"), encoding="utf-8", newline="") as file:
                tissues = {row["name"]: row["tissue"] for row in csv.DictReader(file)}
        self.assertEqual(tissues, {"background": "air", "left rib 6": "cortical_bone", "thing": "liver",
                                   "skin": "skin"})

    def test_a_preset_fills_in_the_probes_numbers(self):
        """A bundled one, one of a person's files, and a file that will not do."""
        with tempfile.TemporaryDirectory() as folder:
            preset = (ROOT / "Data/probes/curvilinear_c5-2.json").read_text()
            pathlib.Path(folder, "mine.json").write_text(preset.replace('"value": 150', '"value": 77'))
            pathlib.Path(folder, "bad.json").write_text(preset.replace('"value": 150', '"value": -1'))
            (sentence,) = self.play("presets.xml", folder)
            names = ("ScanKind", "LineCount", "DepthMm", "WidthMm", "RadiusMm", "CentreFrequencyMHz")
            bundled, mine = ([self.values_of(pathlib.Path(folder, state + ".pvsm"), "SonoProbeSource", name)[0]
                              for name in names] for state in ("bundled", "mine"))
        self.assertEqual(bundled, [0, 128, 40, 38.7096, 60, 7.2])
        self.assertEqual(mine, [2, 128, 77, 38, 49.57, 3.57])
        self.assertIn("bad.json", sentence)
        self.assertIn("depthMm", sentence)

    def test_a_chosen_preset_takes_the_place_of_a_named_one(self):
        with tempfile.TemporaryDirectory() as folder:
            errors = self.play("named_preset.xml", folder, f"--script={PLAYBACKS / 'named_preset.py'}")
            self.assertEqual(errors, [])
            reset, chosen = (pathlib.Path(folder, name + ".pvsm") for name in ("reset", "chosen"))
            files = [self.texts_of(state, "SonoProbeSource", "PresetFile") for state in (reset, chosen)]
            depth = self.values_of(chosen, "SonoProbeSource", "DepthMm")
        self.assertEqual(files, [["linear_l14"], [""]])
        self.assertEqual(depth, [160])

    def test_live_shows_the_display_s_settings_and_presets_without_apply(self):
        """A slider's steps are one step of undo, what lies beyond it can be typed, and the rest goes on waiting."""
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(self.play("live.xml", folder, f"--script={PLAYBACKS / 'window.py'}"), [])
            states = [pathlib.Path(folder, name + ".pvsm") for name in ("slid", "undone", "typed", "preset")]
            gains, paths, kinds = ([self.values_of(state, "SonoUltrasound", name)[0] for state in states]
                                   for name in ("GainDb", "PathsPerLine", "ScanKind"))
        self.assertTrue(10 < gains[0] < 20, gains)  # 70 parts of 100 from -40 to 40 dB are 16
        self.assertEqual(gains[1:], [0, 120, 120])
        self.assertEqual(paths, [20, 20, 20, 33])
        self.assertEqual(kinds, [1, 1, 1, 2])

    def test_find_window(self):
        """For an organ that is not there the probe stays where it is. For the liver the button places it on the skin,
        with the probe for it, and offers four other places, to one of which it goes when that is picked."""
        with tempfile.TemporaryDirectory() as folder:
            third = pathlib.Path(folder, "third.json")
            self.run_script(THIRD_WINDOW, folder, third)
            expected = json.loads(third.read_text(encoding="utf-8"))
            script = pathlib.Path(folder, "window.xml")
            script.write_text((PLAYBACKS / script.name).read_text().replace("SENTENCE", expected["sentence"]))
            (sentence,) = self.play(script, folder, f"--script={PLAYBACKS / 'window.py'}")
            states = [pathlib.Path(folder, name + ".pvsm") for name in ("refused", "found", "another")]
            places = [self.probe_of(state, "SonoUltrasound")["PositionMm"] for state in states]
            kinds = [self.values_of(state, "SonoUltrasound", "ScanKind") for state in states]
        self.assertIn("no 'spleen'; it has: heart, liver", sentence)
        self.assertLess(math.dist(places[0], [87.8, -86.5, -45]), 0.1)
        self.assertEqual(kinds, [[1], [2], [2]])
        self.assertLess(places[1][0], 0)  # on the patient's right
        self.assertGreater(math.dist(places[0], places[1]), 40)
        self.assertGreaterEqual(math.dist(places[1], places[2]), 40)  # so far apart are those that are offered
        self.assertLess(math.dist(places[2], expected["place"]), 1e-3)

    def test_reset_goes_to_the_first_pose_of_the_body_that_is_shown(self):
        """Of a body 300 mm from the bundled one, which brings no pose along."""
        with tempfile.TemporaryDirectory() as folder:
            self.run_script(ELSEWHERE, folder, pathlib.Path(folder, "elsewhere.vti"))
            script = pathlib.Path(folder, "window.py")
            script.write_text((PLAYBACKS / script.name).read_text().replace(
                'ThoraxPhantom(registrationName="thorax", Spacingmm=4)',
                'LabelMapReader(registrationName="thorax", FileName=["elsewhere.vti"])'))
            self.assertEqual(self.play("reset.xml", folder, f"--script={script}"), [])
            first, turned, reset = (self.probe_of(pathlib.Path(folder, name + ".pvsm"), "SonoUltrasound")
                                    for name in ("first", "turned", "reset"))
        self.assertGreater(first["PositionMm"][0], 200)
        self.assertNotEqual(turned["Axial"], first["Axial"])
        self.assertLess(math.dist(reset["PositionMm"], first["PositionMm"]), 1e-3)
        self.assertLess(math.dist(reset["Axial"], first["Axial"]), 1e-4)

    def test_standard_views_are_offered_by_name(self):
        """A search moves nothing; the view that is chosen then does."""
        with tempfile.TemporaryDirectory() as folder:
            view = pathlib.Path(folder, "view.json")
            self.run_script(TWO_CHAMBERS, folder, view)
            expected = json.loads(view.read_text(encoding="utf-8"))
            script = pathlib.Path(folder, "views.xml")
            script.write_text((PLAYBACKS / script.name).read_text().replace("SENTENCE", expected["sentence"]))
            self.assertEqual(self.play(script, folder, f"--script={PLAYBACKS / 'window.py'}"), [])
            states = [pathlib.Path(folder, name + ".pvsm") for name in ("searched", "chosen")]
            places = [self.probe_of(state, "SonoUltrasound")["PositionMm"] for state in states]
        self.assertLess(math.dist(places[0], [87.8, -86.5, -45]), 0.1)
        self.assertLess(math.dist(places[1], expected["place"]), 1e-3)
        self.assertGreater(math.dist(*places), 1)

    def test_probe_is_dragged_along_the_skin(self):
        """With real mouse events: it slides, the picture follows, a button tilts it. Undo takes back that and the
        drag, and redo drags again."""
        with tempfile.TemporaryDirectory() as folder:
            states = [pathlib.Path(folder, name + ".pvsm") for name in ("dragged", "tilted", "before", "undone")]
            seen = pathlib.Path(folder, "drag_probe.png")
            with self.look_after(states[-1], seen):
                errors = self.play("drag_probe.xml", folder, f"--script={PLAYBACKS / 'drag_probe.py'}")
            self.assertEqual(errors, [])
            dragged, tilted, before, undone = map(self.probe_of, states)
            self.compare(seen, "-fail", "0.15", "-failpercent", "1", "-hardfail", "2")
        self.assertEqual(undone, dragged)
        self.assertEqual(before["PositionMm"], [87.8, -86.5, -45])
        self.assertNotEqual(dragged["PositionMm"], before["PositionMm"])
        self.assertEqual(tilted["PositionMm"], dragged["PositionMm"])
        self.assertAlmostEqual(sum(a * b for a, b in zip(tilted["Axial"], dragged["Axial"])),
                               math.cos(math.radians(5)), places=6)
        for state in (dragged, tilted):
            self.assertEqual(state["Preview"], [0])  # at rest

    def test_one_filter_is_dragged_along_the_skin(self):
        """Coarse while the button is down, in full when it rests."""
        with tempfile.TemporaryDirectory() as folder:
            states = [pathlib.Path(folder, name + ".pvsm") for name in ("moving", "rested")]
            seen = [pathlib.Path(folder, f"drag_ultrasound_{name}.png") for name in ("moving", "rested")]
            with self.look_after(states[0], seen[0]), self.look_after(states[1], seen[1]):
                errors = self.play("drag_ultrasound.xml", folder, f"--script={PLAYBACKS / 'drag_ultrasound.py'}")
            self.assertEqual(errors, [])
            moving, rested = (self.probe_of(state, "SonoUltrasound") for state in states)
            prepared = set(pathlib.Path(folder, "prepared.txt").read_text().splitlines())
            for picture in seen:
                self.compare(picture, "-fail", "0.15", "-failpercent", "1", "-hardfail", "2")
        self.assertEqual(len(prepared), 1)  # the anatomy is made ready at first, not for each step, nor at rest
        self.assertEqual((moving.pop("Preview"), rested.pop("Preview")), ([1], [0]))
        self.assertEqual(moving, rested)
        self.assertNotEqual(rested["PositionMm"], [87.8, -86.5, -45])

    def test_a_resting_probe_s_picture_gets_better(self):
        """With a target error: of few paths on the way and when the button goes up, of more each time after that."""
        with tempfile.TemporaryDirectory() as folder:
            errors = self.play("drag_ultrasound.xml", folder, f"--script={PLAYBACKS / 'refine.py'}")
            rounds = [line.split() for line in pathlib.Path(folder, "rounds.txt").read_text().splitlines()]
        self.assertEqual(errors, [])
        paths = [int(number) for number, _ in rounds if number != "0"]
        rested = len(paths) - paths[::-1].index(40)  # after the last on the way
        pictures = list(dict.fromkeys(paths[rested:]))  # each for several outputs
        self.assertEqual(pictures[0], 64)
        self.assertGreater(len(pictures), 2)
        self.assertEqual(pictures, sorted(pictures))
        self.assertTrue(pictures[-1] == 8192 or 0 < float(rounds[-1][1]) <= 0.2, rounds[-1])

    @contextlib.contextmanager
    def look_after(self, path, seen, *cut):
        """Photographs the screen three seconds after a file has appeared."""
        def look():
            for _ in range(3000):
                if path.exists():
                    time.sleep(3)
                    save_screen(seen, self.frame_buffer, *cut)
                    return
                time.sleep(0.1)

        watcher = threading.Thread(target=look)
        watcher.start()
        yield
        watcher.join()

    @staticmethod
    def probe_of(path, kind="SonoProbeSource"):
        """The pose in a state file."""
        (probe,) = (p for p in ElementTree.parse(path).iter("Proxy") if p.get("type") == kind)
        return {name: TestGui.values(probe, name)
                for name in ("PositionMm", "Axial", "Lateral", "Preview")}

    def test_bad_input_gives_one_sentence(self):
        with tempfile.TemporaryDirectory() as folder:
            (sentence,) = self.play("no_labels.xml", folder)
        self.assertIn("'RTData' holds no labels", sentence)

    def test_state_whose_data_are_gone_gives_one_sentence(self):
        """By File > Load State, of a scene that shows image, anatomy and a line."""
        with tempfile.TemporaryDirectory() as folder:
            self.run_script(GONE, folder, pathlib.Path(folder, "gone.pvsm"), self.label_map(folder))
            pathlib.Path(folder, "thorax.vti").unlink()
            (sentence,) = self.play("load_state.xml", folder)
        self.assertIn("thorax.vti is missing", sentence)
        self.assertIn("name a label map", sentence)


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
