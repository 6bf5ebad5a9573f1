"""Data sets of simulated ultrasound: straight into a training loop, or from a written folder into WebDataset's shards."""
import io
import json
import os
import tarfile
import time
import uuid

from vtkmodules.util.numpy_support import vtk_to_numpy

from .dlpack import GpuArray
from .vtkSonoFilters import vtkSonoDataSet


class Dataset:
    """The images of a data set that a JSON file declares (see Data/docs/datasets.md), made when they are asked for and
    written nowhere.

    file   the declaring file, or the name of a bundled one; None: "apical"
    split  "train", "validation" or "test": these alone; None: all
    part, parts  which of how many processes this is; each has images of its own

    Gives (image, mask, info): two arrays of uint8, rows from the transducer on, 0 outside the scanned area and in the
    mask n for the n-th mask group; and all settings and flags as a dict. Anything wrong is a ValueError with one
    sentence.

    on_gpu  the two arrays are in the memory of the GPU that makes the images, for torch.from_dlpack and whoever else speaks
            DLPack, without a copy

    A loop over it is the quick way: threads make images ahead while the loop learns. On a GPU they come as they are
    made, those of up to sixteen bodies among each other, as quick as they are written into a folder; on a CPU in the
    order of their numbers. One loop at a time: another one ends the one before.

    Indexing and len() are those of the split and the part, so that PyTorch takes it as a map-style data set, too; each
    image is then made by itself, when it is asked for.
    """

    def __init__(self, file=None, split=None, part=0, parts=1, on_gpu=False):
        if split not in (None, "train", "validation", "test"):
            raise ValueError(f"split is '{split}': choose train, validation or test, or None for all")
        self._filter = vtkSonoDataSet()
        self._split = split or ""
        self._loop = None
        self._errors = []
        self._filter.AddObserver("ErrorEvent", self._hear())
        self._filter.SetFileName(os.fspath(file) if file is not None else "")
        self._filter.SetPart(part)
        self._filter.SetParts(parts)
        first, end = self._filter.GetFirstImage(), self._filter.GetEndImage()
        if on_gpu:
            self._filter.KeepOnGpu()
        self._refuse_errors()
        if split is None:
            self._numbers = range(first, end)
        else:
            self._numbers = [number for number in range(first, end) if self._filter.GetSplit(number) == split]

    def __len__(self):
        return len(self._numbers)

    def __getitem__(self, index):
        self._filter.SetImageNumber(self._numbers[index])
        return self._given()

    def __iter__(self):
        made = self._filter
        self._loop = loop = object()
        made.BeginStream(self._split)
        self._refuse_errors()
        try:
            while self._loop is loop:
                found = made.TakeImage()
                self._refuse_errors()
                if found == made.NO_IMAGE_LEFT:
                    return
                if found == made.IMAGE_AWAITED:
                    time.sleep(0.0005)  # where Python's other threads run, and Ctrl-C is heard
                else:
                    yield self._given()
        finally:
            if self._loop is loop:
                made.EndStream()
        raise ValueError("another loop over this data set has begun; use a second Dataset for it.")

    def _given(self):
        self._filter.Update()
        self._refuse_errors()
        made = self._filter.GetOutput()
        width, height, _ = made.GetDimensions()
        on_gpu = self._filter.GetGpuImage()  # None unless asked for
        if on_gpu:
            image, mask = (GpuArray(on_gpu, name) for name in ("BMode", "Mask"))
        else:
            image, mask = (vtk_to_numpy(made.GetPointData().GetArray(name)).reshape(height, width).copy()
                           for name in ("BMode", "Mask"))
        return image, mask, json.loads(made.GetFieldData().GetAbstractArray("Info").GetValue(0))

    def _hear(self):
        errors = self._errors

        def hear(_caller, _event, text):
            errors.append(text.split("):", 1)[-1].strip())

        hear.CallDataType = "string0"
        return hear

    def _refuse_errors(self):
        if self._errors:
            sentence = self._errors[-1]
            self._errors.clear()
            raise ValueError(sentence)


def _files_of(folder, name, info):
    """Where a written folder has the image and the mask of a case."""
    with open(os.path.join(folder, "dataset.json"), encoding="utf-8") as file:
        is_monai = "modality" in json.load(file)
    if is_monai:
        return os.path.join("images", name + ".png"), os.path.join("labels", name + ".png")
    end = "Ts" if info["split"] == "test" else "Tr"
    return os.path.join("images" + end, name + "_0000.png"), os.path.join("labels" + end, name + ".png")


def _write_shard(path, members):
    """Whole or not at all; the same bytes for the same members."""
    partial = f"{path}.{uuid.uuid4().hex}.part"
    with tarfile.open(partial, "w", format=tarfile.USTAR_FORMAT) as shard:
        for name, content in members:
            entry = tarfile.TarInfo(name)  # owner and time are 0
            entry.size = len(content)
            shard.addfile(entry, io.BytesIO(content))
    os.replace(partial, path)


def write_shards(folder, target, per_shard=1000):
    """Packs a folder that Ultrasound Data Set wrote into shards for WebDataset, TARGET/SPLIT-000000.tar and so on, of
    `per_shard` images each: CASE.image.png, CASE.mask.png and CASE.json, and where the file asked for channels
    CASE.channels.exr and CASE.beam.exr. Returns the paths."""
    os.makedirs(target, exist_ok=True)
    exr_folders = [name for name in ("channels", "beam") if os.path.isdir(os.path.join(folder, name))]
    members, counts, paths = {}, {}, []

    def flush(split):
        number = counts.get(split, 0)
        counts[split] = number + 1
        paths.append(os.path.join(target, f"{split}-{number:06d}.tar"))
        _write_shard(paths[-1], members.pop(split))

    for file_name in sorted(os.listdir(os.path.join(folder, "info"))):
        name, extension = os.path.splitext(file_name)
        if extension != ".json":
            continue
        with open(os.path.join(folder, "info", file_name), "rb") as file:
            text = file.read()
        info = json.loads(text)
        image, mask = _files_of(folder, name, info)
        of_split = members.setdefault(info["split"], [])
        channels = [(os.path.join(each, name + ".exr"), f".{each}.exr") for each in exr_folders]
        for part, end in ((image, ".image.png"), (mask, ".mask.png"), *channels):
            with open(os.path.join(folder, part), "rb") as file:
                of_split.append((name + end, file.read()))
        of_split.append((name + ".json", text))
        if len(of_split) == (3 + len(channels)) * per_shard:
            flush(info["split"])
    for split in sorted(members):
        flush(split)
    return paths
