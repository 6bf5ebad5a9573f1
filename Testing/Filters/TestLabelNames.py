"""From a label map's file to the tissue of each label: names, codes, lists of numbers, and what is said of guesses."""
import pathlib
import tempfile
import unittest

import numpy as np
from chain import listen, make
from sonovdb.vtkSonoFilters import vtkSonoLabelMapReader, vtkSonoLabelTable, vtkSonoSceneBuilder

HEADER = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n"
TERMS = "TerminologyEntry:any list~SCT^123037004^Anatomical Structure~{}~SCT^7771000^Left~~^^~^^|"


class TestLabelNames(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def reader(self, name, segments, ids, **settings):
        voxels = np.zeros((4, 4, 4), np.uint8)
        voxels[1, 1, :len(ids)] = ids
        lines = "".join(f"Segment{n}_{key}:={value}\n" for n, segment in enumerate(segments)
                        for key, value in segment.items())
        path = self.folder / name
        path.write_bytes((HEADER + lines + "\n").encode() + voxels.tobytes())
        return make(vtkSonoLabelMapReader, FileName=str(path), **settings)

    def tissues(self, reader, **settings):
        """Name, tissue and whether it is a guess, by number; and the warnings."""
        scene = make(vtkSonoSceneBuilder, BuildSurfaces=False, **settings)
        scene.SetInputConnection(reader.GetOutputPort())
        said = listen(scene, "WarningEvent")
        table = vtkSonoLabelTable()
        table.SetInputConnection(scene.GetOutputPort())
        table.Update()
        texts = table.GetLabelRows()
        rows = [texts.GetValue(i).split("\t") for i in range(1, texts.GetNumberOfValues())]
        guesses = table.GetOutput().GetColumnByName("guess")
        self.assertEqual([guesses.GetValue(i) for i in range(len(rows))], [int(row[6] == "yes") for row in rows])
        return {int(row[0]): (row[1], row[5], row[6]) for row in rows}, said

    def test_slicers_codes_name_and_decide(self):
        reader = self.reader("a.seg.nrrd", [
            {"Name": "Segment_1", "LabelValue": 1, "Tags": TERMS.format("SCT^64033007^Kidney")},
            {"Name": "mine", "LabelValue": 2, "Tags": TERMS.format("SRT^T-62000^Liver")},
            {"Name": "left rib 6", "LabelValue": 3, "Tags": "Segmentation.Status:inprogress|"},
        ], [1, 2, 3])
        tissues, said = self.tissues(reader)
        self.assertEqual(tissues, {0: ("background", "air", ""), 1: ("left kidney", "kidney", ""),
                                   2: ("mine", "liver", ""), 3: ("left rib 6", "cortical_bone", "")})
        self.assertEqual(said, [])
        codes = reader.GetOutput().GetFieldData().GetAbstractArray("LabelCodes")
        self.assertEqual([codes.GetValue(i) for i in range(4)], ["", "SCT 64033007", "SRT T-62000", ""])

    def test_guesses_are_named_with_what_they_became(self):
        reader = self.reader("a.seg.nrrd", [{"Name": "thing", "LabelValue": 1}, {"Name": "ventricle", "LabelValue": 2},
                                            {"Name": "liver", "LabelValue": 3}], [1, 2, 3])
        tissues, (sentence,) = self.tissues(reader)
        self.assertEqual(tissues[1], ("thing", "soft_tissue", "yes"))
        self.assertEqual(tissues[2], ("ventricle", "water", "yes"))
        self.assertEqual(tissues[3][2], "")
        self.assertIn("thing (soft_tissue), ventricle (water)", sentence)
        self.assertNotIn("Label Names", sentence)

    def test_what_a_person_chose_is_no_guess(self):
        table = self.folder / "mine.csv"
        table.write_text("id,name,tissue\n1,thing,muscle\n")
        reader = self.reader("a.seg.nrrd", [{"Name": "thing", "LabelValue": 1}], [1])
        tissues, said = self.tissues(reader, LabelTableFile=str(table))
        self.assertEqual((tissues[1], said), (("thing", "muscle", ""), []))

    def test_numbers_mean_what_the_chosen_list_says(self):
        reader = self.reader("a.nrrd", [], [51, 52])
        tissues, (sentence,) = self.tissues(reader)
        self.assertEqual(tissues[51], ("label_51", "soft_tissue", "yes"))
        self.assertIn("Label Names", sentence)
        for names, name, tissue in (("TotalSegmentator v2", "heart", "myocardium"),
                                    ("TotalSegmentator v1 or MONAI", "iliac_artery_left", "blood"),
                                    ("SPL Abdomen", "right_kidney", "kidney")):
            reader.SetLabelNames(names)
            tissues, _ = self.tissues(reader)
            self.assertEqual(tissues[51], (name, tissue, ""))
        reader.SetLabelNames("From Nowhere")
        said = listen(reader)
        reader.Update()
        self.assertEqual(len(said), 1, said)
        self.assertIn("'From Nowhere'", said[0])

    def test_every_list_has_a_tissue_for_each_name(self):
        for names in ("TotalSegmentator v2", "TotalSegmentator v1 or MONAI", "TotalSegmentator MR", "AMOS", "BTCV",
                      "FLARE", "CT-ORG", "SPL Abdomen"):
            with self.subTest(names=names):
                tissues, said = self.tissues(self.reader("a.nrrd", [], [2, 3, 4], LabelNames=names))
                self.assertEqual([tissue[2] for tissue in tissues.values()], [""] * 4)
                self.assertEqual(said, [])


if __name__ == "__main__":
    unittest.main()
