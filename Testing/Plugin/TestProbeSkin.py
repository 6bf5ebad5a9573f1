"""The skin on which the probe slides, against spheres, planes and a brute-force locator. Nothing is rendered."""
import sys
import unittest

import numpy as np
from probecase import angle, pose, sphere, turned
from sonovdb.vtkSonoWidgets import vtkSonoCoarseSurfaces, vtkSonoProbeRepresentation as Probe, vtkSonoSkin
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet, vtkPolyData, vtkStaticCellLocator
from vtkmodules.vtkFiltersSources import vtkPlaneSource, vtkRegularPolygonSource


def blocks(*meshes):
    together = vtkMultiBlockDataSet()
    for i, mesh in enumerate(meshes):
        together.SetBlock(i, mesh)
    return together


class TestSkin(unittest.TestCase):
    def test_sphere(self):
        skin = vtkSonoSkin()
        place, normal = [0.0] * 3, [0.0] * 3
        for inwards in (False, True):
            skin.SetSurfaces(sphere(100, inwards=inwards))
            for direction in np.random.default_rng(2).standard_normal((20, 3)):
                direction /= np.linalg.norm(direction)
                self.assertTrue(skin.Meet(300 * direction, -300 * direction, place, normal))
                np.testing.assert_allclose(place, 100 * direction, atol=0.05)
                self.assertLess(angle(normal, direction), 0.5)

    def test_coarse_surfaces_are_as_good_to_stand_on(self):
        """A skin as of a label map, a thin shell, with a fiftieth of its triangles: what a client gets of it."""
        fine = blocks(sphere(100, steps=800), sphere(98, steps=800, inwards=True))
        made = vtkSonoCoarseSurfaces()
        made.SetInputData(fine)
        made.Update()
        counts = [sum(mesh.GetBlock(i).GetNumberOfPolys() for i in range(2)) for mesh in (fine, made.GetOutput())]
        self.assertLess(counts[1], counts[0] / 50)
        self.assertEqual(made.GetOutput().GetBlock(0).GetPointData().GetNumberOfArrays(), 0)
        skin = vtkSonoSkin()
        skin.SetSurfaces(made.GetOutput())
        place, normal = [0.0] * 3, [0.0] * 3
        for direction in np.random.default_rng(3).standard_normal((200, 3)):
            direction /= np.linalg.norm(direction)
            self.assertTrue(skin.Meet(300 * direction, 0 * direction, place, normal))
            self.assertLess(np.linalg.norm(place - 100 * direction), 0.5)
            self.assertLess(angle(normal, direction), 3)

    def test_coarse_surfaces_are_kept_while_the_meshes_are_the_same(self):
        mesh = sphere(50)
        made = vtkSonoCoarseSurfaces()
        for version, change in ((1, lambda: None), (1, made.Modified), (2, mesh.GetPoints().Modified),
                                (3, lambda: made.SetCubeMm(9)), (4, lambda: mesh.SetPolys(sphere(50).GetPolys()))):
            change()
            again = vtkPolyData()
            again.ShallowCopy(mesh)  # as a pipeline hands it on
            made.SetInputData(blocks(again))
            made.Update()
            self.assertEqual(made.GetVersion(), version)
            self.assertEqual(made.GetOutput().GetNumberOfBlocks(), 1)
            self.assertGreater(made.GetOutput().GetBlock(0).GetNumberOfPolys(), 50)

    def test_noise_does_not_shake_the_normal(self):
        skin = vtkSonoSkin()
        skin.SetSurfaces(sphere(100, steps=400, noise=0.4))  # triangles of 1.6 mm: single ones err by 20 degrees
        place, normal = [0.0] * 3, [0.0] * 3
        errors = {0: [], 10: []}
        for smoothing, found in errors.items():
            skin.SetSmoothingMm(smoothing)
            for degrees in np.arange(0, 60, 0.5):
                direction = turned(np.array((1.0, 0, 0)), (0, 0, 1), degrees)
                self.assertTrue(skin.Meet(200 * direction, 0 * direction, place, normal))
                found.append(angle(normal, direction))
        self.assertGreater(np.mean(errors[0]), 10)
        self.assertLess(np.max(errors[10]), 3)

    def test_thin_shell_has_its_outer_normal(self):
        skin = vtkSonoSkin()
        skin.SetSurfaces(blocks(sphere(98, inwards=True), sphere(100)))
        place, normal = [0.0] * 3, [0.0] * 3
        self.assertTrue(skin.Meet((0, 200, 0), (0, -200, 0), place, normal))
        np.testing.assert_allclose(place, (0, 100, 0), atol=0.05)
        self.assertLess(angle(normal, (0, 1, 0)), 0.5)

    def test_nearest(self):
        skin = vtkSonoSkin()
        place, normal = [0.0] * 3, [0.0] * 3
        self.assertFalse(skin.FindNearest((0, 0, 0), place, normal))
        skin.SetSurfaces(blocks(sphere(100), sphere(20)))
        self.assertTrue(skin.FindNearest((0, 0, 140), place, normal))
        np.testing.assert_allclose(place, (0, 0, 100), atol=0.05)
        self.assertLess(angle(normal, (0, 0, 1)), 0.5)
        self.assertTrue(skin.FindNearest((0, 30, 0), place, normal))
        np.testing.assert_allclose(place, (0, 20, 0), atol=0.05)

    def test_it_finds_what_a_locator_finds(self):
        rng = np.random.default_rng(7)
        mesh = sphere(60, steps=90, noise=3)
        skin, locator = vtkSonoSkin(), vtkStaticCellLocator()
        skin.SetSurfaces(mesh)
        skin.SetSmoothingMm(0)
        locator.SetDataSet(mesh)
        locator.BuildLocator()
        place, normal, expected, inside = ([0.0] * 3 for _ in range(4))
        share, distance2, cell, part = reference(0.0), reference(0.0), reference(0), reference(0)
        met = 0
        for start, end in zip(*rng.uniform(-90, 90, (2, 300, 3))):
            hits = locator.IntersectWithLine(start, end, 1e-6, share, expected, inside, part, cell)
            self.assertEqual(skin.Meet(start, end, place, normal), bool(hits))
            if hits:
                met += 1
                np.testing.assert_allclose(place, expected, atol=1e-6)
            locator.FindClosestPoint(start, expected, cell, part, distance2)
            self.assertTrue(skin.FindNearest(start, place, normal))
            self.assertAlmostEqual(np.linalg.norm(start - place), np.sqrt(distance2.get()), places=6)
        self.assertGreater(met, 100)

    def test_large_and_small_polygons_together(self):
        plane = vtkPlaneSource()
        plane.SetOrigin(-50, -50, 0)
        plane.SetPoint1(50, -50, 0)
        plane.SetPoint2(-50, 50, 0)
        plane.Update()
        skin = vtkSonoSkin()
        skin.SetSurfaces(blocks(plane.GetOutput(), sphere(3)))
        place, normal = [0.0] * 3, [0.0] * 3
        for x, y, height in ((0, 0, 3), (1, 40, 0), (-49, -49, 0)):
            self.assertTrue(skin.Meet((x, y, 20), (x, y, -20), place, normal))
            np.testing.assert_allclose(place, (x, y, height), atol=0.05)

    def test_a_polygon_of_thousands_of_corners(self):
        disc = vtkRegularPolygonSource()
        disc.SetNumberOfSides(20000)
        disc.SetRadius(50)
        disc.Update()
        skin = vtkSonoSkin()
        skin.SetSurfaces(disc.GetOutput())
        place, normal = [0.0] * 3, [0.0] * 3
        self.assertTrue(skin.FindNearest((10, 0, 20), place, normal))
        np.testing.assert_allclose(place, (10, 0, 0), atol=1e-4)

    def test_a_surface_is_sorted_once(self):
        skin = vtkSonoSkin()
        outer, inner = sphere(100), sphere(20)
        place, normal = [0.0] * 3, [0.0] * 3
        for step in range(50):
            surfaces = blocks(outer, inner)  # as a pipeline makes them again each time
            skin.SetSurfaces(surfaces)
            skin.Meet(turned(np.array((150.0, 0, 0)), (0, 0, 1), step), (90, 0, 0), place, normal)
        self.assertEqual(skin.GetNumberOfSorts(), 1)  # the outer one hides the other
        skin.Prepare()
        self.assertEqual(skin.GetNumberOfSorts(), 2)
        skin.FindNearest((0, 0, 50), place, normal)
        self.assertEqual(skin.GetNumberOfSorts(), 2)
        skin.SetSurfaces(blocks(sphere(100), inner))
        skin.Prepare()
        self.assertEqual(skin.GetNumberOfSorts(), 3)

    def test_what_is_no_surface_is_left_out(self):
        skin = vtkSonoSkin()
        self.assertTrue(skin.IsEmpty())
        skin.SetSurfaces(blocks(vtkPolyData(), vtkMultiBlockDataSet()))
        self.assertTrue(skin.IsEmpty())
        skin.SetSurfaces(blocks(vtkPolyData(), sphere(10)))
        self.assertFalse(skin.IsEmpty())
        self.assertFalse(skin.Meet((20, 0, 0), (20, 0, 50), [0.0] * 3, [0.0] * 3))
        skin.SetSurfaces(None)
        self.assertTrue(skin.IsEmpty())


class TestStanding(unittest.TestCase):
    def setUp(self):
        self.probe = Probe()
        self.probe.GetSkin().SetSurfaces(sphere(100))
        self.probe.SetPositionMm(0, 0, 130)
        self.probe.SetAxial(0, 0, -1)
        self.probe.SetLateral(1, 0, 0)

    def test_snap_looks_straight_in(self):
        self.probe.SetAxial(0.4, 0, -1)  # its axis still meets the sphere, beside the nearest place
        self.assertTrue(self.probe.SnapToSkin())
        position, axial, _ = pose(self.probe)
        self.assertAlmostEqual(np.linalg.norm(position), 100, delta=0.05)
        self.assertLess(angle(axial, -position), 0.5)
        # The line from (0, 0, 130) along (0.4, 0, -1), backwards first, against the sphere.
        t = min(np.roots((1.16, -260, 130**2 - 100**2)))
        np.testing.assert_allclose(position, (0.4 * t, 0, 130 - t), atol=0.1)

    def test_snap_from_inside_goes_to_the_outer_side_behind(self):
        self.probe.SetPositionMm(0, 0, 60)
        self.assertTrue(self.probe.SnapToSkin())
        np.testing.assert_allclose(self.probe.GetPositionMm(), (0, 0, 100), atol=0.1)

    def test_snap_that_looks_past_takes_the_nearest(self):
        self.probe.SetAxial(1, 0, 0)
        self.assertTrue(self.probe.SnapToSkin())
        position, axial, _ = pose(self.probe)
        np.testing.assert_allclose(position, (0, 0, 100), atol=0.1)
        self.assertLess(angle(axial, (0, 0, -1)), 0.5)

    def test_nothing_to_snap_to(self):
        self.probe.GetSkin().SetSurfaces(None)
        before = pose(self.probe)
        self.assertFalse(self.probe.SnapToSkin())
        self.assertIn("click the eye of Anatomy, or of the Ultrasound Scene", self.probe.GetMessage())
        self.assertFalse(self.probe.Walk(1, 0))
        np.testing.assert_array_equal(pose(self.probe), before)

    def test_walk_keeps_to_the_skin_and_does_not_twist(self):
        self.probe.SnapToSkin()
        for step in range(1, 101):
            self.assertTrue(self.probe.Walk(1, 0))
            position, axial, lateral = pose(self.probe)
            self.assertAlmostEqual(np.linalg.norm(position), 100, delta=0.05)
            self.assertLess(angle(axial, -position), 0.5)
            np.testing.assert_allclose(np.cross(axial, lateral), (0, -1, 0), atol=0.02)  # a great circle: no twist
        # 100 steps of 1 mm along the tangent.
        self.assertAlmostEqual(angle(position, (0, 0, 1)), 100 * np.degrees(np.arctan(0.01)), delta=0.5)

    def test_walk_keeps_a_tilt(self):
        self.probe.SnapToSkin()
        self.probe.Tilt(30)
        self.probe.Rock(-10)
        _, axial, lateral = pose(self.probe)
        tilted, turn = angle(axial, (0, 0, -1)), np.dot(lateral, (0, 0, 1))
        for step in range(50):
            self.assertTrue(self.probe.Walk(0, 1))
        position, axial, lateral = pose(self.probe)
        self.assertAlmostEqual(np.linalg.norm(position), 100, delta=0.05)
        self.assertAlmostEqual(angle(axial, -position), tilted, delta=1.0)
        self.assertAlmostEqual(np.dot(lateral, position / np.linalg.norm(position)), turn, delta=0.02)

    def test_off_the_edge_it_stays(self):
        plane = vtkPlaneSource()
        plane.SetOrigin(-10, -10, 0)
        plane.SetPoint1(10, -10, 0)
        plane.SetPoint2(-10, 10, 0)
        plane.Update()
        self.probe.GetSkin().SetSurfaces(plane.GetOutput())
        self.probe.SetPositionMm(0, 0, 0)
        self.assertTrue(self.probe.Walk(9, 0))
        self.assertFalse(self.probe.Walk(9, 0))
        np.testing.assert_allclose(self.probe.GetPositionMm(), (9, 0, 0), atol=1e-9)
        self.assertIn("stays where it last stood", self.probe.GetMessage())


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
