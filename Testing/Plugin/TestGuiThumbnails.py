"""The small picture of each standard view is that view's. Needs Xvfb and python3-pyqt5; run by ctest -L gui."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from guicase import PLAYBACKS, GuiCase

WIDTH, HEIGHT = 80, 60
# The same views, each simulated by a script, in full and with as few lines and paths as a small picture has.
VIEWS = """
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
thorax = ThoraxPhantom(Spacingmm=2)
views = StandardViews(Input=thorax)
views.UpdatePipeline()
views.SMProxy.UpdatePropertyInformation()
rows = views.SMProxy.GetProperty("Rows")
found = {}
presets = ProbePresets()
presets.UpdatePipeline()
table = presets.SMProxy.GetClientSideObject().GetOutputDataObject(0)
for i in range(rows.GetNumberOfElements()):
    sentence, preset, depth, *pose = rows.GetElement(i).split("\\t")
    pose = [float(number) for number in pose]
    ultrasound = SimulateUltrasound(Input=thorax, PositionMm=pose[:3], Axial=pose[3:6], Lateral=pose[6:9])
    row = next(row for row in range(table.GetNumberOfRows()) if table.GetValueByName(row, "Preset").ToString() == preset)
    for column in range(2, table.GetNumberOfColumns()):
        setting = ultrasound.SMProxy.GetProperty(table.GetColumnName(column))
        value = table.GetValue(row, column)
        setting.SetElement(0, value.ToInt() if setting.IsA("vtkSMIntVectorProperty") else value.ToDouble())
    if float(depth) > 0:
        ultrasound.DepthMm = float(depth)
    ultrasound.SMProxy.UpdateVTKObjects()
    for kind in ("full", "few"):
        if kind == "few":
            ultrasound.LineCount, ultrasound.PathsPerLine, ultrasound.MaxCollisions, ultrasound.Preview = 48, 12, 8, 1
            ultrasound.PixelMm = 0.5 * ultrasound.DepthMm / 120  # twice that of a moving probe
        OutputPort(ultrasound, 7).UpdatePipeline()
        image = ultrasound.SMProxy.GetClientSideObject().GetOutputDataObject(7)
        columns, lines, _ = image.GetDimensions()
        found[kind + sentence] = vtk_to_numpy(image.GetPointData().GetArray("BMode")).reshape(lines, columns)
np.savez(sys.argv[1], **found)
"""


def shrunk(grey):
    """Means over the pixels of a picture that it just fits into, black beside it."""
    lines, columns = grey.shape
    scale = min(WIDTH / columns, HEIGHT / lines)
    width, height = round(columns * scale), round(lines * scale)
    across = np.array_split(np.arange(columns), width)
    down = np.array_split(np.arange(lines), height)
    small = np.array([[grey[np.ix_(rows, cells)].mean() for cells in across] for rows in down])
    picture = np.zeros((HEIGHT, WIDTH))
    top, left = (HEIGHT - height) // 2, (WIDTH - width) // 2
    picture[top:top + height, left:left + width] = small
    return picture


def smooth(picture):
    """Without the speckle, which is another one with other lines."""
    kernel = np.ones(5) / 5
    for axis in (0, 1):
        picture = np.apply_along_axis(np.convolve, axis, picture, kernel, mode="same")
    return picture


def read(path):
    raw = path.with_suffix(".ppm")
    subprocess.run(["oiiotool", str(path), "--ch", "R,G,B", "-o", str(raw)], check=True)
    return np.frombuffer(raw.read_bytes()[-3 * WIDTH * HEIGHT:], np.uint8).reshape(HEIGHT, WIDTH, 3)[:, :, 0].astype(float)


class TestGuiThumbnails(GuiCase):
    def test_each_is_the_picture_of_its_view(self):
        with tempfile.TemporaryDirectory() as folder:
            done = self.paraview(folder, f"--script={PLAYBACKS / 'thumbnails.py'}")
            self.assertEqual(done.returncode, 0, done.stdout)
            self.assertEqual([line for line in done.stdout.splitlines() if "ERR|" in line or "Traceback" in line], [])
            sentences = json.loads(pathlib.Path(folder, "thumbnails.json").read_text(encoding="utf-8"))
            small = [smooth(read(pathlib.Path(folder, f"view{row}.png"))) for row in range(len(sentences))]
            full = pathlib.Path(folder, "full.npz")
            self.run_script(VIEWS, folder, full)
            with np.load(full) as found:
                wanted = {kind: [smooth(shrunk(found[kind + sentence].astype(float))) for sentence in sentences]
                          for kind in ("full", "few")}
        self.assertGreater(len(sentences), 4)
        likeness = {kind: np.array([[np.corrcoef(one.ravel(), other.ravel())[0, 1] for other in pictures] for one in small])
                    for kind, pictures in wanted.items()}
        print({kind: np.round(matrix, 2) for kind, matrix in likeness.items()})
        # The same but for how a picture is made small; no other view is as like.
        self.assertTrue((likeness["few"].argmax(axis=1) == np.arange(len(sentences))).all(), likeness)
        self.assertGreater(likeness["few"].diagonal().min(), 0.98, likeness)
        for one, other in zip(small, wanted["few"]):
            self.assertLess(np.abs(one - other).mean(), 3.0)  # of 255: pixels are gathered half of one apart
        # In full there are more echoes in the depth.
        self.assertGreater(likeness["full"].diagonal().min(), 0.6, likeness)


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
