"""With a target error the picture is as exact as it was asked for; whoever looks on sees one of the first paths at once."""
import time
import unittest

import numpy as np
from chain import Chain, count_runs, listen, make
from sonovdb.vtkSonoFilters import vtkSonoErrorMap, vtkSonoThoraxSource
from TestDrag import array, moved, ultrasound_on
from vtkmodules.util.numpy_support import vtk_to_numpy

IMAGE, TRACED_LINES, RAY_PATHS, FLAT_IMAGE, ERROR_MAP = 0, 3, 6, 7, 8


def number(data, name):
    """A number of the field data; None: there is none."""
    values = data.GetFieldData().GetArray(name)
    return values.GetValue(0) if values else None


class TestChain(unittest.TestCase):
    def test_traced_lines_and_error_map_say_what_was_reached(self):
        chain = Chain()
        chain.tracer.SetPathsPerLine(2048)
        chain.tracer.SetTargetErrorDb(2.0)
        error_map = make(vtkSonoErrorMap, PixelMm=0.5)
        error_map.SetInputConnection(chain.tracer.GetOutputPort())
        error_map.Update()
        for data in (chain.tracer.GetOutput(), error_map.GetOutputDataObject(0), error_map.GetOutputDataObject(1)):
            self.assertLessEqual(number(data, "ErrorDb"), 2.0)
            self.assertIn(number(data, "TracedPaths"), [64 * 2**k for k in range(1, 6)])

    def test_a_fixed_number_of_paths_has_no_error_of_the_picture(self):
        chain = Chain()
        chain.tracer.Update()
        self.assertEqual(number(chain.tracer.GetOutput(), "TracedPaths"), chain.tracer.GetPathsPerLine())
        self.assertIsNone(number(chain.tracer.GetOutput(), "ErrorDb"))

    def test_bad_values_are_named(self):
        for setting in ("TargetErrorDb", "TimeBudgetS"):
            chain = Chain()
            heard = listen(chain.tracer)
            getattr(chain.tracer, "Set" + setting)(-1)
            chain.tracer.Update()
            self.assertEqual(len(heard), 1)
            self.assertIn(setting[0].lower() + setting[1:] + " is -1: it must be between 0 and", heard[0])


class TestUltrasound(unittest.TestCase):
    def setUp(self):
        self.thorax = make(vtkSonoThoraxSource, SpacingMm=3.0)
        self.thorax.Update()

    def ultrasound(self, **settings):
        return ultrasound_on(self.thorax, LineCount=32, Device=1, **dict({"PathsPerLine": 1024, "TargetErrorDb": 2.0},
                                                                         **settings))

    def test_all_say_what_was_reached(self):
        ultrasound = self.ultrasound(ErrorMap=True)
        reached = set()
        for port in (IMAGE, TRACED_LINES, FLAT_IMAGE, ERROR_MAP):
            ultrasound.Update(port)
            data = ultrasound.GetOutputDataObject(port)
            reached.add((number(data, "TracedPaths"), number(data, "ErrorDb")))
        self.assertEqual(len(reached), 1)
        paths, error = reached.pop()
        self.assertTrue(0 < error <= 2.0 or paths == 1024, (paths, error))

    def test_the_picture_gets_better_and_ends_as_without(self):
        at_once = self.ultrasound(ErrorMap=True)
        at_once.Update()
        ultrasound = self.ultrasound(ErrorMap=True)
        ultrasound.SetProgressive(True)
        warnings = listen(ultrasound, "WarningEvent")
        runs = count_runs(ultrasound)
        ultrasound.Update()
        self.assertEqual(number(ultrasound.GetOutputDataObject(IMAGE), "TracedPaths"), 64)
        self.assertIsNone(number(ultrasound.GetOutputDataObject(IMAGE), "ErrorDb"))
        said = list(warnings)
        pictures, errors = [64], []
        end = time.time() + 60
        while (ultrasound.IsRefining() or ultrasound.HasBetter()) and time.time() < end:
            before = len(runs)
            better = ultrasound.HasBetter()
            ultrasound.Update()
            if better:
                self.assertGreater(len(runs), before)
                pictures.append(number(ultrasound.GetOutputDataObject(IMAGE), "TracedPaths"))
                ultrasound.Update(ERROR_MAP)
                errors.append(np.mean(array(ultrasound.GetOutputDataObject(ERROR_MAP), "ErrorPercent")))
            time.sleep(0.01)
        self.assertGreater(len(pictures), 1)
        self.assertEqual(pictures, sorted(set(pictures)))
        self.assertEqual(warnings, said)  # nothing is said again of the same lines
        self.assertEqual(errors, sorted(errors, reverse=True))
        runs.clear()
        ultrasound.Update()
        self.assertEqual(len(runs), 0)  # the last one stays
        for name in ("BMode", "ErrorPercent"):
            np.testing.assert_array_equal(array(ultrasound.GetOutputDataObject(FLAT_IMAGE), name),
                                          array(at_once.GetOutputDataObject(FLAT_IMAGE), name))

    def test_outputs_are_of_the_same_paths_until_it_is_asked_again(self):
        """Rounds end whenever they do, between one output and another as well."""
        ultrasound = self.ultrasound(ErrorMap=True, TargetErrorDb=0.0, TimeBudgetS=600.0)
        ultrasound.SetProgressive(True)
        ultrasound.Update()
        while ultrasound.IsRefining():
            time.sleep(0.01)
        paths = lambda port: number(ultrasound.GetOutputDataObject(port), "TracedPaths")
        for asked, expected in ((False, 64), (True, 1024)):
            if asked:
                self.assertTrue(ultrasound.HasBetter())
            for port in (IMAGE, TRACED_LINES, ERROR_MAP, FLAT_IMAGE, IMAGE):
                ultrasound.Update(port)
                self.assertEqual(paths(port), expected)
        self.assertFalse(ultrasound.HasBetter())

    def test_without_who_looks_on_the_last_one_is_waited_for(self):
        ultrasound = self.ultrasound()
        ultrasound.SetProgressive(True)
        ultrasound.Update()
        ultrasound.SetProgressive(False)
        ultrasound.Update()
        self.assertFalse(ultrasound.IsRefining() or ultrasound.HasBetter())
        self.assertLessEqual(number(ultrasound.GetOutputDataObject(IMAGE), "ErrorDb"), 2.0)

    def test_a_moving_probe_ends_it_at_once(self):
        ultrasound = self.ultrasound(TargetErrorDb=0.001, PathsPerLine=10000000)
        ultrasound.SetProgressive(True)
        ultrasound.Update()
        self.assertTrue(ultrasound.IsRefining())
        probe = ultrasound.GetProbe()
        probe.SetPreview(True)
        probe.SetPositionMm(*moved(probe.GetPositionMm(), 2))
        begin = time.time()
        ultrasound.Update()
        self.assertLess(time.time() - begin, 5)
        self.assertFalse(ultrasound.IsRefining())
        self.assertEqual(number(ultrasound.GetOutputDataObject(IMAGE), "TracedPaths"), 40)

    def test_a_filter_that_goes_ends_it(self):
        ultrasound = self.ultrasound(TargetErrorDb=0.001, PathsPerLine=10000000)
        ultrasound.SetProgressive(True)
        ultrasound.Update()
        begin = time.time()
        del ultrasound
        self.assertLess(time.time() - begin, 5)

    def test_abort_stops_it(self):
        ultrasound = self.ultrasound(TargetErrorDb=0.001, PathsPerLine=10000000)
        ultrasound.AddObserver("ProgressEvent", lambda *_: ultrasound.GetProgress() > 0.31
                               and ultrasound.SetAbortExecute(1))
        begin = time.time()
        ultrasound.Update()
        self.assertLess(time.time() - begin, 30)
        self.assertFalse(ultrasound.IsRefining())

    def test_gain_keeps_the_rounds(self):
        """What comes after the paths changes while they are traced."""
        ultrasound = self.ultrasound(TargetErrorDb=0.001, PathsPerLine=10000000)
        ultrasound.SetProgressive(True)
        ultrasound.Update()
        ultrasound.GetBMode().SetGainDb(6.0)
        ultrasound.Update()
        self.assertTrue(ultrasound.IsRefining())

    def test_shown_paths_are_those_that_were_traced(self):
        ultrasound = self.ultrasound(NumberOfShownPaths=32 * 1024)
        ultrasound.Update(RAY_PATHS)
        paths = ultrasound.GetOutputDataObject(RAY_PATHS)
        ultrasound.Update(TRACED_LINES)
        traced = number(ultrasound.GetOutputDataObject(TRACED_LINES), "TracedPaths")
        self.assertEqual(paths.GetNumberOfCells(), 32 * min(traced, 1024))
        self.assertEqual(len(set(vtk_to_numpy(paths.GetCellData().GetArray("Line")))), 32)

    def test_a_time_budget_ends_in_time(self):
        ultrasound = self.ultrasound(TargetErrorDb=0.0, TimeBudgetS=0.5, PathsPerLine=10000000)
        ultrasound.GetProbe().SetPreview(True)
        ultrasound.Update()  # prepares the anatomy
        ultrasound.GetProbe().SetPreview(False)
        ultrasound.Update()
        traced = number(ultrasound.GetOutputDataObject(IMAGE), "TracedPaths")
        self.assertGreaterEqual(traced, 64)
        self.assertLess(traced, 1000000)  # all would take minutes, however quick the machine


if __name__ == "__main__":
    unittest.main()
