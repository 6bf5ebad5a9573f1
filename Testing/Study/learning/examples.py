"""Labelled pictures from folders: SonoVDB's own data sets, CAMUS, EchoNet-Dynamic, and a folder a view.

Each reader gives Examples in the order of their names. Pictures are square, SIDE pixels, grey levels 0 to 255; masks
have the values of STRUCTURES. Needs numpy and Pillow; nibabel for CAMUS, OpenCV for EchoNet-Dynamic.
"""

import csv
import json
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Optional

import numpy

SIDE = 224
STRUCTURES = ["background", "ventricle", "wall", "atrium"]
VIEWS = ["A2C", "A3C", "A4C", "A5C"]
SPLITS = ["train", "validation", "test"]

# What data sets of SonoVDB call the structures.
MASK_GROUPS = {"LV cavity": 1, "LV wall": 2, "left atrium": 3}


class Unreadable(Exception):
    """One sentence: which file or folder, and the way out."""


@dataclass(frozen=True)
class Example:
    """A picture, not yet read. Structures without a mask in the data set are not in `marked`."""

    name: str
    patient: str
    split: str
    view: Optional[str]
    marked: frozenset
    picture: Callable[[], numpy.ndarray]
    mask: Optional[Callable[[], numpy.ndarray]]


def square(array, smooth):
    """Padded to a square by zeros on both sides, then SIDE pixels wide; masks by nearest pixels."""
    from PIL import Image

    height, width = array.shape
    edge = max(height, width)
    top, left = (edge - height) // 2, (edge - width) // 2
    padded = numpy.zeros((edge, edge), dtype=array.dtype)
    padded[top : top + height, left : left + width] = array
    kind = Image.Resampling.BOX if smooth else Image.Resampling.NEAREST
    return numpy.asarray(Image.fromarray(padded).resize((SIDE, SIDE), kind))


def with_values(mask, values):
    """Pixels of `mask` by a table {value in the file: structure}; all others are background."""
    table = numpy.zeros(256, dtype=numpy.uint8)
    for value, structure in values.items():
        table[value] = structure
    return table[mask.astype(numpy.uint8)]


def _png(path):
    from PIL import Image

    return numpy.asarray(Image.open(path).convert("L"))


def _json(path):
    try:
        return json.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise Unreadable(f"cannot read '{path}': {error}; write the data set again.") from error


def sonovdb(folder):
    """A data set of SonoVDB, in nnU-Net's or MONAI's folders."""
    folder = Path(folder)
    infos = sorted((folder / "info").glob("*.json"))
    if not infos:
        raise Unreadable(f"'{folder}' has no info/*.json; give the folder that a data set was written to.")
    monai = (folder / "images").is_dir()
    examples = []
    for path in infos:
        info = _json(path)
        case, split = info["case"], info["split"]
        if monai:
            picture, mask = folder / "images" / f"{case}.png", folder / "labels" / f"{case}.png"
        else:
            end = "Ts" if split == "test" else "Tr"
            picture, mask = folder / f"images{end}" / f"{case}_0000.png", folder / f"labels{end}" / f"{case}.png"
        values = {
            group["value"]: MASK_GROUPS[name]
            for name, group in info["masks"].items()
            if name in MASK_GROUPS and group["inPatient"]
        }
        examples.append(
            Example(
                case,
                f"{info['patient']['id']} {info['patient']['copy']}",
                split,
                info["view"],
                frozenset(values.values()),
                lambda p=picture: square(_png(p), True),
                lambda p=mask, v=values: square(with_values(_png(p), v), False),
            )
        )
    return examples


def camus(folder):
    """CAMUS as its authors give it: database_nifti/patientNNNN/patientNNNN_{2,4}CH_{ED,ES}[_gt].nii.gz, and the splits
    of database_split/subgroup_{training,validation,testing}.txt; without those all patients are for testing."""
    import nibabel

    root = Path(folder)
    patients = root / "database_nifti" if (root / "database_nifti").is_dir() else root
    splits = {}
    for split, file in zip(SPLITS, ["training", "validation", "testing"]):
        path = root / "database_split" / f"subgroup_{file}.txt"
        if path.is_file():
            splits.update({patient: split for patient in path.read_text().split()})

    def slice_of(path):
        # The first axis runs along the array, the second away from it.
        array = numpy.asarray(nibabel.load(path).dataobj)
        return array.reshape(array.shape[:2]).T.astype(numpy.uint8)

    examples = []
    for path in sorted(patients.glob("patient*/patient*_?CH_E?.nii.gz")):
        patient, chambers, _ = path.name.split("_")
        mask = path.with_name(path.name.replace(".nii.gz", "_gt.nii.gz"))
        if chambers not in ("2CH", "4CH") or not mask.is_file():
            continue
        examples.append(
            Example(
                path.name[: -len(".nii.gz")],
                patient,
                splits.get(patient, "test"),
                {"2CH": "A2C", "4CH": "A4C"}[chambers],
                frozenset({1, 2, 3}),
                lambda p=path: square(slice_of(p), True),
                lambda p=mask: square(slice_of(p), False),
            )
        )
    if not examples:
        raise Unreadable(f"'{folder}' has no patient*_4CH_ED.nii.gz; give the folder of CAMUS that has database_nifti.")
    return examples


def _frame(path, number):
    import cv2

    video = cv2.VideoCapture(str(path))
    video.set(cv2.CAP_PROP_POS_FRAMES, number)
    there, frame = video.read()
    video.release()
    if not there:
        raise Unreadable(f"'{path}' has no frame {number}; download the video again.")
    return cv2.cvtColor(frame, cv2.COLOR_BGR2GRAY)


def traced_area(chords, shape):
    """Mask of a ventricle from EchoNet-Dynamic's tracing: rows of x1, y1, x2, y2 in pixels, of which the first is the
    long axis and the others cross it, from one end to the other."""
    from PIL import Image, ImageDraw

    chords = numpy.asarray(chords, dtype=float)[1:]
    outline = numpy.concatenate([chords[:, :2], chords[::-1, 2:]])
    image = Image.new("L", (shape[1], shape[0]), 0)
    ImageDraw.Draw(image).polygon([tuple(point) for point in outline], fill=1)
    return numpy.asarray(image)


def echonet(folder):
    """EchoNet-Dynamic: FileList.csv, VolumeTracings.csv and Videos/*.avi; the two traced frames of each video. Only the
    ventricle is marked."""
    folder = Path(folder)
    if not (folder / "FileList.csv").is_file():
        raise Unreadable(f"'{folder}' holds no FileList.csv; give the folder of EchoNet-Dynamic.")
    splits = {"TRAIN": "train", "VAL": "validation", "TEST": "test"}
    with open(folder / "FileList.csv", newline="") as stream:
        split_of = {Path(row["FileName"]).stem: splits[row["Split"]] for row in csv.DictReader(stream)}
    tracings = defaultdict(list)
    with open(folder / "VolumeTracings.csv", newline="") as stream:
        for row in csv.DictReader(stream):
            chord = [float(row[key]) for key in ("X1", "Y1", "X2", "Y2")]
            tracings[Path(row["FileName"]).stem, int(row["Frame"])].append(chord)
    examples = []
    for (video, frame), chords in sorted(tracings.items()):
        path = folder / "Videos" / f"{video}.avi"
        if video not in split_of or not path.is_file():
            continue

        def mask(path=path, frame=frame, chords=chords):
            return square(traced_area(chords, _frame(path, frame).shape), False)

        examples.append(
            Example(
                f"{video}_{frame}",
                video,
                split_of[video],
                "A4C",
                frozenset({1}),
                lambda p=path, f=frame: square(_frame(p, f), True),
                mask,
            )
        )
    return examples


def views(folder):
    """Pictures sorted into folders by view, FOLDER/[SPLIT/]VIEW/*.png; without splits all are for testing. A file's
    patient is its name up to the last underscore. TTE47 and other collections without masks are sorted so."""
    folder = Path(folder)
    examples = []
    for path in sorted(p for end in ("png", "jpg", "jpeg") for p in folder.glob(f"**/*.{end}")):
        if path.parent.name not in VIEWS:
            continue
        split = path.parent.parent.name
        examples.append(
            Example(
                path.stem,
                path.stem.rpartition("_")[0] or path.stem,
                split if split in SPLITS else "test",
                path.parent.name,
                frozenset(),
                lambda p=path: square(_png(p), True),
                None,
            )
        )
    if not examples:
        raise Unreadable(f"'{folder}' holds no pictures in folders named {', '.join(VIEWS)}; sort them so.")
    return examples


READERS = {"sonovdb": sonovdb, "camus": camus, "echonet": echonet, "views": views}


def read(source):
    """Examples of KIND:FOLDER, or of a data set's folder of SonoVDB."""
    kind, colon, folder = str(source).partition(":")
    if not colon:
        kind, folder = "sonovdb", str(source)
    if kind not in READERS:
        raise Unreadable(f"'{kind}' is no kind of data set; there are {', '.join(READERS)}.")
    return READERS[kind](folder)
