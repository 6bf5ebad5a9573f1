"""Plays what a new user clicks in ParaView, on a display of its own, and looks at what is left: the saved state and the
messages. Needs Xvfb; run by ctest -L gui."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

PLAYBACKS = pathlib.Path(__file__).resolve().parent / "gui"
PLUGIN = pathlib.Path(os.environ["SONOVDB_PLUGIN"])


class TestGui(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        reading, writing = os.pipe()
        cls.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(writing), "-screen", "0", "1400x900x24", "+extension", "GLX"],
            pass_fds=[writing], stderr=subprocess.DEVNULL)
        os.close(writing)
        with os.fdopen(reading) as number:
            cls.display = ":" + number.readline().strip()

    @classmethod
    def tearDownClass(cls):
        cls.server.terminate()
        cls.server.wait()

    def play(self, name, folder):
        """Plays one script; the lines that ParaView calls errors."""
        environment = dict(os.environ, DISPLAY=self.display, HOME=folder, XDG_RUNTIME_DIR=folder)
        done = subprocess.run(
            ["paraview", "--dr", f"--plugin-search-paths={PLUGIN.parent}", "--plugins=SonoVDB",
             f"--test-directory={folder}", f"--test-script={PLAYBACKS / name}", "--exit"],
            env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=400)
        self.assertEqual(done.returncode, 0, done.stdout)
        return [line for line in done.stdout.splitlines() if "ERR|" in line]

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

    def test_bad_input_gives_one_sentence(self):
        with tempfile.TemporaryDirectory() as folder:
            (sentence,) = self.play("no_labels.xml", folder)
        self.assertIn("'RTData' holds no labels", sentence)


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
