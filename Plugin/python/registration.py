"""What moves between the phases of a motion, from their label maps alone: displacement fields by elastix, with which speckle rides
on the tissue (see Data/docs/motion.md)."""
import os

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIntArray
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkImagingGeneral import vtkImageEuclideanDistance
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from . import elastix, volume
from .vtkSonoFilters import vtkSonoLabelMapReader, vtkSonoLabelTable, vtkSonoSceneBuilder

CHANGED_SHARE = 0.12  # of a label's voxels, by which a phase differs from the reference, so that the label counts as moving
REACH_MM = 3.0  # a label is told by tanh(distance to its surface / reach): its surfaces have to meet, and it may thicken between
BAND_MM = 4.0  # around a surface, where it is looked at
SAMPLES = 4000  # there, a label
GRID_MM = 8.0  # between the last control points
SMOOTHED_MM = (4.0, 2.0, 1.0)  # one a resolution
BENDING = (60.0, 60.0, 24.0)  # mm^2, one a resolution: less folds, more does not follow a wall that thickens
WORKING_MM = 2.0  # between the voxels that elastix is given
MARGIN_MM = 12.0  # around all that moves
NEAR_VOXELS = 3  # around the labels that the speckle rides on; 0 mm beyond


def register_phases(files, folder, reference=0, moving=None, say=print):
    """Writes the label maps of a motion's phases, each with the displacement since the reference phase.

    files      label maps, one a phase, of the same grid, or one NIfTI file with a fourth axis; what the Label Map Reader takes
    folder     where phase_00.vti, phase_01.vti, ... are written, with DisplacementMm and MovingLabels: what is at x stood at
               x - u(x) in the reference phase, in mm along LPS
    reference  number of that phase
    moving     ids of the labels that the speckle rides on; None: those of which 12 % or more of the voxels change, but not blood
    say        takes a sentence a phase

    Returns the paths. Needs the program elastix. Anything wrong is a ValueError with one sentence.
    """
    if not elastix.is_there():
        raise ValueError("elastix was not found, which registers the phases: install it (apt install elastix, or from "
                         "elastix.dev) so that elastix and transformix are in PATH")
    images = _read_phases(files)
    if not 0 <= reference < len(images):
        raise ValueError(f"reference is {reference}: choose a phase from 0 to {len(images) - 1}")
    if len(images) < 2:
        raise ValueError("there is one phase only: name a label map for each phase of the motion")
    labels = [_voxels(image) for image in images]
    changed = _changed_labels(labels, reference)
    if not changed:
        raise ValueError("no label of the phases changes: nothing moves")
    if moving is None:
        moving = changed - _of_tissue(images[reference], "blood")
    absent = sorted(set(moving) - set(np.unique(labels[reference]).tolist()))
    if absent:
        raise ValueError(f"the reference phase has no label {absent[0]}: name labels that it has")
    if not moving:
        raise ValueError("only blood moves: name the labels that the speckle is to ride on")
    # Leaflets swing: where they are says nothing of where the tissue around went, but for the blood that they part.
    swinging = _of_tissue(images[reference], "valve")
    muscles = _of_tissue(images[reference], "myocardium")
    followed = sorted((changed | set(moving)) - swinging)
    if not followed:
        raise ValueError("only valves move: name labels whose way their surfaces tell")
    box = _box(labels, followed, images[0].GetSpacing())
    os.makedirs(folder, exist_ok=True)
    rest = _Edges(labels[reference][box], followed, swinging, muscles, images[0].GetSpacing())
    paths, digits = [], max(2, len(str(len(images) - 1)))
    for phase, image in enumerate(images):
        field = np.zeros(labels[0].shape + (3,), np.float32)
        if phase != reference:
            now = labels[phase][box]
            near = _distance(~np.isin(now, list(moving)), image.GetSpacing()) <= NEAR_VOXELS * max(image.GetSpacing())
            field[box] = _register(_Edges(now, followed, swinging, muscles, image.GetSpacing()), rest, image, box) * near[..., None]
            say(f"Phase {phase}: " + _judge(field[box], now, labels[reference][box], moving, image))
        paths.append(os.path.join(folder, f"phase_{phase:0{digits}d}.vti"))
        _write(image, field, moving, paths[-1])
    return paths


def _hear(algorithm):
    heard = []

    def hear(_caller, _event, text):
        heard.append(text.split("):", 1)[-1].strip())

    hear.CallDataType = "string0"
    algorithm.AddObserver("ErrorEvent", hear)
    return heard


def _read_phases(files):
    reader = vtkSonoLabelMapReader()
    errors = _hear(reader)
    for file in files:
        reader.AddFileName(os.fspath(file))
    reader.UpdateInformation()
    steps = vtkStreamingDemandDrivenPipeline.TIME_STEPS()
    images = []
    for time in [] if errors else reader.GetOutputInformation(0).Get(steps) or [0.0]:
        reader.UpdateTimeStep(time)
        if errors:
            break
        images.append(vtkImageData())
        images[-1].DeepCopy(reader.GetOutput())
        if not np.allclose(_placement(images[-1]), _placement(images[0]), atol=1e-3):
            raise ValueError(f"phase {len(images) - 1} lies elsewhere than the first one; resample it to the same grid")
    if errors:
        raise ValueError(errors[0])
    return images


def _placement(image):
    return np.concatenate([image.GetOrigin(), image.GetSpacing(), _direction(image).ravel()])


def _direction(image):
    matrix = image.GetDirectionMatrix()
    return np.array([[matrix.GetElement(row, column) for column in range(3)] for row in range(3)])


def _voxels(image):
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(image.GetDimensions()[::-1])


def _changed_labels(labels, reference):
    """Those of which CHANGED_SHARE or more changes in some phase; 0 is no tissue."""
    rest = labels[reference]
    counts = np.bincount(rest.ravel(), minlength=65536)
    changed = set()
    for phase in labels:
        here = phase != rest
        gone, come = (np.bincount(of[here], minlength=65536) for of in (rest, phase))
        both = counts + np.bincount(phase.ravel(), minlength=65536)
        changed.update(np.flatnonzero((gone + come > CHANGED_SHARE * both) & (both > 0)).tolist())
    return changed - {0}


def _of_tissue(image, tissue):
    """Labels of a tissue, by their names."""
    scene = vtkSonoSceneBuilder()
    scene.SetBuildSurfaces(False)
    scene.SetInputData(image)
    errors = _hear(scene)
    table = vtkSonoLabelTable()
    table.SetInputConnection(scene.GetOutputPort())
    table.Update()
    if errors:
        raise ValueError(errors[0])
    rows = table.GetOutput()
    return {int(rows.GetValueByName(row, "id").ToInt()) for row in range(rows.GetNumberOfRows())
            if rows.GetValueByName(row, "tissue").ToString() == tissue}


def _box(labels, followed, spacing):
    """The slices of the voxels where followed labels are in any phase, with a margin."""
    where = np.zeros(labels[0].shape, bool)
    wanted = np.zeros(65536, bool)
    wanted[followed] = True
    for phase in labels:
        where |= wanted[phase]
    box = []
    for axis, mm in zip(range(3), spacing[::-1]):
        there = np.flatnonzero(where.any(axis=tuple(other for other in range(3) if other != axis)))
        margin = int(np.ceil(MARGIN_MM / mm))
        box.append(slice(max(0, there[0] - margin), min(where.shape[axis], there[-1] + 1 + margin)))
    return tuple(box)


def _distance(inside, spacing):
    """To the nearest voxel that is not inside, mm between centres."""
    image = vtkImageData()
    image.SetDimensions(inside.shape[::-1])
    image.SetSpacing(spacing)
    image.GetPointData().SetScalars(numpy_to_vtk(inside.ravel().astype(np.float64), deep=True))
    distance = vtkImageEuclideanDistance()
    distance.SetInputData(image)
    distance.SetMaximumDistance(1e9)
    distance.Update()
    return np.sqrt(vtk_to_numpy(distance.GetOutput().GetPointData().GetScalars())).reshape(inside.shape)


class _Edges:
    """Of each label that is there: reach * tanh(signed distance / reach), every so many voxels; where nothing swings; and how much
    a place is one of muscle: so deep in a wall that differences over two working voxels are of the wall alone. Thin walls have none."""

    def __init__(self, labels, followed, swinging, muscles, spacing):
        self.spacing = spacing
        self.steps = tuple(max(1, round(WORKING_MM / mm)) for mm in spacing)
        self.label = {label: self._edge(labels == label) for label in followed if (labels == label).any()}
        leaflets = np.isin(labels, list(swinging))
        muscle = np.isin(labels, list(muscles))
        deep = np.arctanh(np.clip(-self._edge(muscle) / REACH_MM, 0.0, 0.99)) if muscle.any() else np.zeros(1)
        self.muscle = np.clip(deep * REACH_MM / WORKING_MM - 1.0, 0.0, 0.5) / 0.5
        self.is_calm = self._thinned(_distance(~leaflets, spacing) > BAND_MM if leaflets.any() else ~leaflets)

    def _thinned(self, values):
        return values[::self.steps[2], ::self.steps[1], ::self.steps[0]]

    def _edge(self, inside):
        margin = [int(np.ceil(3 * REACH_MM / mm)) for mm in self.spacing[::-1]]
        around = []
        for axis in range(3):
            there = np.flatnonzero(inside.any(axis=tuple(other for other in range(3) if other != axis)))
            around.append(slice(max(0, there[0] - margin[axis]), there[-1] + 1 + margin[axis]))
        part = inside[tuple(around)]
        half = 0.5 * np.mean(self.spacing)
        signed = np.where(part, half - _distance(part, self.spacing), _distance(~part, self.spacing) - half)
        edge = np.full(inside.shape, REACH_MM, np.float32)
        edge[tuple(around)] = REACH_MM * np.tanh(signed / REACH_MM)
        return self._thinned(edge)


def _register(now, rest, image, box):
    """u in mm at the voxels of the box."""
    both = [label for label in now.label if label in rest.label]
    edge = REACH_MM * np.tanh(BAND_MM / REACH_MM)
    near = {label: np.abs(now.label[label]) < edge for label in both}
    bands = {label: (near[label] & now.is_calm).astype(np.uint8) for label in both}
    smooth = np.logical_or.reduce(list(near.values())).astype(np.uint8)
    both = [label for label in both if bands[label].any()]
    whole = sum(int(bands[label].sum()) for label in both)
    pairs = [(now.label[label], rest.label[label], bands[label], int(bands[label].sum()) / whole) for label in both]
    spacing = np.array(image.GetSpacing())
    direction = _direction(image)
    origin = np.array(image.GetOrigin()) + direction @ (spacing * [part.start for part in box[::-1]])
    way = elastix.displacement(pairs, smooth, (origin, spacing * now.steps, direction), GRID_MM, SMOOTHED_MM, BENDING, SAMPLES)
    if now.muscle.any():
        way = _with_muscle_kept(way, now, spacing * now.steps, direction)
    for axis, step in zip(range(3), now.steps[::-1]):
        way = _refined(way, axis, step, box[axis].stop - box[axis].start)
    return -way


def _with_muscle_kept(way, now, spacing, direction):
    """Labels say where a surface went, not how far a wall slid along itself: muscle keeps its volume, which says the rest."""
    band = REACH_MM * np.tanh(WORKING_MM / REACH_MM)
    surfaces = sum(volume.normals(edge, band, spacing) for edge in now.label.values())
    return volume.kept(way @ direction, now.muscle, surfaces, spacing) @ direction.T


def _refined(field, axis, step, count):
    """Linear between every `step` voxels along an axis, `count` of them; constant after the last."""
    at = np.minimum(np.arange(count) / step, field.shape[axis] - 1)
    low = np.minimum(at.astype(int), max(0, field.shape[axis] - 2))
    share = np.expand_dims(at - low, tuple(other for other in range(4) if other != axis)).astype(np.float32)
    return (1 - share) * field.take(low, axis) + share * field.take(np.minimum(low + 1, field.shape[axis] - 1), axis)


def _judge(field, now, rest, moving, image):
    """A clause: how well the moving labels meet, how far they go, and where the field folds."""
    voxel = image.GetSpacing()
    local = field @ _direction(image) / voxel  # in voxels, x first
    rides = np.isin(now, list(moving))
    at = [np.clip(np.rint(index - local[..., 2 - axis]), 0, size - 1).astype(np.intp)
          for axis, (index, size) in enumerate(zip(np.indices(now.shape, np.float32), now.shape))]
    met = rest[tuple(at)]
    share = 2 * np.count_nonzero((met == now) & rides) / (np.count_nonzero(np.isin(met, list(moving))) + np.count_nonzero(rides))
    slopes = np.stack([np.stack(np.gradient(local[..., axis])[::-1], -1) for axis in range(3)], -2)
    folds = int(np.count_nonzero(np.linalg.det(np.eye(3) - slopes)[rides] <= 0))
    furthest = np.linalg.norm(field, axis=-1)[rides].max()
    return (f"the moving labels go up to {furthest:.1f} mm and cover {100 * share:.0f} % of each other (Dice)" +
            (f"; THE FIELD FOLDS AT {folds} VOXELS OF THEM" if folds else ""))


def _write(image, field, moving, path):
    displacement = numpy_to_vtk(field.reshape(-1, 3), deep=True)
    displacement.SetName("DisplacementMm")
    image.GetPointData().AddArray(displacement)
    ids = vtkIntArray()
    ids.SetName("MovingLabels")
    for label in sorted(moving):
        ids.InsertNextValue(label)
    image.GetFieldData().AddArray(ids)
    writer = vtkXMLImageDataWriter()
    writer.SetDataModeToBinary()  # which ParaView's own reader, too, reads
    writer.SetInputData(image)
    writer.SetFileName(path)
    if not writer.Write():
        raise ValueError(f"{path} could not be written: free some space or name another folder")
