"""Muscle keeps its volume: what a registration of labels leaves open, how far a wall slides along itself, is chosen so that it does."""
import numpy as np

SMOOTH = 0.1  # weight of the change's slopes against the wall's change of volume
STAY = 1.0  # 1/mm^2, of how far a surface is moved off
ROUNDS = 2  # of Gauss and Newton
STEPS = 40  # of conjugate gradients in each, at most; four times as many of half as fine ones
FEWEST = 12  # voxels along an axis
ENOUGH = 1e-4  # of the square of what is left of the equations


def kept(way, muscle, surfaces, spacing, steps=STEPS):
    """The way in mm, along the arrays' axes, x first, changed by as little as it takes.

    way       t(x), of what is at x to x + t(x): an array indexed [z, y, x, axis]
    muscle    0 to 1: how much det(I + dt/dx) is to be 1 there
    surfaces  sums of weight n n^T over the surfaces that are to stay on themselves, of unit normals n: [z, y, x, 3, 3]
    spacing   mm, x first
    steps     of conjugate gradients in a round, at most
    """
    way = np.asarray(way, float)
    muscle = np.pad(muscle[1:-1, 1:-1, 1:-1], 1)  # the border has no slopes
    change = np.zeros_like(way)
    if min(way.shape[:3]) >= 2 * FEWEST:  # what reaches far is found on fewer voxels first
        every_other = (slice(None, None, 2),) * 3
        coarse = way[every_other]
        changed = kept(coarse, muscle[every_other], surfaces[every_other], [2.0 * mm for mm in spacing], 4 * steps)
        change = _doubled(changed - coarse, way.shape)
    for _ in range(ROUNDS):
        jacobian = np.eye(3) + _slopes(way + change, spacing)
        rows = [jacobian[..., i, :] for i in range(3)]
        cofactors = np.stack([np.cross(rows[(i + 1) % 3], rows[(i + 2) % 3]) for i in range(3)], -2)
        grown = np.sum(rows[0] * cofactors[..., 0, :], -1) - 1.0

        def equations(step, cofactors=cofactors):
            slopes = _slopes(step, spacing)
            per_volume = muscle * np.sum(cofactors * slopes, (-2, -1))
            return (_slopes_transposed(cofactors * per_volume[..., None, None] + SMOOTH * slopes, spacing) +
                    STAY * np.einsum("...ij,...j", surfaces, step))

        pull = cofactors * (muscle * grown)[..., None, None] + SMOOTH * _slopes(change, spacing)
        change -= _solved(equations, _slopes_transposed(pull, spacing) + STAY * np.einsum("...ij,...j", surfaces, change), steps)
    return way + change


def normals(edge, band, spacing):
    """Weight n n^T of a surface, by a function that rises through 0 there: 1 on it, 0 from where that is `band`."""
    slope = np.stack([_central(edge, axis, spacing) for axis in range(3)], -1)
    slope /= np.maximum(np.linalg.norm(slope, axis=-1, keepdims=True), 1e-9)
    weight = np.clip(1.0 - np.abs(edge) / band, 0.0, 1.0)
    return weight[..., None, None] * slope[..., :, None] * slope[..., None, :]


def _along(axis, part, dimensions):
    """Slices of an array [z, y, x, ...] by a part of one of its axes, x first."""
    return tuple(part if at == 2 - axis else slice(None) for at in range(3)) + (slice(None),) * (dimensions - 3)


def _central(values, axis, spacing):
    """Differences over two voxels; 0 at the borders."""
    ahead, behind, middle = (_along(axis, part, values.ndim) for part in (slice(2, None), slice(None, -2), slice(1, -1)))
    slope = np.zeros_like(values)
    slope[middle] = (values[ahead] - values[behind]) / (2.0 * spacing[axis])
    return slope


def _slopes(field, spacing):
    """[..., component, axis]."""
    return np.stack([_central(field, axis, spacing) for axis in range(3)], -1)


def _slopes_transposed(slopes, spacing):
    field = np.zeros(slopes.shape[:-1])
    for axis in range(3):
        ahead, behind, middle = (_along(axis, part, field.ndim) for part in (slice(2, None), slice(None, -2), slice(1, -1)))
        inner = slopes[..., axis][middle] / (2.0 * spacing[axis])
        field[ahead] += inner
        field[behind] -= inner
    return field


def _doubled(field, shape):
    """Linear between voxels that were every other one of an array of that shape."""
    for axis in range(3):
        half = np.moveaxis(field, axis, 0)
        between = 0.5 * (half + np.concatenate([half[1:], half[-1:]]))
        both = np.stack([half, between], 1).reshape((-1,) + half.shape[1:])
        field = np.moveaxis(both[:shape[axis]], 0, axis)
    return field


def _solved(equations, right, steps):
    """By conjugate gradients (Hestenes and Stiefel 1952)."""
    solution = np.zeros_like(right)
    left = right.copy()
    towards = left.copy()
    square = first = np.sum(left * left)
    for _ in range(steps):
        if square <= ENOUGH * first:
            break
        pulled = equations(towards)
        size = square / np.sum(towards * pulled)
        solution += size * towards
        left -= size * pulled
        before, square = square, np.sum(left * left)
        towards = left + square / before * towards
    return solution
