"""The probe widget: its movements against rotations as matrix exponentials, its skin against spheres, its handles against
what the mouse does. Nothing is rendered."""
import itertools
import sys
import unittest

import numpy as np
from sonovdb.vtkSonoFilters import vtkSonoProbeSource
from sonovdb.vtkSonoWidgets import vtkSonoProbeRepresentation, vtkSonoProbeWidget, vtkSonoSkin
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet, vtkPolyData, vtkStaticCellLocator
from vtkmodules.vtkFiltersSources import vtkPlaneSource, vtkRegularPolygonSource, vtkSphereSource
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow, vtkRenderWindowInteractor

Probe = vtkSonoProbeRepresentation


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


def blocks(*meshes):
    together = vtkMultiBlockDataSet()
    for i, mesh in enumerate(meshes):
        together.SetBlock(i, mesh)
    return together


def angle(a, b):
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b)), np.dot(a, b)))


class TestPose(unittest.TestCase):
    def setUp(self):
        self.probe = Probe()
        self.probe.SetPositionMm(12, -30, 7)
        self.probe.SetAxial(0.2, 0.3, 2.0)
        self.probe.SetLateral(1.0, 0.4, 0.1)
        self.probe.Rotate(0)  # makes unit vectors of them

    def check(self, axial, lateral):
        position, found_axial, found_lateral = pose(self.probe)
        np.testing.assert_array_equal(position, (12, -30, 7))
        np.testing.assert_allclose(found_axial, axial, atol=1e-12)
        np.testing.assert_allclose(found_lateral, lateral, atol=1e-12)

    def test_defaults_are_the_source_s(self):
        probe, source = Probe(), vtkSonoProbeSource()
        for name in ("PositionMm", "Axial", "Lateral", "ScanKind", "LineCount", "DepthMm", "SectorDeg", "RadiusMm",
                     "WidthMm", "ElevationLineCount", "ElevationSectorDeg", "PresetFile"):
            self.assertEqual(getattr(probe, "Get" + name)(), getattr(source, "Get" + name)(), name)

    def test_typed_vectors_become_unit_vectors_at_right_angles(self):
        _, axial, lateral = pose(self.probe)
        expected = np.array((0.2, 0.3, 2.0)) / np.linalg.norm((0.2, 0.3, 2.0))
        side = np.array((1.0, 0.4, 0.1)) - expected * np.dot(expected, (1.0, 0.4, 0.1))
        self.check(expected, side / np.linalg.norm(side))

    def test_what_is_set_stays_as_it_is(self):
        self.probe.SetAxial(-0.53, 0.65, 0.545)
        self.assertEqual(self.probe.GetAxial(), (-0.53, 0.65, 0.545))

    def test_rotate(self):
        _, axial, lateral = pose(self.probe)
        self.probe.Rotate(35)
        self.check(axial, turned(lateral, axial, 35))
        self.assertGreater(np.dot(pose(self.probe)[2], np.cross(axial, lateral)), 0)

    def test_tilt(self):
        _, axial, lateral = pose(self.probe)
        self.probe.Tilt(35)
        self.check(turned(axial, lateral, -35), lateral)
        self.assertGreater(np.dot(pose(self.probe)[1], np.cross(axial, lateral)), 0)

    def test_rock(self):
        _, axial, lateral = pose(self.probe)
        elevation = np.cross(axial, lateral)
        self.probe.Rock(35)
        self.check(turned(axial, elevation, 35), turned(lateral, elevation, 35))
        self.assertGreater(np.dot(pose(self.probe)[1], lateral), 0)

    def test_a_thousand_movements_leave_unit_vectors(self):
        for turn in itertools.islice(itertools.cycle((self.probe.Rotate, self.probe.Tilt, self.probe.Rock)), 1000):
            turn(7.3)
        _, axial, lateral = pose(self.probe)
        self.assertAlmostEqual(np.linalg.norm(axial), 1, delta=1e-12)
        self.assertAlmostEqual(np.linalg.norm(lateral), 1, delta=1e-12)
        self.assertAlmostEqual(np.dot(axial, lateral), 0, delta=1e-12)

    def test_directions_that_are_none(self):
        self.probe.SetAxial(0, 0, 0)
        self.probe.SetLateral(0, 0, 0)
        self.probe.Rotate(10)
        _, axial, lateral = pose(self.probe)
        self.assertAlmostEqual(np.linalg.norm(axial), 1)
        self.assertAlmostEqual(np.dot(axial, lateral), 0)

    def test_depth_stays_in_its_range(self):
        self.probe.ChangeDepth(15)
        self.assertEqual(self.probe.GetDepthMm(), 175)
        self.assertIn("175 mm", self.probe.GetMessage())
        self.probe.ChangeDepth(-1e6)
        self.assertEqual(self.probe.GetDepthMm(), 1)
        self.probe.SetPresetFile("some.json")
        self.probe.ChangeDepth(15)
        self.assertEqual(self.probe.GetDepthMm(), 1)
        self.assertIn("preset", self.probe.GetMessage())


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
        self.assertIn("show the Ultrasound Scene", self.probe.GetMessage())
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


class TestMouse(unittest.TestCase):
    """The widget gets the events of a window that is never shown."""

    def setUp(self):
        self.window, self.renderer, self.interactor = vtkRenderWindow(), vtkRenderer(), vtkRenderWindowInteractor()
        self.window.SetSize(800, 600)
        self.window.AddRenderer(self.renderer)
        self.interactor.SetRenderWindow(self.window)
        self.interactor.SetInteractorStyle(None)
        self.interactor.EnableRenderOff()
        camera = self.renderer.GetActiveCamera()
        camera.SetPosition(420, 260, 380)
        camera.SetFocalPoint(0, 0, 60)
        camera.SetViewUp(0, 0, 1)
        camera.SetClippingRange(10, 2000)
        self.probe, self.widget = Probe(), vtkSonoProbeWidget()
        self.probe.GetSkin().SetSurfaces(sphere(100))
        self.probe.SetPositionMm(0, 0, 100)
        self.probe.SetAxial(0, 0, -1)
        self.probe.SetLateral(1, 0, 0)
        self.probe.SetDepthMm(80)
        self.widget.SetInteractor(self.interactor)
        self.widget.SetRepresentation(self.probe)
        self.widget.SetCurrentRenderer(self.renderer)
        self.widget.SetDefaultRenderer(self.renderer)
        self.widget.SetEnabled(1)
        self.heard = []
        for event in ("StartInteractionEvent", "InteractionEvent", "EndInteractionEvent"):
            self.widget.AddObserver(event, lambda _, name: self.heard.append(name[:-len("InteractionEvent")]))

    def display(self, world):
        self.renderer.SetWorldPoint(*world, 1)
        self.renderer.WorldToDisplay()
        return np.array(self.renderer.GetDisplayPoint()[:2])

    def handle(self, state):
        world = [0.0] * 3
        self.probe.GetHandle(state, world)
        return np.array(world)

    def event(self, name, at, key=None, shift=0, control=0):
        self.interactor.SetEventInformation(int(round(at[0])), int(round(at[1])), control, shift, "\0", 0, key)
        self.interactor.InvokeEvent(name)

    def drag(self, start, *stations):
        self.event("MouseMoveEvent", start)
        self.event("LeftButtonPressEvent", start)
        for station in stations:
            self.event("MouseMoveEvent", station)
        self.event("LeftButtonReleaseEvent", stations[-1])

    def test_states_of_the_handles(self):
        for state in (Probe.SLIDING, Probe.ROTATING, Probe.TILTING, Probe.ROCKING, Probe.DEEPENING):
            x, y = self.display(self.handle(state))
            self.assertEqual(self.probe.ComputeInteractionState(int(round(x)), int(round(y))), state)
        self.assertEqual(self.probe.ComputeInteractionState(5, 5), Probe.OUTSIDE)
        self.probe.SetPresetFile("some.json")
        x, y = self.display(self.handle(Probe.DEEPENING))
        self.assertEqual(self.probe.ComputeInteractionState(int(round(x)), int(round(y))), Probe.OUTSIDE)

    def test_handles_turn_about_their_own_axis_and_follow_the_pointer(self):
        for state, moves in ((Probe.ROTATING, "lateral"), (Probe.TILTING, "axial"), (Probe.ROCKING, "both")):
            with self.subTest(state=state):
                self.setUp()
                position, axial, lateral = pose(self.probe)
                elevation = np.cross(axial, lateral)
                start = self.display(self.handle(state))
                # Where the handle would be after 25 degrees.
                axis = {Probe.ROTATING: axial, Probe.TILTING: -lateral, Probe.ROCKING: elevation}[state]
                aim = self.display(position + turned(self.handle(state) - position, axis, 25))
                self.drag(start, 0.5 * (start + aim), aim)
                after = pose(self.probe)
                np.testing.assert_array_equal(after[0], position)
                np.testing.assert_allclose(after[1], turned(axial, axis, 25), atol=0.03)
                np.testing.assert_allclose(after[2], turned(lateral, axis, 25), atol=0.03)

    def test_depth_handle(self):
        start = self.display(self.handle(Probe.DEEPENING))
        self.drag(start, self.display((0, 0, -30)))  # 130 mm below the face
        self.assertAlmostEqual(self.probe.GetDepthMm(), 130, delta=2)

    def test_dragging_the_head_slides_the_face_under_the_pointer(self):
        start = self.display(self.handle(Probe.SLIDING))
        aims = [100 * np.array((np.sin(a), 0, np.cos(a))) for a in np.radians((5, 10, 15, 20))]
        offset = start - self.display((0, 0, 100))
        self.drag(start, *(self.display(aim) + offset for aim in aims))
        position, axial, lateral = pose(self.probe)
        np.testing.assert_allclose(position, aims[-1], atol=1.5)
        self.assertLess(angle(axial, -position), 0.5)
        self.assertEqual(self.heard[0], "Start")
        self.assertEqual(self.heard[-1], "End")
        self.assertEqual(self.heard.count(""), 4)

    def test_off_the_skin_it_keeps_the_last_place(self):
        start = self.display(self.handle(Probe.SLIDING))
        self.drag(start, start + (3, 0), (790, 590))
        self.assertIn("off the skin", self.probe.GetMessage())
        self.assertAlmostEqual(np.linalg.norm(self.probe.GetPositionMm()), 100, delta=0.05)

    def test_a_press_beside_the_probe_is_not_the_widget_s(self):
        before = pose(self.probe)
        self.drag((5, 5), (100, 100))
        np.testing.assert_array_equal(pose(self.probe), before)
        self.assertEqual(self.heard, [])

    def test_arrow_keys_while_the_pointer_is_over_the_probe(self):
        over = self.display(self.handle(Probe.SLIDING))
        self.event("KeyPressEvent", (5, 5), "Right")
        self.assertEqual(self.heard, [])
        self.event("MouseMoveEvent", over)
        self.event("KeyPressEvent", over, "Right")
        np.testing.assert_allclose(self.probe.GetPositionMm(), (1, 0, 100), atol=0.05)
        self.assertEqual(self.heard, ["Start", "", "End"])
        self.event("KeyPressEvent", over, "Up")  # towards the elevation, -y here
        np.testing.assert_allclose(self.probe.GetPositionMm(), (1, -1, 100), atol=0.05)
        _, axial, lateral = pose(self.probe)
        self.event("KeyPressEvent", over, "Left", control=1)
        self.assertAlmostEqual(angle(pose(self.probe)[2], lateral), 2, delta=1e-6)
        _, axial, lateral = pose(self.probe)
        self.event("KeyPressEvent", over, "Up", shift=1)
        self.assertAlmostEqual(np.dot(pose(self.probe)[1], np.cross(axial, lateral)), np.sin(np.radians(2)))
        _, axial, lateral = pose(self.probe)
        self.event("KeyPressEvent", over, "Right", shift=1)
        self.assertAlmostEqual(np.dot(pose(self.probe)[1], lateral), np.sin(np.radians(2)))
        self.event("KeyPressEvent", over, "Down", control=1)
        self.assertEqual(self.probe.GetDepthMm(), 85)
        self.event("KeyPressEvent", over, "a")
        self.assertEqual(len(self.heard), 18)


class TestShape(unittest.TestCase):
    def bounds_in_frame(self, probe):
        probe.SetPositionMm(0, 0, 0)
        probe.SetAxial(0, 0, 1)
        probe.SetLateral(1, 0, 0)
        return probe.GetBounds()

    def test_fan_is_the_source_s_outline(self):
        for kind in range(5):
            with self.subTest(kind=kind):
                probe, source = Probe(), vtkSonoProbeSource()
                for each in (probe, source):
                    each.SetScanKind(kind)
                    each.SetDepthMm(170)
                source.Update()
                self.assertGreaterEqual(probe.GetBounds()[1] + 1e-6, source.GetOutput().GetBounds()[1])
                # The far end of the fan is deeper than head and handles reach, in the frame of the probe.
                source.SetPositionMm(0, 0, 0)
                source.SetAxial(0, 0, 1)
                source.SetLateral(1, 0, 0)
                source.Update()
                deepest = max(source.GetOutput().GetBounds()[5], 170)  # a matrix's middle is deeper than its border
                self.assertAlmostEqual(self.bounds_in_frame(probe)[5], deepest, delta=4)

    def test_numbers_that_are_not_valid_leave_the_last_shape(self):
        probe = Probe()
        before = self.bounds_in_frame(probe)
        probe.SetDepthMm(0)
        self.assertEqual(probe.GetBounds()[:5], before[:5])

    def test_preset_that_is_missing_is_drawn_with_the_numbers(self):
        probe = Probe()
        before = self.bounds_in_frame(probe)
        probe.SetPresetFile("nowhere/no.json")
        np.testing.assert_allclose(probe.GetBounds()[:4], before[:4], atol=1e-9)


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
