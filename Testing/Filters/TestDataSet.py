"""A data set's images as arrays, in a folder and in shards; bad input gets a sentence."""
import json
import os
import pathlib
import tarfile
import tempfile
import unittest

import numpy as np
import sonovdb
from chain import listen
from sonovdb.vtkSonoFilters import vtkSonoDataSet

BUNDLED = pathlib.Path(__file__).resolve().parents[2] / "Data" / "datasets" / "apical.json"


def small(folder, **changes):
    """The bundled set with few and coarse images; its path."""
    declared = json.loads(BUNDLED.read_text(encoding="utf-8"))
    declared["patients"][0].update(spacingMm=4, copies=3)
    declared["probe"].update(lineCount=16, depthMm=140)
    declared["tracing"]["pathsPerLine"] = 10
    declared.update(exams=3, imagesPerExam=2, pixelMm=1, split={"train": 0.4, "validation": 0.3, "test": 0.3})
    declared.update(changes)
    path = pathlib.Path(folder) / "small.json"
    path.write_text(json.dumps(declared), encoding="utf-8")
    return str(path)


class TestDataSet(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = self.scratch.name

    def test_images_are_arrays_with_all_that_made_them(self):
        images = sonovdb.Dataset(small(self.folder))
        self.assertEqual(len(images), 6)
        image, mask, info = images[3]
        self.assertEqual((image.dtype, mask.dtype, image.shape), (np.uint8, np.uint8, mask.shape))
        self.assertEqual(image.shape, (info["image"]["height"], info["image"]["width"]))
        for group in info["masks"].values():
            self.assertEqual(int((mask == group["value"]).sum()), group["pixels"])
        self.assertGreater(info["masks"]["LV cavity"]["pixels"], 500)
        self.assertLess(image[mask == info["masks"]["LV cavity"]["value"]].mean(),
                        image[mask == info["masks"]["LV wall"]["value"]].mean())  # blood is darker than muscle
        self.assertTrue(np.all(mask[image == 0] == 0))
        self.assertTrue(info["flags"]["faceOnSkin"])
        self.assertGreater(info["flags"]["shareInsideVolume"], 0.5)
        self.assertTrue(0.0 < info["flags"]["shareShadowed"] < 1.0)
        for key in ("gainDb", "tgcDbPerCm", "dynamicRangeDb", "noiseSeed"):
            self.assertIn(key, info["display"])
        self.assertIn("pathSeed", info["tracing"])
        self.assertIn("scattererSeed", info["echo"])
        self.assertIn("blood", info["tissues"])
        self.assertEqual(info["patient"]["licence"], "BSD-3-Clause")
        again = sonovdb.Dataset(small(self.folder))[3]  # without the three before it
        np.testing.assert_array_equal(again[0], image)
        self.assertEqual(again[2], info)

    def test_splits_and_parts_share_the_images(self):
        path = small(self.folder, exams=30)
        names = {split: sonovdb.Dataset(path, split)._numbers for split in ("train", "validation", "test")}
        self.assertEqual(sorted(sum(names.values(), [])), list(range(60)))
        parts = [sonovdb.Dataset(path, part=part, parts=4) for part in range(4)]
        self.assertEqual([n for part in parts for n in part._numbers], list(range(60)))
        validation = sonovdb.Dataset(path, "validation")
        self.assertEqual(validation[0][2]["split"], "validation")
        self.assertEqual(len(list(zip(range(2), validation))), 2)

    def test_shards_hold_the_folder(self):
        for form in ("nnU-Net", "MONAI"):
            with self.subTest(format=form):
                target = os.path.join(self.folder, form)
                writer = vtkSonoDataSet()
                writer.SetFileName(small(self.folder, format=form))
                writer.SetFolder(target)
                texts = []
                writer.AddObserver("ProgressEvent", lambda *_: texts.append(writer.GetProgressText()))
                writer.Update()
                self.assertEqual(writer.GetWrittenImages(), 6)
                self.assertTrue(any("image 6 of 6" in text for text in texts))
                shards = sonovdb.write_shards(target, os.path.join(self.folder, form + "-shards"), per_shard=2)
                found = {}
                for path in shards:
                    with tarfile.open(path) as shard:
                        for entry in shard:
                            found[entry.name] = shard.extractfile(entry).read()
                self.assertEqual(len(found), 18)
                info = json.loads(found["apical_0000005.json"])
                image = [p for p in pathlib.Path(target).rglob("apical_0000005*.png") if "images" in p.parent.name]
                self.assertEqual(found["apical_0000005.image.png"], image[0].read_bytes())
                self.assertTrue(any(os.path.basename(path).startswith(info["split"]) for path in shards))

    def test_an_abort_keeps_what_is_there(self):
        writer = vtkSonoDataSet()
        writer.SetFileName(small(self.folder))
        writer.SetFolder(os.path.join(self.folder, "stopped"))

        def stop(*_):
            if "image 2 of 6" in writer.GetProgressText():
                writer.AbortExecuteOn()

        observer = writer.AddObserver("ProgressEvent", stop)
        heard = listen(writer)
        writer.Update()
        self.assertEqual(heard, [])
        self.assertEqual(writer.GetWrittenImages(), 2)
        writer.RemoveObserver(observer)
        writer.AbortExecuteOff()
        writer.Modified()
        writer.Update()
        self.assertEqual(writer.GetWrittenImages(), 4)
        self.assertEqual(len(os.listdir(os.path.join(self.folder, "stopped", "info"))), 6)

    def test_what_is_wrong_is_said_in_a_sentence(self):
        with self.assertRaisesRegex(ValueError, "'seed' is not a number"):
            sonovdb.Dataset(small(self.folder, seed="one"))
        with self.assertRaisesRegex(ValueError, "no such file"):
            sonovdb.Dataset(os.path.join(self.folder, "nowhere.json"))
        with self.assertRaisesRegex(ValueError, "split is 'dev'"):
            sonovdb.Dataset(small(self.folder), "dev")
        with self.assertRaisesRegex(ValueError, "process 3 of 2"):
            sonovdb.Dataset(small(self.folder), part=3, parts=2)
        with self.assertRaisesRegex(ValueError, "none of 32 poses drawn for view 'A4C' stands on the skin"):
            sonovdb.Dataset(small(self.folder, jitter={"slideElevationMm": 90, "slideLateralMm": 90, "tiltDeg": 80}))[0]
        writer = vtkSonoDataSet()
        heard = listen(writer)
        writer.SetFileName(small(self.folder))
        writer.SetImageNumber(6)
        writer.Update()
        self.assertRegex(heard[-1], "there is no image 6; choose 0 to 5")
        writer.SetImageNumber(0)
        writer.SetFolder(os.path.join(self.folder, "taken"))
        writer.Update()
        other = os.path.join(self.folder, "other")
        os.mkdir(other)
        writer.SetFileName(small(other, seed=2))
        writer.Update()
        self.assertRegex(heard[-1], "holds images of another data set")
        writer.SetFolder(writer.GetFileName())  # a file
        writer.Update()
        self.assertRegex(heard[-1], "cannot make the folder")


if __name__ == "__main__":
    unittest.main()
