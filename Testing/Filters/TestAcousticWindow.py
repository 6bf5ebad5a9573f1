"""Where the probe of a new simulation stands: the pose that the data bring along, or places found on the skin; and what
the anatomy says of itself."""
import unittest

import numpy as np
from chain import label_image, listen, make
from sonovdb.vtkSonoFilters import (vtkSonoAcousticWindow, vtkSonoLabelTable, vtkSonoSceneBuilder, vtkSonoThoraxSource,
                                    vtkSonoUltrasound)
from vtkmodules.vtkCommonCore import vtkIntArray, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkImageData


def pose(window):
    window.Update()
    field = window.GetOutput().GetFieldData()
    return [np.array(field.GetArray(name).GetTuple3(0)) for name in ("ProbePositionMm", "ProbeAxial", "ProbeLateral")]


def ball(fill=1):
    """A ball, radius 20 mm around (32, 32, 32), in a box of 64 mm; outside and ball labelled 0 and `fill`."""
    z, y, x = np.mgrid[0:32, 0:32, 0:32] * 2.0
    image = label_image((((x - 32)**2 + (y - 32)**2 + (z - 32)**2 < 20**2) * fill).astype(np.uint8))
    image.SetSpacing(2, 2, 2)
    return image


def named(image, **names):
    """The image with names for its labels."""
    ids, texts = vtkIntArray(), vtkStringArray()
    ids.SetName("LabelIds")
    texts.SetName("LabelNames")
    for name, number in names.items():
        ids.InsertNextValue(number)
        texts.InsertNextValue(name)
    for array in (ids, texts):
        image.GetFieldData().AddArray(array)
    return image


def organ(inner=2, outer=3):
    """A ball, radius 16 mm, of label `inner` in one of `outer`, radius 26 mm, in a box of 64 mm."""
    z, y, x = np.mgrid[0:32, 0:32, 0:32] * 2.0
    r = np.sqrt((x - 32)**2 + (y - 32)**2 + (z - 32)**2)
    image = label_image(np.select([r < 16, r < 26], [inner, outer], 0).astype(np.uint8))
    image.SetSpacing(2, 2, 2)
    return image


class TestAcousticWindow(unittest.TestCase):
    def test_the_thorax_brings_its_pose_along(self):
        thorax = make(vtkSonoThoraxSource, SpacingMm=4.0)
        window = vtkSonoAcousticWindow()
        window.SetInputConnection(thorax.GetOutputPort())
        position, axial, _ = pose(window)
        field = thorax.GetOutput().GetFieldData()
        np.testing.assert_array_equal(position, field.GetArray("A4CPositionMm").GetTuple3(0))
        np.testing.assert_allclose(axial, field.GetArray("A4CAxial").GetTuple3(0), atol=1e-12)

    def test_a_place_on_the_skin_that_looks_at_the_middle(self):
        window = vtkSonoAcousticWindow()
        window.SetInputData(ball())
        position, axial, lateral = pose(window)
        self.assertAlmostEqual(np.linalg.norm(position - 32), 20, delta=2)
        np.testing.assert_allclose(np.cross(32 - position, axial), 0, atol=1e-9)
        self.assertAlmostEqual(axial @ lateral, 0)
        self.assertEqual(window.GetOutput().GetNumberOfCells(), 1)

    def test_a_target_of_ones_own(self):
        window = make(vtkSonoAcousticWindow, ChooseTarget=True)
        window.SetTargetMm(32, 25, 35)
        window.SetInputData(ball())
        position, axial, _ = pose(window)
        np.testing.assert_allclose(np.cross(np.array([32, 25, 35]) - position, axial), 0, atol=1e-9)

    def test_places_to_choose_from(self):
        thorax = make(vtkSonoThoraxSource, SpacingMm=3.0)
        seen = []
        for candidate in range(3):
            window = make(vtkSonoAcousticWindow, Target="Liver", Candidate=candidate)
            window.SetInputConnection(thorax.GetOutputPort())
            position, axial, _ = pose(window)
            field = window.GetOutput().GetFieldData()
            np.testing.assert_array_equal(position, field.GetArray("CandidatePositionMm").GetTuple3(candidate))
            np.testing.assert_array_equal(axial, field.GetArray("CandidateAxial").GetTuple3(candidate))
            self.assertEqual(field.GetAbstractArray("ProbePreset").GetValue(0), "curvilinear_c5-2")
            count = field.GetAbstractArray("Sentence").GetNumberOfValues()
            self.assertEqual({field.GetArray(name).GetNumberOfTuples()
                              for name in ("DepthMm", "SeenPercent", "LossDb", "InsidePercent")}, {count})
            self.assertEqual(window.GetRows().GetNumberOfValues(), count)
            self.assertIn("of the Liver's largest section", window.GetRows().GetValue(candidate))
            seen.append(position)
        for a, b in ((0, 1), (0, 2), (1, 2)):
            self.assertGreater(np.linalg.norm(seen[a] - seen[b]), 40)
        targets = [window.GetTargets().GetValue(i) for i in range(window.GetTargets().GetNumberOfValues())]
        self.assertEqual(targets[:2], ["heart", "liver"])
        self.assertIn("stomach", targets)

    def test_a_named_target_is_looked_for_although_the_data_bring_a_pose(self):
        thorax = make(vtkSonoThoraxSource, SpacingMm=4.0)
        window = make(vtkSonoAcousticWindow, Target="heart")
        window.SetInputConnection(thorax.GetOutputPort())
        position, _, _ = pose(window)
        self.assertGreater(np.linalg.norm(position - thorax.GetOutput().GetFieldData().GetArray("A4CPositionMm")
                                          .GetTuple3(0)), 1)

    def test_a_scene_will_do(self):
        scene = make(vtkSonoSceneBuilder, BuildSurfaces=False)
        scene.SetInputData(ball())
        of_scene, of_image = vtkSonoAcousticWindow(), vtkSonoAcousticWindow()
        of_scene.SetInputConnection(scene.GetOutputPort())
        of_image.SetInputData(ball())
        np.testing.assert_array_equal(pose(of_scene), pose(of_image))

    def test_bad_input(self):
        outside = make(vtkSonoAcousticWindow, ChooseTarget=True)
        outside.SetTargetMm(500, 0, 0)
        for window, image, word in ((vtkSonoAcousticWindow(), ball(fill=0), "nothing but"),
                                    (outside, ball(), "by hand"),
                                    (vtkSonoAcousticWindow(), vtkImageData(), "no voxels"),
                                    (make(vtkSonoAcousticWindow, CentreFrequencyMHz=0.0), ball(), "CentreFrequencyMHz"),
                                    (make(vtkSonoAcousticWindow, Target="spleen"), ball(), "no 'spleen'; it has: label_1")):

            with self.subTest(word=word):
                window.SetInputData(image)
                said = listen(window)
                window.Update()
                self.assertEqual(len(said), 1, said)
                self.assertIn(word, said[0])
                self.assertIn(word, window.GetRefusal())



class TestWhatTheAnatomySays(unittest.TestCase):
    """Fill Body Auto, through the filter around it, as an observer hears it."""

    def build(self, image, mode=None):
        scene = make(vtkSonoSceneBuilder, BuildSurfaces=False)
        self.assertEqual(scene.GetFillBody(), vtkSonoSceneBuilder.FILL_AUTO)
        if mode is not None:
            scene.SetFillBody(mode)
        scene.SetInputData(image)
        heard = listen(scene, "WarningEvent")
        scene.Update()
        names = scene.GetOutput().GetFieldData().GetAbstractArray("LabelNames")
        return [names.GetValue(i) for i in range(names.GetNumberOfValues())], heard

    def test_a_body_without_skin_is_filled(self):
        image = named(organ(), liver=2, rib_left_5=3)
        names, heard = self.build(image)
        self.assertIn("skin", names)
        self.assertEqual(len(heard), 1, heard)
        self.assertIn("no skin", heard[0])
        names, heard = self.build(image, vtkSonoSceneBuilder.FILL_OFF)
        self.assertEqual(names, ["background", "liver", "rib_left_5"])
        self.assertEqual(len(heard), 1, heard)
        self.assertIn("Fill Body is Off", heard[0])
        names, heard = self.build(image, True)  # as scripts have it
        self.assertIn("skin", names)
        self.assertEqual(heard, [])

    def test_a_bare_organ_gets_a_bath(self):
        names, heard = self.build(organ())  # labels 2 and 3, without names
        self.assertIn("skin", names)
        self.assertTrue(any("bath of soft tissue, 40 mm" in sentence for sentence in heard), heard)

    def test_shapes_of_a_heart_without_names(self):
        image = organ()
        image.SetSpacing(3, 3, 3)
        scene = make(vtkSonoSceneBuilder, BuildSurfaces=False)
        scene.SetInputData(image)
        heard = listen(scene, "WarningEvent")
        table = vtkSonoLabelTable()
        table.SetInputConnection(scene.GetOutputPort())
        table.Update()
        rows = table.GetLabelRows()
        tissues = {row[1]: row[5:] for row in (rows.GetValue(i).split("\t") for i in range(1, rows.GetNumberOfValues()))}
        self.assertEqual(tissues["label_2"], ["blood", "yes"])
        self.assertEqual(tissues["label_3"], ["myocardium", "yes"])
        self.assertIn("label_3 lies around a chamber", heard[0])
        self.assertIn("guesses, to be changed in View > Ultrasound Tissues: label_2 (blood)", heard[0])
        window = vtkSonoAcousticWindow()
        window.SetInputData(image)
        window.Update()
        self.assertIn("the heart's largest section", window.GetRows().GetValue(0))

    def test_a_search_leaves_it_to_the_picture(self):
        """Who looks for a window makes a picture next, and would read each sentence twice."""
        image = named(organ(), liver=2, rib_left_5=3)
        window = vtkSonoAcousticWindow()
        window.SetInputData(image)
        heard = listen(window, "WarningEvent")
        window.Update()
        self.assertEqual(heard, [])

    def test_a_heart_of_one_label_has_no_chambers(self):
        _, heard = self.build(named(organ(), aorta=2, heart=3))
        self.assertTrue(any("chambers are missing" in sentence for sentence in heard), heard)

    def test_the_one_filter_says_it_too_and_warns_of_the_probes_place(self):
        ultrasound = make(vtkSonoUltrasound, LineCount=12, PathsPerLine=20, DepthMm=60.0, BuildSurfaces=False)
        ultrasound.SetInputData(named(organ(), liver=2, rib_left_5=3))
        ultrasound.GetProbe().SetPositionMm(32, 32, 32)
        heard = listen(ultrasound, "WarningEvent")
        ultrasound.Update()
        self.assertTrue(any("no skin" in sentence for sentence in heard), heard)
        self.assertTrue(any("inside the body: press Find Window" in sentence for sentence in heard), heard)


if __name__ == "__main__":
    unittest.main()
