"""The one filter on a small thorax, quick to run, its flat image in a view, as ParaView's --script. Each time that the view was
drawn, a line of scanner.jsonl says what the filter's properties were and what the picture is."""
import hashlib
import json
import time

import numpy
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

FLAT_IMAGE = 7
NUMBERS = ("Preview", "ScanKind", "LineCount", "DepthMm", "SectorDeg", "TransmitFocusMm", "CentreFrequencyMHz",
           "ImagingMode", "GainDb", "DynamicRangeDb", "GreyMap", "TgcDbPerCm", "Tgc1Db", "Tgc8Db", "TargetErrorDb",
           "PositionMm", "Axial", "Lateral")
view = GetActiveViewOrCreate("RenderView")
thorax = ThoraxPhantom(registrationName="thorax", Spacingmm=4)
ultrasound = SimulateUltrasound(registrationName="ultrasound", Input=thorax, LineCount=24, PathsPerLine=512)
Show(OutputPort(ultrasound, FLAT_IMAGE), view)
view.InteractionMode = "2D"
view.CameraPosition, view.CameraViewUp, view.CameraFocalPoint = (0, 0, -1), (0, -1, 0), (0, 0, 0)
ResetCamera(view)
log = open("scanner.jsonl", "w", buffering=1, encoding="utf-8")
last = []


def value(name):
    found = ultrasound.GetProperty(name)
    return list(found) if len(found) > 1 else found[0]


def cut(picture, mask, axis):
    """Both in eight, along an axis."""
    return [numpy.array_split(each, 8, axis=axis) for each in (picture, mask)]


def mean_of(picture, mask):
    """0 where nothing is seen."""
    return float(picture[mask].mean()) if mask.any() else 0.0


def note(*_):
    image = ultrasound.SMProxy.GetClientSideObject().GetOutputDataObject(FLAT_IMAGE)
    grey = image.GetPointData().GetArray("BMode") if image else None
    if not grey:
        return
    columns, rows, slices = image.GetDimensions()
    picture = vtk_to_numpy(grey).reshape(slices, rows, columns)
    mask = vtk_to_numpy(image.GetPointData().GetArray("Mask")).reshape(slices, rows, columns) > 0
    line = {name: value(name) for name in NUMBERS}
    line.update({"ViewTime": view.ViewTime, "mean": mean_of(picture, mask), "bounds": list(image.GetBounds()),
                 "blocks": [[mean_of(cell, inside) for cell, inside in zip(*cut(picture, mask, 2))]
                            for picture, mask in zip(*cut(picture, mask, 1))],
                 "picture": hashlib.md5(picture.tobytes()).hexdigest()})
    if line not in last:
        log.write(json.dumps({**line, "clock": time.monotonic()}) + "\n")
        last[:] = [line]


view.SMProxy.AddObserver("EndEvent", note)
SetActiveSource(thorax)
Render()
