# The first picture of a CT of 512 x 512 x 600 voxels with 117 labels, from files, in a process of its own.
"""Writes the bundled thorax, its labels cut into 117 and a CT of it, as .nii.gz; then times another pvpython that reads both, adds
the CT, finds a window on the liver and simulates; and another after it, which finds what that one kept. Then 104 of the labels as
a folder of masks, read."""
import gzip
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import time
import zlib

SIZE = (512, 512, 600)
LABELS = 117
MASKS = 104


def load():
    from paraview import simple
    simple.LoadPlugin(os.environ["SONOVDB_PLUGIN"], remote=False, ns=vars(simple))
    return simple


def write_nifti(path, voxels, code, spacing):
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, *SIZE, 1, 1, 1, 1)
    struct.pack_into("<2h", header, 70, code, voxels.dtype.itemsize * 8)
    struct.pack_into("<8f", header, 76, 1, *spacing, 1, 1, 1, 1)
    struct.pack_into("<f", header, 108, 352)
    struct.pack_into("<2h", header, 252, 0, 1)
    for row in range(3):  # LPS becomes RAS
        values = [0.0] * 4
        values[row] = spacing[row] * (1 if row == 2 else -1)
        struct.pack_into("<4f", header, 280 + 16 * row, *values)
    header[344:348] = b"n+1\0"
    with gzip.open(path, "wb", compresslevel=1) as file:
        file.write(bytes(header))
        file.write(voxels.tobytes())


def write_files(folder):
    import numpy as np
    from sonovdb.vtkSonoFilters import vtkSonoThoraxSource
    from vtkmodules.util.numpy_support import vtk_to_numpy
    thorax = vtkSonoThoraxSource()
    thorax.SetSpacingMm(1.0)
    thorax.Update()
    image = thorax.GetOutput()
    small = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(image.GetDimensions()[::-1])
    extents = np.array(small.shape[::-1]) * image.GetSpacing()
    at = [(np.arange(n) * m // n) for n, m in zip(SIZE[::-1], small.shape)]
    labels = small[np.ix_(*at)].astype(np.uint8)
    field = image.GetFieldData()
    ids = field.GetArray("LabelIds")
    names = {int(ids.GetValue(i)): field.GetAbstractArray("LabelNames").GetValue(i) for i in range(ids.GetNumberOfTuples())}
    hu = np.full(256, 50, np.int16)
    for number, name in names.items():
        for words, value in ((("air", "background"), -1000), (("lung",), -850), (("rib", "sternum", "vertebra", "spine"), 400),
                             (("fat",), -100)):
            if any(word in name for word in words):
                hu[number] = value
    random = np.random.default_rng(1)
    scan = hu[labels] + random.integers(-15, 16, labels.shape, np.int16)
    # The largest labels become slabs of the same name until there are enough.
    air = next(number for number, name in names.items() if hu[number] == -1000)
    sizes = np.bincount(labels.ravel(), minlength=256)
    largest = [n for n in np.argsort(-sizes) if n in names and n != air]
    extra = LABELS - len(names)
    free = [n for n in range(1, 256) if n not in names]
    slab = (np.arange(SIZE[2]) // 20)[:, None, None]
    for i in range(extra):
        number = largest[i % min(8, len(largest))]
        mark = (labels == number) & (slab % 16 == i // 8 + 1)
        labels[mark] = free[i]
        names[free[i]] = f"{names[number]} part {i}"
    spacing = extents / SIZE
    write_nifti(folder / "labels.nii.gz", labels, 2, spacing)
    write_nifti(folder / "ct.nii.gz", scan.astype(np.int16), 4, spacing)
    (folder / "labels.csv").write_text("id,name\n" + "".join(f"{n},{name}\n" for n, name in names.items()))
    return len(np.unique(labels))


def first_picture(folder):
    start = time.perf_counter()
    simple = load()
    from paraview import servermanager
    labels = simple.LabelMapReader(FileName=[str(folder / "labels.nii.gz")])
    scan = simple.CTorMRReader(FileName=str(folder / "ct.nii.gz"))
    added = simple.AddCTorMR(Input=labels, Scan=scan)
    window = simple.AcousticWindow(Input=added, Target="liver")
    window.UpdatePipeline()
    field = servermanager.Fetch(window).GetFieldData()
    image = simple.SimulateUltrasound(Input=added)
    image.BuildSurfaces = 0
    for name in ("PositionMm", "Axial", "Lateral"):
        setattr(image, name, field.GetArray("Probe" + name).GetTuple3(0))
    image.UpdatePipeline()
    took = time.perf_counter() - start
    picture = servermanager.Fetch(image).GetPointData().GetArray("BMode")
    assert picture.GetNumberOfValues() > 1
    seen = zlib.crc32(memoryview(picture))
    with open("/proc/self/status") as status:
        peak = next(int(line.split()[1]) for line in status if line.startswith("VmHWM")) / 1024
    print(f"TOOK {took} {peak} {seen}")


def write_masks(folder):
    """One file a label, of as many as TotalSegmentator had first."""
    import numpy as np
    with gzip.open(folder / "labels.nii.gz", "rb") as file:
        content = file.read()
    header, voxels = content[:352], np.frombuffer(content, np.uint8, offset=352)
    masks = folder / "masks"
    masks.mkdir()
    for number in np.unique(voxels)[1:MASKS + 1]:
        with gzip.open(masks / f"label_{number}.nii.gz", "wb", compresslevel=1) as file:
            file.write(header)
            file.write((voxels == number).astype(np.uint8).tobytes())
    return len(list(masks.iterdir()))


def read_masks(folder):
    load()
    from sonovdb.vtkSonoFilters import vtkSonoMaskFolderReader
    reader = vtkSonoMaskFolderReader()
    reader.SetFileName(str(folder / "masks"))
    start = time.perf_counter()
    reader.Update()
    print(f"TOOK {time.perf_counter() - start} {reader.GetOutput().GetPointData().GetScalars().GetRange()[1]} 0")


def timed(work, folder):
    """What another process printed of its work: seconds, and what else it found."""
    environment = dict(os.environ, XDG_CACHE_HOME=str(folder / "cache"))
    run = subprocess.run(["pvpython", __file__, str(folder), work], check=True, capture_output=True, text=True, env=environment)
    return [float(word) for word in next(line.split()[1:] for line in run.stdout.splitlines() if line.startswith("TOOK"))]


def main():
    if len(sys.argv) > 1:
        {"picture": first_picture, "masks": read_masks}[sys.argv[2]](pathlib.Path(sys.argv[1]))
        return
    with tempfile.TemporaryDirectory() as name:
        load()
        print(f"first_picture_labels {write_files(pathlib.Path(name))} labels")
        pictures = set()
        for figure, asked in (("first_picture", 15), ("second_picture", 2)):
            took, peak, seen = timed("picture", pathlib.Path(name))
            pictures.add(seen)
            print(f"{figure}_s {took:.2f} s (asked: {asked})")
            print(f"{figure}_peak_mb {peak:.0f} MB (asked: 3000)")
        assert len(pictures) == 1, "the second picture is another one"
        print(f"masks {write_masks(pathlib.Path(name))} files")
        print(f"masks_read_s {timed('masks', pathlib.Path(name))[0]:.2f} s (asked: 10)")


main()
