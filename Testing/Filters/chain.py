"""What the filters' tests share: a small chain of all stages, and ears for what they say."""
import pathlib

import numpy as np
import paraview  # noqa: F401  (finds ParaView's VTK libraries)
from sonovdb.vtkSonoFilters import (vtkSonoBMode, vtkSonoImageFormation, vtkSonoLabelMapReader, vtkSonoProbeSource,
                                    vtkSonoRayTracer, vtkSonoScanConverter, vtkSonoSceneBuilder, vtkSonoThoraxSource)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter


def listen(algorithm, event="ErrorEvent"):
    """A list that gathers the sentences of an algorithm's errors or warnings."""
    heard = []

    def on_event(_object, _event, text):
        heard.append(text.split("):", 1)[-1].strip())

    on_event.CallDataType = "string0"
    algorithm.AddObserver(event, on_event)
    return heard


def count_runs(algorithm):
    """A list that grows by one entry each time the algorithm's data are made."""
    runs = []
    algorithm.AddObserver("StartEvent", lambda *_: runs.append(1))
    return runs


STAGES = ("SceneBuilder", "Probe", "RayTracer", "ImageFormation", "BMode", "ScanConverter")


def owner(algorithm, setting):
    """The object that has a setting: the filter, or of vtkSonoUltrasound the stage."""
    parts = [algorithm] + [getattr(algorithm, "Get" + name)() for name in STAGES if hasattr(algorithm, "Get" + name)]
    return next(part for part in parts if hasattr(part, "Set" + setting))


def make(kind, **settings):
    """A filter of this class with its settings, of vtkSonoUltrasound with those of its stages."""
    stage = kind()
    for name, value in settings.items():
        getattr(owner(stage, name), "Set" + name)(value)
    return stage


def label_image(voxels, name="Labels"):
    """A vtkImageData of an array indexed [z, y, x]."""
    image = vtkImageData()
    image.SetDimensions(voxels.shape[::-1])
    array = numpy_to_vtk(voxels.ravel(), deep=True)
    array.SetName(name)
    image.GetPointData().SetScalars(array)
    return image


def write_labels(path, voxels):
    """A label map as a file, from an array indexed [z, y, x]; its path as text."""
    writer = vtkXMLImageDataWriter()
    writer.SetInputData(label_image(voxels))
    writer.SetFileName(str(path))
    writer.Write()
    return str(path)


def moving_plane(folder, depths, size, names):
    """A reader of phases of two labels, `names`, that meet at a depth; one file a depth, all in a folder."""
    reader = vtkSonoLabelMapReader()
    for phase, depth in enumerate(depths):
        voxels = np.full(size, 1, np.uint16)
        voxels[depth:] = 2
        reader.AddFileName(write_labels(pathlib.Path(folder, f"phase{phase}.vti"), voxels))
    pathlib.Path(folder, "labels.csv").write_text("id,name\n1,{}\n2,{}\n".format(*names))
    return reader


def shown_deeper(lines, line, range_mm, elevations=1, elevation=0.0):
    """How much deeper, in mm, than its range lies what traced lines show there: their offsets, which begin with each
    bin, straight between bins, lines and elevations. `line` counts from 0, with fractions, `elevation` from 0 to 1."""
    offsets = vtk_to_numpy(lines.GetFieldData().GetArray("DepthOffsetMm"))
    offsets = offsets.reshape(elevations, lines.GetDimensions()[1] // elevations, -1)
    starts = lines.GetSpacing()[0] * np.arange(offsets.shape[2])
    deeper = 0.0
    for e, plane in enumerate(offsets):
        for n, of_line in enumerate(plane):
            shares = [np.maximum(0, 1 - np.abs(np.clip(wanted, 0, last) - at)) for wanted, at, last in (
                (line, n, len(plane) - 1), (elevation * (elevations - 1), e, elevations - 1))]
            deeper = deeper + shares[0] * shares[1] * np.interp(range_mm, starts, of_line)
    return deeper


class Chain:
    """Every stage, from a coarse thorax to its picture, quick to run."""

    def __init__(self):
        self.thorax = make(vtkSonoThoraxSource, SpacingMm=4.0)
        self.thorax.Update()
        field = self.thorax.GetOutput().GetFieldData()
        pose = [field.GetArray("A4C" + part).GetTuple3(0) for part in ("PositionMm", "Axial", "Lateral")]
        self.probe = make(vtkSonoProbeSource, LineCount=12, DepthMm=90.0, SectorDeg=60.0)
        self.probe.SetPositionMm(pose[0])
        self.probe.SetAxial(pose[1])
        self.probe.SetLateral(pose[2])
        self.scene = make(vtkSonoSceneBuilder, BuildSurfaces=False)
        self.scene.SetInputConnection(self.thorax.GetOutputPort())
        self.tracer = make(vtkSonoRayTracer, PathsPerLine=20)
        self.tracer.SetInputConnection(0, self.scene.GetOutputPort())
        self.tracer.SetInputConnection(1, self.probe.GetOutputPort())
        self.formation = vtkSonoImageFormation()
        self.formation.SetInputConnection(self.tracer.GetOutputPort())
        self.bmode = vtkSonoBMode()
        self.bmode.SetInputConnection(self.formation.GetOutputPort())
        self.converter = vtkSonoScanConverter()
        self.converter.SetInputConnection(self.bmode.GetOutputPort())

    def stages(self):
        return {"thorax": self.thorax, "probe": self.probe, "scene": self.scene, "tracer": self.tracer,
                "formation": self.formation, "bmode": self.bmode, "converter": self.converter}
