"""Under MPI, with every rank running this script, the first rank makes the picture and the others wait quietly."""
import os

from paraview import simple
from paraview.modules.vtkRemotingCore import vtkProcessModule
from paraview.servermanager import Fetch

simple.LoadPlugin(os.environ["SONOVDB_PLUGIN"], remote=False, ns=vars(simple))
processes = vtkProcessModule.GetProcessModule()
assert processes.GetNumberOfLocalPartitions() == 2, "run me on two ranks, with --symmetric"

probe = simple.UltrasoundProbe(LineCount=12, Depthmm=90)  # by default in the thorax's apical view
scene = simple.UltrasoundScene(Input=simple.ThoraxPhantom(Spacingmm=4), BuildSurfaces=0)
traced = simple.UltrasoundRayTracer(Scene=scene, Probe=probe, PathsperLine=20)
bmode = simple.UltrasoundBMode(Input=simple.UltrasoundImageFormation(Input=traced))
picture = Fetch(simple.ScanConverter(Input=bmode))  # gathers: every rank takes part, the first one gets it
ultrasound = simple.SimulateUltrasound(Input=simple.ThoraxPhantom(Spacingmm=4), LineCount=12, DepthMm=90,
                                       PathsPerLine=20)
in_one = Fetch(ultrasound)
anatomy = Fetch(ultrasound, idx=4)

if processes.GetPartitionId() == 0:
    for image in (picture, in_one):
        brightest = image.GetPointData().GetArray("BMode").GetRange()[1]
        assert brightest > 200, brightest
    # sys.exit would skip MPI's own farewell, which counts as a failure
    assert anatomy.GetNumberOfPoints() > 1000, anatomy.GetNumberOfPoints()
