"""How far a displacement field is from another one at the surface of labels."""
import numpy as np


def _blurred(values, passes=3):
    for axis in range(3):
        for _ in range(passes):
            padded = np.pad(values, [(1, 1) if other == axis else (0, 0) for other in range(3)], mode="edge")
            values = sum(np.take(padded, range(shift, shift + values.shape[axis]), axis) for shift in range(3)) / 3
    return values


def wall_errors(found, known, inside, spacing):
    """Lengths of the difference at the outermost voxels of `inside`, an array [z, y, x] of bool: along the normal, which is that
    of the blurred shape, and along the surface. Fields are [z, y, x, 3] in mm; axes are the world's."""
    inner = inside.copy()
    for axis in range(3):
        for shift in (-1, 1):
            inner &= np.roll(inside, shift, axis)
    surface = inside & ~inner
    blurred = _blurred(inside.astype(float))
    normal = np.stack(np.gradient(blurred, *spacing[::-1])[::-1], -1)[surface]
    normal /= np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-12)
    error = (found - known)[surface]
    along = np.abs(np.sum(error * normal, -1))
    return along, np.sqrt(np.maximum(np.sum(error * error, -1) - along * along, 0))
