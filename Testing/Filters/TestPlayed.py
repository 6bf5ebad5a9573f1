"""Phases that were played are kept for the next play, within a bound, and go when they are dropped."""
import pathlib
import tempfile
import time
import unittest

import numpy as np
from chain import listen, make, write_labels
from sonovdb.vtkSonoFilters import (vtkSonoLabelMapReader, vtkSonoPhasesAhead, vtkSonoSceneBuilder, vtkSonoThoraxSource,
                                    vtkSonoUltrasound)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIntArray, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

TIMES = (0.0, 1.0, 2.0, 3.0)


def resident_mb():
    """What this process has in memory."""
    pages = int(pathlib.Path("/proc/self/statm").read_text().split()[1])
    return pages * 4096 / 1e6


def phases(folder, edge, share=0.2):
    """A ball of blood in muscle, of another size in each phase, from a share of the edge on: a reader of a file a phase."""
    grid = np.indices((edge, edge, edge)) - (edge - 1) / 2
    radius = np.sqrt((grid ** 2).sum(axis=0))
    names = vtkStringArray()
    names.SetName("LabelNames")
    ids = vtkIntArray()
    ids.SetName("LabelIds")
    for number, name in enumerate(("background", "muscle", "blood", "skin")):
        ids.InsertNextValue(number)
        names.InsertNextValue(name)
    reader = vtkSonoLabelMapReader()
    for phase in range(len(TIMES)):
        labels = np.where(radius < 0.45 * edge, 1, 0)
        labels[(radius >= 0.43 * edge) & (labels == 1)] = 3
        labels[radius < (share + 0.04 * phase) * edge] = 2
        image = vtkImageData()
        image.SetDimensions(edge, edge, edge)
        image.SetSpacing(*(3 * [80.0 / edge]))
        array = numpy_to_vtk(labels.astype(np.uint16).ravel(), deep=True)
        array.SetName("Labels")
        image.GetPointData().SetScalars(array)
        image.GetFieldData().AddArray(ids)
        image.GetFieldData().AddArray(names)
        path = str(pathlib.Path(folder, f"phase{phase}.vti"))
        writer = vtkXMLImageDataWriter()
        writer.SetInputData(image)
        writer.SetFileName(path)
        writer.Write()
        reader.AddFileName(path)
    return reader


class Heart:
    def __init__(self, source, **settings):
        self.source = source
        self.ultrasound = vtkSonoUltrasound()
        self.ultrasound.SetInputConnection(0, self.source.GetOutputPort())
        for name, value in dict({"BuildSurfaces": False, "PathsPerLine": 8, "LineCount": 16, "DepthMm": 60.0}, **settings).items():
            part = next(part for part in self.parts() if hasattr(part, "Set" + name))
            getattr(part, "Set" + name)(value)
        self.ultrasound.GetProbe().SetPositionMm(40.0, 40.0, 4.0)
        self.ultrasound.GetProbe().SetAxial(0.0, 0.0, 1.0)
        self.ultrasound.GetProbe().SetLateral(1.0, 0.0, 0.0)
        self.errors = listen(self.ultrasound)
        self.warnings = listen(self.ultrasound, "WarningEvent")

    def parts(self):
        u = self.ultrasound
        return u, u.GetSceneBuilder(), u.GetProbe(), u.GetRayTracer(), u.GetBMode()

    def play(self, times=TIMES):
        """The pictures of the phases, with their fields' names and their labels."""
        return [self.at(time) for time in times]

    def at(self, time):
        self.ultrasound.UpdateTimeStep(time)
        image = self.ultrasound.GetOutput()
        arrays = [vtk_to_numpy(image.GetPointData().GetArray(name)).copy() for name in ("BMode", "Labels", "Mask")]
        fields = image.GetFieldData()
        names = sorted(fields.GetArrayName(i) for i in range(fields.GetNumberOfArrays()))
        return arrays, names, image.GetOrigin()

    def built(self):
        return self.ultrasound.GetSceneBuilder().GetBuiltAnatomies()


class TestPlayed(unittest.TestCase):
    def setUp(self):
        self.limit = vtkSonoSceneBuilder.GetKeptPhasesMegabytes()
        self.addCleanup(vtkSonoSceneBuilder.LimitKeptPhasesMegabytes, self.limit)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def heart(self, edge=40, **settings):
        return Heart(phases(self.folder, edge), **settings)

    def assert_same(self, some, others):
        self.assertEqual(len(some), len(others))
        for (arrays, names, place), (expected, its_names, its_place) in zip(some, others):
            self.assertEqual((names, place), (its_names, its_place))
            for one, other in zip(arrays, expected):
                np.testing.assert_array_equal(one, other)

    def test_the_second_play_builds_nothing(self):
        heart = self.heart()
        first = heart.play()
        self.assertEqual(heart.built(), len(TIMES))
        self.assertGreater(np.abs(first[0][0][0].astype(float) - first[1][0][0]).max(), 10)  # it beats
        self.assert_same(heart.play(), first)
        self.assertEqual(heart.built(), len(TIMES))
        self.assertEqual(heart.errors, [])

    def test_it_is_the_picture_that_would_be_made(self):
        """Against one that keeps nothing, with another gain than that of the first play as well."""
        kept = self.heart()
        for gain in (0.0, 12.0):
            kept.ultrasound.GetBMode().SetGainDb(gain)
            kept.play(TIMES[:2])
            seen = kept.play(TIMES[:2])
            self.assertEqual(kept.built(), 2)
            fresh = [self.heart(GainDb=gain).at(time) for time in TIMES[:2]]
            self.assert_same(seen, fresh)

    def test_a_probe_that_moved_meets_a_phase_that_is_kept(self):
        heart = self.heart()
        first = heart.play()
        x, y, z = heart.ultrasound.GetProbe().GetPositionMm()
        heart.ultrasound.GetProbe().SetPositionMm(x, y, z + 4.0)
        moved = heart.play()
        self.assertEqual(heart.built(), len(TIMES))
        self.assertFalse(np.array_equal(moved[1][0][0], first[1][0][0]))

    def test_nothing_is_kept_where_nothing_may_be(self):
        vtkSonoSceneBuilder.LimitKeptPhasesMegabytes(0.0)
        heart = self.heart()
        first = heart.play()
        self.assert_same(heart.play(), first)
        self.assertEqual(heart.built(), 2 * len(TIMES))
        self.assertEqual(vtkSonoSceneBuilder.GetPhasesMegabytesNow(), 0.0)

    def test_the_bound_holds_and_the_last_used_stays(self):
        heart = self.heart()
        heart.at(TIMES[0])
        one = vtkSonoSceneBuilder.GetPhasesMegabytesNow()
        self.assertGreater(one, 0.0)
        bound = 2.6 * one
        vtkSonoSceneBuilder.LimitKeptPhasesMegabytes(bound)
        for time in TIMES:
            heart.at(time)
            self.assertLessEqual(vtkSonoSceneBuilder.GetPhasesMegabytesNow(), bound)
        built = heart.built()
        heart.at(TIMES[2])
        heart.at(TIMES[3])
        self.assertEqual(heart.built(), built)
        heart.at(TIMES[0])
        self.assertEqual(heart.built(), built + 1)

    def test_what_is_kept_costs_what_is_said_and_is_given_back(self):
        heart = self.heart(160, BuildSurfaces=True)
        heart.at(TIMES[0])
        before, said_before = resident_mb(), vtkSonoSceneBuilder.GetPhasesMegabytesNow()
        heart.play()
        full, said = resident_mb(), vtkSonoSceneBuilder.GetPhasesMegabytesNow() - said_before
        self.assertGreater(said, 50.0)
        self.assertLess(full - before, 1.15 * said)  # what is said is no less than what is taken
        vtkSonoSceneBuilder.LimitKeptPhasesMegabytes(0.0)
        self.assertEqual(vtkSonoSceneBuilder.GetPhasesMegabytesNow(), 0.0)
        self.assertLess(resident_mb(), full - 0.5 * (full - before))

    def test_filters_that_go_take_what_they_kept_along(self):
        heart = self.heart()
        heart.play()
        self.assertGreater(vtkSonoSceneBuilder.GetPhasesMegabytesNow(), 0.0)
        del heart
        self.assertEqual(vtkSonoSceneBuilder.GetPhasesMegabytesNow(), 0.0)

    def test_one_that_stands_still_is_not_kept(self):
        source = make(vtkSonoThoraxSource, SpacingMm=5.0)
        heart = Heart(source)
        heart.ultrasound.Update()
        self.assertEqual(vtkSonoSceneBuilder.GetPhasesMegabytesNow(), 0.0)

    def test_the_bundled_heart(self):
        """Its walls' speckle rides on a displacement, which is part of what is kept."""
        heart = Heart(make(vtkSonoThoraxSource, SpacingMm=5.0, Phases=2))
        first = heart.play((0.0, 0.5))
        self.assert_same(heart.play((0.0, 0.5)), first)
        self.assertEqual(heart.built(), 2)

    def ahead(self, shown):
        """Has its phases made by another one like it."""
        second = self.heart()
        made = vtkSonoPhasesAhead()
        made.Begin(shown.source, shown.ultrasound, second.source, second.ultrasound)
        self.assertEqual(made.GetNumberOfPhases(), len(TIMES))
        return made

    def wait(self, is_there):
        end = time.monotonic() + 60
        while not is_there():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)

    def test_what_was_made_ahead_is_what_would_be_made(self):
        shown = self.heart()
        shown.at(TIMES[0])
        made = self.ahead(shown)
        self.wait(lambda: made.TakeReady() == len(TIMES))
        self.assertTrue(all(made.IsReady(time) for time in TIMES))
        del made  # the second filters go, and what they made stays
        seen = shown.play()
        self.assertEqual(shown.built(), 1)
        self.assertEqual(shown.errors, [])
        self.assert_same(seen, self.heart().play())

    def test_a_source_that_was_changed_is_not_given_what_another_made(self):
        shown = self.heart()
        made = self.ahead(shown)
        self.wait(made.HasEnded)
        phases(self.folder, 40, share=0.18)
        shown.source.Modified()
        self.assertEqual(made.TakeReady(), len(TIMES))  # nobody waits any more
        seen = shown.play()
        self.assertEqual(shown.built(), len(TIMES))
        self.assert_same(seen, Heart(phases(self.folder, 40, share=0.18)).play())

    def test_phases_that_cannot_be_made_ahead_are_waited_for_by_nobody(self):
        shown = self.heart()
        shown.at(TIMES[0])
        pathlib.Path(self.folder, "phase1.vti").unlink()
        made = self.ahead(shown)
        self.wait(lambda: made.TakeReady() == len(TIMES))
        self.assertEqual(shown.errors, [])  # those that see it say so

    def test_files_that_changed_are_read_again(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            voxels = [np.full((4, 5, 6), label, np.uint16) for label in (1, 2, 3)]
            reader = vtkSonoLabelMapReader()
            for i in range(2):
                reader.AddFileName(write_labels(folder / f"phase{i}.vti", voxels[i]))

            def label_at(time):
                reader.UpdateTimeStep(time)
                return set(vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()))

            self.assertEqual([label_at(0), label_at(1), label_at(0)], [{1}, {2}, {1}])
            write_labels(folder / "phase0.vti", voxels[2])
            reader.Modified()
            self.assertEqual([label_at(0), label_at(1)], [{3}, {2}])


if __name__ == "__main__":
    unittest.main()
