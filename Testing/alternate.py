#!/usr/bin/env python3
"""alternate.py OLD_BUILD NEW_BUILD [ROUNDS] [defaults]: is anything slower than it was?

Two build folders' filters make the bundled A4C in turn, each time in a new process, on the CPU, with Amadou2024's
numbers, which every version knows, or each with its own defaults. Prints the processor seconds of each part, medians of
ROUNDS (6), as `name old new new/old`. What else the machine does meets both alike.
"""
import os
import resource
import statistics
import subprocess
import sys


def processor_s():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def parts(defaults):
    import sonovdb.vtkSonoFilters as filters

    thorax = filters.vtkSonoThoraxSource()
    thorax.Update()
    scene = filters.vtkSonoSceneBuilder()
    scene.SetBuildSurfaces(False)
    scene.SetInputConnection(thorax.GetOutputPort())
    probe = filters.vtkSonoProbeSource()
    pose = thorax.GetOutput().GetFieldData()
    for name in ("PositionMm", "Axial", "Lateral"):
        getattr(probe, "Set" + name)(pose.GetArray("A4C" + name).GetTuple3(0))
    tracer, former = filters.vtkSonoRayTracer(), filters.vtkSonoImageFormation()
    bmode, converter = filters.vtkSonoBMode(), filters.vtkSonoScanConverter()
    for stage, port, source in ((tracer, 0, scene), (tracer, 1, probe), (former, 0, tracer), (bmode, 0, former),
                                (converter, 0, bmode)):
        stage.SetInputConnection(port, source.GetOutputPort())
    tracer.SetDevice(1)
    former.SetDevice(1)
    if not defaults:
        tracer.SetInterfaceModel(1)
        tracer.SetPathsPerLine(1000)
        tracer.SetMaxCollisions(7)
        tracer.SetLobeSigmaDeg(45.0)
    set_seed = getattr(tracer, "SetPathSeed", None) or tracer.SetSeed

    def cost(stage):
        begin = processor_s()
        stage.Update()
        return processor_s() - begin

    yield "first", cost(converter)
    for seed in (2, 3, 4):
        set_seed(seed)
        costs = [cost(tracer), cost(former), cost(converter)]
        yield from zip(("trace", "echo", "display"), costs)
        yield "image", sum(costs)
    probe.SetPreview(True)
    converter.Update()
    x, y, z = probe.GetPositionMm()
    for step in range(8):
        probe.SetPositionMm(x - 0.5 * step, y, z + 0.3 * step)
        yield "drag", cost(converter)


def run(build, words):
    libraries = os.path.join(build, "lib")
    environment = dict(os.environ, PYTHONPATH=os.path.join(libraries, "python3/dist-packages"),
                       LD_LIBRARY_PATH=libraries)
    printed = subprocess.run(["pvpython", os.path.abspath(__file__), "parts", *words], env=environment, check=True,
                             stdout=subprocess.PIPE, text=True).stdout
    costs = {}
    for line in printed.splitlines():
        name, seconds = line.split()
        costs.setdefault(name, []).append(float(seconds))
    return {name: statistics.median(values) for name, values in costs.items()}


def main():
    words = [word for word in sys.argv[1:] if word == "defaults"]
    given = [word for word in sys.argv[1:] if word != "defaults"]
    if given == ["parts"]:
        for name, seconds in parts(bool(words)):
            print(name, f"{seconds:.4f}")
        return
    if len(given) not in (2, 3):
        sys.exit(__doc__)
    builds = given[:2]
    rounds = [[run(build, words) for build in builds] for _ in range(int(given[2]) if len(given) == 3 else 6)]
    for name in rounds[0][0]:
        old, new = (statistics.median(each[which][name] for each in rounds) for which in (0, 1))
        print(f"{name} {old:.4f} {new:.4f} {new / old:.3f}")


if __name__ == "__main__":
    main()
