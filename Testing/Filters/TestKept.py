"""What is kept from one run of the program to the next: the same picture to the bit, never another one's."""
import os
import pathlib
import shutil
import tempfile
import unittest

import numpy as np
from chain import Chain, listen, make
from sonovdb.vtkSonoFilters import (vtkSonoAcousticWindow, vtkSonoLabelMapReader, vtkSonoScanDetail, vtkSonoScanReader,
                                    vtkSonoUltrasound)
from TestScan import labels_of, names_of, thorax_ct
from vtkmodules.util.numpy_support import vtk_to_numpy


def meta_image(image, voxels, kind):
    """A MetaImage of voxels at an image's place."""
    direction = [image.GetDirectionMatrix().GetElement(r, c) for c in range(3) for r in range(3)]
    words = {"NDims": 3, "BinaryData": True, "BinaryDataByteOrderMSB": False, "TransformMatrix": direction,
             "Offset": image.GetOrigin(), "ElementSpacing": image.GetSpacing(), "DimSize": image.GetDimensions(),
             "ElementType": kind, "ElementDataFile": "LOCAL"}
    lines = (f"{name} = {' '.join(map(str, value)) if isinstance(value, (list, tuple)) else value}\n"
             for name, value in words.items())
    return ("ObjectType = Image\n" + "".join(lines)).encode() + voxels.tobytes()


class Run:
    """What a run of the program does: filters of its own from files to a picture."""

    def __init__(self, folder, pose, cache, **settings):
        self.labels = make(vtkSonoLabelMapReader, FileName=str(folder / "labels.mha"))
        self.scan = make(vtkSonoScanReader, FileName=str(folder / "ct.mha"))
        self.added = vtkSonoScanDetail()
        self.added.SetInputConnection(0, self.labels.GetOutputPort())
        self.added.SetInputConnection(1, self.scan.GetOutputPort())
        self.ultrasound = make(vtkSonoUltrasound, MaxCollisions=2, PathsPerLine=16, LineCount=24, DepthMm=90.0,
                               BuildSurfaces=False, CacheFolder=cache)
        self.ultrasound.SetInputConnection(0, self.added.GetOutputPort())
        for name, value in zip(("PositionMm", "Axial", "Lateral"), pose):
            getattr(self.ultrasound.GetProbe(), "Set" + name)(value)
        for name, value in settings.items():
            owner = self.added if hasattr(self.added, "Set" + name) and name != "LabelTissueFile" else None
            make_in = owner or next(part for part in self.parts() if hasattr(part, "Set" + name))
            getattr(make_in, "Set" + name)(value)
        self.errors = listen(self.ultrasound)
        self.warnings = listen(self.ultrasound, "WarningEvent")

    def parts(self):
        u = self.ultrasound
        return (u.GetSceneBuilder(), u.GetProbe(), u.GetRayTracer(), u.GetImageFormation(), u.GetBMode(),
                u.GetScanConverter())

    def picture(self):
        """Arrays by name, of points and fields; the flat image's place."""
        self.ultrasound.Update()
        image = self.ultrasound.GetOutput()
        flat = self.ultrasound.GetOutputDataObject(7)
        arrays = {name: image.GetPointData().GetArray(name) for name in ("BMode", "Mask", "Labels")}
        fields = image.GetFieldData()
        texts = {fields.GetArrayName(i): fields.GetAbstractArray(i) for i in range(fields.GetNumberOfArrays())}
        found = {name: vtk_to_numpy(array).tolist() for name, array in arrays.items()}
        for name, array in texts.items():
            found[name] = [str(array.GetVariantValue(n)) for n in range(array.GetNumberOfValues())]
        found["place"] = [image.GetOrigin(), image.GetSpacing(), image.GetDimensions(), flat.GetOrigin(), flat.GetDimensions(),
                          image.GetPointData().GetScalars().GetName(), flat.GetPointData().GetScalars().GetName()]
        return found

    def was_read(self):
        return self.labels.GetOutput().GetNumberOfPoints() > 0


class Kept(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.image = Chain().thorax.GetOutput()
        field = cls.image.GetFieldData()
        cls.pose = [field.GetArray("A4C" + part).GetTuple3(0) for part in ("PositionMm", "Axial", "Lateral")]
        cls.voxels = labels_of(cls.image).astype(np.uint8)
        cls.names = names_of(cls.image)
        random = np.random.default_rng(1)
        ct = thorax_ct(cls.voxels, cls.names) + random.integers(-15, 16, cls.voxels.shape)
        cls.ct = ct.astype(np.int16)

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.cache = self.folder / "cache"
        self.write("labels.mha", self.voxels, "MET_UCHAR")
        self.write("ct.mha", self.ct, "MET_SHORT")
        self.write_names(self.names)

    def write(self, name, voxels, kind):
        (self.folder / name).write_bytes(meta_image(self.image, voxels, kind))

    def write_names(self, names):
        (self.folder / "labels.csv").write_text("id,name\n" + "".join(f"{n},{name}\n" for n, name in names.items()))

    def run_of(self, cache=None, **settings):
        return Run(self.folder, self.pose, str(self.cache) if cache is None else cache, **settings)

    def kept(self, kind="picture"):
        return sorted(self.cache.glob(kind + "_*.kept"))

    def test_second_run_has_the_same_picture_and_reads_no_file(self):
        first = self.run_of()
        made = first.picture()
        self.assertEqual(first.errors, [])
        self.assertTrue(first.was_read())
        self.assertGreater(len(set(made["BMode"])), 20)
        self.assertEqual(len(self.kept()), 1)
        second = self.run_of()
        found = second.picture()
        self.assertFalse(second.was_read())
        self.assertEqual(found, made)
        self.assertEqual(second.warnings, first.warnings)
        self.assertEqual(self.run_of(cache="").picture(), made)
        # The files count, not where they lie.
        shutil.copytree(self.folder, self.folder / "moved", ignore=shutil.ignore_patterns("cache", "moved"))
        self.folder = self.folder / "moved"
        moved = self.run_of()
        self.assertEqual(moved.picture(), made)
        self.assertFalse(moved.was_read())

    def test_label_map_and_other_outputs_are_there_after_a_kept_picture(self):
        self.write_names({**self.names, max(self.names): "thing"})  # a guess
        made = self.run_of()
        made.picture()
        run = self.run_of()
        run.picture()
        run.ultrasound.Update(1)  # B-mode lines
        self.assertTrue(run.was_read())
        self.assertNotEqual(made.warnings, [])
        self.assertEqual(run.warnings, made.warnings)  # not said again
        self.assertGreater(vtk_to_numpy(run.ultrasound.GetOutputDataObject(1).GetPointData().GetScalars()).max(), 0)
        run = self.run_of()
        run.picture()
        run.labels.Update()
        np.testing.assert_array_equal(labels_of(run.labels.GetOutput()), self.voxels)
        run.scan.Update()
        np.testing.assert_array_equal(vtk_to_numpy(run.scan.GetOutput().GetPointData().GetScalars()), self.ct.ravel())
        run.ultrasound.GetBMode().SetGainDb(3.0)
        made.ultrasound.GetBMode().SetGainDb(3.0)
        self.assertEqual(run.picture(), made.picture())
        self.assertEqual(len(self.kept()), 2)  # of what had to be built, not of each change after it

    def test_whatever_changes_the_picture_is_another(self):
        plain = self.run_of().picture()
        words = (self.folder / "words.csv")
        words.write_text("pattern,tissue\n*,muscle\n")
        settings = [{"DetailDbPer100Hu": 30.0}, {"DetailDirection": 2}, {"FillFromCt": False}, {"FillBody": 1},
                    {"FallbackTissue": "fat"}, {"GainDb": 5.0}, {"PathsPerLine": 20}, {"PathSeed": 3}, {"SectorDeg": 50.0},
                    {"Beam": 1}, {"PositionMm": [p + 0.01 for p in self.pose[0]]}, {"PixelMm": 0.5},
                    {"NoiseSeed": 7, "NoiseDb": -30.0}, {"SpeckleReduction": 5},
                    {"GreyMap": "S-Shaped"}, {"LabelTissueFile": str(words)}]
        for number, changed in enumerate(settings):
            with self.subTest(**changed):
                run = self.run_of(**changed)
                made = run.picture()
                self.assertTrue(run.was_read())
                self.assertEqual(made, self.run_of(cache="", **changed).picture())
        words.write_text("pattern,tissue\n*,fat\n")
        run = self.run_of(LabelTissueFile=str(words))
        run.picture()
        self.assertTrue(run.was_read())
        again = self.run_of()
        self.assertEqual(again.picture(), plain)
        self.assertFalse(again.was_read())

    def test_whatever_changes_in_the_files_is_another(self):
        plain = self.run_of().picture()

        def is_another(difference=True):
            run = self.run_of()
            made = run.picture()
            self.assertTrue(run.was_read())
            self.assertEqual(made, self.run_of(cache="").picture())
            self.assertEqual(made != plain, difference)

        with self.subTest("the scan, as long and as old"):
            times = os.stat(self.folder / "ct.mha")
            ct = self.ct.copy()
            ct[self.voxels == max(self.names)] += 20
            ct[:, :, ::2] += 30
            self.write("ct.mha", ct, "MET_SHORT")
            os.utime(self.folder / "ct.mha", ns=(times.st_atime_ns, times.st_mtime_ns))
            is_another()
            self.write("ct.mha", self.ct, "MET_SHORT")
        with self.subTest("the label map"):
            voxels = self.voxels.copy()
            wall, blood = (next(n for n, name in self.names.items() if name == f"left_ventricle_{part}")
                           for part in ("myocardium", "blood"))
            voxels[:, :, ::2][voxels[:, :, ::2] == wall] = blood
            self.write("labels.mha", voxels, "MET_UCHAR")
            is_another()
            self.write("labels.mha", self.voxels, "MET_UCHAR")
        with self.subTest("the names beside it"):
            self.write_names({n: name.replace("left_ventricle_myocardium", "liver") for n, name in self.names.items()})
            is_another()
            self.write_names(self.names)
        run = self.run_of()
        self.assertEqual(run.picture(), plain)
        self.assertFalse(run.was_read())

    def test_file_that_changes_after_it_was_read_is_not_taken_for_what_was_read(self):
        run = self.run_of()
        run.added.Update()
        ct = self.ct.copy()
        ct[:, :, ::2] += 40
        self.write("ct.mha", ct, "MET_SHORT")
        stale = run.picture()
        self.assertEqual(self.kept(), [])
        self.assertNotEqual(self.run_of().picture(), stale)

    def test_damaged_file_is_made_anew(self):
        made = self.run_of().picture()
        (file,) = self.kept()
        whole = file.read_bytes()
        for content in (b"", whole[:1000], whole[:-1], whole.replace(b"BMode", b"BMoed")):
            file.write_bytes(content)
            run = self.run_of()
            self.assertEqual(run.picture(), made)
            self.assertTrue(run.was_read())
            self.assertEqual(file.read_bytes(), whole)

    def test_switched_off_and_cleared(self):
        self.run_of(cache="").picture()
        self.assertFalse(self.cache.exists())
        run = self.run_of()
        run.picture()
        (self.cache / "mine.txt").write_text("")
        run.ultrasound.GetSceneBuilder().ClearCache()
        self.assertEqual([path.name for path in self.cache.iterdir()], ["mine.txt"])

    def test_windows_are_kept(self):
        def window(target="heart"):
            run = self.run_of()
            search = make(vtkSonoAcousticWindow, Target=target, CacheFolder=str(self.cache))
            search.SetInputConnection(run.added.GetOutputPort())
            warnings = listen(search, "WarningEvent")
            search.Update()
            fields = search.GetOutput().GetFieldData()
            rows, targets = search.GetRows(), search.GetTargets()
            found = {fields.GetArrayName(i): [str(fields.GetAbstractArray(i).GetVariantValue(n))
                                              for n in range(fields.GetAbstractArray(i).GetNumberOfValues())]
                     for i in range(fields.GetNumberOfArrays())}
            found["rows"] = [rows.GetValue(i) for i in range(rows.GetNumberOfValues())]
            found["targets"] = [targets.GetValue(i) for i in range(targets.GetNumberOfValues())]
            found["line"] = [search.GetOutput().GetPoint(n) for n in (0, 1)] + warnings
            return found, run.was_read()

        made, was_read = window()
        self.assertTrue(was_read)
        self.assertGreater(len(made["rows"]), 0)
        self.assertEqual(window(), (made, False))
        self.assertEqual(window("liver")[1], True)
        self.assertEqual(len(self.kept("window")), 2)


if __name__ == "__main__":
    unittest.main()
