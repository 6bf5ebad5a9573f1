"""Simulates an ultrasound image with VTK alone, without ParaView's pipeline or windows:

    python3 plain_vtk.py [label map] [image.png]

Without a label map it scans the bundled thorax. Python finds the module sonovdb in lib/python3/dist-packages below the
place where SonoVDB is built or installed.
"""
import sys

import paraview  # noqa: F401  (only so that Debian's VTK is found, which comes with ParaView)
from sonovdb.vtkSonoFilters import (vtkSonoAcousticWindow, vtkSonoLabelMapReader, vtkSonoPictureWriter,
                                    vtkSonoThoraxSource, vtkSonoUltrasound)

if len(sys.argv) > 1:
    labels = vtkSonoLabelMapReader()
    labels.SetFileName(sys.argv[1])
else:
    labels = vtkSonoThoraxSource()

window = vtkSonoAcousticWindow()  # a place on the skin from which the heart, or else the liver, can be seen
window.SetInputConnection(labels.GetOutputPort())
window.Update()
pose = window.GetOutput().GetFieldData()

ultrasound = vtkSonoUltrasound()
ultrasound.SetInputConnection(labels.GetOutputPort())
ultrasound.SetBuildSurfaces(False)  # nothing is shown in 3-D here
ultrasound.SetPositionMm(*pose.GetArray("ProbePositionMm").GetTuple3(0))
ultrasound.SetAxial(*pose.GetArray("ProbeAxial").GetTuple3(0))
ultrasound.SetLateral(*pose.GetArray("ProbeLateral").GetTuple3(0))
ultrasound.SetDepthMm(160)
ultrasound.SetGainDb(3)

writer = vtkSonoPictureWriter()
writer.SetInputConnection(ultrasound.GetOutputPort(vtkSonoUltrasound.FLAT_IMAGE))
writer.SetFileName(sys.argv[2] if len(sys.argv) > 2 else "ultrasound.png")
writer.Write()
print("Wrote", writer.GetFileName())
