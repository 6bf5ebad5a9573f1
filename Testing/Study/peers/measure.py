"""Time and error of programs of others, and the error of ours, on the scenes of FOLDER/peers_scenes.json.

measure.py FOLDER [--quick] leaves peers_theirs.csv, a row for each setting of each program on each device that is here,
the CPU and an NVIDIA GPU, also of those that are not installed or do not run here, peers_reference.csv, how far the reference lies from itself by another way, and for each
scene the pulse for us (peers_pulse_NAME.csv).
measure.py FOLDER --ours then reads our signals (peers_ours_NAME_DEVICE.f32, transmits x elements x samples, of the
devices cpu and cuda) and leaves peers_ours.csv with their errors.
"""
import csv
import importlib
import importlib.metadata
import itertools
import json
import os
import pathlib
import pickle
import resource
import subprocess
import sys
import time

import numpy as np
import reference
import simulators

HEADER = ["scene", "program", "version", "setting", "seconds", "core seconds", "first call, s", "error", "device"]
SIMULATORS = ("PyMust", "FastSimus", "Zea", "Esdiva", "KWave")
NOT_RUN = [
    ("fullwave25", "not run: it needs an NVIDIA GPU, and its solver asks for programs that the wheel of 1.4.1 lacks and that "
                   "it fetches from elsewhere when it runs; wheels to 1.1.3 hold theirs, but there a source prescribes the "
                   "pressure, so that an element hears nothing where it sends; k-Wave stands for what solves waves"),
    ("OpenBCSim", "not run: C++ with no wheel and no Debian package; its method, points under a beam's profile (COLE), "
                  "has no element signals"),
    ("raysim", "not run: no wheel (the package of that name is another one), needs OptiX; rays through surfaces, no "
               "element signals"),
]
LONGEST = 240  # seconds of one program on one device; XLA has been seen to wait for ever on two cores


def device_names():
    """Devices that are here, with their names in the tables."""
    names = {"cpu": "CPU"}
    try:
        told = subprocess.run(["nvidia-smi", "--query-gpu=name", "--format=csv,noheader"], text=True, timeout=60,
                              capture_output=True)
        if told.returncode == 0 and told.stdout.strip():
            names["cuda"] = "GPU, " + told.stdout.strip().splitlines()[0]
    except (OSError, subprocess.TimeoutExpired):
        pass
    return names


def write(path, header, rows):
    with open(path, "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([header, *rows])


def core_seconds():
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in used)


def measured(run):
    """The first call's seconds, then medians of wall and core seconds of up to three more; one call that takes longer
    than 5 s counts itself where nothing is compiled in it."""
    times = []
    while len(times) < 4:
        core, wall = core_seconds(), time.perf_counter()
        signals = run()
        times.append((time.perf_counter() - wall, core_seconds() - core))
        if len(times) > 1 and sum(t[0] for t in times) > 10 or times[0][0] > 20:
            break
    later = times[1:] or times
    return (*np.median(later, axis=0), times[0][0], signals)


def spectrum_of(folder, scene):
    return pickle.loads((folder / f"peers_spectrum_{scene['name']}.pickle").read_bytes())


def run_one(folder, name, device):
    """Prints a row a setting, in a process of its own: a program that dies or hangs takes no other with it."""
    simulator = getattr(simulators, name)(device)
    for scene in json.loads((folder / "peers_scenes.json").read_text()):
        if scene["name"] not in simulator.scenes:
            continue
        spectrum = spectrum_of(folder, scene)
        for words, run in itertools.islice(simulator.settings(scene), 1 if "--quick" in sys.argv else None):
            wall, core, first, signals = measured(run)
            error, _ = reference.difference(spectrum, *signals)
            row = [scene["name"], simulator.name, importlib.metadata.version(simulator.package), words, f"{wall:.6g}",
                   f"{core:.6g}", f"{first:.6g}", f"{error:.6g}"]
            print("ROW " + json.dumps(row), flush=True)


def is_installed(package):
    try:
        importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return False
    return True


def rows_of(folder, name, device, device_name):
    kind = getattr(simulators, name)
    # One thread for matrices: PyMUST multiplies small ones, for which two waiting for each other take many times as long.
    environment = dict(os.environ, KERAS_BACKEND="jax", XDG_CACHE_HOME=str(folder / "cache"), OPENBLAS_NUM_THREADS="1",
                       JAX_PLATFORMS=device, JAX_TRACEBACK_FILTERING="off")
    try:
        process = subprocess.run([sys.executable, __file__, str(folder), "--one", name, device, *sys.argv[2:]],
                                 env=environment, text=True, capture_output=True, timeout=LONGEST)
        output, errors, failed = process.stdout, process.stderr.strip(), process.returncode != 0
    except subprocess.TimeoutExpired as error:
        output, errors, failed = (error.stdout or b"").decode(), f"stopped after {LONGEST} s", True
    rows = [json.loads(line[4:]) + [device_name] for line in output.splitlines() if line.startswith("ROW ")]
    if failed:
        print(errors, file=sys.stderr, flush=True)
        last = errors.splitlines()[-1] if errors else "it ended without a word"
        rows.append([kind.scenes[0], kind.name, "", "failed: " + last, "", "", "", "", device_name])
    return rows


def check(scene, spectrum):
    """The reference by another way, on two points, and with twice as many nodes, on ten."""
    times = np.arange(0, spectrum.length, 1 / scene["sampling"])
    fine = reference.Spectrum(scene, scene["points"][:10], 2, [0])
    coarse = reference.Spectrum(scene, scene["points"][:10], 1, [0])
    nodes = np.linalg.norm(fine.values - coarse.values) / np.linalg.norm(fine.values)
    # A cylinder's waves have tails, which no sum of delayed pulses has.
    if scene["waves"] == "cylinder" or "--quick" in sys.argv and scene["waves"] != "flat":
        return [scene["name"], f"{nodes:.2g}", "", len(spectrum.f)]
    one = dict(scene, delays=scene["delays"][:1])
    few = reference.Spectrum(one, scene["points"][:2], 2, [0])
    other, _ = reference.difference(few, reference.in_time(one, scene["points"][:2], [0], times), scene["sampling"])
    return [scene["name"], f"{nodes:.2g}", f"{other:.2g}", len(spectrum.f)]


def compare_ours(folder):
    rows = []
    names = device_names()
    for scene, device in itertools.product(json.loads((folder / "peers_scenes.json").read_text()), ("cpu", "cuda")):
        path = folder / f"peers_ours_{scene['name']}_{device}.f32"
        if path.exists():
            rf = np.fromfile(path, dtype=np.float32)
            rf = rf.reshape(len(scene["delays"]), len(scene["elementX"]), -1)
            error, _ = reference.difference(spectrum_of(folder, scene), rf, scene["sampling"])
            rows.append([scene["name"], f"{error:.6g}", names.get(device, "GPU")])
    write(folder / "peers_ours.csv", ["scene", "error", "device"], rows)
    for used in [*folder.glob("peers_spectrum_*.pickle"), *folder.glob("peers_ours_*.f32")]:
        used.unlink()


def main(folder):
    checks, rows = [], []
    for scene in json.loads((folder / "peers_scenes.json").read_text()):
        if scene["waves"] == "cylinder":
            try:
                importlib.import_module("scipy.special")
            except ImportError:
                continue
        start = time.perf_counter()
        spectrum = reference.Spectrum(scene, scene["points"])
        seconds = time.perf_counter() - start
        checks.append(check(scene, spectrum) + [f"{seconds:.3g}"])
        t, p = reference.pulse_samples(scene)
        write(folder / f"peers_pulse_{scene['name']}.csv", ["time_us", "amplitude"],
              [(f"{a:.9g}", f"{b:.9g}") for a, b in zip(t, p)])
        (folder / f"peers_spectrum_{scene['name']}.pickle").write_bytes(pickle.dumps(spectrum))
    write(folder / "peers_reference.csv", ["scene", "twice the nodes", "by delays in time", "frequencies", "seconds"],
          checks)
    names = device_names()
    for name in SIMULATORS:
        kind = getattr(simulators, name)
        if not is_installed(kind.package):
            rows.append([kind.scenes[0], kind.name, "", "not installed; see install-dependencies.sh tests --peers", "", "",
                         "", "", ""])
            continue
        for device in kind.devices:
            if device in names:
                found = rows_of(folder, name, device, names[device])
                rows += found
                for row in found:
                    print(*row[:5], row[7], row[8], file=sys.stderr, flush=True)
    rows += [["", name, "", words, "", "", "", "", ""] for name, words in NOT_RUN]
    write(folder / "peers_theirs.csv", HEADER, rows)


if __name__ == "__main__":
    if "--ours" in sys.argv:
        compare_ours(pathlib.Path(sys.argv[1]))
        sys.exit()
    if "--one" in sys.argv:
        run_one(pathlib.Path(sys.argv[1]), *sys.argv[sys.argv.index("--one") + 1:][:2])
    else:
        main(pathlib.Path(sys.argv[1]).resolve())
