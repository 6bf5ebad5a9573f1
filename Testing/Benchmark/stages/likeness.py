# How like real apical four-chamber pictures those of 200 drawn bodies are, by a program that knows the statistics of real ones.
"""Makes one four-chamber picture of each of 200 bodies as `apical_views` declares them and gives them, with their masks, to the program
that ECHO_STATS names, or ../shared/tools/echo_stats.py (needs python3-scipy and python3-pil): each statistic's distance from its mean
over real pictures, in their standard deviations."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import paraview  # noqa: F401  (finds ParaView's VTK libraries)
from sonovdb.vtkSonoFilters import vtkSonoDataSet

ROOT = pathlib.Path(__file__).resolve().parents[3]
BODIES = 200
PIXEL_MM = 0.308  # of the real ones


def declare(path):
    declared = json.loads((ROOT / "Data/datasets/apical_views.json").read_text())
    del declared["$schema"]
    declared.update(name="likeness", seed=5, exams=BODIES, imagesPerExam=1, pixelMm=PIXEL_MM)
    declared["patients"][0].update(copies=BODIES, views=[{"name": "A4C"}])
    path.write_text(json.dumps(declared))


def main():
    program = pathlib.Path(os.environ.get("ECHO_STATS", ROOT.parent / "shared/tools/echo_stats.py"))
    if not program.is_file():
        sys.exit(f"likeness: '{program}' is not there; name the program in ECHO_STATS.")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        declare(folder / "likeness.json")
        made = vtkSonoDataSet()
        made.SetFileName(str(folder / "likeness.json"))
        made.SetFolder(str(folder / "made"))
        made.Update()
        pairs = []
        for end in ("Tr", "Ts"):
            for picture in sorted((folder / f"made/images{end}").glob("*_0000.png")):
                pairs += [str(picture), str(folder / f"made/labels{end}" / picture.name.replace("_0000.png", ".png"))]
        # Debian's, whose packages are there; another Python may stand before it.
        told = subprocess.run(["/usr/bin/python3", str(program), str(PIXEL_MM)] + pairs, capture_output=True, text=True)
    if told.returncode:
        sys.exit(f"likeness: '{program}' failed: {told.stderr.strip()}")
    print(told.stdout, file=sys.stderr)
    lines = re.findall(r"^(\S+) .* z ([+-][0-9.]+)$", told.stdout, re.M)
    inside = sum(abs(float(z)) <= 1.0 for _, z in lines)
    worst = max(lines, key=lambda line: abs(float(line[1])))
    print(f"likeness_pictures {len(pairs) // 2} pictures")
    print(f"camus_lines_within_1sd_percent {100.0 * inside / len(lines):.0f} % (asked: 90)")
    print(f"camus_worst_z {abs(float(worst[1])):.1f} SD, {worst[0]} (asked: 2)")


main()
