"""A sheet of real and simulated pictures in chance order, without a word on it, to ask people which are which.

sheet.py REAL DRAWN SHEET.png [--count 8] [--seed 1]: pictures (PNG) of the two folders, at most so many of each; which
tile is which goes into SHEET.csv. Real pictures and sheets with them are never committed. Needs python3-pil.
"""
import argparse
import csv
import pathlib
import random
import sys

from PIL import Image

TILE = 300
COLUMNS = 4


def tile(path):
    """What isn't black, as large as the others. Text that a scanner burnt in stays: leave such pictures out."""
    picture = Image.open(path).convert("L")
    box = picture.point(lambda grey: 255 if grey > 8 else 0).getbbox() or (0, 0, *picture.size)
    picture = picture.crop(box)
    picture.thumbnail((TILE, TILE), Image.LANCZOS)
    square = Image.new("L", (TILE, TILE))
    square.paste(picture, ((TILE - picture.width) // 2, (TILE - picture.height) // 2))
    return square


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("real", type=pathlib.Path)
    parser.add_argument("drawn", type=pathlib.Path)
    parser.add_argument("sheet", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=8, help="of each, at most")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    chance = random.Random(given.seed)
    chosen = []
    for kind, folder in (("real", given.real), ("simulated", given.drawn)):
        paths = sorted(folder.glob("*.png"))
        if not paths:
            sys.exit(f"sheet.py: '{folder}' holds no PNG files: name a folder of pictures.")
        chosen += [(kind, path) for path in chance.sample(paths, min(given.count, len(paths)))]
    chance.shuffle(chosen)
    rows = -(-len(chosen) // COLUMNS)
    sheet = Image.new("L", (COLUMNS * TILE, rows * TILE))
    for n, (_, path) in enumerate(chosen):
        sheet.paste(tile(path), (n % COLUMNS * TILE, n // COLUMNS * TILE))
    sheet.save(given.sheet)
    with given.sheet.with_suffix(".csv").open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows(
            [("row", "column", "kind", "file"),
             *((n // COLUMNS + 1, n % COLUMNS + 1, kind, path.name) for n, (kind, path) in enumerate(chosen))])


main()
