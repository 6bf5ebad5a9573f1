"""A wall's slide along itself, of which its surfaces say nothing, by its volume alone, against motions in closed form."""
import unittest
from unittest import mock

import numpy as np
from sonovdb import volume

SPACING = (2.0, 2.0, 2.0)
LENGTH_MM = 80.0  # of a tube along z
INNER_MM, OUTER_MM = 14.0, 26.0


def places():
    """mm about the tube's middle, [z, y, x, axis]."""
    z, y, x = np.indices((51, 36, 36))
    return np.stack([2.0 * x - 35.0, 2.0 * y - 35.0, 2.0 * z - 50.0], -1)


class TestVolumeKept(unittest.TestCase):
    def test_slopes_have_their_transpose(self):
        draw = np.random.default_rng(1).normal
        field, slopes = draw(size=(5, 6, 7, 3)), draw(size=(5, 6, 7, 3, 3))
        spacing = (1.0, 2.0, 0.5)
        self.assertAlmostEqual(np.sum(volume._slopes(field, spacing) * slopes),
                               np.sum(field * volume._slopes_transposed(slopes, spacing)), 9)
        at = places()
        linear = at @ np.array([[1.0, 0.2, 0.0], [0.0, -2.0, 0.5], [0.3, 0.0, 0.7]])
        self.assertAlmostEqual(np.abs(volume._slopes(linear, SPACING)[1:-1, 1:-1, 1:-1] -
                                      [[1.0, 0.0, 0.3], [0.2, -2.0, 0.0], [0.0, 0.5, 0.7]]).max(), 0.0, 9)

    def test_a_tube_that_narrows_lengthens(self):
        """A wall of a tube between two cylinders that both come in by a share keeps its volume where it is as much longer: its way
        along z, which its surfaces do not tell, is z times that."""
        at = places()
        radius = np.hypot(at[..., 0], at[..., 1])
        narrowed = 0.05  # x and y by this share, so that z goes by 1 / (1 - 0.05)^2 - 1
        way = np.stack([-narrowed * at[..., 0], -narrowed * at[..., 1], np.zeros_like(radius)], -1)
        inside = np.minimum(radius - INNER_MM, OUTER_MM - radius)
        muscle = np.clip(inside / 2.0, 0.0, 1.0) * (np.abs(at[..., 2]) < 0.5 * LENGTH_MM)
        surfaces = sum(volume.normals(radius - of, 2.0, SPACING) for of in (INNER_MM, OUTER_MM))
        wall = (inside > 2.0) & (np.abs(at[..., 2]) < 0.3 * LENGTH_MM)

        def grown(field):
            return np.abs(np.linalg.det(np.eye(3) + volume._slopes(field, SPACING))[wall] - 1.0).mean()

        self.assertAlmostEqual(grown(way), 1.0 - (1.0 - narrowed) ** 2, 6)
        with mock.patch.object(volume, "SMOOTH", 0.005):  # which costs little
            found = volume.kept(way, muscle, surfaces, SPACING, steps=200)
        self.assertLess(grown(found), 0.005)
        lengthened = 1.0 / (1.0 - narrowed) ** 2 - 1.0
        self.assertLess(abs(volume._slopes(found, SPACING)[..., 2, 2][wall].mean() / lengthened - 1.0), 0.1)
        on_surface = (np.abs(inside) < 1.0) & (np.abs(at[..., 2]) < 0.3 * LENGTH_MM)
        moved = np.sum((found - way)[..., :2] * at[..., :2], -1)[on_surface] / radius[on_surface]
        self.assertLess(np.abs(moved).max(), 0.3)  # mm along the normal, a seventh of a voxel

    def test_what_keeps_its_volume_stays_as_it_is(self):
        at = places()
        turned = 0.01 * at[..., 2]  # by an angle that rises along z: nothing changes its volume
        way = np.stack([at[..., 0] * np.cos(turned) - at[..., 1] * np.sin(turned) - at[..., 0],
                        at[..., 0] * np.sin(turned) + at[..., 1] * np.cos(turned) - at[..., 1], np.zeros_like(turned)], -1)
        found = volume.kept(way, np.ones(turned.shape), np.zeros(turned.shape + (3, 3)), SPACING)
        self.assertLess(np.abs(found - way)[5:-5, 5:-5, 5:-5].max(), 0.1)  # differences over two voxels miss as much


if __name__ == "__main__":
    unittest.main()
