"""What the tests of the probe widget share: rotations as matrix exponentials, and spheres to stand on."""
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkFiltersSources import vtkSphereSource


def turned(vector, axis, degrees):
    """exp of the cross-product matrix, as a power series."""
    x, y, z = np.asarray(axis, float) * np.radians(degrees)
    generator = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    term = total = np.eye(3)
    for n in range(1, 40):
        term = term @ generator / n
        total = total + term
    return total @ vector


def pose(probe):
    return tuple(np.array(v) for v in (probe.GetPositionMm(), probe.GetAxial(), probe.GetLateral()))


def sphere(radius, steps=240, inwards=False, noise=0.0):
    """A sphere of triangles about 0; `noise` moves each point along its normal."""
    source = vtkSphereSource()
    source.SetRadius(radius)
    source.SetThetaResolution(steps)
    source.SetPhiResolution(steps // 2)
    source.Update()
    mesh = source.GetOutput()
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    points *= 1 + noise / radius * np.random.default_rng(1).standard_normal((len(points), 1))
    mesh.GetPoints().SetData(numpy_to_vtk(points, deep=True))
    if inwards:
        ids = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        ids[:] = ids[:, ::-1].copy()
        mesh.GetPolys().Modified()
    return mesh


def angle(a, b):
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b)), np.dot(a, b)))
