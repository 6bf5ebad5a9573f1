"""Where the probe of a new simulation stands: the pose that the data bring along, or a place found on the skin."""
import unittest

import numpy as np
from chain import label_image, listen, make
from sonovdb.vtkSonoFilters import vtkSonoAcousticWindow, vtkSonoSceneBuilder, vtkSonoThoraxSource
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
                                    (make(vtkSonoAcousticWindow, CentreFrequencyMHz=0.0), ball(), "CentreFrequencyMHz")):
            with self.subTest(word=word):
                window.SetInputData(image)
                said = listen(window)
                window.Update()
                self.assertEqual(len(said), 1, said)
                self.assertIn(word, said[0])


if __name__ == "__main__":
    unittest.main()
