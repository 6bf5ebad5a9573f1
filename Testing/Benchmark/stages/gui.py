# A probe that is dragged along the skin of the bundled thorax at 1 mm, once as a chain of proxies and once as the one filter,
# in pvpython, without drawing the views. Run by measure.sh with SONOVDB_PLUGIN and PYTHONPATH set.
import os
import time

from paraview import simple
from paraview.servermanager import Fetch
from sonovdb.vtkSonoWidgets import vtkSonoProbeRepresentation

FRAMES = 60
STEP_MM = 1.0


def drag(name, probe, picture, skin):
    """Prints the figures of one drag and of the rest after it. `picture` is what the view shows of the image."""
    hand = vtkSonoProbeRepresentation()
    # A view asks for the output that it shows; UpdatePipeline() would ask for all ten of the one filter, and gather what is known
    # of each.
    made = picture.SMProxy.GetClientSideObject()

    def show(preview):
        """One picture at the pose of the hand, as the probe's panel asks for it; the seconds that it took."""
        start = time.perf_counter()
        for name in ("PositionMm", "Axial", "Lateral"):
            probe.GetProperty(name).SetData(getattr(hand, "Get" + name)())
        probe.Preview = preview
        made.Update(0)
        return time.perf_counter() - start

    show(0)
    if not made.GetOutputDataObject(0).GetPointData().HasArray("BMode"):
        raise SystemExit("gui: the chain made no picture")
    start = time.perf_counter()
    hand.GetSkin().SetSurfaces(skin)
    hand.GetSkin().Prepare()  # as the panel does when nothing else is to be done
    prepare_s = time.perf_counter() - start
    times = []
    for _ in range(FRAMES):
        start = time.perf_counter()
        if not hand.Walk(STEP_MM, 0.0):
            raise SystemExit("gui: " + hand.GetMessage())
        show(1)
        times.append(time.perf_counter() - start)
    rest_s = show(0)
    print(f"{name}_frames_per_s {FRAMES / sum(times):.4g} 1/s")
    print(f"{name}_first_frame_s {times[0]:.4g} s")
    print(f"{name}_median_frame_s {sorted(times)[FRAMES // 2]:.4g} s")
    print(f"{name}_worst_frame_s {max(times):.4g} s")
    print(f"{name}_rest_s {rest_s:.4g} s")  # full quality when the probe rests
    print(f"{name}_prepare_skin_s {prepare_s:.4g} s", flush=True)  # once, between the last picture and the drag


simple.LoadPlugin(os.environ["SONOVDB_PLUGIN"], remote=False, ns=vars(simple))
thorax = simple.ThoraxPhantom(Spacingmm=1)
scene = simple.UltrasoundScene(Input=thorax)
posed = simple.UltrasoundProbe()
bmode = simple.UltrasoundBMode(Input=simple.UltrasoundImageFormation(
    Input=simple.UltrasoundRayTracer(Scene=scene, Probe=posed)))
converted = simple.ScanConverter(Input=bmode)
surfaces = Fetch(scene)
drag("drag", posed, converted, surfaces)
for stage in (converted, bmode, bmode.Input, bmode.Input.Input):
    simple.Delete(stage)
one = simple.SimulateUltrasound(Input=scene)
drag("one_filter_drag", one, one, surfaces)
