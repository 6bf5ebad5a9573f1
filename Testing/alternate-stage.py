#!/usr/bin/env python3
"""alternate-stage.py OLD_TREE NEW_TREE STAGE [ROUNDS]: what a machine makes of a stage of measure.sh that is a script (gui,
drawn, first), before and now.

Two source trees, each with its own build of the preset `release`, run their own script of that name in turn. Prints the medians
of ROUNDS (3) of what both print, as `name old new new/old unit`. A figure that was given for the old tree on another
machine, times the ratio, is what that machine may make of the new one.
"""
import os
import pathlib
import statistics
import subprocess
import sys


def figures(tree, stage):
    build = pathlib.Path(tree, "build").resolve()
    environment = dict(os.environ, SONOVDB_PLUGIN=str(build / "lib/paraview-5.11/plugins/SonoVDB/SonoVDB.so"),
                       PYTHONPATH=str(build / "lib/python3/dist-packages"),
                       XDG_CACHE_HOME="/dev/null")  # what an earlier run has kept is no figure
    script = pathlib.Path(tree, "Testing/Benchmark/stages", stage + ".py").resolve()
    printed = subprocess.run(["pvpython", str(script)], env=environment, check=True, stdout=subprocess.PIPE,
                             stderr=subprocess.DEVNULL, text=True).stdout
    found = {}
    for line in printed.splitlines():
        words = line.split()
        if len(words) == 3:
            try:
                found[words[0]] = float(words[1]), words[2]
            except ValueError:
                pass  # a sentence
    return found


def main():
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    trees, stage = sys.argv[1:3], sys.argv[3]
    rounds = [[figures(tree, stage) for tree in trees] for _ in range(int(sys.argv[4]) if len(sys.argv) == 5 else 3)]
    for name, (_, unit) in rounds[0][0].items():
        if name in rounds[0][1]:
            old, new = (statistics.median(each[which][name][0] for each in rounds) for which in (0, 1))
            print(f"{name} {old:.4g} {new:.4g} {new / old:.3f} {unit}")


if __name__ == "__main__":
    main()
