"""A probe on its way: each step runs the stages behind the probe once and prepares nothing again, the picture does not depend
on the way, and it looks like the final one."""
import time
import unittest

import numpy as np
from chain import Chain, count_runs, make
from sonovdb.vtkSonoFilters import vtkSonoRayTracer, vtkSonoThoraxSource, vtkSonoUltrasound
from vtkmodules.util.numpy_support import vtk_to_numpy

ANATOMY = 4  # the one filter's output


def array(image, name="BMode"):
    width, height, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetArray(name)).reshape(height, width).copy()


def ultrasound_on(thorax, **settings):
    """The one filter at the thorax' own pose."""
    ultrasound = make(vtkSonoUltrasound, BuildSurfaces=False, **settings)
    ultrasound.SetInputConnection(thorax.GetOutputPort())
    field = thorax.GetOutput().GetFieldData()
    for part in ("PositionMm", "Axial", "Lateral"):
        getattr(ultrasound.GetProbe(), "Set" + part)(*field.GetArray("A4C" + part).GetTuple3(0))
    return ultrasound


def scene_time(ultrasound):
    """When the scene of the one filter was built."""
    ultrasound.Update(ANATOMY)
    return ultrasound.GetOutputDataObject(ANATOMY).GetFieldData().GetAbstractArray("SonoScene").GetMTime()


def moved(position, steps):
    return [p + 0.6 * steps * direction for p, direction in zip(position, (0.3, 0.2, 1.0))]


class TestDrag(unittest.TestCase):
    def test_a_step_runs_each_stage_once_and_the_scene_never(self):
        chain = Chain()
        chain.converter.Update()
        runs = {name: count_runs(stage) for name, stage in chain.stages().items()}
        position = chain.probe.GetPositionMm()
        chain.probe.SetPreview(True)
        for step in range(1, 11):
            chain.probe.SetPositionMm(moved(position, step))
            chain.converter.Update()
        counts = {name: len(times) for name, times in runs.items()}
        self.assertEqual(counts.pop("scene", 0), 0)
        self.assertEqual(counts.pop("thorax", 0), 0)
        self.assertEqual(set(counts.values()), {10})

    def test_the_one_filter_builds_its_anatomy_once(self):
        thorax = make(vtkSonoThoraxSource, SpacingMm=4.0)
        thorax.Update()
        ultrasound = ultrasound_on(thorax, LineCount=12, PathsPerLine=20)
        position = ultrasound.GetProbe().GetPositionMm()
        texts = []
        ultrasound.AddObserver("ProgressEvent", lambda *_: texts.append(ultrasound.GetProgressText()))
        ultrasound.Update()
        self.assertIn("Building the anatomy", texts)
        texts.clear()
        ultrasound.GetProbe().SetPreview(True)
        built = scene_time(ultrasound)
        for step in range(1, 6):
            before = array(ultrasound.GetOutputDataObject(0))
            ultrasound.GetProbe().SetPositionMm(*moved(position, step))
            ultrasound.Update()
            self.assertFalse(np.array_equal(array(ultrasound.GetOutputDataObject(0)), before))
        self.assertNotIn("Building the anatomy", texts)
        self.assertEqual(scene_time(ultrasound), built)

    def test_nothing_is_prepared_unless_a_widget_asks(self):
        chain = Chain()
        prepared = lambda: "moving probe: yes" in str(
            chain.tracer.GetOutputDataObject(0).GetFieldData().GetAbstractArray("SonoScene"))
        chain.converter.Update()
        self.assertFalse(prepared())  # a script's image leaves no work and no memory behind
        chain.probe.SetPrepareInteraction(True)
        chain.converter.Update()
        self.assertFalse(prepared())  # the image is the same: nothing runs again for it
        chain.probe.SetPositionMm(moved(chain.probe.GetPositionMm(), 1))
        chain.converter.Update()
        self.assertTrue(prepared())

    def test_a_window_that_is_idle_has_the_moving_probe_prepared(self):
        """Of a picture that was made, which stays; what moves looks as without."""
        thorax = make(vtkSonoThoraxSource, SpacingMm=4.0)
        thorax.Update()
        pictures = []
        for prepares in (False, True):
            ultrasound = ultrasound_on(thorax, LineCount=12, PathsPerLine=20)
            ultrasound.PrepareMoving()  # of what, is not known yet
            ultrasound.Update()
            prepared = lambda: "moving probe: yes" in str(
                ultrasound.GetOutput().GetFieldData().GetAbstractArray("SonoScene"))
            self.assertFalse(prepared())
            time = ultrasound.GetMTime()
            if prepares:
                ultrasound.PrepareMoving()
            self.assertEqual((prepared(), ultrasound.GetMTime()), (prepares, time))
            ultrasound.GetProbe().SetPreview(True)
            ultrasound.GetProbe().SetPositionMm(*moved(ultrasound.GetProbe().GetPositionMm(), 2))
            ultrasound.Update()
            pictures.append(array(ultrasound.GetOutput()))
        np.testing.assert_array_equal(*pictures)

    def test_the_next_picture_is_made_while_one_is_drawn(self):
        """And is the one that comes without; what was made for another pose, or for other settings, is dropped."""
        thorax = make(vtkSonoThoraxSource, SpacingMm=4.0)
        thorax.Update()
        ahead, alone = (ultrasound_on(thorax, LineCount=24, Device=vtkSonoRayTracer.CPU) for _ in range(2))
        probe = ahead.GetProbe()
        start, axial, lateral = probe.GetPositionMm(), probe.GetAxial(), probe.GetLateral()
        begin = lambda step: ahead.MakeAhead(moved(start, step), axial, lateral)
        self.assertFalse(begin(1))  # nothing has been made
        ahead.Update()
        for ultrasound in (ahead, alone):
            ultrasound.GetProbe().SetPreview(True)

        def check(step):
            for ultrasound in (ahead, alone):
                ultrasound.GetProbe().SetPositionMm(*moved(start, step))
                ultrasound.Update()
            for port in (0, 7):
                for name in ("BMode", "Labels"):
                    np.testing.assert_array_equal(array(ahead.GetOutputDataObject(port), name),
                                                  array(alone.GetOutputDataObject(port), name))

        self.assertTrue(begin(1))
        for step in range(1, 5):
            self.assertTrue(begin(step + 1))  # behind the one that is under way
            check(step)
        while not ahead.IsAheadReady():
            time.sleep(0.001)
        check(5)
        self.assertTrue(begin(6))
        check(7)
        self.assertTrue(begin(8))
        for ultrasound in (ahead, alone):
            ultrasound.GetRayTracer().SetPathSeed(5)
            ultrasound.GetBMode().SetGainDb(6)
        check(8)
        self.assertFalse(ahead.MakeAhead(start, axial, axial))
        check(9)

    def test_picture_does_not_depend_on_the_way(self):
        thorax = make(vtkSonoThoraxSource, SpacingMm=4.0)
        thorax.Update()
        dragged = ultrasound_on(thorax, LineCount=24)
        fresh = ultrasound_on(thorax, LineCount=24)
        position = dragged.GetProbe().GetPositionMm()
        dragged.Update()
        for preview in (True, False):  # on the way, and when it rests
            dragged.GetProbe().SetPreview(True)
            for step in range(1, 13):
                dragged.GetProbe().SetPositionMm(*moved(position, step))
                dragged.Update()
            for ultrasound in (dragged, fresh):
                ultrasound.GetProbe().SetPositionMm(*moved(position, 12))
                ultrasound.GetProbe().SetPreview(preview)
                ultrasound.Update()
            for port in range(dragged.GetNumberOfOutputPorts()):
                dragged.Update(port)
                fresh.Update(port)
                made, expected = dragged.GetOutputDataObject(port), fresh.GetOutputDataObject(port)
                if made.IsA("vtkImageData"):
                    with self.subTest(preview=preview, port=port):
                        for i in range(expected.GetPointData().GetNumberOfArrays()):
                            np.testing.assert_array_equal(vtk_to_numpy(made.GetPointData().GetArray(i)),
                                                          vtk_to_numpy(expected.GetPointData().GetArray(i)))


class TestPreview(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        thorax = make(vtkSonoThoraxSource, SpacingMm=2.0)
        thorax.Update()
        ultrasound = ultrasound_on(thorax, LineCount=64)
        cls.images = {"fine": [], "coarse": []}
        for seed in (1, 2, 3, 4):  # a preview's few paths leave 2 dB of noise
            ultrasound.GetRayTracer().SetPathSeed(seed)
            for name, preview in (("fine", False), ("coarse", True)):
                ultrasound.GetProbe().SetPreview(preview)
                ultrasound.Update()
                image = ultrasound.GetOutputDataObject(0).NewInstance()
                image.DeepCopy(ultrasound.GetOutputDataObject(0))
                cls.images[name].append(image)
        cls.db_per_grey = ultrasound.GetBMode().GetDynamicRangeDb() / 255

    def squares(self, name, edge):
        """Mean levels in dB of squares of pixels, and the part of each that lies in the sector."""
        inside = array(self.images[name][0], "Mask") > 0
        level = np.mean([array(image) for image in self.images[name]], axis=0) * self.db_per_grey * inside
        rows, columns = (n // edge for n in level.shape)

        def summed(values):
            return values[:rows * edge, :columns * edge].reshape(rows, edge, columns, edge).sum(axis=(1, 3))

        count = summed(inside.astype(float))
        return summed(level) / np.maximum(count, 1), count / edge**2

    def test_it_lies_in_the_same_place(self):
        fine, coarse = self.images["fine"][0], self.images["coarse"][0]
        pixel = coarse.GetSpacing()[0]
        np.testing.assert_allclose(coarse.GetBounds(), fine.GetBounds(), atol=pixel)
        self.assertEqual(pixel, 2 * fine.GetSpacing()[0])
        self.assertLess(coarse.GetNumberOfPoints(), fine.GetNumberOfPoints() / 3.9)

    def test_it_is_as_bright(self):
        mean = {name: np.mean([array(image)[array(image, "Mask") > 0].mean() for image in images]) * self.db_per_grey
                for name, images in self.images.items()}
        # Fewer paths leave noise in what is dark.
        self.assertLess(abs(mean["coarse"] - mean["fine"]), 2.5)

    def test_it_shows_the_same(self):
        fine, share = self.squares("fine", 40)
        coarse, coarse_share = self.squares("coarse", 20)
        rows, columns = np.minimum(fine.shape, coarse.shape)
        whole = (share[:rows, :columns] > 0.95) & (coarse_share[:rows, :columns] > 0.95)
        self.assertGreater(whole.sum(), 100)
        pair = fine[:rows, :columns][whole], coarse[:rows, :columns][whole]
        self.assertGreater(np.corrcoef(*pair)[0, 1], 0.95)


if __name__ == "__main__":
    unittest.main()
