"""Registration of several pairs of images at once by the program elastix (elastix.dev, Apache 2.0)."""
import os
import re
import shutil
import subprocess
import tempfile

import numpy as np

PARAMETERS = """
(Registration "MultiMetricMultiResolutionRegistration")
(FixedInternalImagePixelType "float")
(MovingInternalImagePixelType "float")
(FixedImageDimension 3)
(MovingImageDimension 3)
(UseDirectionCosines "true")
(Transform "RecursiveBSplineTransform")
(HowToCombineTransforms "Compose")
(Optimizer "QuasiNewtonLBFGS")
(StopIfWolfeNotSatisfied "false")
(GradientMagnitudeTolerance 0.000001)
(LBFGSMemory 10)
(MaximumNumberOfIterations 80)
(NewSamplesEveryIteration "false")
(NumberOfSpatialSamples {samples})
(ErodeMask "false")
(RequiredRatioOfValidSamples 0.05)
(RandomSeed 1)
(Resampler "DefaultResampler")
(ResampleInterpolator "FinalBSplineInterpolator")
(ResultImageFormat "mha")
(WriteResultImage "false")
(CompressResultImage "false")
"""


def is_there():
    return bool(shutil.which("elastix") and shutil.which("transformix"))


def displacement(pairs, smooth, placement, grid_mm, smoothed_mm, bending, samples):
    """t in mm, world axes, at the voxels of a grid: what is at x in the fixed images is at x + t(x) in the moving ones.

    pairs        (fixed, moving, mask, weight) of each: arrays indexed [z, y, x], the mask of where to look
    smooth       mask of where the field is to be smooth
    placement    origin, spacing, direction (columns are axes) of all arrays
    grid_mm      between the last control points of the B-spline; twice as wide in each resolution before
    smoothed_mm  standard deviation of the smoothing, one a resolution
    bending      weight of the bending energy against the pairs' mean squared difference, one a resolution
    """
    origin, spacing, direction = placement
    header = {"Offset": origin, "ElementSpacing": spacing, "TransformMatrix": np.transpose(direction).ravel()}
    count = len(pairs)
    resolutions = len(smoothed_mm)
    schedule = [max(1, round(2 * sigma / mm)) for sigma in smoothed_mm for mm in spacing]
    with tempfile.TemporaryDirectory() as folder:
        arguments = []
        # The bending energy, too, is to have images.
        for i, parts in enumerate(pairs + [(*pairs[0][:2], smooth)]):
            for kind, array in zip(("f", "m", "fMask"), parts):
                path = os.path.join(folder, f"{kind}{i}.mha")
                _write(path, array, header)
                arguments += [f"-{kind}{i}", path]
        text = PARAMETERS.format(samples=samples)
        text += _line("Metric", *["AdvancedMeanSquares"] * count, "TransformBendingEnergyPenalty")
        for name, value in (("FixedImagePyramid", "FixedSmoothingImagePyramid"), ("Interpolator", "LinearInterpolator"),
                            ("MovingImagePyramid", "MovingSmoothingImagePyramid"), ("ImageSampler", "RandomSparseMask")):
            text += _line(name, *[value] * (count + 1))
        for i, weight in enumerate([pair[3:] for pair in pairs] + [bending]):
            text += _line(f"Metric{i}Weight", *weight)
        text += _line("NumberOfResolutions", resolutions) + _line("ImagePyramidSchedule", *schedule)
        text += _line("FinalGridSpacingInPhysicalUnits", *[grid_mm] * 3)
        text += _line("GridSpacingSchedule", *[2.0 ** i for i in reversed(range(resolutions))])
        parameters = os.path.join(folder, "parameters.txt")
        with open(parameters, "w", encoding="ascii") as file:
            file.write(text)
        _run("elastix", *arguments, "-p", parameters, "-out", folder)
        _run("transformix", "-def", "all", "-tp", os.path.join(folder, "TransformParameters.0.txt"), "-out", folder)
        return _read(os.path.join(folder, "deformationField.mha"))


def _line(name, *values):
    return "({} {})\n".format(name, " ".join(f'"{value}"' if isinstance(value, str) else str(value) for value in values))


def _run(program, *arguments):
    done = subprocess.run([program, *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode:
        said = re.findall(r"^.*(?:ERROR|Description).*$", done.stdout, re.MULTILINE) or [f"it ended with {done.returncode}"]
        raise ValueError(f"{program} failed: {said[-1].strip()}")


def _write(path, array, header):
    kind = {"f": "MET_FLOAT", "u": "MET_UCHAR"}[array.dtype.kind]
    fields = {"ObjectType": "Image", "NDims": 3, "BinaryData": True, "BinaryDataByteOrderMSB": False,
              **{name: " ".join(map(repr, map(float, values))) for name, values in header.items()},
              "DimSize": " ".join(map(str, array.shape[::-1])), "ElementType": kind, "ElementDataFile": "LOCAL"}
    with open(path, "wb") as file:
        file.write("".join(f"{name} = {value}\n" for name, value in fields.items()).encode())
        file.write(np.ascontiguousarray(array).tobytes())


def _read(path):
    with open(path, "rb") as file:
        header, content = file.read().split(b"ElementDataFile = LOCAL\n", 1)
    size = [int(word) for word in re.search(rb"DimSize = (\d+) (\d+) (\d+)", header).groups()]
    return np.frombuffer(content, np.float32).reshape(*size[::-1], 3)
