"""Makes the tutorial's pictures of the layout and of Ventricle Volume anew: pictures.py [FOLDER], by default Data/pictures. With
the environment of the tests of the plugin; needs Xvfb. Look at what it made before it is committed."""
import pathlib
import subprocess
import sys
import tempfile
import threading
import time

from guicase import PLAYBACKS, GuiCase, save_screen

WINDOW = "1152x762+0+0"
VIEWS = "850x532+300+196"
# Of standard views of the bundled heart.
VENTRICLE = """
thorax = ThoraxPhantom(Spacingmm=1.5)
search = StandardViews(Input=UltrasoundScene(Input=thorax))
search.UpdatePipeline()
search.SMProxy.UpdatePropertyInformation()
rows = search.SMProxy.GetProperty("Rows")
rows = [rows.GetElement(i).split("\\t") for i in range(rows.GetNumberOfElements())]


def simulated(name):
    _, preset, depth, *pose = next(row for row in rows if row[0].startswith(name))
    pose = [float(number) for number in pose]
    return OutputPort(SimulateUltrasound(Input=thorax, PresetFile=preset, DepthMm=float(depth), PositionMm=pose[:3],
                                         Axial=pose[3:6], Lateral=pose[6:9]), 7)


images = simulated("A4C"), simulated("A2C")
volume = VentricleVolume(Input=images[0], TwoChamber=images[1], Contour="Labels")
for port, image in enumerate(images):
    view = CreateView("RenderView")
    view.UseColorPaletteForBackground, view.Background, view.OrientationAxesVisibility = 0, [0, 0, 0], 0
    view.InteractionMode = "2D"
    Show(image, view)
    Show(OutputPort(volume, port), view)
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [0, 85, -300], [0, 85, 0], [0, -1, 0]
    view.CameraParallelScale = 100
    SaveScreenshot(sys.argv[1] + f"{port}.png", view, ImageResolution=[600, 500])
"""


class Maker(GuiCase):
    def runTest(self):
        to = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else PLAYBACKS.parents[2] / "Data/pictures")
        with tempfile.TemporaryDirectory() as folder:
            data = str(pathlib.Path(folder, "thorax.vti"))
            self.run_script("SaveData(sys.argv[1], proxy=ThoraxPhantom(Spacingmm=1))", folder, data)
            script = pathlib.Path(folder, "layout.xml")
            script.write_text((PLAYBACKS / "rested.xml").read_text().replace(
                "</pqevents>", '  <pqevent object="pqClientMainWindow" command="pause" arguments="6000"/>\n</pqevents>'))
            threading.Thread(target=self.look, args=(pathlib.Path(folder, "rested.pvsm"), to)).start()
            self.play(script, folder, f"--data={data}")
            views = pathlib.Path(folder, "view")
            self.run_script(VENTRICLE, folder, views)
            subprocess.run(["oiiotool", f"{views}0.png", f"{views}1.png", "--mosaic", "2x1", "--ch", "R,G,B", "-o",
                            str(to / "ventricle.png")], check=True)

    def look(self, sign, to):
        while not sign.exists():
            time.sleep(0.1)
        time.sleep(3)
        for name, cut in (("layout", WINDOW), ("place", VIEWS)):
            save_screen(to / f"{name}.png", self.frame_buffer, cut, "100%")


if __name__ == "__main__":
    Maker.setUpClass()
    try:
        Maker().debug()
    finally:
        Maker.tearDownClass()
