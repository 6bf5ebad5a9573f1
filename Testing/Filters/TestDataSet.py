"""A data set's images as arrays, in a folder and in shards; bad input gets a sentence."""
import ctypes
import json
import os
import pathlib
import re
import struct
import subprocess
import tarfile
import tempfile
import unittest

import numpy as np
import sonovdb
from chain import listen
from sonovdb import dlpack
from sonovdb.vtkSonoFilters import vtkSonoDataSet
from TestPicture import converted, read_png, read_tif
from vtkmodules.util.numpy_support import vtk_to_numpy

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


def read_channel(exr, name):
    """As floats, rows from the top."""
    to = exr.with_suffix(f".{name}.tif")
    subprocess.run(["oiiotool", str(exr), "--ch", name, "-d", "float", "-o", str(to)], check=True)
    return read_tif(to)


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
        apex = info["landmarks"]["apex"]
        self.assertTrue(apex["inSector"])
        self.assertTrue(0 < apex["column"] < image.shape[1] and 0 < apex["row"] < image.shape[0])
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

    def test_a_loop_gives_what_indices_give(self):
        images = sonovdb.Dataset(small(self.folder))
        alone = sonovdb.Dataset(small(self.folder))
        count = 0
        for index, (image, mask, info) in enumerate(images):  # on a CPU in order
            expected = alone[index]
            np.testing.assert_array_equal(np.from_dlpack(image), expected[0])
            np.testing.assert_array_equal(mask, expected[1])
            self.assertEqual(info, expected[2])
            count += 1
        self.assertEqual(count, 6)
        self.assertEqual([info["index"] for *_, info in images], list(range(6)))  # an epoch later
        test = sonovdb.Dataset(small(self.folder), "test")
        self.assertEqual([info["split"] for *_, info in test], ["test"] * len(test))

    def test_a_loop_may_be_left(self):
        images = sonovdb.Dataset(small(self.folder, exams=1000))
        first = next(iter(images))
        np.testing.assert_array_equal(images[0][0], first[0])
        loop = iter(images)
        next(loop)
        np.testing.assert_array_equal(images[1][0], next(loop)[0])  # asked for in between
        again = iter(images)
        next(again)
        with self.assertRaisesRegex(ValueError, "another loop"):
            next(loop)
        self.assertEqual(next(again)[2]["index"], 1)
        images._filter.EndStream()
        self.assertEqual(list(again), [])

    def test_images_stay_on_the_gpu_where_there_is_one(self):
        try:
            image, mask, _ = sonovdb.Dataset(small(self.folder), on_gpu=True)[0]
        except ValueError as error:
            self.assertRegex(str(error), "cannot stay on a GPU, since none makes them: .*; take them from the host")
        else:
            self.assertEqual(image.__dlpack_device__()[0], 2)
            self.assertEqual(image.shape, mask.shape)

    def test_a_tensor_goes_by_whoever_has_it(self):
        bytes_ = (ctypes.c_uint8 * 6)(*range(6))
        shape = (ctypes.c_int64 * 2)(2, 3)
        gone = []
        delete = ctypes.CFUNCTYPE(None, ctypes.c_void_p)(gone.append)
        # DLManagedTensor: data, device, dimensions and type, shape, strides, offset, context, deleter; on the host
        tensor = struct.pack("@PiiiBBHPPQPP", ctypes.addressof(bytes_), 1, 0, 2, 1, 8, 1, ctypes.addressof(shape), 0, 0,
                             0, ctypes.cast(delete, ctypes.c_void_p).value)
        memory = ctypes.create_string_buffer(tensor)
        destroy = dlpack.destructor(gone.append)

        class Array:
            def __dlpack__(self, **_):
                return dlpack.capsule(ctypes.addressof(memory), destroy)

            def __dlpack_device__(self):
                return 1, 0

        taken = np.from_dlpack(Array())
        np.testing.assert_array_equal(taken, [[0, 1, 2], [3, 4, 5]])
        self.assertEqual(gone, [])
        del taken
        self.assertEqual(gone, [ctypes.addressof(memory)])  # by its own deleter
        Array().__dlpack__()
        self.assertEqual(gone, 2 * [ctypes.addressof(memory)])  # by the capsule, since nobody took it

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

    def test_channels_say_what_the_pictures_say(self):
        target = pathlib.Path(self.folder, "channels")
        writer = vtkSonoDataSet()
        heard = listen(writer)
        writer.SetFileName(small(self.folder, format="MONAI",
                                 channels=["grey", "mask", "label", "tissue", "error", "beam"]))
        writer.SetFolder(str(target))
        writer.Update()
        self.assertEqual(heard, [])
        info = json.loads((target / "info" / "apical_0000002.json").read_text(encoding="utf-8"))
        exr = target / "channels" / "apical_0000002.exr"
        # Read by OpenImageIO: each channel as the floats of a TIFF.
        pixels = {name: read_channel(exr, name) for name in ("grey", "mask", "label", "tissue", "error")}
        image = read_png(target / "images" / "apical_0000002.png").astype(int)
        mask = read_png(target / "labels" / "apical_0000002.png")
        for folder, values in (("images", image), ("labels", mask)):
            as_tif = converted(target / folder / "apical_0000002.png", "uint8", "tif")
            np.testing.assert_array_equal(read_tif(as_tif), values)
        inside = image > 0
        np.testing.assert_array_equal(np.maximum(1, np.floor(255 * pixels["grey"][inside] + 0.5)), image[inside])
        np.testing.assert_array_equal(pixels["mask"], mask)
        np.testing.assert_array_equal(pixels["tissue"] > 0, inside)
        writer.SetImageNumber(2)
        writer.Update()
        shown = vtk_to_numpy(writer.GetOutput().GetPointData().GetArray("label"))
        np.testing.assert_array_equal(shown.reshape(image.shape), pixels["label"])
        cavity = {int(number) for number, name in info["labels"].items()
                  if "left" in name.lower() and "ventricle_blood" in name.lower()}
        self.assertEqual(len(cavity), 1)
        shown = np.isin(pixels["label"].astype(int), list(cavity))
        self.assertGreater(shown.sum(), 200)
        self.assertTrue(np.all(mask[shown] == info["masks"]["LV cavity"]["value"]))
        names = list(info["tissues"])
        self.assertEqual({names[int(n) - 1] for n in np.unique(pixels["tissue"][shown])}, {"blood"})
        self.assertTrue(0 < pixels["error"].max() <= 100)
        said = subprocess.run(["oiiotool", "--info", "-v", str(exr)], capture_output=True, text=True, check=True).stdout
        self.assertRegex(said, rf"{image.shape[1]} x +{image.shape[0]}, 5 channel, float openexr")
        self.assertRegex(said, r"pixelMm: 1\b")
        self.assertIn("error: percent of the intensity", said)

        beam = target / "beam" / "apical_0000002.exr"
        lines = {name: read_channel(beam, name) for name in ("grey", "envelope", "iq.re", "iq.im", "intensity")}
        self.assertEqual(lines["grey"].shape[0], info["probe"]["lineCount"])
        np.testing.assert_allclose(np.hypot(lines["iq.re"], lines["iq.im"]), lines["envelope"], rtol=1e-5)
        self.assertTrue(0 <= lines["grey"].min() and lines["grey"].max() <= 1)
        self.assertTrue(np.all(lines["intensity"] <= 1) and lines["intensity"].max() > 0)
        # A pixel lies between two lines and two samples: where those are as bright, so is it.
        middle = info["probe"]["lineCount"] // 2
        column = int(round(-info["image"]["lateralMinMm"]))
        said = subprocess.run(["oiiotool", "--info", "-v", str(beam)], capture_output=True, text=True, check=True).stdout
        sample_mm = float(re.search(r"sampleMm: ([0-9.e-]+)", said).group(1))
        for row in range(10, image.shape[0] - 5):
            at = row / sample_mm
            near = lines["grey"][middle - 1:middle + 1, int(at):int(at) + 2]
            self.assertTrue(near.min() - 1e-3 <= pixels["grey"][row, column] <= near.max() + 1e-3, row)

        shards = sonovdb.write_shards(str(target), os.path.join(self.folder, "exr-shards"), per_shard=2)
        found = []
        for path in shards:
            with tarfile.open(path) as shard:
                found += shard.getnames()
        self.assertEqual(sum(name.endswith(".channels.exr") for name in found), 6)
        self.assertEqual(len(found), 30)

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
        with self.assertRaisesRegex(ValueError, "none of 32 poses drawn"):
            list(sonovdb.Dataset(small(self.folder, jitter={"slideElevationMm": 90, "slideLateralMm": 90, "tiltDeg": 80})))
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
