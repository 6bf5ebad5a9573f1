"""What a scanner does to finished images: persistence over time steps, speckle reduction, compounded fans."""
import tempfile
import unittest

import numpy as np
from chain import Chain, listen, make, moving_plane
from sonovdb.vtkSonoFilters import (vtkSonoBMode, vtkSonoImageFormation, vtkSonoProbeSource, vtkSonoRayTracer,
                                    vtkSonoScanConverter, vtkSonoSceneBuilder, vtkSonoUltrasound)
from vtkmodules.util.numpy_support import vtk_to_numpy

SETTINGS = {"LineCount": 24, "ScanKind": 0, "WidthMm": 24.0, "DepthMm": 40.0, "PathsPerLine": 20, "PixelMm": 0.4,
            "PositionMm": (20.0, 20.0, 0.0), "Axial": (0.0, 0.0, 1.0), "Lateral": (1.0, 0.0, 0.0),
            "AutomaticReference": False, "ReferenceAmplitude": 0.1, "DynamicRangeDb": 90.0, "BuildSurfaces": False,
            "FillBody": 0, "TgcDbPerCm": 3.0, "MaxCollisions": 20, "CoherenceMm": 20.0}


def grey(image):
    return vtk_to_numpy(image.GetPointData().GetArray("BMode")).astype(float)


class Phases(unittest.TestCase):
    """Blocks of muscle and fat whose boundary moves, a file a time step."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.reader = moving_plane(folder.name, (10, 20, 30), (42, 40, 40), ("muscle", "fat"))

    def one(self, **settings):
        """Simulate Ultrasound; what it shows at a time."""
        filter = make(vtkSonoUltrasound, **{**SETTINGS, **settings})
        filter.SetInputConnection(self.reader.GetOutputPort())

        def shown(time):
            filter.UpdateInformation()
            filter.UpdateTimeStep(time)
            return grey(filter.GetOutput())
        return filter, filter.GetScanConverter(), filter.GetBMode(), shown

    def chain(self, **settings):
        """The same of the stages one after the other."""
        wanted = {**SETTINGS, **settings}
        stages = [kind() for kind in (vtkSonoSceneBuilder, vtkSonoRayTracer, vtkSonoImageFormation, vtkSonoBMode,
                                      vtkSonoScanConverter)]
        probe = vtkSonoProbeSource()
        for name, value in wanted.items():
            next(getattr(s, "Set" + name) for s in (*stages, probe) if hasattr(s, "Set" + name))(value)
        stages[0].SetInputConnection(self.reader.GetOutputPort())
        for before, after in zip(stages, stages[1:]):
            after.SetInputConnection(0, before.GetOutputPort())
        stages[1].SetInputConnection(1, probe.GetOutputPort())

        def shown(time):
            stages[-1].UpdateInformation()
            stages[-1].UpdateTimeStep(time)
            return grey(stages[-1].GetOutput())
        return stages[-1], stages[-1], stages[3], shown


class TestPersistence(Phases):
    def test_it_averages_the_time_steps(self):
        for door in (self.one, self.chain):
            with self.subTest(door=door.__name__):
                _, _, _, single = door()
                frames = [single(time) for time in (0, 1, 2)]
                self.assertGreater(np.abs(frames[0] - frames[1]).max(), 20)
                _, _, _, shown = door(Persistence=0.75)
                np.testing.assert_array_equal(shown(0), frames[0])
                second = 0.75 * frames[0] + 0.25 * frames[1]
                np.testing.assert_allclose(shown(1), second, atol=1.01)  # bytes of an average, average of bytes
                np.testing.assert_allclose(shown(2), 0.75 * second + 0.25 * frames[2], atol=1.5)

    def test_what_is_asked_for_again_is_no_new_frame(self):
        filter, _, _, shown = self.one(Persistence=0.5)
        shown(0)
        once = shown(1).copy()
        filter.Modified()
        np.testing.assert_array_equal(shown(1), once)

    def test_it_begins_anew(self):
        for door in (self.one, self.chain):
            for change in ("gain", "pose"):
                with self.subTest(door=door.__name__, change=change):
                    filter, _, bmode, shown = door(Persistence=0.5)
                    shown(0)
                    shown(1)
                    if change == "gain":
                        bmode.SetGainDb(4)
                        _, _, _, fresh = door(GainDb=4)
                    else:
                        probe = filter.GetProbe() if door == self.one else filter
                        if door != self.one:
                            continue
                        probe.SetPositionMm(19.0, 20.0, 0.0)
                        _, _, _, fresh = door(PositionMm=(19.0, 20.0, 0.0))
                    np.testing.assert_array_equal(shown(1), fresh(1))

    def test_off_remembers_nothing(self):
        _, _, _, shown = self.one()
        first = shown(0).copy()
        shown(2)
        np.testing.assert_array_equal(shown(0), first)

    def test_out_of_range(self):
        filter, _, _, shown = self.one(Persistence=1.0)
        said = listen(filter)
        filter.UpdateInformation()
        filter.UpdateTimeStep(0)
        self.assertEqual(len(said), 1, said)
        self.assertIn("persistence", said[0])


class TestSpeckleReduction(Phases):
    def test_speckle_is_evened_out_and_an_edge_stays(self):
        flat, edge = {}, {}
        for iterations in (0, 8):
            _, _, _, shown = self.one(SpeckleReduction=iterations, SpeckleThreshold=25.0)
            picture = shown(1).reshape(101, -1)
            # Muscle down to 20 mm, fat below; 0.4 mm a pixel.
            inside = picture[15:45, 5:-5]
            flat[iterations] = (inside.mean(), inside.std())
            rows = picture[:, 5:-5].mean(axis=1)
            edge[iterations] = np.abs(np.diff(rows))[47:54].max()
        self.assertLess(flat[8][1], 0.6 * flat[0][1])
        self.assertLess(abs(flat[8][0] - flat[0][0]), 0.1 * flat[0][0])
        self.assertGreater(edge[8], 0.5 * edge[0])

    def test_what_was_not_scanned_stays_empty(self):
        chain = Chain()
        chain.converter.Update()
        before = grey(chain.converter.GetOutput())
        chain.converter.SetSpeckleReduction(5)
        chain.converter.Update()
        after = grey(chain.converter.GetOutput())
        np.testing.assert_array_equal(before == 0, after == 0)
        self.assertFalse((before == after).all())
        chain.converter.SetSpeckleReduction(0)
        chain.converter.Update()
        np.testing.assert_array_equal(grey(chain.converter.GetOutput()), before)


class TestCompounding(Phases):
    def test_fans_are_averaged_by_both_doors_alike(self):
        _, _, _, single = self.one()
        _, _, _, one = self.one(CompoundFans=3, CompoundSpanDeg=16.0)
        _, _, _, chain = self.chain(CompoundFans=3, CompoundSpanDeg=16.0)
        picture = one(0)
        np.testing.assert_array_equal(picture, chain(0))
        plain = single(0)
        inside = (plain > 0).reshape(101, -1)
        np.testing.assert_array_equal(plain > 0, picture > 0)
        part = inside & (np.arange(101)[:, None] > 40)
        self.assertLess(picture.reshape(101, -1)[part].std(), plain.reshape(101, -1)[part].std())


if __name__ == "__main__":
    unittest.main()
