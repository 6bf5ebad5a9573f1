"""The labels at the image's pixels, and the volume of a matrix probe."""
import unittest

import numpy as np
from chain import Chain, count_runs, label_image, shown_deeper
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline


def array(image, name):
    """A point array indexed [z, y, x]."""
    return vtk_to_numpy(image.GetPointData().GetArray(name)).reshape(image.GetDimensions()[::-1])


def places(image):
    """World coordinates of all points, as VTK has them, indexed [z, y, x]."""
    points = [image.GetPoint(i) for i in range(image.GetNumberOfPoints())]
    return np.array(points).reshape(*image.GetDimensions()[::-1], 3)


def lookup(label_map, points):
    """The voxel that holds each point, 0 outside; and whether the point is well inside of it, past all rounding, that
    of offsets in single precision included."""
    direction = np.array([[label_map.GetDirectionMatrix().GetElement(r, c) for c in range(3)] for r in range(3)])
    index = (points - label_map.GetOrigin()) @ direction / label_map.GetSpacing()
    voxel = np.floor(index + 0.5).astype(int)
    clear = np.all(np.abs(index + 0.5 - np.round(index + 0.5)) > 1e-4, axis=-1)
    size = np.array(label_map.GetDimensions())
    inside = np.all((voxel >= 0) & (voxel < size), axis=-1)
    x, y, z = np.moveaxis(np.clip(voxel, 0, size - 1), -1, 0)
    return np.where(inside, array(label_map, "Labels")[z, y, x], 0), clear


def shown(chain, image, elevations=1):
    """World coordinates of what all points show, in a sector of 60 degrees, and of 40 in elevation where there are
    several: on the way from the face's middle, deeper than the point as the traced lines say."""
    probe = chain.probe
    axial, lateral = np.array(probe.GetAxial()), np.array(probe.GetLateral())
    axial /= np.linalg.norm(axial)
    lateral -= (lateral @ axial) * axial
    lateral /= np.linalg.norm(lateral)
    points = places(image)
    away = points - probe.GetPositionMm()
    x, y, z = away @ lateral, away @ np.cross(axial, lateral), away @ axial
    range_mm = np.linalg.norm(away, axis=-1)
    forward = np.hypot(y, z)
    along = (np.degrees(np.arctan2(x, forward)) + 30) / 60 * 11
    traced = chain.tracer.GetOutput()
    deeper = shown_deeper(traced, along, range_mm, elevations, (np.degrees(np.arctan2(y, z)) + 20) / 40)
    return points + away * (deeper / np.maximum(range_mm, 1e-9))[..., None]


def numbered_map():
    """A map whose every voxel has its own label: 1 + i + 20 j + 400 k, 10 mm wide, from (-60, -100, -80) mm."""
    label_map = label_image(np.arange(1, 8001, dtype=np.uint16).reshape(20, 20, 20))
    label_map.SetOrigin(-60, -100, -80)
    label_map.SetSpacing(10, 10, 10)
    return label_map


class TestGroundTruth(unittest.TestCase):
    def setUp(self):
        self.chain = Chain()
        self.chain.converter.SetPixelMm(1.0)

    def converted(self):
        self.chain.converter.Update()
        return self.chain.converter.GetOutput()

    def expect_labels(self, image, label_map):
        expected, clear = lookup(label_map, shown(self.chain, image))
        mask = array(image, "Mask") == 1
        labels = array(image, "Labels")
        self.assertGreater(np.count_nonzero(clear & mask), 1000)
        np.testing.assert_array_equal(labels[clear & mask], expected[clear & mask])
        self.assertFalse(labels[~mask].any())

    def test_labels_are_the_scenes(self):
        image = self.converted()
        self.assertGreater(np.unique(array(image, "Labels")).size, 3)
        self.expect_labels(image, self.chain.thorax.GetOutput())

    def test_labels_come_with_their_names(self):
        names = {}
        for image in (self.chain.thorax.GetOutput(), self.converted()):
            field = image.GetFieldData()
            ids = vtk_to_numpy(field.GetArray("LabelIds"))
            names[image] = {int(n): field.GetAbstractArray("LabelNames").GetValue(i) for i, n in enumerate(ids)}
        first, second = names.values()
        self.assertEqual(first, second)

    def test_connected_map_goes_first(self):
        label_map = numbered_map()
        self.chain.converter.SetInputDataObject(1, label_map)
        image = self.converted()
        self.expect_labels(image, label_map)

    def test_label_at_a_place_computed_by_hand(self):
        """Straight ahead of (87.8, -86.5, -45) by 50 mm along (-0.53, 0.65, 0.545), which is 1.0002 long, lies
        (61.3, -54.0, -17.75): 12.13, 4.60 and 6.23 voxels from the first, so i, j, k = 12, 5, 6. In the model whose range
        is depth."""
        self.chain.tracer.SetInterfaceModel(1)
        self.chain.probe.SetPositionMm(87.8, -86.5, -45.0)
        self.chain.probe.SetAxial(-0.53, 0.65, 0.545)
        self.chain.probe.SetLateral(0.843, 0.333, 0.423)
        self.chain.converter.SetInputDataObject(1, numbered_map())
        image = self.converted()  # 91 columns, from -45 to 45 mm; 91 rows, from 0 to 90 mm
        self.assertEqual(image.GetDimensions(), (91, 91, 1))
        self.assertEqual(array(image, "Labels")[0, 50, 45], 1 + 12 + 20 * 5 + 400 * 6)

    def test_changed_map_is_taken_and_nothing_else_runs(self):
        label_map = numbered_map()
        self.chain.converter.SetInputDataObject(1, label_map)
        before = array(self.converted(), "Labels").copy()
        runs = count_runs(self.chain.bmode)
        array(label_map, "Labels")[:] += 1
        label_map.GetPointData().GetArray("Labels").Modified()
        after = array(self.converted(), "Labels")
        np.testing.assert_array_equal(after[before > 0], before[before > 0] + 1)
        self.assertEqual(runs, [])


class TestMatrix(unittest.TestCase):
    def setUp(self):
        self.chain = Chain()
        self.chain.probe.SetScanKind(3)
        self.chain.probe.SetElevationLineCount(6)
        self.chain.probe.SetElevationSectorDeg(40.0)
        self.chain.converter.SetPixelMm(2.0)
        self.chain.converter.Update()
        self.image = self.chain.converter.GetOutput()

    def test_size(self):
        # 2 x 90 sin 30 = 90 mm and 2 x 90 sin 20 = 61.56 mm wide, 90 mm deep, in steps of 2 mm.
        self.assertEqual(self.image.GetDimensions(), (46, 32, 46))
        self.assertEqual(self.image.GetSpacing(), (2.0, 2.0, 2.0))

    def test_what_is_too_fine_is_as_fine_as_fits(self):
        self.chain.converter.SetPixelMm(0.1)
        self.chain.converter.UpdateInformation()
        low = self.chain.converter.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.WHOLE_EXTENT())[1::2]
        self.assertLessEqual(np.prod(np.array(low, dtype=float) + 1), 2**25)
        self.assertGreater(np.prod(np.array(low, dtype=float) + 1), 0.98 * 2**25)

    def test_place(self):
        """Axes are lateral, elevation and axial; the face's centre is in the middle of the first slice."""
        axial = np.array(self.chain.probe.GetAxial())
        axial /= np.linalg.norm(axial)
        face = np.array(self.chain.probe.GetPositionMm())
        points = places(self.image)
        np.testing.assert_allclose(points[0].reshape(-1, 3).mean(axis=0), face, atol=1e-9)
        np.testing.assert_allclose(points[20, 5, 7] - points[0, 5, 7], 40.0 * axial, atol=1e-9)
        across = points[0, 0, 45] - points[0, 0, 0], points[0, 31, 0] - points[0, 0, 0]
        np.testing.assert_allclose(np.cross(*across) / (90.0 * 62.0), axial, atol=1e-9)

    def test_mask_and_grey(self):
        mask, grey = array(self.image, "Mask"), array(self.image, "BMode")
        self.assertTrue(mask[20, 15:17, 22:24].all())
        self.assertFalse(mask[20, 0].any())   # 31 mm beside the axis at 40 mm: 38 degrees, the sector has 20
        self.assertFalse(mask[20, :, 0].any())  # 45 mm: 48 degrees, the sector has 30
        self.assertFalse(grey[mask == 0].any())
        self.assertGreater(np.unique(grey[mask == 1]).size, 50)

    def test_labels(self):
        expected, clear = lookup(self.chain.thorax.GetOutput(), shown(self.chain, self.image, elevations=6))
        chosen = clear & (array(self.image, "Mask") == 1)
        np.testing.assert_array_equal(array(self.image, "Labels")[chosen], expected[chosen])
        self.assertGreater(np.unique(expected[chosen]).size, 3)


if __name__ == "__main__":
    unittest.main()
