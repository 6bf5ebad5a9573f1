"""A simulation that is quick to make, in the first view, as ParaView's --script."""
from paraview.simple import *

view = GetActiveViewOrCreate("RenderView")
thorax = ThoraxPhantom(registrationName="thorax", Spacingmm=4)
ultrasound = SimulateUltrasound(registrationName="ultrasound", Input=thorax, LineCount=48, PathsPerLine=100,
                                BuildSurfaces=0)
Show(OutputPort(ultrasound, 0), view)
view.OrientationAxesVisibility = 0
view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = (200, -500, 120), (20, 0, 0), (0, 0, 1)
SetActiveSource(ultrasound)
Render()
