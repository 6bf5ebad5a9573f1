#!/usr/bin/env python3
"""variants.py FILE FOLDER: of a data set's declaration, three in the folder that differ in one thing each, as in the
ablation of Amadou et al. 2024: mcpt.json as it is, straight.json whose paths leave nothing to chance and do not spread,
field.json whose echoes are weighted by the computed beam of the probe's elements."""

import copy
import json
import sys
from pathlib import Path

CHANGES = {
    "mcpt": {},
    "straight": {"tracing": {"deterministic": True, "pathsPerLine": 1}},
    "field": {"echo": {"beam": "Computed"}},
}


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    declared = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    folder = Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    for name, changes in CHANGES.items():
        variant = copy.deepcopy(declared)
        variant["name"] = name
        for group, values in changes.items():
            variant.setdefault(group, {}).update(values)
        (folder / f"{name}.json").write_text(json.dumps(variant, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
