"""A state to open in ParaView (File, Load State) once the plugin is loaded: the bundled thorax in its apical
four-chamber view, in the body and flat, with some of the ray paths coloured by their intensity.
"""
from paraview.simple import *

thorax = ThoraxPhantom(registrationName="Thorax", Spacingmm=1.5)
ultrasound = SimulateUltrasound(
    registrationName="Ultrasound", Input=thorax, NumberOfShownPaths=300,
    PositionMm=[87.8, -86.5, -44.9], Axial=[-0.53, 0.65, 0.545], Lateral=[0.843, 0.333, 0.423])
image, anatomy, probe, paths, flat = (OutputPort(ultrasound, port) for port in (0, 4, 5, 6, 7))

# Views come into a layout before anything is shown in them: one that appears on the screen is drawn at once.
body = CreateView("RenderView", registrationName="In the body")
picture = CreateView("RenderView", registrationName="Flat")
layout = CreateLayout("Ultrasound")
AssignViewToLayout(body, layout)
AssignViewToLayout(picture, layout, hint=0)

for port in (anatomy, probe, image):
    Show(port, body)
shown = Show(paths, body)
ColorBy(shown, ("POINTS", "IntensityDb"))
colors = GetColorTransferFunction("IntensityDb")
colors.RescaleTransferFunction(-60, 0)
shown.SetScalarBarVisibility(body, True)
body.CameraPosition, body.CameraFocalPoint, body.CameraViewUp = [250, -500, 175], [0, 0, 0], [0, 0, 1]

picture.UseColorPaletteForBackground = 0
picture.Background = [0, 0, 0]
picture.InteractionMode = "2D"
picture.OrientationAxesVisibility = 0
Show(flat, picture)
picture.CameraPosition, picture.CameraFocalPoint, picture.CameraViewUp = [0, 80, -300], [0, 80, 0], [0, -1, 0]
picture.CameraParallelScale = 150

SetActiveView(body)
SetActiveSource(ultrasound)
