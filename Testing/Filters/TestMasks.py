"""Foreign readers, and our own, find in a DICOM Segmentation the labels that the pictures beside it show."""
import shutil
import subprocess
import unittest

import numpy as np
import peers
import pydicom
from TestDicom import DicomCase, sweep_of
from chain import listen, make
from sonovdb.vtkSonoFilters import vtkSonoDicomWriter, vtkSonoLabelMapReader, vtkSonoThoraxSource, vtkSonoUltrasound
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData

# highdicom's own way from a picture's frame to the segments in it.
READ_BY_HIGHDICOM = """
import sys
import highdicom
import numpy as np
segmentation = highdicom.seg.segread(sys.argv[1])
(study, series, instance), = segmentation.get_source_image_uids()
frames = list(range(1, int(sys.argv[3]) + 1))
pixels = segmentation.get_pixels_by_source_frame(source_sop_instance_uid=instance, source_frame_numbers=frames,
                                                 combine_segments=True, assert_missing_frames_are_empty=True)
names = [segmentation.get_segment_description(n).segment_label for n in segmentation.segment_numbers]
np.savez(sys.argv[2], pixels=pixels, names=names, uids=[study, series, instance])
"""


# What dcmqi's segimage2itkimage, by which 3D Slicer opens segmentations, has made: places and names of its masks.
READ_BY_ITK = """
import json
import pathlib
import sys
import numpy as np
import SimpleITK
folder = pathlib.Path(sys.argv[1])
said = json.loads((folder / "read-meta.json").read_text())["segmentAttributes"]
masks, names = [], []
for segment in said:
    image = SimpleITK.ReadImage(str(folder / f"read-{segment[0]['labelID']}.nrrd"))
    masks.append(SimpleITK.GetArrayFromImage(image) != 0)
    names.append(segment[0]["SegmentLabel"])
corner = [n - 1 for n in image.GetSize()]
np.savez(folder / "read.npz", masks=masks, names=names, first=image.TransformIndexToPhysicalPoint((0, 0, 0)),
         last=image.TransformIndexToPhysicalPoint(corner))
"""


def labels_of(image):
    width, height, slices = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetArray("Labels")).reshape(slices, height, width)


def names_of(image):
    field = image.GetFieldData()
    names = field.GetAbstractArray("LabelNames")
    return {int(number): names.GetValue(n) for n, number in enumerate(vtk_to_numpy(field.GetArray("LabelIds")))}


def colours_of(image):
    field = image.GetFieldData()
    return dict(zip(names_of(image).values(), vtk_to_numpy(field.GetArray("LabelColors")).tolist()))


class MaskCase(DicomCase):
    def masks(self, port, name="Bild für Jörg.dcm", **settings):
        """The segmentation that is written beside a picture, and the picture."""
        path = self.written(port, name, LabelMasks=True, **settings)
        beside = path.with_name(path.stem + ".seg.dcm")
        self.assertEqual(sorted(self.folder.iterdir()), sorted([path, beside]))
        self.check(path)
        self.check(beside)
        return beside, path

    def frames(self, path):
        """Of a segmentation: the picture's number, the name and the mask of each frame."""
        data = pydicom.dcmread(path)
        names = {int(item.SegmentNumber): item.SegmentLabel for item in data.SegmentSequence}
        pixels = data.pixel_array.reshape(-1, data.Rows, data.Columns)
        for groups, mask in zip(data.PerFrameFunctionalGroupsSequence, pixels):
            source = groups.DerivationImageSequence[0].SourceImageSequence[0]
            segment = groups.SegmentIdentificationSequence[0].ReferencedSegmentNumber
            yield source.ReferencedFrameNumber - 1, names[segment], mask

    def compare(self, path, images):
        """Each label of each picture has its frame, and there are no others."""
        wanted = {(n, names_of(image)[label]): plane == label for n, (image, plane) in enumerate(images)
                  for label in np.unique(plane) if label != 0}
        found = {(n, name): mask for n, name, mask in self.frames(path)}
        self.assertEqual(found.keys(), wanted.keys())
        self.assertGreater(len(wanted), 2)
        for key, mask in found.items():
            np.testing.assert_array_equal(mask != 0, wanted[key])


class TestContent(MaskCase):
    def test_pydicom_finds_labels_and_places(self):
        for port in (0, 1):  # in the world and flat: one place, which the probe says
            with self.subTest(port=port):
                path, picture = self.masks(self.chain.converter.GetOutputPort(port))
                world = self.chain.converter.GetOutput()
                self.compare(path, [(world, labels_of(world)[0])])
                data, beside = pydicom.dcmread(path), pydicom.dcmread(picture)
                for name in ("StudyInstanceUID", "FrameOfReferenceUID", "PatientName", "Rows", "Columns", "StudyTime"):
                    self.assertEqual(data[name].value, beside[name].value)
                self.assertNotEqual(data.SeriesInstanceUID, beside.SeriesInstanceUID)
                series, = data.ReferencedSeriesSequence
                self.assertEqual(series.SeriesInstanceUID, beside.SeriesInstanceUID)
                self.assertEqual(series.ReferencedInstanceSequence[0].ReferencedSOPInstanceUID, beside.SOPInstanceUID)
                self.assertEqual([item.SegmentNumber for item in data.SegmentSequence],
                                 list(range(1, len(data.SegmentSequence) + 1)))
                shared, = data.SharedFunctionalGroupsSequence
                turn = np.reshape(shared.PlaneOrientationSequence[0].ImageOrientationPatient, (2, 3)).astype(float)
                spacing = np.array(shared.PixelMeasuresSequence[0].PixelSpacing, float)
                first = data.PerFrameFunctionalGroupsSequence[0].PlanePositionSequence[0].ImagePositionPatient
                for column, row in ((0, 0), (40, 120), (beside.Columns - 1, beside.Rows - 1)):
                    found = np.array(first, float) + column * spacing[1] * turn[0] + row * spacing[0] * turn[1]
                    wanted = [0, 0, 0]
                    world.TransformIndexToPhysicalPoint(column, row, 0, wanted)
                    np.testing.assert_allclose(found, wanted, atol=1e-4)
                for item in (path, picture):
                    item.unlink()

    def test_a_sweep_has_its_frames(self):
        sweep = sweep_of(self.chain, 3)
        path, _ = self.masks(sweep.GetOutputPort())
        self.compare(path, [(sweep.GetOutput(), plane) for plane in labels_of(sweep.GetOutput())])

    @peers.needs("highdicom")
    def test_highdicom_finds_the_segments_of_a_frame(self):
        sweep = sweep_of(self.chain, 3)
        path, picture = self.masks(sweep.GetOutputPort())
        peers.run(READ_BY_HIGHDICOM, path, self.folder / "read.npz", 3)
        read = np.load(self.folder / "read.npz")
        names = np.array(["", *read["names"]])
        known = names_of(sweep.GetOutput())
        wanted = np.vectorize(lambda label: known[label] if label else "")(labels_of(sweep.GetOutput()))
        np.testing.assert_array_equal(names[read["pixels"]], wanted)
        beside = pydicom.dcmread(picture)
        self.assertEqual(list(read["uids"]), [beside.StudyInstanceUID, beside.SeriesInstanceUID, beside.SOPInstanceUID])


    @peers.needs("dcmqi", "SimpleITK")
    def test_slicers_reader_finds_masks_and_places(self):
        """A picture, and a sweep across its plane, whose pictures it takes as slices."""
        across = np.cross(self.chain.probe.GetLateral(), self.chain.probe.GetAxial())
        sweep = sweep_of(self.chain, 3, across / np.linalg.norm(across))
        for algorithm in (self.chain.converter, sweep):
            path, picture = self.masks(algorithm.GetOutputPort())
            read = self.folder / "read"
            read.mkdir()
            subprocess.run([peers.FOLDER / "bin/segimage2itkimage", "--inputDICOM", path, "--outputDirectory", read,
                            "--prefix", "read", "--outputType", "nrrd"], check=True, capture_output=True)
            peers.run(READ_BY_ITK, read)
            found = np.load(read / "read.npz")
            image = algorithm.GetOutput()
            known, planes = names_of(image), labels_of(image)
            self.assertEqual(sorted(found["names"]), sorted(known[n] for n in np.unique(planes) if n != 0))
            for mask, name in zip(found["masks"], found["names"]):
                label, = (n for n, each in known.items() if each == name)
                np.testing.assert_array_equal(mask, planes == label)
            width, height, slices = image.GetDimensions()
            for place, index, n in ((found["first"], (0, 0, 0), 0), (found["last"], (width - 1, height - 1, 0), slices - 1)):
                wanted = [0, 0, 0]
                self.chain.converter.GetOutput().TransformIndexToPhysicalPoint(index, wanted)
                np.testing.assert_allclose(place, wanted + n * across / np.linalg.norm(across), atol=0.01)
            shutil.rmtree(read)
            for item in (path, picture):
                item.unlink()


class TestThereAndBack(MaskCase):
    def read(self, path):
        reader = make(vtkSonoLabelMapReader)
        reader.AddFileName(str(path))
        said = listen(reader)
        reader.Update()
        return reader.GetOutput(), said

    def compare_image(self, found, wanted, planes):
        names, known = names_of(found), names_of(wanted)
        self.assertEqual(found.GetDimensions(), (*wanted.GetDimensions()[:2], len(planes)))
        as_read = np.vectorize(lambda label: names[label] if label else "")(labels_of(found))
        as_shown = np.vectorize(lambda label: known[label] if label else "")(planes)
        np.testing.assert_array_equal(as_read, as_shown)
        colours = colours_of(wanted)
        for name, colour in colours_of(found).items():
            if name in as_shown:
                np.testing.assert_allclose(colour, colours[name], atol=1 / 255)

    def test_one_picture(self):
        path, _ = self.masks(self.chain.converter.GetOutputPort(1))
        found, said = self.read(path)
        self.assertEqual(said, [])
        world = self.chain.converter.GetOutput()
        self.compare_image(found, world, labels_of(world))
        for index in ((0, 0, 0), (40, 120, 0)):
            places = [[0, 0, 0], [0, 0, 0]]
            for image, place in zip((found, world), places):
                image.TransformIndexToPhysicalPoint(*index, place)
            np.testing.assert_allclose(*places, atol=1e-4)

    def test_a_stack_of_planes(self):
        """A sweep across the plane is a volume of labels."""
        across = np.cross(self.chain.probe.GetLateral(), self.chain.probe.GetAxial())
        sweep = sweep_of(self.chain, 3, across / np.linalg.norm(across))
        path, _ = self.masks(sweep.GetOutputPort())
        found, said = self.read(path)
        self.assertEqual(said, [])
        self.compare_image(found, sweep.GetOutput(), labels_of(sweep.GetOutput()))

    def test_a_film_is_no_label_map(self):
        thorax = make(vtkSonoThoraxSource, SpacingMm=4.0, Phases=2)
        ultrasound = make(vtkSonoUltrasound, PathsPerLine=5, PixelMm=1.0, LineCount=12)
        ultrasound.SetInputConnection(thorax.GetOutputPort())
        for part in ("PositionMm", "Axial", "Lateral"):
            getattr(ultrasound.GetProbe(), "Set" + part)(getattr(self.chain.probe, "Get" + part)())
        path, _ = self.masks(ultrasound.GetOutputPort(ultrasound.FLAT_IMAGE))
        images = []
        for n in range(2):
            ultrasound.UpdateTimeStep(0.5 * n)
            image = vtkImageData()
            image.DeepCopy(ultrasound.GetOutputDataObject(ultrasound.FLAT_IMAGE))
            images.append((image, labels_of(image)[0]))
        self.compare(path, images)
        self.assertTrue((images[0][1] != images[1][1]).any())
        _, said = self.read(path)
        self.assertIn("as a film does", said[0])


class TestRefusals(MaskCase):
    def refused(self, image):
        path, said = self.write(image, LabelMasks=True)
        self.assertEqual(len(said), 1, said)
        self.assertEqual(list(self.folder.iterdir()), [])
        return said[0]

    def test_one_sentence_each(self):
        copy = vtkImageData()
        copy.DeepCopy(self.chain.converter.GetOutputDataObject(1))
        vtk_to_numpy(copy.GetPointData().GetArray("Labels"))[:] = 0
        self.assertIn("no pixel shows a label", self.refused(copy))
        copy.GetPointData().RemoveArray("Labels")
        self.assertIn("'Labels'", self.refused(copy))

    def test_the_name_follows(self):
        writer = make(vtkSonoDicomWriter, FileName="a/Bild.dcm")
        self.assertEqual(writer.LabelMaskFileName(), "a/Bild.seg.dcm")


if __name__ == "__main__":
    unittest.main()
