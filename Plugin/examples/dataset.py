"""Writes a data set that a JSON file declares, as nnU-Net or MONAI take it:

    pvbatch dataset.py FILE.json FOLDER
    mpirun -np 4 pvbatch dataset.py FILE.json FOLDER
    pvbatch dataset.py FILE.json FOLDER --part 0 --parts 10

With mpirun the processes share the work; so they do, without MPI, when each is told which part of how many it is.
Stopped or killed, the same command goes on where it was. FILE may be the name of a bundled one: apical, amadou2024.
"""
import argparse
import os
import sys
import time

try:
    from paraview.simple import *
except ImportError as error:
    raise SystemExit(f"{error}: ParaView is built for Debian's Python, and this is {sys.version.split()[0]} "
                     f"({sys.executable}): start the example with pvbatch or pvpython.") from None

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("file", help="the declaring file")
parser.add_argument("folder", help="where to write")
parser.add_argument("--plugin", default=os.environ.get("SONOVDB_PLUGIN"),
                    help="SonoVDB.so; or set SONOVDB_PLUGIN. Needless where SonoVDB's Debian package is installed")
parser.add_argument("--part", type=int, default=0, help="which part, from 0")
parser.add_argument("--parts", type=int, default=0, help="of how many; 0: MPI's")
parser.add_argument("--every", type=float, default=10.0, help="seconds between two lines that say how far it is")
args = parser.parse_args()

if args.plugin:
    LoadPlugin(args.plugin, remote=False, ns=globals())
elif "UltrasoundDataSet" not in globals():
    parser.error("ParaView has not loaded SonoVDB by itself: name SonoVDB.so with --plugin")
source = UltrasoundDataSet(FileName=args.file, Folder=os.path.abspath(args.folder), Part=args.part, Parts=args.parts)
writer = source.GetClientSideObject()
said = {"text": "", "at": time.monotonic()}


def say(*_):
    """How far this process is, and how quick."""
    text = writer.GetProgressText()
    if " of " in text and text != said["text"] and time.monotonic() - said["at"] >= args.every:
        said.update(text=text, at=time.monotonic())
        print(text, flush=True)


writer.AddObserver("ProgressEvent", say)
# Every process of MPI writes its share when the first one asks for the data.
source.UpdatePipeline()
if source.GetDataInformation().GetNumberOfPoints() == 0:
    raise SystemExit("The data set was not written to its end")
source.UpdatePropertyInformation()
print(f"Wrote {source.GetProperty('WrittenImages').GetData()} images to {os.path.abspath(args.folder)} in this process, "
      f"{source.GetProperty('ImagesPerSecond').GetData():.1f} a second")
