# A probe that is dragged along the skin of the bundled thorax at 1 mm: the whole chain of proxies in pvpython, the default
# probe's 128 lines, without drawing the views. Run by measure.sh with SONOVDB_PLUGIN and PYTHONPATH set.
import os
import time

from paraview import simple
from paraview.servermanager import Fetch
from sonovdb.vtkSonoWidgets import vtkSonoProbeRepresentation

FRAMES = 60
STEP_MM = 1.0

simple.LoadPlugin(os.environ["SONOVDB_PLUGIN"], remote=False, ns=vars(simple))
scene = simple.UltrasoundScene(Input=simple.ThoraxPhantom(VoxelSizemm=1))
probe = simple.UltrasoundProbe()
bmode = simple.UltrasoundBMode(Input=simple.UltrasoundImageFormation(
    Input=simple.UltrasoundRayTracer(Scene=scene, Probe=probe)))
picture = simple.ScanConverter(Input=bmode)
hand = vtkSonoProbeRepresentation()
hand.GetSkin().SetSurfaces(Fetch(scene))


def show(preview):
    """One picture at the pose of the hand, as the probe's panel asks for it; the seconds that it took."""
    start = time.perf_counter()
    probe.Positionmm, probe.AxialDirection, probe.LateralDirection = (
        hand.GetPositionMm(), hand.GetAxial(), hand.GetLateral())
    probe.Preview = preview
    picture.UpdatePipeline()
    if picture.GetDataInformation().GetPointDataInformation().GetArrayInformation("BMode") is None:
        raise SystemExit("gui: the chain made no picture")
    return time.perf_counter() - start


show(0)
times = []
for frame in range(FRAMES):
    start = time.perf_counter()
    if not hand.Walk(STEP_MM, 0.0):
        raise SystemExit("gui: " + hand.GetMessage())
    show(1)
    times.append(time.perf_counter() - start)
rest_s = show(0)

print(f"drag_frames_per_s {FRAMES / sum(times):.4g} 1/s")
print(f"drag_frame_median_s {sorted(times)[FRAMES // 2]:.4g} s")
print(f"drag_first_frame_s {times[0]:.4g} s")  # prepares the scene around the probe, for all that follow
print(f"drag_worst_later_frame_s {max(times[1:]):.4g} s")
print(f"drag_rest_s {rest_s:.4g} s")  # full quality when the probe rests
