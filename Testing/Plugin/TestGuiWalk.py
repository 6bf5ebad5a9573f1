"""From a folder of masks to the picture with the events of a real mouse, each click counted, and what is on
the screen when. Needs Xvfb and python3-xlib; run by ctest -L gui."""
import json
import pathlib
import sys
import tempfile
import threading
import time
import unittest

from guicase import PLAYBACKS, GuiCase, read_screen, save_screen
from person import Person

# The thorax as a segmentation tool leaves it: a mask a structure, neither skin nor what lies between the organs.
MASKS = """
import gzip
import numpy
from paraview.vtk.util.numpy_support import vtk_to_numpy
image = servermanager.Fetch(ThoraxPhantom(Spacingmm=4))
labels = vtk_to_numpy(image.GetPointData().GetArray("Labels"))
ids, names = (image.GetFieldData().GetAbstractArray(name) for name in ("LabelIds", "LabelNames"))
header = ("NRRD0004\\ntype: uint8\\ndimension: 3\\nsizes: %d %d %d\\nencoding: gzip\\nspace: left-posterior-superior\\n"
          "space directions: (%g,0,0) (0,%g,0) (0,0,%g)\\nspace origin: (%g,%g,%g)\\n\\n"
          % (*image.GetDimensions(), *image.GetSpacing(), *image.GetOrigin())).encode()
os.makedirs(sys.argv[1])
for row in range(names.GetNumberOfValues()):
    name = names.GetValue(row)
    if name not in ("background", "skin", "muscle") and "fat" not in name:
        mask = (labels == ids.GetValue(row)).astype(numpy.uint8)
        with open(os.path.join(sys.argv[1], name + ".nrrd"), "wb") as file:
            file.write(header + gzip.compress(mask.tobytes()))
"""
# Where things are on the screen, and what of them has a colour once they can be clicked.
OPEN = (29, 42)  # the toolbar's button
FOLDER, FOLDER_ICON = (437, 213), (403, 213)  # the first row of the dialog
OK = (856, 487)
APPLY, APPLY_EDGE = (60, 424), (15, 424)
FAN = (757, 122)
FLAT_VIEW = (735, 210, 400, 280)  # left, top, width, height; messages may lie below
AWAY = (1390, 890)
WINDOW = "1152x762+0+0"


class TestGuiWalk(GuiCase):
    def test_from_a_folder_of_masks_to_the_picture(self):
        """Open, the folder, OK, Apply, the fan: five clicks."""
        failures, greys = [], []
        with tempfile.TemporaryDirectory() as folder:
            self.run_script(MASKS, folder, pathlib.Path(folder, "segmentations"))
            person = Person(self, folder)

            def walk():
                try:
                    for place, coloured in ((OPEN, OPEN), (FOLDER, FOLDER_ICON), (OK, FOLDER_ICON), (APPLY, APPLY_EDGE),
                                            (FAN, FAN)):
                        person.await_colour(*coloured)
                        time.sleep(2)  # it moves no more, and a hand takes as long
                        person.click(*place)
                        person.move(*AWAY)
                    greys.append(self.await_picture(person))
                    self.await_still(person)
                    save_screen(pathlib.Path.cwd() / "walk.png", self.frame_buffer, WINDOW, "100%")
                except Exception as failure:  # to be told by the test, not by the thread
                    failures.append(failure)
                person.move(600, 400)  # where the keys go
                person.press_quit()

            walking = threading.Thread(target=walk)
            walking.start()
            done = self.paraview(folder)
            person.ended.set()
            walking.join()
        self.assertEqual(failures, [], done.stdout)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertNotIn("ERR|", done.stdout)
        self.assertEqual(done.stdout.count("its body was filled"), 1, done.stdout)  # the skin is an estimate
        self.assertGreater(greys[0], 40)
        self.assertEqual(person.clicks, 5)

    def test_kept_picture_is_on_the_screen_before_the_rest_is_made(self):
        """In a second session with the same file. What is left is the same as in the first."""
        seen, states = [], []
        with tempfile.TemporaryDirectory() as folder:
            self.label_map(folder)
            for _ in range(2):
                person = Person(self, folder)

                def look(person=person):
                    person.await_file("outputs.json")
                    seen.append((json.loads((person.folder / "outputs.json").read_text()),
                                 self.await_picture(person, 50)))
                    save_screen(pathlib.Path.cwd() / "kept.png", self.frame_buffer, WINDOW, "100%")
                    (person.folder / "looked").touch()

                looking = threading.Thread(target=look)
                looking.start()
                self.assertEqual(self.play("kept.xml", folder, f"--script={PLAYBACKS / 'kept.py'}"), [])
                person.ended.set()
                looking.join()
                states.append((person.folder / "kept.pvsm").read_text())
                for name in ("outputs.json", "looked"):
                    (person.folder / name).unlink()
        outputs, greys = seen[1]
        self.assertEqual(outputs, ["flat image"])
        self.assertGreater(greys, 40)
        self.assertEqual(states[0], states[1])

    @staticmethod
    def await_picture(person, looks=600):
        """How many different greys the flat view has, once there are many: speckle."""
        left, top, columns, rows = FLAT_VIEW
        greys = set()
        for _ in range(looks):
            width, _, pixels = read_screen(person.frame_buffer)
            for y in range(top, top + rows, 2):
                line = pixels[3 * (width * y + left):3 * (width * y + left + columns)]
                greys |= {line[i] for i in range(0, len(line), 3) if line[i] == line[i + 1] == line[i + 2]}
            if len(greys) > 40 or person.ended.wait(0.2):
                break
        return len(greys)

    @staticmethod
    def await_still(person, looks=30):
        """Until the body has been drawn, too: nothing on the screen changes for two seconds."""
        before = None
        for _ in range(looks):
            now = read_screen(person.frame_buffer)
            if now == before or person.ended.wait(2):
                break
            before = now


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
