"""Every filter has a proxy with the class's defaults, a documented property for each setting, and a place in the menus."""
import os
import pathlib
import sys
import unittest
import xml.etree.ElementTree as ElementTree

from paraview import servermanager, simple
from sonovdb import vtkSonoFilters

simple.LoadPlugin(os.environ["SONOVDB_PLUGIN"], remote=False, ns=vars(simple))

XML_FOLDER = pathlib.Path(__file__).resolve().parents[2] / "Plugin"
CLASSES = {name: kind for name, kind in vars(vtkSonoFilters).items() if name.startswith("vtkSono")}
VECTOR_PROPERTIES = ("IntVectorProperty", "DoubleVectorProperty", "StringVectorProperty")


def described(class_name):
    """The <SourceProxy>, <WriterProxy> or plain <Proxy> of a class and its group."""
    group = ElementTree.parse(XML_FOLDER / f"{class_name}.xml").getroot().find("ProxyGroup")
    return group.get("name"), next(e for e in group if e.tag in ("SourceProxy", "WriterProxy", "Proxy"))


def values(value):
    return list(value) if isinstance(value, (tuple, list)) else [value]


class TestProxies(unittest.TestCase):
    def each(self):
        for name, kind in CLASSES.items():
            with self.subTest(filter=name):
                yield kind, *described(name)

    def test_there_is_a_class_to_test(self):
        self.assertEqual(len(CLASSES), 21)

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

    def test_curve_is_empty_by_default(self):
        proxy = servermanager.ProxyManager().NewProxy("filters", "SonoBMode")
        self.assertEqual(proxy.GetProperty("TgcPoints").GetNumberOfElements(), 0)
        self.assertEqual(vtkSonoFilters.vtkSonoBMode().GetNumberOfTgcPoints(), 0)

    def test_every_setting_has_a_property(self):
        for kind, _, description in self.each():
            commands = {e.get("command") for e in description}
            settings = {name for name in vars(kind) if name.startswith("Set") and "Get" + name[3:] in vars(kind)}
            self.assertEqual(settings - commands, set())

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
                self.assertRegex(tooltip, r"\b(mm|cm|dB|MHz|degrees|no unit)\b")
                self.assertRegex(tooltip, r"\d|any place")
        self.assertGreater(numbers, 80)

    def test_simple_panels_are_short(self):
        """What few people touch is advanced: of Simulate Ultrasound's settings the most."""
        element = described("vtkSonoUltrasound")[1]
        own = [e for e in element if e.tag in VECTOR_PROPERTIES]
        simple_ones = [e for e in own if not e.get("panel_visibility")]
        self.assertLess(len(simple_ones), 0.5 * len(own))

    def test_simulate_ultrasound_describes_settings_as_the_stages_do(self):
        """Labels, ranges and tooltips are those of the stage whose setting it is; some defaults differ."""
        stages = ("SceneBuilder", "ProbeSource", "ImageFormation", "RayTracer", "BMode", "ScanConverter")
        theirs = {element.get("name"): element for stage in stages
                  for element in described("vtkSono" + stage)[1] if element.tag in VECTOR_PROPERTIES}
        defaults = {"MaxCollisions", "CoherenceMm", "LobeSigmaDeg", "TgcDbPerCm"}
        own = [element for element in described("vtkSonoUltrasound")[1] if element.tag in VECTOR_PROPERTIES]
        self.assertGreater(len(own), 50)

        def text(element):
            # Which of them are advanced is this filter's own choice.
            hidden = ("panel_visibility",) + (("default_values",) if element.get("name") in defaults else ())
            attributes = {key: value for key, value in element.attrib.items() if key not in hidden}
            return [element.tag, attributes, (element.text or "").strip(), [text(child) for child in element]]

        for element in own:
            with self.subTest(property=element.get("name")):
                if element.get("name") not in ("Seed", "ErrorMap"):  # which seeds two stages, which switches one on
                    self.assertEqual(text(element), text(theirs[element.get("name")]))

    def test_every_filter_is_in_the_ultrasound_menu(self):
        for _, _, description in self.each():
            if description.tag == "SourceProxy":
                self.assertEqual(description.find("Hints/ShowInMenu").get("category"), "Ultrasound")


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
