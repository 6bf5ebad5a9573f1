# A probe that is dragged along the skin of the bundled thorax at 1 mm in pvpython, off-screen, each picture drawn: through the
# filter alone, in the flat view, and in the flat view and the one with the body, as ParaView's window draws them while a probe moves.
# Run by measure.sh, with SONOVDB_PLUGIN and PYTHONPATH set, and on a machine with a GPU by run-gpu.sh.
import os
import sys
import time

if "DISPLAY" not in os.environ:
    os.execvp("xvfb-run", ["xvfb-run", "-a", "-s", "-screen 0 1400x900x24", "pvpython", sys.argv[0]])

from paraview import simple
from paraview.servermanager import CreateProxy, Fetch, _getPyProxy
from sonovdb.vtkSonoFilters import vtkSonoUltrasound
from sonovdb.vtkSonoWidgets import vtkSonoImageMapper, vtkSonoProbeRepresentation
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray

FRAMES = 60
STEP_MM = 1.0
SIZE = [800, 800]
SKIPPED_UPDATE_DATA_EVENT = 1091  # vtkPVDataRepresentation has it


def parts_of(representation):
    proxy = representation.SMProxy
    each = proxy.NewPropertyIterator()
    each.Begin()
    parts = set()
    while not each.IsAtEnd():
        part = each.GetProperty().GetParent().GetClientSideObject()
        if part and part.IsA("vtkPVDataRepresentation"):
            parts.add(part)
        each.Next()
    return parts


def mute(representation):
    """So that ParaView does not gather after each picture what there is to choose from in panels."""
    for part in parts_of(representation):
        for event in ("UpdateDataEvent", SKIPPED_UPDATE_DATA_EVENT):
            tags = []
            tags.append(part.AddObserver(event, lambda caller, _, tags=tags: caller.GetCommand(tags[0]).AbortFlagOn(), 1000.0))


def view_of(filter, ports, position, up):
    """A view of these outputs, without what depends on a window."""
    view = simple.CreateView("RenderView", ViewSize=SIZE, UseFXAA=0, UseLight=0)
    shown = {port: simple.Show(simple.OutputPort(filter, port), view) for port in ports}
    if vtkSonoUltrasound.FLAT_IMAGE in shown:  # without opacity, as the layout's
        greys = _getPyProxy(CreateProxy("lookup_tables", "SonoColorTable"))
        greys.RGBPoints = [0, 0, 0, 0, 255, 1, 1, 1]
        greys.UpdateVTKObjects()
        shown[vtkSonoUltrasound.FLAT_IMAGE].LookupTable = greys
    simple.ResetCamera(view)
    camera = view.GetActiveCamera()
    focus = camera.GetFocalPoint()
    camera.SetPosition(*(f + 1000 * p for f, p in zip(focus, position)))
    camera.SetViewUp(*up)
    simple.ResetCamera(view)
    view.SMProxy.GetClientSideObject().SetUseDepthPeeling(0)
    view.SMProxy.StillRender()
    for representation in shown.values():
        mute(representation)
    return view, shown


def draw_on_gpu(views):
    """As ParaView's window does from a probe's first step on; where the GPU draws and has made the pictures, they stay there."""
    slices = [part for _, shown in views for each in shown.values() for part in parts_of(each)
              if part.IsA("vtkImageSliceRepresentation")]
    for part in slices:
        vtkSonoImageMapper.UseIn(part)
    return [part.GetActor().GetMapper() for part in slices]


def keep(view, representation):
    """The anatomy does not change with the pose."""
    drawn = representation.SMProxy.GetClientSideObject()
    drawn.SetForcedCacheKey(view.SMProxy.GetClientSideObject().GetCacheKey())
    drawn.SetForceUseCache(1)


def draw(view, shown):
    """Until the picture is there: a depth is asked for."""
    for port, representation in shown.items():
        if port != vtkSonoUltrasound.ANATOMY:
            representation.SMProxy.GetClientSideObject().MarkModified()
    view.SMProxy.MarkDirty(view.SMProxy)
    view.SMProxy.StillRender()
    view.SMProxy.GetRenderWindow().GetZbufferDataAtPoint(0, 0)


def pixels_of(view):
    window = view.SMProxy.GetRenderWindow()
    pixels = vtkUnsignedCharArray()
    window.GetPixelData(0, 0, SIZE[0] - 1, SIZE[1] - 1, 0, pixels, 0)
    return memoryview(pixels).tobytes()


def drag(name, filter, hand, step_mm, views):
    made = filter.SMProxy.GetClientSideObject()
    times = []
    for _ in range(FRAMES):
        start = time.perf_counter()
        if not hand.Walk(step_mm, 0.0):
            raise SystemExit("renders: " + hand.GetMessage())
        for part in ("PositionMm", "Axial", "Lateral"):
            filter.GetProperty(part).SetData(getattr(hand, "Get" + part)())
        filter.Preview = 1
        if not views:
            made.Update(0)
        for view, shown in views:
            draw(view, shown)
        times.append(time.perf_counter() - start)
    print(f"{name}_frames_per_s {FRAMES / sum(times):.4g} 1/s")
    print(f"{name}_median_frame_s {sorted(times)[FRAMES // 2]:.4g} s")
    print(f"{name}_worst_frame_s {max(times):.4g} s", flush=True)


simple.LoadPlugin(os.environ["SONOVDB_PLUGIN"], remote=False, ns=vars(simple))
thorax = simple.ThoraxPhantom(Spacingmm=1)
scene = simple.UltrasoundScene(Input=thorax)
surfaces = Fetch(scene)
one = simple.SimulateUltrasound(Input=scene)
one.UpdatePipeline()
if not one.SMProxy.GetClientSideObject().GetOutputDataObject(0).GetPointData().HasArray("BMode"):
    raise SystemExit("renders: the filter made no picture")
hand = vtkSonoProbeRepresentation()
hand.GetSkin().SetSurfaces(surfaces)
hand.GetSkin().Prepare()
flat = view_of(one, [vtkSonoUltrasound.FLAT_IMAGE], (0, 0, -1), (0, -1, 0))
body = view_of(one, [vtkSonoUltrasound.ANATOMY, vtkSonoUltrasound.PROBE, vtkSonoUltrasound.IMAGE], (0.5, -1, 0.35), (0, 0, 1))
keep(body[0], body[1][vtkSonoUltrasound.ANATOMY])
print("drawn by " + flat[0].SMProxy.GetRenderWindow().ReportCapabilities().split("renderer string:")[1].split("\n")[0].strip())
for name, step_mm, views in (("render_filter", STEP_MM, []), ("render_host_flat", -STEP_MM, [flat]),
                             ("render_host_both", STEP_MM, [flat, body])):
    drag(name + "_drag", one, hand, step_mm, views)
mappers = draw_on_gpu([flat, body])
for name, step_mm, views in (("render_flat", -STEP_MM, [flat]), ("render_both", STEP_MM, [flat, body])):
    drag(name + "_drag", one, hand, step_mm, views)
on_gpu = sum(mapper.GetPicturesOnGpu() for mapper in mappers if mapper.IsA("vtkSonoImageMapper"))
print(f"render_pictures_on_gpu {on_gpu} pictures")
for name, port in (("flat", vtkSonoUltrasound.FLAT_IMAGE), ("image", vtkSonoUltrasound.IMAGE)):
    by_host, by_gpu = (view_of(one, [port], (0.5, -1, 0.35), (0, 0, 1)) for _ in range(2))
    draw_on_gpu([by_gpu])
    by_gpu[0].SMProxy.StillRender()
    bytes_off = sum(a != b for a, b in zip(pixels_of(by_host[0]), pixels_of(by_gpu[0])))
    print(f"render_{name}_differs_from_host {bytes_off} bytes", flush=True)
if os.environ.get("SONOVDB_RENDERED"):
    for name, (view, _) in (("flat", flat), ("body", body)):
        simple.SaveScreenshot(os.path.join(os.environ["SONOVDB_RENDERED"], name + ".png"), view)
