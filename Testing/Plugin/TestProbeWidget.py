"""The probe widget: its movements against rotations as matrix exponentials, its handles against what the mouse does, its
shape. Nothing is rendered."""
import itertools
import sys
import unittest

import numpy as np
from probecase import angle, pose, sphere, turned
from sonovdb.vtkSonoFilters import vtkSonoProbeSource
from sonovdb.vtkSonoWidgets import vtkSonoProbeRepresentation as Probe, vtkSonoProbeWidget
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkRenderingCore import (vtkPropCollection, vtkRenderer, vtkRenderWindow, vtkRenderWindowInteractor,
                                         vtkTextProperty, vtkTextRenderer)
import vtkmodules.vtkRenderingFreeType


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
        for name in ("PositionMm", "Axial", "Lateral", "DepthMm", "PresetFile"):
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
        self.assertEqual(self.probe.GetMessage(), "")
        self.probe.ChangeDepth(15)
        self.assertEqual(self.probe.GetDepthMm(), 1)
        self.assertIn("preset", self.probe.GetMessage())


    def test_a_message_ends_when_its_number_is_set_otherwise(self):
        self.probe.ChangeDepth(15)
        self.probe.SetDepthMm(175)  # as the panel does that follows
        self.assertIn("175 mm", self.probe.GetMessage())
        self.probe.SetDepthMm(300)
        self.assertEqual(self.probe.GetMessage(), "")
        self.probe.ChangeDepth(15)
        self.probe.SetNumber("SectorDeg", 60)
        self.assertEqual(self.probe.GetMessage(), "")

    def test_long_messages_are_drawn_in_lines(self):
        """The sentence of a view that shows no surface, in a wide view, in one of a layout, and in a narrow one."""
        self.probe.Walk(1, 0)
        sentence = self.probe.GetMessage()
        self.assertGreater(len(sentence), 80)
        self.assertEqual(self.probe.GetMessageLines(4000), sentence)
        for width in (420, 200):
            lines = self.probe.GetMessageLines(width).split("\n")
            self.assertEqual(" ".join(lines), sentence)
            widths = [text_width(line) for line in lines]
            self.assertLess(max(widths), width)
            self.assertGreater(min(widths[:-1]), 0.5 * width)  # no line more than it takes


def text_width(text):
    """Of 16 pixels' Arial, as VTK draws it into an image."""
    properties, image, size = vtkTextProperty(), vtkImageData(), [0, 0]
    properties.SetFontSize(16)
    properties.SetShadow(True)
    vtkTextRenderer.GetInstance().RenderString(properties, text, image, size, 72)
    return size[0]


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

    def test_arrow_keys_wherever_the_pointer_is(self):
        corner = (5, 5)
        self.event("KeyPressEvent", corner, "Right")
        np.testing.assert_allclose(self.probe.GetPositionMm(), (1, 0, 100), atol=0.05)
        self.assertEqual(self.heard, ["Start", "", "End"])
        self.event("KeyPressEvent", corner, "Up")  # towards the elevation, -y here
        np.testing.assert_allclose(self.probe.GetPositionMm(), (1, -1, 100), atol=0.05)
        _, axial, lateral = pose(self.probe)
        self.event("KeyPressEvent", corner, "Left", control=1)
        self.assertAlmostEqual(angle(pose(self.probe)[2], lateral), 2, delta=1e-6)
        _, axial, lateral = pose(self.probe)
        self.event("KeyPressEvent", corner, "Up", shift=1)
        self.assertAlmostEqual(np.dot(pose(self.probe)[1], np.cross(axial, lateral)), np.sin(np.radians(2)))
        _, axial, lateral = pose(self.probe)
        self.event("KeyPressEvent", corner, "Right", shift=1)
        self.assertAlmostEqual(np.dot(pose(self.probe)[1], lateral), np.sin(np.radians(2)))
        self.event("KeyPressEvent", corner, "Down", control=1)
        self.assertEqual(self.probe.GetDepthMm(), 85)
        self.event("KeyPressEvent", corner, "a")
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
                    each.SetNumber("ScanKind", kind)
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

    def test_numbers_that_never_were_valid_leave_nothing_to_draw(self):
        """Each time the view was drawn, VTK complained of mappers without an input."""
        probe, parts = Probe(), vtkPropCollection()
        probe.SetNumber("SectorDeg", 0)
        probe.GetBounds()
        probe.GetActors(parts)
        mappers = [parts.GetItemAsObject(i).GetMapper() for i in range(parts.GetNumberOfItems())
                   if parts.GetItemAsObject(i).IsA("vtkActor")]
        self.assertGreater(len(mappers), 5)
        self.assertTrue(all(mapper.GetInput() for mapper in mappers))

    def test_preset_that_is_missing_is_drawn_with_the_numbers(self):
        probe = Probe()
        before = self.bounds_in_frame(probe)
        probe.SetPresetFile("nowhere/no.json")
        np.testing.assert_allclose(probe.GetBounds()[:4], before[:4], atol=1e-9)


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
