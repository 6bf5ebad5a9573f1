# What it costs to write a film of 1000 pictures as DICOM, with and without label masks, and what is read back of it.
import os
import pathlib
import resource
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "Filters"))

import numpy as np  # noqa: E402
import pydicom  # noqa: E402
from chain import make  # noqa: E402
from sonovdb.vtkSonoFilters import vtkSonoDicomWriter, vtkSonoThoraxSource, vtkSonoUltrasound  # noqa: E402
from vtkmodules.util.numpy_support import vtk_to_numpy  # noqa: E402
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase  # noqa: E402
from vtkmodules.vtkCommonDataModel import vtkImageData  # noqa: E402
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline  # noqa: E402

PICTURES = 1000
STEP_S = 0.02


class Film(VTKPythonAlgorithmBase):
    """A picture whose greys change with time, each of them to be told from the others. Takes no time to make."""

    def __init__(self, picture):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkImageData")
        self.picture = picture
        self.greys = vtk_to_numpy(picture.GetPointData().GetArray("BMode")).copy()

    def at(self, n):
        return self.greys + np.uint8(n % 256)  # and on from 0

    def RequestInformation(self, _request, _input, output):
        info = output.GetInformationObject(0)
        info.Set(Pipeline.WHOLE_EXTENT(), self.picture.GetExtent(), 6)
        times = [n * STEP_S for n in range(PICTURES)]
        info.Set(Pipeline.TIME_STEPS(), times, len(times))
        info.Set(Pipeline.TIME_RANGE(), [times[0], times[-1]], 2)
        return 1

    def RequestData(self, _request, _input, output):
        n = round(output.GetInformationObject(0).Get(Pipeline.UPDATE_TIME_STEP()) / STEP_S)
        image = vtkImageData.GetData(output, 0)
        image.DeepCopy(self.picture)
        vtk_to_numpy(image.GetPointData().GetArray("BMode"))[:] = self.at(n)
        return 1


def peak_mb():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e6  # Linux counts in KiB


def figure(name, value, unit, asked=""):
    print(f"{name} {value:.6g} {unit}{f' (asked: {asked})' if asked else ''}", flush=True)


def written(film, path, **settings):
    """Seconds and what the peak of memory grew by, in MB."""
    writer = make(vtkSonoDicomWriter, FileName=str(path), **settings)
    writer.SetInputConnection(film.GetOutputPort())
    before, begin = peak_mb(), time.perf_counter()
    if not writer.Write():
        sys.exit(f"{path} was not written")
    os.sync()
    return time.perf_counter() - begin, peak_mb() - before


def place_error_mm(data, image):
    """Of the corners, by the calibration alone, in mm from the middle of the face."""
    region, = data.SequenceOfUltrasoundRegions
    worst = 0
    for axis, n in (("X", 0), ("Y", 1)):
        for pixel in (0, image.GetDimensions()[n] - 1):
            found = 10 * (region[f"PhysicalDelta{axis}"].value * (pixel - region[f"ReferencePixel{axis}0"].value)
                          + region[f"ReferencePixelPhysicalValue{axis}"].value)
            worst = max(worst, abs(found - image.GetOrigin()[n] - pixel * image.GetSpacing()[n]))
    return worst


ultrasound = make(vtkSonoUltrasound, PathsPerLine=10)
thorax = make(vtkSonoThoraxSource, SpacingMm=4.0)
ultrasound.SetInputConnection(thorax.GetOutputPort())
ultrasound.Update()
flat = ultrasound.GetOutputDataObject(ultrasound.FLAT_IMAGE)
film = Film(flat)
with tempfile.TemporaryDirectory() as folder:
    path = pathlib.Path(folder, "film.dcm")
    seconds, grown = written(film, path)
    figure("dicom_1000_s", seconds, "s", "at most 60")
    figure("dicom_1000_peak_mb", grown, "MB", "no more than for one picture, 10")
    figure("dicom_1000_file_mb", path.stat().st_size / 1e6, "MB")
    seconds, grown = written(film, pathlib.Path(folder, "labelled.dcm"), LabelMasks=True)
    figure("dicom_masks_1000_s", seconds, "s")
    figure("dicom_masks_1000_peak_mb", grown, "MB")
    figure("dicom_masks_1000_file_mb", pathlib.Path(folder, "labelled.seg.dcm").stat().st_size / 1e6, "MB")
    # Last: what is read is memory, too.
    data = pydicom.dcmread(path, defer_size=1000)
    figure("dicom_place_error_mm", place_error_mm(data, flat), "mm", "at most 0.01")
    offset = path.stat().st_size - flat.GetNumberOfPoints() * PICTURES  # of an even number: nothing behind them
    pixels = np.memmap(path, np.uint8, "r", offset, (PICTURES, flat.GetNumberOfPoints()))
    worst = max(int(np.abs(pixels[n].astype(int) - film.at(n)).max()) for n in range(PICTURES))
    figure("dicom_grey_error", worst, "greys", "at most 1")
    figure("dicom_frame_time_error_ms", abs(float(data.FrameTime) - 1000 * STEP_S), "ms")
