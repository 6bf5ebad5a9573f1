#!/usr/bin/env python3
"""Readers and scores of learn.py, on folders made here."""

import json
import math
import tempfile
import unittest
from pathlib import Path

import nibabel
import numpy
from PIL import Image

import examples
import scores


class Folders(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = Path(self.temporary.name)

    def save(self, path, array):
        target = self.folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        Image.fromarray(array).save(target)

    def write(self, path, text):
        target = self.folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text)

    def info(self, case, split, groups):
        masks = {name: {"value": value, "inPatient": there} for name, value, there in groups}
        patient = {"id": "p", "copy": 2}
        info = {"case": case, "split": split, "patient": patient, "view": "A4C", "masks": masks}
        self.write(f"info/{case}.json", json.dumps(info))

    def test_masks_of_a_data_set_are_found_by_name_whatever_their_values(self):
        mask = numpy.zeros((112, 56), dtype=numpy.uint8)
        mask[:56] = 7
        mask[56:] = 9
        self.save("imagesTs/c_0000.png", numpy.full((112, 56), 200, dtype=numpy.uint8))
        self.save("labelsTs/c.png", mask)
        self.info("c", "test", [("left atrium", 7, True), ("RV cavity", 9, True), ("LV wall", 3, False)])
        (example,) = examples.read(self.folder)
        self.assertEqual((example.split, example.view, example.patient), ("test", "A4C", "p 2"))
        self.assertEqual(example.marked, {3})
        picture, found = example.picture(), example.mask()
        self.assertEqual(picture.shape, (224, 224))
        # Twice as large, in the middle: a quarter is empty on either side.
        self.assertTrue((picture[:, 60:164] == 200).all() and (picture[:, :55] == 0).all())
        self.assertTrue((found[:110, 60:164] == 3).all())
        self.assertEqual(int((found != 0).sum()), 112 * 112)

    def test_monai_folders_are_read_the_same(self):
        self.save("images/c.png", numpy.full((8, 8), 5, dtype=numpy.uint8))
        self.save("labels/c.png", numpy.full((8, 8), 1, dtype=numpy.uint8))
        self.info("c", "train", [("LV cavity", 1, True)])
        (example,) = examples.read(f"sonovdb:{self.folder}")
        self.assertTrue((example.mask() == 1).all())
        self.assertEqual(example.split, "train")

    def test_camus_lies_with_the_probe_on_top(self):
        def nifti(name, array):
            path = self.folder / "database_nifti" / "patient0007" / name
            path.parent.mkdir(parents=True, exist_ok=True)
            nibabel.save(nibabel.Nifti1Image(array, numpy.eye(4)), path)

        array = numpy.zeros((40, 40), dtype=numpy.uint8)  # lateral, axial
        array[:20, :10] = 1  # left, near the probe
        nifti("patient0007_4CH_ED.nii.gz", array * 100)
        nifti("patient0007_4CH_ED_gt.nii.gz", array)
        nifti("patient0007_4CH_half_sequence.nii.gz", array)
        self.write("database_split/subgroup_training.txt", "patient0007\n")
        (example,) = examples.read(f"camus:{self.folder}")
        self.assertEqual((example.view, example.split, example.patient), ("A4C", "train", "patient0007"))
        mask = example.mask()
        self.assertTrue((mask[:55, :111] == 1).all())
        self.assertEqual(int(mask.sum()), 56 * 112)

    def test_a_traced_ventricle_is_as_large_as_its_chords(self):
        # An ellipse of half axes 30 and 20 pixels, cut by 40 chords.
        chords = [[50, 20, 50, 80]]
        for n in range(41):
            y = 20 + 60 * n / 40
            half = 20 * math.sqrt(max(0.0, 1 - ((y - 50) / 30) ** 2))
            chords.append([50 - half, y, 50 + half, y])
        area = int(examples.traced_area(chords, (100, 100)).sum())
        self.assertAlmostEqual(area / (math.pi * 600), 1, delta=0.04)

    def test_views_come_from_folders(self):
        for path in ("train/A2C/p1_1.png", "test/A5C/p2_1.png", "test/PLAX/p2_2.png"):
            self.save(path, numpy.full((4, 4), 9, dtype=numpy.uint8))
        found = examples.read(f"views:{self.folder}")
        self.assertEqual([(e.view, e.split, e.patient) for e in found], [("A5C", "test", "p2"), ("A2C", "train", "p1")])

    def test_folders_that_are_none_say_what_to_give(self):
        for source in (str(self.folder), f"camus:{self.folder}", f"echonet:{self.folder}", f"views:{self.folder}"):
            with self.assertRaisesRegex(examples.Unreadable, "give|sort"):
                examples.read(source)
        with self.assertRaisesRegex(examples.Unreadable, "no kind"):
            examples.read("other:folder")


class Scores(unittest.TestCase):
    def test_dice_of_overlapping_squares(self):
        a = numpy.zeros((2, 10, 10), dtype=int)
        b = a.copy()
        a[0, :, :4] = 2  # 40 pixels, of which 20 are in both
        b[0, :, 2:8] = 2  # 60
        self.assertAlmostEqual(scores.dice(a, b, 2, [True, False]), 0.4)
        self.assertAlmostEqual(scores.dice(a, b, 2, [True, True]), 0.7)  # nothing in neither is right
        self.assertIsNone(scores.dice(a, b, 2, [False, False]))

    def test_f1_counts_classes_alike(self):
        truth = numpy.array([0] * 8 + [1] * 2)
        found = numpy.array([0] * 8 + [1, 0])
        result = scores.macro_f1(found, truth, 4)
        self.assertAlmostEqual(result["accuracy"], 0.9)
        self.assertAlmostEqual(result["F1"], (16 / 17 + 2 / 3) / 2)


if __name__ == "__main__":
    unittest.main()
