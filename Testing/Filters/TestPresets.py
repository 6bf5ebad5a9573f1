"""The table of the presets holds what their files do, and a probe takes them by name."""
import json
import pathlib
import tempfile
import unittest

from chain import listen, make
from sonovdb.vtkSonoFilters import vtkSonoProbePresets, vtkSonoProbeSource, vtkSonoTextFile

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "Data" / "probes"
KINDS = {"linear": 0, "phased_sector": 1, "curvilinear": 2, "matrix": 3, "radial": 4}
KEYS = {"LineCount": "numberOfLines", "DepthMm": "depthMm", "SectorDeg": "sectorDeg", "RadiusMm": "radiusMm",
        "WidthMm": "widthMm", "CentreFrequencyMHz": "centreFrequencyMHz", "FractionalBandwidth": "fractionalBandwidth"}


class TestPresets(unittest.TestCase):
    def test_every_bundled_file_has_its_row(self):
        presets = vtkSonoProbePresets()
        presets.Update()
        table = presets.GetOutput()
        files = sorted(FOLDER.glob("*.json"))
        self.assertEqual([table.GetValueByName(i, "Preset").ToString() for i in range(table.GetNumberOfRows())],
                         [file.stem for file in files])
        for row, file in enumerate(files):
            preset = json.loads(file.read_text())
            self.assertEqual(table.GetValueByName(row, "Name").ToString(), preset["name"])
            self.assertEqual(table.GetValueByName(row, "ScanKind").ToInt(), KINDS[preset["scan"]])
            probe = make(vtkSonoProbeSource, PresetFile=file.stem)
            probe.Update()
            field = probe.GetOutput().GetFieldData()
            for column, key in KEYS.items():
                if key in preset:
                    self.assertEqual(table.GetValueByName(row, column).ToDouble(), preset[key]["value"])
                    self.assertEqual(field.GetArray(column).GetValue(0), preset[key]["value"])

    def test_rows_as_text_say_the_same(self):
        presets = vtkSonoProbePresets()
        presets.Update()
        rows = [presets.GetRows().GetValue(i).split("\t") for i in range(presets.GetRows().GetNumberOfValues())]
        table = presets.GetOutput()
        self.assertEqual(len(rows), table.GetNumberOfRows() + 1)
        for i, row in enumerate(rows[1:]):
            for name, text in zip(rows[0][2:], row[2:]):
                self.assertAlmostEqual(float(text), table.GetValueByName(i, name).ToDouble(), places=8)

    def test_a_file_of_ones_own_comes_last(self):
        presets = make(vtkSonoProbePresets, FileName=str(FOLDER / "linear_l14.json"))
        presets.Update()
        last = presets.GetOutput().GetNumberOfRows() - 1
        self.assertEqual(last, len(list(FOLDER.glob("*.json"))))
        self.assertEqual(presets.GetOutput().GetValueByName(last, "DepthMm").ToDouble(), 40)

    def test_bad_files_give_one_sentence(self):
        with tempfile.TemporaryDirectory() as folder:
            broken = pathlib.Path(folder, "broken.json")
            broken.write_text('{"name": 3')
            for name, word in ((str(broken), "broken.json"), ("nowhere/no.json", "nowhere/no.json")):
                presets = make(vtkSonoProbePresets, FileName=name)
                said = listen(presets)
                presets.Update()
                self.assertEqual(len(said), 1, said)
                self.assertIn(word, said[0])
                self.assertEqual(presets.GetRefusal(), said[0])
        probe = make(vtkSonoProbeSource, PresetFile="no_such_probe")
        said = listen(probe)
        probe.Update()
        self.assertEqual(len(said), 1, said)
        self.assertIn("no_such_probe", said[0])
        self.assertIn("linear_l14", said[0])


class TestTextFile(unittest.TestCase):
    def test_text_is_written_and_replaced(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "text.csv")
            for text in ("first\n", "zweite Fassung, ä\n"):
                file = make(vtkSonoTextFile, FileName=str(path), Text=text)
                file.Write()
                self.assertEqual(file.GetRefusal(), "")
                self.assertEqual(path.read_text(encoding="utf-8"), text)
            self.assertEqual([p.name for p in pathlib.Path(folder).iterdir()], ["text.csv"])

    def test_what_cannot_be_written_is_said(self):
        file = make(vtkSonoTextFile, FileName="/nowhere/at/all.csv", Text="x")
        file.Write()
        self.assertIn("/nowhere/at/all.csv", file.GetRefusal())


if __name__ == "__main__":
    unittest.main()
