"""A folder of masks as one label map, what is said of overlaps, and how reading is stopped."""
import gzip
import pathlib
import struct
import tempfile
import unittest

import numpy as np
from chain import listen, make
from sonovdb.vtkSonoFilters import vtkSonoLabelMapReader, vtkSonoMaskFolderReader
from vtkmodules.util.numpy_support import vtk_to_numpy


def nifti(voxels):
    """NIfTI-1 of an array indexed [z, y, x], with voxels of 1 mm."""
    header = bytearray(352)
    types = {np.dtype(np.uint8): (2, 8), np.dtype(np.int16): (4, 16)}
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, *voxels.shape[::-1], 1, 1, 1, 1)
    struct.pack_into("<2h", header, 70, *types[voxels.dtype])
    struct.pack_into("<9f", header, 76, 1, 1, 1, 1, 1, 1, 1, 1, 352)
    header[344:347] = b"n+1"
    return bytes(header) + voxels.tobytes()


class TestMaskFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, *set_voxels, value=1):
        voxels = np.zeros((1, 2, 4), np.uint8)
        voxels.flat[list(set_voxels)] = value
        path = self.folder / f"{name}.nii.gz"
        path.write_bytes(gzip.compress(nifti(voxels)))
        return str(path)

    def test_folder_is_one_label_map(self):
        self.write("liver", 0, 1, 2, 3)
        self.write("gallbladder")
        self.write("portal_vein", 2, 3)
        for path in (self.folder, self.folder / "liver.nii.gz"):
            reader = make(vtkSonoMaskFolderReader, FileName=str(path))
            warned = listen(reader, "WarningEvent")
            reader.Update()
            reader.Modified()
            reader.Update()
            image = reader.GetOutput()
            # The empty gallbladder is number 1; the vein is smaller than the liver around it.
            self.assertEqual(list(vtk_to_numpy(image.GetPointData().GetScalars())), [2, 2, 3, 3, 0, 0, 0, 0])
            names = image.GetFieldData().GetAbstractArray("LabelNames")
            self.assertEqual([names.GetValue(i) for i in range(3)], ["background", "liver", "portal_vein"])
            self.assertEqual(len(warned), 1, warned)
            self.assertIn("fewer voxels", warned[0])

    def test_reader_offers_itself_for_masks_alone(self):
        can_read = vtkSonoMaskFolderReader.CanReadFile
        liver = self.write("liver", 0, 1)
        self.assertEqual([can_read(liver), can_read(str(self.folder))], [0, 1])  # nothing lies beside it
        self.write("spleen", 5)
        labels = self.folder / "labels.nii"
        labels.write_bytes(nifti(np.arange(8, dtype=np.int16).reshape(1, 2, 4)))
        notes = self.folder / "notes.txt"
        notes.write_text("no mask")
        self.assertEqual([can_read(str(path)) for path in (liver, labels, notes, "nowhere")], [1, 0, 0, 0])
        self.assertEqual(vtkSonoLabelMapReader.CanReadFile(str(notes)), 0)

    def test_unequal_masks_are_one_sentence(self):
        self.write("liver", 0, 1)
        (self.folder / "spleen.nii").write_bytes(nifti(np.ones((1, 2, 5), np.uint8)))
        reader = make(vtkSonoMaskFolderReader, FileName=str(self.folder))
        said = listen(reader)
        reader.Update()
        self.assertEqual(len(said), 1, said)
        for word in ("liver.nii.gz", "spleen.nii", "(4, 2, 1)", "(5, 2, 1)"):
            self.assertIn(word, said[0])

    def test_reading_stops(self):
        path = self.folder / "large.nii"
        path.write_bytes(nifti(np.zeros((100, 100, 100), np.int16)))
        reader = make(vtkSonoLabelMapReader, FileName=str(path))
        said, fractions = listen(reader), []

        def on_progress(algorithm, _event):
            fractions.append(algorithm.GetProgress())
            if 0 < fractions[-1] < 1:
                algorithm.AbortExecuteOn()

        tag = reader.AddObserver("ProgressEvent", on_progress)
        reader.Update()
        self.assertTrue(any(0 < fraction < 1 for fraction in fractions), fractions)
        self.assertEqual(reader.GetOutput().GetNumberOfPoints(), 0)
        self.assertEqual(said, [])
        reader.RemoveObserver(tag)
        reader.AbortExecuteOff()
        reader.Modified()
        reader.Update()
        self.assertEqual(reader.GetOutput().GetNumberOfPoints(), 10 ** 6)
