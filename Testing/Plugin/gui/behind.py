"""An image behind the camera, which looks at a ball, and a plot of the traced lines, as ParaView's --script."""
from paraview.simple import *
from paraview.simple import _DisableFirstRenderCameraReset

_DisableFirstRenderCameraReset()
view = GetActiveViewOrCreate("RenderView")
thorax = ThoraxPhantom(registrationName="thorax", Spacingmm=4)
ultrasound = SimulateUltrasound(registrationName="ultrasound", Input=thorax, LineCount=48, PathsPerLine=20,
                                BuildSurfaces=0, PositionMm=(0, 0, 0), Axial=(0, 1, 0),
                                Lateral=(1, 0, 0))
line = ALine(registrationName="line", Input=OutputPort(ultrasound, 3), Line=3)
line.UpdatePipeline()
Show(OutputPort(ultrasound, 0), view)
Show(Sphere(Center=(0, 80, 300), Radius=50), view)
view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = (0, 80, 20), (0, 80, 300), (0, 1, 0)
SetActiveSource(ultrasound)
Render()
