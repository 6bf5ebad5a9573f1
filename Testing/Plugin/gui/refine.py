"""The one filter with a target error, as ParaView's --script. Writes down the paths of a line that each of its pictures
has, and how exact it is known to be, into rounds.txt in the home folder."""
import pathlib

from paraview.simple import *

view = GetActiveViewOrCreate("RenderView")
thorax = ThoraxPhantom(registrationName="thorax", Spacingmm=4)
ultrasound = SimulateUltrasound(registrationName="ultrasound", Input=thorax, LineCount=48, Device="CPU",
                                PathsPerLine=8192, TargetErrorDb=0.2)
Show(OutputPort(ultrasound, 0), view)
Show(OutputPort(ultrasound, 4), view)
rounds = open(pathlib.Path.home() / "rounds.txt", "w", encoding="utf-8", buffering=1)
made = ultrasound.SMProxy.GetClientSideObject()


def write(*_):
    fields = made.GetOutputDataObject(0).GetFieldData()
    paths, error = fields.GetArray("TracedPaths"), fields.GetArray("ErrorDb")
    print(int(paths.GetValue(0)) if paths else 0, error.GetValue(0) if error else 0.0, file=rounds)


made.AddObserver("EndEvent", write)
view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = (250, -650, 330), (20, 0, 0), (0, 0, 1)
view.OrientationAxesVisibility = 0
SetActiveSource(thorax)
Render()
