# Speckle tracking as in `strain`, where the walls ride on displacements that elastix finds in the labels of the phases alone.
"""Makes label maps of nine phases of systole, registers them, and says how far the fields are from the thorax's own; then has the
stage `strain` track speckle on them."""
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np
import paraview  # noqa: F401  (finds ParaView's VTK libraries)
from sonovdb import register_phases
from sonovdb.vtkSonoFilters import vtkSonoLabelMapReader, vtkSonoThoraxSource
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "Testing/Filters"))
from wallerror import wall_errors

SPACING_MM = 1.0
PHASES, FRAMES = 24, 9  # as in strain.cpp
WALL = (12, 13)  # the left ventricle's myocardium, and the septum


def write_labels(folder, source):
    """Label maps without any motion, one a frame."""
    files = []
    for frame in range(FRAMES):
        source.UpdateTimeStep(frame / PHASES)
        only = vtkImageData()
        only.ShallowCopy(source.GetOutput())
        only.GetPointData().RemoveArray("DisplacementMm")
        only.GetFieldData().RemoveArray("MovingLabels")
        writer = vtkXMLImageDataWriter()
        writer.SetInputData(only)
        writer.SetFileName(str(folder / f"{frame}.vti"))
        writer.Write()
        files.append(writer.GetFileName())
    return files


def field_of(image):
    return vtk_to_numpy(image.GetPointData().GetArray("DisplacementMm")).reshape(image.GetDimensions()[::-1] + (3,))


def main():
    subprocess.run([ROOT / "Testing/build-preset.sh", "simulation", "measure"], stdout=sys.stderr, check=True)
    source = vtkSonoThoraxSource()
    source.SetSpacingMm(SPACING_MM)
    source.SetPhases(PHASES)
    source.UpdateInformation()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        files = write_labels(folder, source)
        start = time.perf_counter()
        paths = register_phases(files, folder, say=lambda sentence: print(sentence, file=sys.stderr))
        print(f"registered_phase_s {(time.perf_counter() - start) / (FRAMES - 1):.3g} s")
        reader = vtkSonoLabelMapReader()
        for path in paths:
            reader.AddFileName(path)
        for frame in range(FRAMES):
            reader.UpdateTimeStep(frame)
            found = field_of(reader.GetOutput())
            found.astype(np.float32).tofile(folder / f"displacement_{frame}")
        vtk_to_numpy(reader.GetOutput().GetFieldData().GetArray("MovingLabels")).astype(np.int32).tofile(folder / "moving_labels")
        labels = vtk_to_numpy(source.GetOutput().GetPointData().GetArray("Labels")).reshape(found.shape[:3])
        errors = wall_errors(found, field_of(source.GetOutput()), np.isin(labels, WALL), (SPACING_MM,) * 3)
        for way, error in zip(("normal", "along"), errors):  # to the walls' surface, at the end of systole
            print(f"registered_wall_{way}_error_mm {error.mean():.3g} mm")
            print(f"registered_wall_{way}_error_95_mm {np.percentile(error, 95):.3g} mm", flush=True)
        os.environ["SONOVDB_REGISTERED"] = str(folder)
        subprocess.run([ROOT / "build-simulation/bin/measure", "strain"], check=True)


main()
