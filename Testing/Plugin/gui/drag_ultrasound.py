"""The one filter on a small thorax, its anatomy and its image in the first view, as ParaView's --script. Writes down
which poses the anatomy is made ready to be drawn, into prepared.txt in the home folder."""
import pathlib

from paraview.simple import *

view = GetActiveViewOrCreate("RenderView")
thorax = ThoraxPhantom(registrationName="thorax", Spacingmm=4)
ultrasound = SimulateUltrasound(registrationName="ultrasound", Input=thorax, LineCount=48, PathsPerLine=300)
Show(OutputPort(ultrasound, 0), view)
anatomy = Show(OutputPort(ultrasound, 4), view).SMProxy.GetClientSideObject().GetActiveRepresentation()
prepared = open(pathlib.Path.home() / "prepared.txt", "w", encoding="utf-8", buffering=1)
anatomy.AddObserver("UpdateDataEvent", lambda *_: print(*ultrasound.PositionMm, file=prepared), 1e6)  # before others
view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = (250, -650, 330), (20, 0, 0), (0, 0, 1)
view.OrientationAxesVisibility = 0
SetActiveSource(thorax)
Render()
