"""A small chain in the first view, as ParaView's --script."""
from paraview.simple import *

view = GetActiveViewOrCreate("RenderView")
scene = UltrasoundScene(registrationName="scene", Input=ThoraxPhantom(registrationName="thorax", Spacingmm=4))
probe = UltrasoundProbe(registrationName="probe", LineCount=48)
traced = UltrasoundRayTracer(registrationName="traced", Scene=scene, Probe=probe, PathsperLine=100)
rf = UltrasoundImageFormation(registrationName="rf", Input=traced)
picture = ScanConverter(registrationName="picture", Input=UltrasoundBMode(registrationName="bmode", Input=rf))
for source in (scene, probe, picture):
    Show(source, view)
view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = (400, -700, 120), (20, 0, 0), (0, 0, 1)
view.OrientationAxesVisibility = 0
SetActiveSource(scene)
Render()
