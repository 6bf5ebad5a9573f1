"""Simulate Ultrasound on a small thorax with a Live Link on its flat image, as ParaView's --script. Writes the port that
is open into port.txt in the home folder, and into pictures.txt of each picture where the probe was and whether it was a
coarse one."""
import pathlib

from paraview.simple import *

view = GetActiveViewOrCreate("RenderView")
thorax = ThoraxPhantom(registrationName="thorax", Spacingmm=4)
ultrasound = SimulateUltrasound(registrationName="ultrasound", Input=thorax, LineCount=48, PathsPerLine=300, Device="CPU")
Show(OutputPort(ultrasound, 0), view)
link = LiveLink(registrationName="link", Input=OutputPort(ultrasound, 7), Port=0)
link.UpdatePipeline()
home = pathlib.Path.home()
pictures = open(home / "pictures.txt", "w", encoding="utf-8", buffering=1)
made = ultrasound.SMProxy.GetClientSideObject()


def write(*_):
    fields = made.GetOutputDataObject(0).GetFieldData()
    print(*fields.GetArray("ProbePositionMm").GetTuple3(0), int(fields.GetArray("Preview").GetValue(0)), file=pictures)


made.AddObserver("EndEvent", write)
view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = (250, -650, 330), (20, 0, 0), (0, 0, 1)
SetActiveSource(thorax)
Render()
link.UpdatePropertyInformation()
(home / "port.part").write_text(link.GetProperty("Status").GetElement(0).split(",")[0].split()[1])  # Port 18944, ...
(home / "port.part").rename(home / "port.txt")
