"""The one filter on a small thorax, quick to run, as ParaView's --script."""
from paraview.simple import *

view = GetActiveViewOrCreate("RenderView")
thorax = ThoraxPhantom(registrationName="thorax", Spacingmm=4)
ultrasound = SimulateUltrasound(registrationName="ultrasound", Input=thorax, LineCount=12, PathsPerLine=20)
Show(OutputPort(ultrasound, 0), view)
SetActiveSource(thorax)
Render()
