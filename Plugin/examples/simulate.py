"""Simulates one ultrasound image of a label map:

    pvpython simulate.py [--labels map.nii.gz --pose pose.json] [--output image.png]

Without --labels, it scans the bundled thorax in its apical four-chamber view. A pose file is JSON with position, axial
and lateral (LPS mm), and depth_mm and sector_deg if they are to differ; pose.json:A4C takes what is under "poses", "A4C".
"""
import argparse
import json
import os
import sys
import time

try:
    from paraview.servermanager import Fetch
    from paraview.simple import *
except ImportError as error:
    raise SystemExit(f"{error}: ParaView is built for Debian's Python, and this is {sys.version.split()[0]} "
                     f"({sys.executable}): start the example with pvpython.") from None

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--plugin", default=os.environ.get("SONOVDB_PLUGIN"),
                    help="SonoVDB.so; or set SONOVDB_PLUGIN. Needless where SonoVDB's Debian package is installed")
parser.add_argument("--labels", help="label map: .nii, .nii.gz, .nrrd, .seg.nrrd or .vti; needs --pose")
parser.add_argument("--pose", help="where the probe stands: file.json or file.json:NAME")
parser.add_argument("--output", default="ultrasound.png", help="picture: .png, .tif, .exr or .jpg")
parser.add_argument("--spacing", type=float, default=1.0, help="voxel size of the bundled thorax in mm")
parser.add_argument("--lines", type=int, default=128, help="scan lines")
parser.add_argument("--paths", type=int, default=256, help="paths per scan line")
args = parser.parse_args()
if args.labels and not args.pose:
    parser.error("--labels needs --pose, as only the bundled thorax brings a pose along")


def timed(stage):
    """Runs a stage and says how long it took; ends the script where the stage failed and said why."""
    start = time.perf_counter()
    stage.UpdatePipeline()
    if stage.GetDataInformation().GetNumberOfPoints() == 0:
        raise SystemExit(f"{stage.GetXMLLabel()} failed")
    print(f"{stage.GetXMLLabel():28s} {time.perf_counter() - start:7.2f} s")
    return stage


def pose_of(anatomy):
    """The pose of the pose file, or the one that the thorax carries in its field data."""
    if not args.pose:
        field = Fetch(anatomy).GetFieldData()
        return {key: field.GetArray(name).GetTuple3(0)
                for key, name in (("position", "A4CPositionMm"), ("axial", "A4CAxial"), ("lateral", "A4CLateral"))}
    path, _, name = args.pose.partition(":")
    with open(path, encoding="utf-8") as file:
        pose = json.load(file)
    return pose["poses"][name] if name else pose


if args.plugin:
    LoadPlugin(args.plugin, remote=False, ns=globals())
elif "LabelMapReader" not in globals():
    parser.error("ParaView has not loaded SonoVDB by itself: name SonoVDB.so with --plugin")
anatomy = timed(LabelMapReader(FileName=args.labels) if args.labels else ThoraxPhantom(Spacingmm=args.spacing))
pose = pose_of(anatomy)
probe = UltrasoundProbe(Positionmm=pose["position"], Axial=pose["axial"], Lateral=pose["lateral"],
                        Depthmm=pose.get("depth_mm", 160), Sectordeg=pose.get("sector_deg", 90),
                        LineCount=args.lines)
scene = timed(UltrasoundScene(Input=anatomy, BuildSurfaces=0))  # no surfaces: nothing is shown in 3-D here
# Sixteen centimetres of chest cross more than seven boundaries.
traced = timed(UltrasoundRayTracer(Scene=scene, Probe=probe, PathsperLine=args.paths, MaxCollisions=20, Coherencemm=20))
rf = timed(UltrasoundImageFormation(Input=traced))
bmode = timed(UltrasoundBMode(Input=rf, TGCdBpercm=3))
picture = timed(ScanConverter(Input=bmode))
writer = CreateWriter(args.output, picture)
writer.UpdatePipeline()
if writer.GetClientSideObject().GetErrorCode():
    raise SystemExit("The picture was not written")
print("Wrote", os.path.abspath(args.output))
