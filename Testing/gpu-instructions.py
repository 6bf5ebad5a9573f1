#!/usr/bin/env python3
"""What an image's kernels issue on a GPU, of ncu's table on the standard input: `run-gpu.sh instructions` asks for it.

An image's kernels are those from one follower of the lines' times to the next; that of most instructions but the first,
which prepares the scene besides, is the whole one. Each scheduler issues one instruction of a warp in a cycle at most: so
all of them take at least `gpu_image_issue_floor_ms`, whatever they wait for."""

import csv
import re
import sys

metrics = {"instructions": "smsp__inst_executed.sum", "ns": "gpu__time_duration.sum",
           "processors": "device__attribute_multiprocessor_count", "kHz": "device__attribute_clock_rate"}
schedulers = 4  # of a multiprocessor
first_kernel = "timeLines"
path_kernel = "tracePaths"  # grows with the paths, the others do not


def launches(lines):
    rows = csv.reader(line for line in lines if line.startswith('"'))
    header = next(rows)
    found = {}
    for row in rows:
        entry = dict(zip(header, row))
        name = re.match(r"(?:void )?(?:(?:\w+|<unnamed>)::)*(\w+)", entry["Kernel Name"]).group(1)
        found.setdefault(int(entry["ID"]), {"name": name})[entry["Metric Name"]] = float(
            entry["Metric Value"].replace(",", ""))
    return [found[number] for number in sorted(found)]


def images(kernels):
    starts = [n for n, kernel in enumerate(kernels) if kernel["name"] == first_kernel]
    return [kernels[a:b] for a, b in zip(starts, starts[1:])]


def instructions(kernels):
    return sum(kernel[metrics["instructions"]] for kernel in kernels)


whole = max(images(launches(sys.stdin))[1:], key=instructions)
by_name = {}
for kernel in whole:
    sums = by_name.setdefault(kernel["name"], [0.0, 0.0])
    sums[0] += kernel[metrics["instructions"]]
    sums[1] += kernel[metrics["ns"]]
for name, (count, ns) in by_name.items():
    print(f"gpu_instructions_{name} {count * 1e-6:.4g} million")
    print(f"gpu_alone_{name}_ms {ns * 1e-6:.4g} ms")
total = instructions(whole)
of_paths = by_name[path_kernel][0]
issued_per_ms = whole[0][metrics["processors"]] * schedulers * whole[0][metrics["kHz"]]
print(f"gpu_image_instructions {total * 1e-6:.4g} million")
print(f"gpu_image_issue_floor_ms {total / issued_per_ms:.4g} ms")
print(f"gpu_image_issue_floor_of_paths_ms {of_paths / issued_per_ms:.4g} ms")
