"""The label table says what each label is, and a table of one's own changes it."""
import pathlib
import tempfile
import unittest

import numpy as np
from chain import label_image, listen, make
from sonovdb.vtkSonoFilters import vtkSonoLabelTable, vtkSonoSceneBuilder, vtkSonoThoraxSource

NUMBERS = ("impedance_MRayl", "sound_speed_m_per_s", "attenuation_dB_per_cm_MHz", "mu0", "sigma0", "mu1", "tau", "gamma",
           "roughness_mm", "correlation_mm", "backscatter_1MHz_per_cm_sr", "backscatter_exponent", "fibre_anisotropy_dB",
           "nonlinearity")


class TestLabelTable(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def file(self, text):
        path = self.folder / "labels.csv"
        path.write_text(text, encoding="utf-8")
        return str(path)

    def table(self, **settings):
        voxels = np.zeros((4, 4, 4), np.uint8)
        voxels[1:3, 1:3, 1:3] = 7
        scene = make(vtkSonoSceneBuilder, BuildSurfaces=False, **settings)
        scene.SetInputData(label_image(voxels))
        listen(scene, "WarningEvent")
        table = vtkSonoLabelTable()
        table.SetInputConnection(scene.GetOutputPort())
        table.Update()
        return scene, table

    def row(self, table, label):
        data = table.GetOutput()
        ids = [data.GetValue(i, 0).ToInt() for i in range(data.GetNumberOfRows())]
        names = [data.GetColumnName(i) for i in range(data.GetNumberOfColumns())]
        return {name: data.GetValue(ids.index(label), i) for i, name in enumerate(names)}

    def test_each_label_has_its_tissues_numbers(self):
        _, table = self.table()
        row = self.row(table, 7)
        self.assertEqual((row["name"].ToString(), row["tissue"].ToString()), ("label_7", "soft_tissue"))
        self.assertEqual([row[name].ToDouble() for name in NUMBERS[:3]], [1.63, 1540, 0.54])  # as in Data/tissues.csv
        rows = [table.GetTissueRows().GetValue(i).split("\t") for i in range(table.GetTissueRows().GetNumberOfValues())]
        self.assertEqual(rows[0], ["tissue", *NUMBERS, "source"])
        self.assertIn("cortical_bone", [fields[0] for fields in rows])
        self.assertEqual(table.GetLabelRows().GetValue(2).split("\t")[:2], ["7", "label_7"])

    def test_a_label_map_itself_has_names_and_colours_alone(self):
        thorax = make(vtkSonoThoraxSource, SpacingMm=5.0)
        table = vtkSonoLabelTable()
        table.SetInputConnection(thorax.GetOutputPort())
        table.Update()
        rows = [table.GetLabelRows().GetValue(i).split("\t") for i in range(table.GetLabelRows().GetNumberOfValues())]
        self.assertIn(["left_ventricle_blood", "217", "26", "26"], [row[1:5] for row in rows])  # as the phantom is drawn
        self.assertEqual(table.GetTissueRows().GetNumberOfValues(), 0)
        self.assertEqual(table.GetOutput().GetNumberOfColumns(), 7)

    def test_a_table_of_ones_own(self):
        _, table = self.table(LabelTableFile=self.file("id,name,r,g,b,tissue\n7,my liver,200,100,50,liver\n"))
        row = self.row(table, 7)
        self.assertEqual([row[name].ToString() for name in ("name", "tissue", "red", "green", "blue")],
                         ["my liver", "liver", "200", "100", "50"])
        self.assertEqual(row["impedance_MRayl"].ToDouble(), 1.65)

    def test_texts_take_the_place_of_files(self):
        """Of both tables; a message names the text as it names a file."""
        columns = ",".join(NUMBERS[:8])
        settings = {"LabelTableText": "id,name,r,g,b,tissue\n7,mine,200,100,50,jelly\n",
                    "TissueTableText": f"tissue,{columns},source\njelly,1.7,1500,0.5,0.3,0.2,0.1,1,0,mine\n"
                                       f"air,0.0004,330,1,0,0,0,1,0,mine\nsoft_tissue,1.6,1540,0.5,0,0,0,1,0,mine\n",
                    "LabelTableFile": "nowhere.csv", "TissueTableFile": "nowhere.csv"}
        scene, table = self.table(**settings)
        row = self.row(table, 7)
        self.assertEqual([row[name].ToString() for name in ("name", "tissue", "red")], ["mine", "jelly", "200"])
        self.assertEqual([row[name].ToDouble() for name in NUMBERS[:6]], [1.7, 1500, 0.5, 0.3, 0.2, 0.1])
        said = listen(scene)
        scene.SetTissueTableText(f"tissue,{columns},source\njelly,-1,1500,0.5,0.3,0.2,0.1,1,0,mine\n")
        scene.Update()
        self.assertEqual(len(said), 1, said)
        self.assertRegex(said[0], "the tissue editor's tissues.*jelly.*impedance_MRayl")

    def test_every_column_is_explained(self):
        """In a sentence with its unit and range."""
        for column in NUMBERS:
            with self.subTest(column=column):
                self.assertRegex(vtkSonoLabelTable.Meaning(column), r"^\w.*\b(MRayl|m/s|dB|mm|sr|no unit)\b.*\d.*\.$")
        self.assertEqual(vtkSonoLabelTable.Meaning("source"), "")

    def test_without_a_tissue_the_name_decides(self):
        _, table = self.table(LabelTableFile=self.file("id,name\n7,liver\n"))
        self.assertEqual(self.row(table, 7)["tissue"].ToString(), "liver")

    def test_bad_tables(self):
        for text, word in (("id,name,tissue\n7,x,unobtainium\n", "unobtainium"), ("id,name\nseven,x\n", "'seven'")):
            with self.subTest(word=word):
                scene, _ = self.table()
                said = listen(scene)
                scene.SetLabelTableFile(self.file(text))
                scene.Update()
                self.assertEqual(len(said), 1, said)
                self.assertIn(word, said[0])

    def test_numbers_are_refused_as_in_a_file(self):
        for column, value, refused in (("impedance_MRayl", 0.0, True), ("impedance_MRayl", 1.6, False),
                                       ("attenuation_dB_per_cm_MHz", -1.0, True), ("mu1", 1.5, True),
                                       ("gamma", -2.0, False), ("sound_speed_m_per_s", float("nan"), True)):
            with self.subTest(column=column, value=value):
                sentence = vtkSonoLabelTable.Refusal("fat", column, value)
                self.assertEqual(bool(sentence), refused)
                if refused:
                    self.assertIn("'fat'", sentence)
                    self.assertIn(column, sentence)


if __name__ == "__main__":
    unittest.main()
