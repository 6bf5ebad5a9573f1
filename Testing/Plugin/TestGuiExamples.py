"""What a new user meets first: the examples of the toolbar, a label map's own colours, and Delete. Needs Xvfb; run by
ctest -L gui."""
import json
import pathlib
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

from guicase import PLAYBACKS, GuiCase, bytes_of

# Of each Simulate Ultrasound of a state, in the order in which they were made: the shares of the flat image's labels, and the
# greys.
ASK = """
import json
from vtkmodules.util.numpy_support import vtk_to_numpy
LoadState(sys.argv[1])
found = []
for (name, _), source in sorted(GetSources().items(), key=lambda item: (len(item[0][0]), item[0][0])):
    if source.GetXMLName() != "SonoUltrasound":
        continue
    source.UpdatePipeline()
    image = source.SMProxy.GetClientSideObject().GetOutputDataObject(7)
    field, data = image.GetFieldData(), image.GetPointData()
    names = {field.GetArray("LabelIds").GetValue(i): field.GetAbstractArray("LabelNames").GetValue(i)
             for i in range(field.GetArray("LabelIds").GetNumberOfTuples())}
    mask, labels, greys = (data.GetArray(name) for name in ("Mask", "Labels", "BMode"))
    inside = vtk_to_numpy(mask) > 0
    labels, greys = vtk_to_numpy(labels)[inside], vtk_to_numpy(greys)[inside]
    shares = {names.get(int(id), "nothing"): float((labels == id).mean()) for id in set(labels.tolist())}
    found.append({"shares": shares, "mean": float(greys.mean()), "bright": sorted(greys.tolist())[len(greys) * 99 // 100],
                  "targets": bool(source.Targets)})
with open(sys.argv[2], "w", encoding="utf-8") as file:
    json.dump(found, file)
"""
# A slice of a label map as ParaView shows it by itself, and the colours that its labels have.
SLICE = """
import json
thorax = ThoraxPhantom(Spacingmm=2)
view = CreateView("RenderView")
view.UseColorPaletteForBackground = 0
view.Background = [0, 0, 0]
view.OrientationAxesVisibility = 0
Show(thorax, view)
ResetCamera(view)
SaveScreenshot(sys.argv[1], view, ImageResolution=[400, 400])
field = thorax.SMProxy.GetClientSideObject().GetOutputDataObject(0).GetFieldData()
colors = field.GetArray("LabelColors")
with open(sys.argv[2], "w", encoding="utf-8") as file:
    json.dump([colors.GetTuple(i) for i in range(colors.GetNumberOfTuples())], file)
"""


def proxies(state):
    return [p.get("type") for p in ElementTree.parse(state).iter("Proxy")]


class TestGuiExamples(GuiCase):
    def picture_of(self, example):
        """What ASK finds in the example's state, which raised nothing."""
        with tempfile.TemporaryDirectory() as folder:
            script, found = pathlib.Path(folder, "example.xml"), pathlib.Path(folder, "found.json")
            script.write_text((PLAYBACKS / script.name).read_text().replace("EXAMPLE", example))
            self.assertEqual(self.play(script, folder), [])
            self.run_script(ASK, folder, pathlib.Path(folder, "example.pvsm"), found)
            (picture,) = json.loads(found.read_text(encoding="utf-8"))
        self.assertTrue(20 < picture["mean"] < 140, picture)
        self.assertGreater(picture["bright"], 120)
        self.assertEqual(picture["targets"], example in ("Phantom", "Needle"))
        return picture["shares"]

    def test_each_example_shows_what_it_is_called(self):
        heart = self.picture_of("Heart")
        for chamber in ("left_ventricle", "right_ventricle", "left_atrium", "right_atrium"):
            self.assertGreater(heart[chamber + "_blood"], 0.02)
        thyroid = self.picture_of("Thyroid")
        self.assertGreater(thyroid["thyroid_gland"], 0.1)
        self.assertGreater(thyroid["nodule"], 0.01)
        self.assertGreater(thyroid["carotid_jugular_blood"], 0.01)
        for example, most in (("Liver", "liver"), ("Lung", "lung_right"), ("Needle", "liver")):
            shares = self.picture_of(example)
            self.assertEqual(max(shares, key=shares.get), most)
        phantom = self.picture_of("Phantom")
        self.assertGreater(sum(share for name, share in phantom.items() if name.startswith("phantom")), 0.8)
        self.assertGreater(1 - phantom["phantom_gel"] - phantom.get("nothing", 0), 0.02)

    def test_a_label_map_is_shown_in_its_labels_colours(self):
        """But where one pixel shows the border of two."""
        with tempfile.TemporaryDirectory() as folder:
            picture, colors = (pathlib.Path(folder, name) for name in ("slice.png", "colors.json"))
            self.run_script(SLICE, folder, picture, colors)
            known = {tuple(round(255 * part) for part in color) for color in json.loads(colors.read_text())} - {(0, 0, 0)}
            data = bytes_of(picture, 3 * 400 * 400)
        seen = [tuple(data[i:i + 3]) for i in range(0, len(data), 3)]
        inside = [pixel for pixel in seen if pixel != (0, 0, 0)]
        own = [pixel for pixel in inside if pixel in known]
        self.assertGreater(len(inside), 20000)
        self.assertGreater(len(own), 0.9 * len(inside))
        self.assertGreater(len(set(own)), 12)

    def test_delete_leaves_nothing_without_its_input(self):
        """The panel's button is grey while flat views depend on a filter; the tree goes as a whole, and comes back so."""
        with tempfile.TemporaryDirectory() as folder:
            data = self.label_map(folder)
            done = self.paraview(folder, f"--test-script={pathlib.Path(__file__).parent / 'gui' / 'delete.xml'}",
                                 f"--data={data}", "--exit")
            self.assertEqual(done.returncode, 0, done.stdout)
            self.assertNotIn("property value is", done.stdout)
            for sign in ("ERR|", "critical: In ./Qt/Core", "not registered"):
                self.assertNotIn(sign, done.stdout)
            before, deleted, undone = (proxies(pathlib.Path(folder, name + ".pvsm"))
                                       for name in ("before", "deleted", "undone"))
        for kind in ("SonoUltrasound", "SonoALine", "SonoFlatScale", "SonoFlatText"):
            self.assertEqual([before.count(kind), deleted.count(kind), undone.count(kind)], [1, 0, 1], kind)


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
