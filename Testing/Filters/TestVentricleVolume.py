"""A ventricle's volume by discs: of contours that are typed, against equations, and of labels, against voxels."""
import math
import unittest

import numpy as np
from chain import listen, make
from sonovdb.vtkSonoFilters import vtkSonoStandardViews, vtkSonoThoraxSource, vtkSonoUltrasound, vtkSonoVentricleVolume
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData

FLAT_IMAGE = 7


def half_ellipse(half, length, apex_depth, count=60):
    """From hinge to hinge, the apex up."""
    return [(half * math.cos(math.pi * i / count), apex_depth + length - length * math.sin(math.pi * i / count))
            for i in range(count + 1)]


def volume_of(filter, name="VolumeMl", port=0):
    array = filter.GetOutputDataObject(port).GetFieldData().GetArray(name)
    return array.GetValue(0) if array else None


def text_of(filter, port=0):
    return filter.GetOutputDataObject(port).GetFieldData().GetAbstractArray("Text").GetValue(0)


class TestTraced(unittest.TestCase):
    def filter(self, four=(), two=None):
        volume = vtkSonoVentricleVolume()
        image = vtkImageData()
        image.SetDimensions(2, 2, 1)
        for port in range(1 if two is None else 2):
            volume.SetInputDataObject(port, image)
        for point in four:
            volume.AddFourChamberPoint(*point)
        for point in two or ():
            volume.AddTwoChamberPoint(*point)
        volume.Update()
        return volume

    def test_a_triaxial_ellipsoid_from_two_views(self):
        volume = self.filter(half_ellipse(22, 85, 20), half_ellipse(26, 85, 15))
        exact = 2 / 3 * math.pi * 22 * 26 * 85 / 1000
        self.assertAlmostEqual(volume_of(volume), exact, delta=0.003 * exact)
        self.assertAlmostEqual(volume_of(volume, "FourChamberMl"), exact * 22 / 26, delta=0.003 * exact)
        self.assertAlmostEqual(volume_of(volume, "TwoChamberMl"), exact * 26 / 22, delta=0.003 * exact)
        self.assertAlmostEqual(volume_of(volume, "LengthMm"), 85, places=6)
        for port in range(2):
            self.assertEqual(volume_of(volume, port=port), volume_of(volume))
            self.assertEqual(text_of(volume, port), f"{volume_of(volume):.1f} ml biplane")
            self.assertGreater(volume.GetOutputDataObject(port).GetNumberOfLines(), 60 + 20)

    def test_one_view_takes_it_for_round(self):
        exact = 2 / 3 * math.pi * 24 * 24 * 80 / 1000
        for contours in ((half_ellipse(24, 80, 20),), ((), half_ellipse(24, 80, 20))):
            volume = self.filter(*contours)
            self.assertAlmostEqual(volume_of(volume), exact, delta=0.003 * exact)
            self.assertTrue(text_of(volume).endswith("ml single plane"))

    def test_a_contour_that_has_just_begun_has_no_volume(self):
        for points in ((), ((0, 50),), ((0, 50), (3, 40)), ((0, 50), (0, 50), (0, 50))):
            volume = self.filter(points)
            self.assertIsNone(volume_of(volume))
            self.assertEqual(text_of(volume), "")

    def test_points_are_cleared_and_discs_are_refused(self):
        volume = self.filter(half_ellipse(24, 80, 20))
        volume.ClearFourChamberPoints()
        volume.Update()
        self.assertIsNone(volume_of(volume))
        errors = listen(volume)
        volume.SetDiscs(0)
        volume.Update()
        self.assertEqual(len(errors), 1)
        self.assertIn("number of discs", errors[0])


class TestLabels(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.thorax = make(vtkSonoThoraxSource, SpacingMm=2.0)
        cls.thorax.Update()

    def view(self, name):
        """The flat image of a standard view, coarse, since labels alone count."""
        views = make(vtkSonoStandardViews, View=name)
        views.SetInputConnection(self.thorax.GetOutputPort())
        views.Update()
        field = views.GetOutput().GetFieldData()
        ultrasound = vtkSonoUltrasound()
        ultrasound.SetInputConnection(self.thorax.GetOutputPort())
        ultrasound.GetProbe().SetDepthMm(170.0)
        ultrasound.GetRayTracer().SetPathsPerLine(4)
        for setter, name in (("SetPositionMm", "ProbePositionMm"), ("SetAxial", "ProbeAxial"), ("SetLateral", "ProbeLateral")):
            getattr(ultrasound.GetProbe(), setter)(*field.GetArray(name).GetTuple(0))
        ultrasound.Update(FLAT_IMAGE)
        return ultrasound

    def test_discs_find_the_voxels_of_the_bundled_heart(self):
        """Blood and the papillary muscles in it, but for what discs say of a shape that is not quite round."""
        four, two = self.view("A4C"), self.view("A2C")
        volume = vtkSonoVentricleVolume()
        volume.SetInputConnection(0, four.GetOutputPort(FLAT_IMAGE))
        volume.SetInputConnection(1, two.GetOutputPort(FLAT_IMAGE))
        volume.SetContour(vtkSonoVentricleVolume.Labels)
        volume.Update()
        image = self.thorax.GetOutput()
        field = image.GetFieldData()
        ids = vtk_to_numpy(field.GetArray("LabelIds"))
        names = [field.GetAbstractArray("LabelNames").GetValue(i) for i in range(len(ids))]
        inside = [id for id, name in zip(ids, names, strict=True)
                  if name == "left_ventricle_blood" or name.startswith("papillary_muscle_lv")]
        voxels = np.isin(vtk_to_numpy(image.GetPointData().GetArray("Labels")), inside).sum()
        truth = voxels * np.prod(image.GetSpacing()) / 1000
        self.assertAlmostEqual(volume_of(volume) / truth, 1, delta=0.06)
        self.assertAlmostEqual(volume_of(volume, "FourChamberMl") / truth, 1, delta=0.12)

    def test_a_label_that_is_not_there_is_named(self):
        four = self.view("A4C")
        volume = vtkSonoVentricleVolume()
        volume.SetInputConnection(0, four.GetOutputPort(FLAT_IMAGE))
        volume.SetContour(vtkSonoVentricleVolume.Labels)
        volume.SetVentricle("third ventricle")
        errors = listen(volume)
        volume.Update()
        self.assertEqual(len(errors), 1)
        self.assertIn("no label 'third ventricle'", errors[0])


if __name__ == "__main__":
    unittest.main()
