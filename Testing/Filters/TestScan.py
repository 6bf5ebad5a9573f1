"""A CT or MR beside a label map: what it adds, and what it changes in the picture."""
import pathlib
import tempfile
import unittest

import numpy as np
from chain import Chain, label_image, listen, make
from sonovdb.vtkSonoFilters import vtkSonoScanDetail, vtkSonoScanReader, vtkSonoUltrasound
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkImagingCore import vtkExtractVOI

HU = {"air": -1000, "lung": -850, "bone": 400, "fat": -100, "soft": 50}


def scan_image(like, values):
    image = vtkImageData()
    image.CopyStructure(like)
    array = numpy_to_vtk(values.astype(np.float32).ravel(), deep=True)
    array.SetName("Intensities")
    image.GetPointData().SetScalars(array)
    return image


def labels_of(image):
    dimensions = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetArray("Labels")).reshape(dimensions[::-1])


def names_of(image):
    field = image.GetFieldData()
    ids, names = field.GetArray("LabelIds"), field.GetAbstractArray("LabelNames")
    return {ids.GetValue(i): names.GetValue(i) for i in range(names.GetNumberOfValues())}


def thorax_ct(labels, names):
    """What a CT of the thorax phantom has in each label."""
    values = np.full(labels.shape, float(HU["soft"]))
    for number, name in names.items():
        kind = next((k for k, words in {"air": ("air", "background"), "lung": ("lung",), "bone": ("rib", "sternum", "vertebra", "spine"),
                                        "fat": ("fat",)}.items() if any(w in name for w in words)), "soft")
        values[labels == number] = HU[kind]
    return values


class Scan(unittest.TestCase):
    def setUp(self):
        self.chain = Chain()
        self.image = self.chain.thorax.GetOutput()
        self.labels = labels_of(self.image)
        self.names = names_of(self.image)
        self.ct = thorax_ct(self.labels, self.names)

    def added(self, ct, **settings):
        stage = make(vtkSonoScanDetail, **settings)
        stage.SetInputDataObject(0, self.image)
        stage.SetInputDataObject(1, scan_image(self.image, ct))
        self.errors = listen(stage)
        stage.Update()
        return stage

    def picture(self, image):
        stage = make(vtkSonoUltrasound, MaxCollisions=2, PathsPerLine=64, Reverberation=False)
        stage.SetInputDataObject(0, image)
        field = self.image.GetFieldData()
        for name in ("PositionMm", "Axial", "Lateral"):
            getattr(stage.GetProbe(), "Set" + name)(field.GetArray("A4C" + name).GetTuple3(0))
        stage.Update(7)
        return vtk_to_numpy(stage.GetOutputDataObject(7).GetPointData().GetScalars()).astype(float)

    def test_detail_reaches_the_picture(self):
        flat = self.added(self.ct).GetOutput()
        self.assertEqual(self.errors, [])
        plain = self.picture(flat)
        # Slabs of 32 mm, every other one with 60 HU more where it is soft, which then echoes more, and the rest less.
        striped = self.ct.copy()
        slab = np.broadcast_to(np.arange(self.labels.shape[2]) % 16 < 8, self.labels.shape)
        striped[slab & (self.ct == HU["soft"])] += 60
        with_detail = self.picture(self.added(striped, DetailDirection=1).GetOutput())
        self.assertEqual(self.errors, [])
        shown = plain > 32
        self.assertGreater(np.abs(with_detail - plain)[shown].mean(), 5.0)
        np.testing.assert_array_equal(self.picture(self.image), plain)  # a scan without structure changes nothing

    def test_what_has_no_label_is_named(self):
        background = next(n for n, name in self.names.items() if name in ("air", "background"))
        keep = [n for n, name in self.names.items() if "heart" in name or "ventric" in name or "myocard" in name]
        bare = np.where(np.isin(self.labels, keep), self.labels, 0).astype(np.uint16)
        image = label_image(bare)
        image.SetOrigin(self.image.GetOrigin())
        image.SetSpacing(self.image.GetSpacing())
        image.SetDirectionMatrix(self.image.GetDirectionMatrix())
        image.GetFieldData().ShallowCopy(self.image.GetFieldData())
        self.image = image
        output = self.added(self.ct).GetOutput()
        self.assertEqual(self.errors, [])
        found = set(names_of(output).values())
        self.assertLessEqual({"skin", "fat", "muscle", "bone", "lung"}, found)
        lung = next(n for n, name in names_of(output).items() if name == "lung")
        was_lung = np.isin(self.labels, [n for n, name in self.names.items() if "lung" in name])
        self.assertGreater((labels_of(output)[was_lung] == lung).mean(), 0.9)
        self.assertNotEqual(background, lung)
        for name in ("Labels", "ScanDetail"):  # the array was told its range
            array = output.GetPointData().GetArray(name)
            values = vtk_to_numpy(array)
            self.assertEqual(array.GetRange(), (values.min(), values.max()))
            self.assertEqual(array.GetFiniteRange(), (values.min(), values.max()))

    def test_what_does_not_fit_is_refused(self):
        self.added(np.roll(self.ct, self.ct.shape[2] // 2, axis=2))
        self.assertIn("another patient", " ".join(self.errors))
        stage = make(vtkSonoScanDetail)
        stage.SetInputDataObject(0, self.image)
        colours = vtkImageData()
        colours.CopyStructure(self.image)
        rgb = numpy_to_vtk(np.zeros((self.labels.size, 3), np.uint8), deep=True)
        colours.GetPointData().SetScalars(rgb)
        stage.SetInputDataObject(1, colours)
        errors = listen(stage)
        stage.Update()
        self.assertIn("colour image", " ".join(errors))

    def test_another_frame_of_reference_is_refused(self):
        def framed(image, uid):
            frame = vtkStringArray()
            frame.SetName("FrameOfReference")
            frame.InsertNextValue(uid)
            image.GetFieldData().AddArray(frame)

        scan = scan_image(self.image, self.ct)
        stage = make(vtkSonoScanDetail)
        stage.SetInputDataObject(0, self.image)
        stage.SetInputDataObject(1, scan)
        errors = listen(stage)
        framed(scan, "1.2.3")
        stage.Update()
        self.assertEqual(errors, [])  # the label map names none
        framed(self.image, "1.2.4")
        stage.Modified()
        stage.Update()
        self.assertEqual(len(errors), 1, errors)
        for words in ("(1.2.3)", "(1.2.4)", "frame of reference", "register"):
            self.assertIn(words, errors[0])

    def test_a_scan_that_ends_before_the_labels_is_said_so(self):
        stage = make(vtkSonoScanDetail)
        stage.SetInputDataObject(0, self.image)
        part = vtkExtractVOI()
        part.SetInputData(scan_image(self.image, self.ct))
        columns, rows, slices = self.image.GetDimensions()
        part.SetVOI(0, columns - 1, 0, rows - 1, slices // 4, slices - 1)
        stage.SetInputConnection(1, part.GetOutputPort())
        errors, warned = listen(stage), listen(stage, "WarningEvent")
        stage.Update()
        self.assertEqual(errors, [])
        self.assertEqual(len(warned), 1, warned)
        self.assertIn("ends before the labels", warned[0])

    def test_reader(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "scan.mha"
            values = np.arange(24, dtype="<i2").reshape(2, 3, 4) - 1000
            path.write_bytes(b"ObjectType = Image\nNDims = 3\nBinaryData = True\nDimSize = 4 3 2\nElementSpacing = 1 2 3\n"
                             b"Offset = 5 6 7\nElementType = MET_SHORT\nElementDataFile = LOCAL\n" + values.tobytes())
            reader = make(vtkSonoScanReader, FileName=str(path))
            errors = listen(reader)
            reader.Update()
            self.assertEqual(errors, [])
            output = reader.GetOutput()
            self.assertEqual(output.GetOrigin(), (5.0, 6.0, 7.0))
            np.testing.assert_array_equal(vtk_to_numpy(output.GetPointData().GetScalars()), values.ravel())
            missing = make(vtkSonoScanReader, FileName=str(path) + "x")
            errors = listen(missing)
            missing.Update()
            self.assertEqual(len(errors) > 0, True)


if __name__ == "__main__":
    unittest.main()
