"""Makes the tutorial's pictures of the layout, the panels, a biplane and Ventricle Volume anew, and the standard views':
pictures.py [FOLDER], by default Data/pictures. With the environment of the tests of the plugin; needs Xvfb. Look at what it made
before it is committed."""
import pathlib
import subprocess
import sys
import tempfile
import threading
import time

from events import MAIN, PROBE, SCANNER, click, event, menu, pause, play_on, save_state, select, write
from guicase import PLAYBACKS, GuiCase, save_screen

WINDOW = "1152x762+0+0"
VIEWS = "850x532+300+196"
# Of standard views of the bundled heart.
SEARCH = """
thorax = ThoraxPhantom(Spacingmm=float(sys.argv[2]))
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


def save(number, shown, half, size):
    view = CreateView("RenderView")
    view.UseColorPaletteForBackground, view.Background, view.OrientationAxesVisibility = 0, [0, 0, 0], 0
    view.InteractionMode = "2D"
    for each in shown:
        Show(each, view)
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [0, 85, -300], [0, 85, 0], [0, -1, 0]
    view.CameraParallelScale = half
    SaveScreenshot(sys.argv[1] + f"{number}.png", view, ImageResolution=size)
"""
VENTRICLE = SEARCH + """
images = simulated("A4C"), simulated("A2C")
volume = VentricleVolume(Input=images[0], TwoChamber=images[1], Contour="Labels")
for port, image in enumerate(images):
    save(port, (image, OutputPort(volume, port)), 100, [600, 500])
"""
STANDARD = ("A4C", "A2C", "A3C", "A5C", "PLAX", "PSAX mid", "PSAX apex", "SC4C")
VIEWED = SEARCH + """
for number, name in enumerate(sys.argv[3:]):
    save(number, (simulated(name), Text(Text=name)), 95, [315, 300])
"""


APPLY = click(f"{MAIN}/propertiesDock/propertiesPanel/Accept")
OPEN_SCANNER = click(f"{MAIN}/SonoToolBar/SonoScannerButton")
TISSUES = f"{MAIN}/pqSonoTissueDock/SonoTissueContents"
# What is done before a picture of the window.
SCANNED = (APPLY, click(f"{MAIN}/SonoToolBar/actionSonoSimulate"), play_on(3000), OPEN_SCANNER, pause(500),
           *[part for _ in range(8) for part in (click(f"{PROBE}/RotatePlus"), pause(200))], play_on(5000),
           click(f"{SCANNER}/Freeze"), event(f"{SCANNER}/SonoCine/Scrubber", "set_int", 3), play_on(4000))
EDITED = (APPLY, click(f"{MAIN}/SonoToolBar/actionSonoSimulate"), play_on(3000), menu("menu_View", "actionSonoTissues"),
          click(f"{TISSUES}/SonoTissueLoad"), event(f"{TISSUES}/SonoTissueTable", "editAccepted", "2.1,"))
BIPLANE = (select(0, 0), pause(1000), OPEN_SCANNER, pause(500), click(f"{SCANNER}/Biplane"), play_on(5000))


class Maker(GuiCase):
    def runTest(self):
        to = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else PLAYBACKS.parents[2] / "Data/pictures")
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            data = str(folder / "thorax.vti")
            self.run_script("SaveData(sys.argv[1], proxy=ThoraxPhantom(Spacingmm=1))", folder, data)
            script = folder / "layout.xml"
            script.write_text((PLAYBACKS / "rested.xml").read_text().replace("</pqevents>", play_on(6000) + "\n</pqevents>"))
            self.show(script, to, "rested", {"layout": WINDOW, "place": VIEWS}, f"--data={data}")
            scene = folder / "biplane.py"
            scene.write_text((PLAYBACKS / "biplane.py").read_text().replace("Spacingmm=4", "Spacingmm=1").replace(
                "LineCount=24, SectorDeg=80", "LineCount=128, SectorDeg=80").replace(
                "ElevationSectorDeg=50, PathsPerLine=60, PixelMm=2", "ElevationSectorDeg=80, PathsPerLine=256, PixelMm=0.5"))
            for name, events, argument in (("scanner", SCANNED, f"--data={data}"), ("tissues", EDITED, f"--data={data}"),
                                           ("biplane", BIPLANE, f"--script={scene}")):
                script = write(folder / f"{name}.xml", *events, save_state(name), play_on(6000))
                self.show(script, to, name, {name: WINDOW}, argument)
            views = folder / "view"
            self.run_script(VENTRICLE, folder, views, 1.5)
            subprocess.run(["oiiotool", f"{views}0.png", f"{views}1.png", "--mosaic", "2x1", "--ch", "R,G,B", "-o",
                            str(to / "ventricle.png")], check=True)
            self.run_script(VIEWED, folder, views, 1, *STANDARD)
            parts = [f"{views}{number}.png" for number in range(len(STANDARD))]
            subprocess.run(["oiiotool", *parts, "--mosaic", "4x2", "--ch", "R,G,B", "-o", str(to / "views.png")], check=True)

    def show(self, script, to, sign, pictures, *arguments):
        """Plays a script; the screen's parts become pictures when it has saved a state of this name."""
        def look():
            while not (script.parent / f"{sign}.pvsm").exists():
                time.sleep(0.1)
            time.sleep(3)
            for name, cut in pictures.items():
                save_screen(to / f"{name}.png", self.frame_buffer, cut, "100%")

        threading.Thread(target=look).start()
        print(*self.play(script, script.parent, *arguments), sep="\n")


if __name__ == "__main__":
    Maker.setUpClass()
    try:
        Maker().debug()
    finally:
        Maker.tearDownClass()
