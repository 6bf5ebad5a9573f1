"""Simulates an ultrasound image with VTK alone, without ParaView's pipeline or windows:

    /usr/bin/python3 plain_vtk.py [label map] [image.png]

Without a label map it scans the bundled thorax. Python finds the module sonovdb where SonoVDB's Debian package is
installed; else set PYTHONPATH to lib/python3/dist-packages below the place where it is built or installed.
"""
import sys

try:
    import paraview  # noqa: F401  (only so that Debian's VTK is found, which comes with ParaView)
    from sonovdb.vtkSonoFilters import (vtkSonoAcousticWindow, vtkSonoLabelMapReader, vtkSonoPictureWriter,
                                        vtkSonoThoraxSource, vtkSonoUltrasound)
except ImportError as error:
    raise SystemExit(
        f"{error}: ParaView and SonoVDB are built for Debian's Python, and this is {sys.version.split()[0]} "
        f"({sys.executable}): start the example with /usr/bin/python3, and with SonoVDB's lib/python3/dist-packages in "
        "PYTHONPATH.") from None

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
ultrasound.GetSceneBuilder().SetBuildSurfaces(False)  # nothing is shown in 3-D here
probe = ultrasound.GetProbe()
probe.SetPositionMm(*pose.GetArray("ProbePositionMm").GetTuple3(0))
probe.SetAxial(*pose.GetArray("ProbeAxial").GetTuple3(0))
probe.SetLateral(*pose.GetArray("ProbeLateral").GetTuple3(0))
probe.SetDepthMm(160)
ultrasound.GetBMode().SetGainDb(3)

writer = vtkSonoPictureWriter()
writer.SetInputConnection(ultrasound.GetOutputPort(vtkSonoUltrasound.FLAT_IMAGE))
writer.SetFileName(sys.argv[2] if len(sys.argv) > 2 else "ultrasound.png")
writer.Write()
print("Wrote", writer.GetFileName())
