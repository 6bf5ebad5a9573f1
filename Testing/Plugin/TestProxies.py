"""Every filter has a proxy with the class's defaults, a documented property for each setting, and a place in the menus."""
import os
import pathlib
import sys
import unittest
import xml.etree.ElementTree as ElementTree

from paraview import servermanager, simple
from sonovdb import vtkSonoFilters
from vtkmodules.vtkCommonCore import reference

simple.LoadPlugin(os.environ["SONOVDB_PLUGIN"], remote=False, ns=vars(simple))

XML_FOLDER = pathlib.Path(os.environ["SONOVDB_DESCRIPTIONS"])
# What others derive from, what works for a panel, what a loop in Python gets.
NO_PROXIES = {"vtkSonoFrameWriter", "vtkSonoPhasesAhead", "vtkSonoGpuImage", "vtkSonoGpuTexture"}
CLASSES = {name: kind for name, kind in vars(vtkSonoFilters).items() if name.startswith("vtkSono")}
for name in NO_PROXIES:
    del CLASSES[name]
VECTOR_PROPERTIES = ("IntVectorProperty", "DoubleVectorProperty", "StringVectorProperty")


def described(class_name):
    """The <SourceProxy>, <WriterProxy> or plain <Proxy> of a class and its group."""
    group = ElementTree.parse(XML_FOLDER / f"{class_name}.xml").getroot().find("ProxyGroup")
    return group.get("name"), next(e for e in group if e.tag in ("SourceProxy", "WriterProxy", "Proxy"))


STAGES = ("SceneBuilder", "Probe", "RayTracer", "ImageFormation", "BMode", "ScanConverter")
# Labels that say something else than the name: what an input is, ParaView's own property, a word that a unit hides.
OTHER_LABELS = {("SonoRayTracer", "Input"), ("SonoSceneWriter", "Input"), ("SonoScanDetail", "SelectInputScalars"), ("SonoSceneBuilder", "SelectInputScalars"),
                ("SonoUltrasound", "SelectInputScalars"), ("SonoSweep", "SelectInputScalars"),
                ("SonoImageFormation", "Field"), ("EchoPictureWriter", "Input"), ("SonoDicomWriter", "Input"), ("SonoLineWriter", "Input"), ("SonoTrackedWriter", "Input"),
                ("EchoPictureWriter", "SelectInputScalars")}


def exposed():
    """The names of the stages' settings on Simulate Ultrasound."""
    root = ElementTree.parse(XML_FOLDER / "vtkSonoUltrasound.xml").getroot()
    return {element.get("name") for element in root.iterfind(".//ExposedProperties//Property")}


def plain(text):
    """Letters and digits in lower case."""
    return "".join(c for c in text.lower() if c.isalnum())


def values(value):
    return list(value) if isinstance(value, (tuple, list)) else [value]


def slider(shown):
    """From where to where a panel's slider reaches; None without one."""
    domain = shown.GetDomain("range") if shown.IsA("vtkSMVectorProperty") and shown.GetNumberOfElements() == 1 else None
    if not domain or not domain.GetMinimumExists(0) or not domain.GetMaximumExists(0):
        return None
    return domain.GetMinimum(0, reference(0)), domain.GetMaximum(0, reference(0))


class TestProxies(unittest.TestCase):
    def proxies(self):
        manager = servermanager.ProxyManager()
        for name in CLASSES:
            group, description = described(name)
            yield manager.NewProxy(group, description.get("name"))

    def each(self):
        for name, kind in CLASSES.items():
            with self.subTest(filter=name):
                yield kind, *described(name)

    def test_there_is_a_class_to_test(self):
        self.assertEqual(len(CLASSES), 41)

    def test_every_proxy_can_be_created(self):
        manager = servermanager.ProxyManager()
        for kind, group, description in self.each():
            proxy = manager.NewProxy(group, description.get("name"))
            self.assertIsNotNone(proxy)
            proxy.UpdateVTKObjects()
            self.assertTrue(proxy.GetClientSideObject().IsA(kind.__name__))

    def test_defaults_equal_the_classes(self):
        manager = servermanager.ProxyManager()
        for kind, group, description in self.each():
            proxy, fresh = manager.NewProxy(group, description.get("name")), kind()
            for element in (e for e in description if e.tag in VECTOR_PROPERTIES):
                name = element.get("name")
                if element.get("command") != "Set" + name:
                    continue
                with self.subTest(setting=name):
                    shown = proxy.GetProperty(name)
                    shown = [shown.GetElement(i) for i in range(shown.GetNumberOfElements())]
                    self.assertEqual(shown, values(getattr(fresh, "Get" + name)()))

    def test_every_setting_has_a_property_and_the_other_way_round(self):
        for kind, _, description in self.each():
            commands = {e.get("command") for e in description}
            methods = {name for name in vars(kind) if name.startswith("Set")}
            settings = {name for name in methods if "Get" + name[3:] in vars(kind)}
            own = {"Set" + name for name in STAGES} if kind.__name__ == "vtkSonoUltrasound" else set()
            self.assertEqual(settings - own - commands, set())
            for element in (e for e in description if e.tag in VECTOR_PROPERTIES and not e.get("information_only")):
                with self.subTest(property=element.get("name")):
                    self.assertTrue(hasattr(kind, element.get("command")))

    def test_names_are_alike_in_cpp_xml_and_python(self):
        """ParaView makes Python's names of the labels, without all that is neither letter nor digit."""
        for _, _, description in self.each():
            for element in (e for e in description if e.tag in VECTOR_PROPERTIES + ("InputProperty",)):
                name, label, command = (element.get(key) or element.get("name") for key in ("name", "label", "command"))
                if element.get("information_only") or (description.get("name"), name) in OTHER_LABELS:
                    continue
                with self.subTest(property=name):
                    self.assertIn(plain(name), (plain(label), plain(label.partition("(")[0])))
                    if element.tag != "InputProperty" and not element.get("repeat_command"):
                        self.assertEqual(command, "Set" + name)

    def test_every_property_is_documented_and_has_its_number_of_elements(self):
        for _, _, description in self.each():
            for element in (e for e in description if e.tag.endswith("Property") and e.tag != "Property"):
                with self.subTest(property=element.get("name")):
                    self.assertTrue(element.findtext("Documentation", "").strip())
                    self.assertTrue(element.tag == "InputProperty" or element.get("number_of_elements"))

    def shown(self):
        """The properties that a panel shows, with their tooltips."""
        for _, _, description in self.each():
            for element in (e for e in description if e.tag in VECTOR_PROPERTIES + ("InputProperty",)):
                if not element.get("information_only") and element.get("panel_visibility") != "never":
                    with self.subTest(property=element.get("name")):
                        yield element, " ".join(element.findtext("Documentation", "").split())

    def test_every_tooltip_is_a_sentence(self):
        for _, tooltip in self.shown():
            self.assertRegex(tooltip, r"^[A-Z].*\w+ \w+ \w+.*\.$")

    def test_every_number_has_a_unit_and_a_range(self):
        """In its tooltip, and a domain that the panel keeps to."""
        numbers = 0
        for element, tooltip in self.shown():
            domains = {child.tag for child in element}
            if element.tag in ("IntVectorProperty", "DoubleVectorProperty") and \
                    not domains & {"EnumerationDomain", "BooleanDomain"}:
                numbers += 1
                self.assertTrue(domains & {"IntRangeDomain", "DoubleRangeDomain"})
                self.assertRegex(tooltip, r"\b(mm|cm|dB|kPa|MHz|m/s|degrees|seconds|a minute|no unit)\b")
                self.assertRegex(tooltip, r"\d|any place")
        self.assertGreater(numbers, 60)

    def test_sliders_reach_as_far_as_a_scanner_s(self):
        """On each filter that has the setting; what is valid beyond them is taken all the same."""
        sliders = {"GainDb": (-40, 40), "DynamicRangeDb": (20, 100), "TgcDbPerCm": (0, 10), "SectorDeg": (10, 120),
                   "LineCount": (16, 512), "PathsPerLine": (1, 4096)}
        found = 0
        for proxy in self.proxies():
            for name, ends in sliders.items():
                if proxy.GetProperty(name):
                    found += 1
                    self.assertEqual(slider(proxy.GetProperty(name)), ends)
        self.assertGreaterEqual(found, 12)
        louder = CLASSES["vtkSonoBMode"]()
        louder.SetGainDb(120)
        self.assertEqual(louder.GetGainDb(), 120)

    def test_every_slider_has_the_default_on_it(self):
        sliders = 0
        for proxy in self.proxies():
            properties = proxy.NewPropertyIterator()
            while not properties.IsAtEnd():
                shown, name = properties.GetProperty(), properties.GetKey()
                properties.Next()
                ends = slider(shown)
                if ends:
                    sliders += 1
                    self.assertTrue(ends[0] <= shown.GetElement(0) <= ends[1], (proxy.GetXMLName(), name))
        self.assertGreater(sliders, 100)

    def test_simple_panels_are_short(self):
        """What few people touch is advanced: of Simulate Ultrasound's settings the most."""
        proxy = servermanager.ProxyManager().NewProxy("filters", "SonoUltrasound")
        shown = [proxy.GetProperty(name).GetPanelVisibility() for name in exposed()]
        self.assertGreater(len(shown), 50)
        self.assertLess(shown.count("default"), 0.5 * len(shown))

    def test_a_preset_stands_above_the_numbers_that_it_fills_in(self):
        for kind in ("vtkSonoProbeSource", "vtkSonoUltrasound"):
            root = ElementTree.parse(XML_FOLDER / f"{kind}.xml").getroot()
            names = [element.get("name") for element in root.iter() if element.get("name")]
            with self.subTest(filter=kind):
                for filled in ("DepthMm", "ScanKind", "CentreFrequencyMHz"):
                    self.assertLess(names.index("PresetFile"), names.index(filled))

    def test_simulate_ultrasound_has_the_settings_of_its_stages(self):
        """As they describe them: with their labels and tooltips, and all of them, but for what the filter sets."""
        manager = servermanager.ProxyManager()
        proxy = manager.NewProxy("filters", "SonoUltrasound")
        proxy.UpdateVTKObjects()
        set_here = {"Device", "SelectInputScalars", "PresetFile"}  # formation's device; the labels' array
        for stage in STAGES:
            group, description = described(getattr(proxy.GetClientSideObject(), "Get" + stage)().GetClassName())
            alone = manager.NewProxy(group, description.get("name"))
            for element in description:
                name = element.get("name")
                if element.tag not in VECTOR_PROPERTIES or name in set_here:
                    continue
                with self.subTest(stage=stage, property=name):
                    shown, expected = proxy.GetProperty(name), alone.GetProperty(name)
                    self.assertIsNotNone(shown)
                    self.assertEqual(shown.GetXMLLabel(), expected.GetXMLLabel())
                    self.assertEqual(shown.GetDocumentation().GetDescription(),
                                     expected.GetDocumentation().GetDescription())
                    self.assertEqual(shown.GetDomain("range") is None, expected.GetDomain("range") is None)

    def test_simulate_ultrasound_starts_as_in_cpp(self):
        """The stages that a fresh proxy hands to the filter have the defaults of a fresh filter's own."""
        proxy, fresh = servermanager.ProxyManager().NewProxy("filters", "SonoUltrasound"), CLASSES["vtkSonoUltrasound"]()
        proxy.UpdateVTKObjects()
        differ = set()
        for stage in STAGES:
            inner, own = getattr(proxy.GetClientSideObject(), "Get" + stage)(), getattr(fresh, "Get" + stage)()
            self.assertIsNot(inner, own)
            alone = CLASSES[own.GetClassName()]()
            for name in vars(type(own)):
                if name.startswith("Get") and "Set" + name[3:] in vars(type(own)):
                    with self.subTest(stage=stage, setting=name[3:]):
                        self.assertEqual(getattr(inner, name)(), getattr(own, name)())
                        if name[3:] in exposed():
                            shown = proxy.GetProperty(name[3:])
                            self.assertEqual([shown.GetElement(i) for i in range(shown.GetNumberOfElements())],
                                             values(getattr(own, name)()))
                    if getattr(own, name)() != getattr(alone, name)():
                        differ.add(name[3:])
        self.assertEqual(differ, {"MaxCollisions", "CoherenceMm", "LobeSigmaDeg", "TgcDbPerCm"})

    def test_a_ruler_beside_ultrasound_counts_mm(self):
        view = simple.CreateView("RenderView")
        alone = simple.Show(simple.Ruler(), view).LabelFormat
        source = simple.ThoraxPhantom()
        beside = simple.Show(simple.Ruler(), view).LabelFormat
        simple.Delete(source)
        self.assertNotIn("mm", alone)
        self.assertEqual(beside, "%.1f mm")

    def test_every_filter_is_in_the_ultrasound_menu(self):
        for _, _, description in self.each():
            if description.tag == "SourceProxy":
                self.assertEqual(description.find("Hints/ShowInMenu").get("category"), "Ultrasound")


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
