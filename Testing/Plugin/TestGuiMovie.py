"""Films of a beating heart and of a probe that was moved, as ParaView saves them, decoded by another FFmpeg. Needs Xvfb;
run by ctest -L gui."""
import pathlib
import sys
import tempfile
import unittest

import numpy as np
from guicase import GuiCase

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "Filters"))
import peers

# Shows the flat image alone, a pixel a pixel, and saves its frames as a film and as arrays.
FILM = """
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
thorax = ThoraxPhantom(Spacingmm=3, Phases=4 if sys.argv[2] == 'heart' else 1)
ultrasound = SimulateUltrasound(Input=thorax, LineCount=48, PathsPerLine=40, PixelMm=0.5, BuildSurfaces=0)
# An even number of pixels, as the film's colours are halved.
view = CreateRenderView(ViewSize=(360, 300), OrientationAxesVisibility=0, Background=(0, 0, 0),
                        UseColorPaletteForBackground=0, CameraParallelProjection=1)
flat = OutputPort(ultrasound, 7)
Show(flat, view)
Render(view) # the first one sets the camera
view.InteractionMode = '2D'
view.CameraPosition, view.CameraFocalPoint = (0, 75.25, -500), (0, 75.25, 0)
view.CameraViewUp, view.CameraParallelScale = (0, -1, 0), 75
scene = GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
if sys.argv[2] == 'drag':
    start = list(ultrasound.PositionMm)
    for axis, way in ((0, 6.0), (2, -6.0)):
        track = GetAnimationTrack('PositionMm', axis, ultrasound)
        track.KeyFrames = [CompositeKeyFrame(KeyTime=0, KeyValues=[start[axis]]),
                           CompositeKeyFrame(KeyTime=1, KeyValues=[start[axis] + way])]
    scene.PlayMode, scene.NumberOfFrames = 'Sequence', 4
greys = []
for n in range(4):
    scene.AnimationTime = 0.25 * n if sys.argv[2] == 'heart' else n / 3
    Render(view)
    flat.UpdatePipeline(scene.AnimationTime)
    image = ultrasound.GetClientSideObject().GetOutputDataObject(7)
    width, height, _ = image.GetDimensions()
    greys.append(vtk_to_numpy(image.GetPointData().GetArray('BMode')).reshape(height, width))
    origin, spacing = image.GetOrigin(), image.GetSpacing()
scene.GoToFirst()
SaveAnimation(sys.argv[1], view, FrameRate=10, ImageResolution=(360, 300))
np.savez(sys.argv[3], greys=greys, origin=origin, spacing=spacing)
"""

DECODE = """
import sys
import imageio_ffmpeg
import numpy as np
frames = imageio_ffmpeg.read_frames(sys.argv[1])
said = next(frames)
width, height = said["size"]
frames = [np.frombuffer(frame, np.uint8).reshape(height, width, 3).mean(axis=2) for frame in frames]
np.savez(sys.argv[2], frames=frames, fps=said["fps"])
"""


class TestMovie(GuiCase):
    @peers.needs("imageio_ffmpeg")
    def test_films_of_a_heart_and_of_a_drag(self):
        for kind in ("heart", "drag"):
            with self.subTest(kind=kind), tempfile.TemporaryDirectory() as folder:
                film, shown, decoded = (pathlib.Path(folder, name) for name in ("film.avi", "shown.npz", "decoded.npz"))
                self.run_script(FILM, folder, film, kind, shown)
                peers.run(DECODE, film, decoded)
                with np.load(shown) as wanted, np.load(decoded) as found:
                    self.assertEqual((len(found["frames"]), float(found["fps"])), (4, 10.0))
                    rows, columns = np.mgrid[0:300, 0:360]
                    # The pixel under each of the view, 0.5 mm wide; in the middle are 75.25 mm of depth.
                    x = ((columns - 179.5) * 0.5 - wanted["origin"][0]) / wanted["spacing"][0]
                    y = ((rows - 149.5) * 0.5 + 75.25 - wanted["origin"][1]) / wanted["spacing"][1]
                    x, y = np.rint(x).astype(int), np.rint(y).astype(int)
                    inside = (x >= 0) & (y >= 0) & (x < wanted["greys"].shape[2]) & (y < wanted["greys"].shape[1])
                    likeness = np.array([[np.corrcoef(frame[inside], grey[y[inside], x[inside]])[0, 1]
                                          for grey in wanted["greys"]] for frame in found["frames"]])
                    self.assertTrue((likeness.argmax(axis=1) == np.arange(4)).all(), likeness)
                    self.assertGreater(likeness.diagonal().min(), 0.97, likeness)


if __name__ == "__main__":
    unittest.main()
