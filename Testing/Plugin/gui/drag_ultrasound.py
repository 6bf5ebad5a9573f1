"""The one filter on a small thorax, its anatomy and its image in the first view, as ParaView's --script."""
from paraview.simple import *

view = GetActiveViewOrCreate("RenderView")
thorax = ThoraxPhantom(registrationName="thorax", VoxelSizemm=4)
ultrasound = SimulateUltrasound(registrationName="ultrasound", Input=thorax, NumberofLines=48, PathsperLine=300)
for port in (0, 4):  # the image and the anatomy
    Show(OutputPort(ultrasound, port), view)
view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = (400, -700, 120), (20, 0, 0), (0, 0, 1)
view.OrientationAxesVisibility = 0
SetActiveSource(thorax)
Render()
