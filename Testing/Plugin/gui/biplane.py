"""A matrix probe on a small thorax, quick to run, its flat image in a view, as ParaView's --script. Each time that a Simulate
Ultrasound has made its flat image, a line of biplane.jsonl says which plane it is of and what it is."""
import hashlib
import json

from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

FLAT_IMAGE = 7
view = GetActiveViewOrCreate("RenderView")
thorax = ThoraxPhantom(registrationName="thorax", Spacingmm=4)
ultrasound = SimulateUltrasound(registrationName="ultrasound", Input=thorax, ScanKind="Matrix", LineCount=24, SectorDeg=80,
                                ElevationLineCount=5, ElevationSectorDeg=50, PathsPerLine=60, PixelMm=2)
log = open("biplane.jsonl", "w", buffering=1, encoding="utf-8")
watched = []


def note(source):
    image = source.SMProxy.GetClientSideObject().GetOutputDataObject(FLAT_IMAGE)
    grey = image.GetPointData().GetArray("BMode") if image else None
    if grey:
        log.write(json.dumps({"plane": source.GetProperty("MatrixPlane").GetData(), "preview": int(source.Preview),
                              "Lateral": list(source.Lateral), "size": image.GetDimensions(),
                              "picture": hashlib.md5(vtk_to_numpy(grey).tobytes()).hexdigest()}) + "\n")


def watch(*_):
    for (name, _), source in GetSources().items():
        if source.GetXMLName() == "SonoUltrasound" and name not in watched:
            watched.append(name)
            source.SMProxy.GetClientSideObject().AddObserver("EndEvent", lambda *_, source=source: note(source))


watch()
servermanager.vtkSMProxyManager.GetProxyManager().AddObserver("RegisterEvent", watch)
Show(OutputPort(ultrasound, FLAT_IMAGE), view)
view.InteractionMode = "2D"
view.CameraPosition, view.CameraViewUp, view.CameraFocalPoint = (0, 0, -1), (0, -1, 0), (0, 0, 0)
ResetCamera(view)
SetActiveSource(thorax)
Render()
