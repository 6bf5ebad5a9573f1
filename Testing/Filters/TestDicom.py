"""Foreign readers find in a DICOM file the greys, the places and the times of the images that it was made of."""
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import peers
import pydicom
from chain import Chain, listen, make
from sonovdb.vtkSonoFilters import (vtkSonoDicomWriter, vtkSonoSweep, vtkSonoThoraxSource,
                                    vtkSonoUltrasound)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkTable


READ_BY_ITK = """
import sys
import numpy as np
import SimpleITK
image = SimpleITK.ReadImage(sys.argv[1])
np.savez(sys.argv[2], greys=SimpleITK.GetArrayFromImage(image), spacing=image.GetSpacing())
"""


def greys_of(image):
    """Of an image's slices, rows from the transducer on."""
    width, height, slices = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetArray("BMode")).reshape(slices, height, width)


def sweep_of(chain, count, step=None):
    """A sweep of the chain's probe that walks by a step (mm), along the array, a millimetre an image."""
    pose = {part: np.array(getattr(chain.probe, "Get" + part)()) for part in ("PositionMm", "Axial", "Lateral")}
    step = pose["Lateral"] if step is None else step
    table = vtkTable()
    for name, vectors in (("Position", pose["PositionMm"] + np.arange(count)[:, None] * step),
                          ("Axial", np.tile(pose["Axial"], (count, 1))),
                          ("Lateral", np.tile(pose["Lateral"], (count, 1)))):
        for axis in range(3):
            column = vtkDoubleArray()
            column.SetName(name + "XYZ"[axis])
            for value in vectors[:, axis]:
                column.InsertNextValue(value)
            table.AddColumn(column)
    sweep = make(vtkSonoSweep, PixelMm=0.5)
    sweep.GetRayTracer().SetPathsPerLine(10)
    sweep.SetInputConnection(0, chain.scene.GetOutputPort())
    sweep.SetInputConnection(1, chain.probe.GetOutputPort())
    sweep.SetInputData(2, table)
    return sweep


class DicomCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.chain = Chain()
        cls.chain.converter.SetPixelMm(0.5)
        cls.chain.converter.Update()

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, port, name="Ultraschall für Jörg.dcm", **settings):
        """Writes what comes out of a port, or an image; the file's path and what the writer said."""
        path = self.folder / name
        writer = make(vtkSonoDicomWriter, FileName=str(path), **settings)
        writer.SetInputDataObject(port) if isinstance(port, vtkImageData) else writer.SetInputConnection(port)
        said = listen(writer)
        self.assertEqual(writer.Write() == 0, bool(said))
        self.assertEqual(writer.GetErrorCode() == 0, not said)
        return path, said

    def written(self, *arguments, **settings):
        path, said = self.write(*arguments, **settings)
        self.assertEqual(said, [])
        self.assertEqual(list(path.parent.glob("*.part")), [])
        return path

    def check(self, path):
        """dicom3tools' validator finds no error."""
        result = subprocess.run(["dciodvfy", str(path)], capture_output=True, text=True)
        self.assertEqual([line for line in result.stderr.splitlines() if line.startswith("Error")], [])


class TestContent(DicomCase):
    def test_pydicom_finds_greys_and_places(self):
        for port in (0, 1):  # in the world and flat
            with self.subTest(port=port):
                path = self.written(self.chain.converter.GetOutputPort(port), f"{port}.dcm")
                self.check(path)
                data = pydicom.dcmread(path)
                np.testing.assert_array_equal(data.pixel_array, greys_of(self.chain.converter.GetOutput())[0])
                region, = data.SequenceOfUltrasoundRegions
                flat = self.chain.converter.GetOutputDataObject(1)
                for axis, n in (("X", 0), ("Y", 1)):
                    self.assertEqual(region[f"PhysicalUnits{axis}Direction"].value, 3)
                    delta = region[f"PhysicalDelta{axis}"].value
                    first = (region[f"ReferencePixelPhysicalValue{axis}"].value
                             - delta * region[f"ReferencePixel{axis}0"].value)
                    for pixel in (0, flat.GetDimensions()[n] - 1):  # in mm from the middle of the face
                        wanted = flat.GetOrigin()[n] + 0.5 * pixel
                        self.assertAlmostEqual(10 * (first + delta * pixel), wanted, delta=1e-6)
                path.unlink()

    def test_pixels_lie_where_the_sector_is(self):
        """Of 60 degrees and 90 mm, by the calibration alone: what is scanned is not black."""
        data = pydicom.dcmread(self.written(self.chain.converter.GetOutputPort(1)))
        region = data.SequenceOfUltrasoundRegions[0]
        rows, columns = data.pixel_array.shape
        x, y = (10 * (region[f"PhysicalDelta{axis}"].value * (np.arange(count) - region[f"ReferencePixel{axis}0"].value)
                      + region[f"ReferencePixelPhysicalValue{axis}"].value) for axis, count in (("X", columns), ("Y", rows)))
        radius, angle = np.hypot(x, y[:, None]), np.degrees(np.arctan2(x, y[:, None]))
        np.testing.assert_array_less(0, data.pixel_array[(radius < 89) & (radius > 2) & (np.abs(angle) < 29.5)])
        self.assertEqual(data.pixel_array[(radius > 91) | ((np.abs(angle) > 31) & (radius > 4))].max(), 0)
        said = dict(entry.split("=") for entry in data.TransducerData)
        self.assertEqual((said["scanKind"], float(said["sectorDeg"]), float(said["depthMm"])), ("phased_sector", 60, 90))
        self.assertEqual((data.TransducerType, data.DepthOfScanField), ("SECTOR_PHASED", 90))
        self.assertEqual(region.TransducerFrequency, 1000 * self.chain.probe.GetCentreFrequencyMHz())
        self.assertNotIn("radiusMm", said)

    def test_it_says_that_it_is_simulated(self):
        settings = {"PatientName": "Müller^Jörg", "PatientId": "Nr. 7 ä"}
        data = pydicom.dcmread(self.written(self.chain.converter.GetOutputPort(1), **settings))
        for text in (data.Manufacturer, data.DerivationDescription, data.SeriesDescription):
            self.assertIn("Simulated", text)
        self.assertEqual((str(data.PatientName), data.PatientID), ("Müller^Jörg", "Nr. 7 ä"))
        uids = [data.SOPInstanceUID, data.SeriesInstanceUID, data.StudyInstanceUID]
        self.assertTrue(all(uid.is_valid and uid.startswith("2.25.") for uid in uids))
        self.assertEqual(len(set(uids)), 3)
        again = pydicom.dcmread(self.written(self.chain.converter.GetOutputPort(1)))
        self.assertNotEqual(again.SOPInstanceUID, data.SOPInstanceUID)

    def test_dcmtk_finds_the_frames_of_a_sweep(self):
        sweep = sweep_of(self.chain, 3)
        path = self.written(sweep.GetOutputPort(), FrameTimeMs=50)
        self.check(path)
        greys = greys_of(sweep.GetOutput())
        self.assertGreater(np.abs(greys[0].astype(int) - greys[2]).max(), 20)
        subprocess.run(["dcmj2pnm", "--all-frames", "--write-raw-pnm", "--no-windowing", str(path),
                        str(self.folder / "frame")], check=True)
        for n, grey in enumerate(greys):
            header, size, most, pixels = (self.folder / f"frame.{n}.pgm").read_bytes().split(b"\n", 3)
            self.assertEqual((header, size, most), (b"P5", b"%d %d" % grey.shape[::-1], b"255"))
            np.testing.assert_array_equal(np.frombuffer(pixels, np.uint8).reshape(grey.shape), grey)
        dump = subprocess.run(["dcmdump", str(path)], check=True, capture_output=True, text=True).stdout
        self.assertRegex(dump, r"\(0018,1063\) DS \[50\]")
        self.assertRegex(dump, r"\(0028,0008\) IS \[3\]")


    @peers.needs("SimpleITK")
    def test_itk_finds_the_frames_and_their_size(self):
        """By GDCM, as 3D Slicer opens pictures."""
        sweep = sweep_of(self.chain, 3)
        sweep.SetPixelMm(0.4)
        path = self.written(sweep.GetOutputPort())
        peers.run(READ_BY_ITK, path, self.folder / "read.npz")
        read = np.load(self.folder / "read.npz")
        np.testing.assert_array_equal(read["greys"], greys_of(sweep.GetOutput()))
        np.testing.assert_allclose(read["spacing"][:2], sweep.GetOutput().GetSpacing()[:2], atol=1e-5)


class TestCine(DicomCase):
    def beating(self, phases):
        thorax = make(vtkSonoThoraxSource, SpacingMm=4.0, Phases=phases)
        ultrasound = make(vtkSonoUltrasound, PathsPerLine=5, PixelMm=1.0, LineCount=12)
        ultrasound.SetInputConnection(thorax.GetOutputPort())
        for part in ("PositionMm", "Axial", "Lateral"):
            getattr(ultrasound.GetProbe(), "Set" + part)(getattr(self.chain.probe, "Get" + part)())
        return ultrasound

    def test_time_steps_become_frames(self):
        ultrasound = self.beating(4)
        path = self.written(ultrasound.GetOutputPort(ultrasound.FLAT_IMAGE))
        data = pydicom.dcmread(path)
        self.assertEqual((data.NumberOfFrames, data.FrameIncrementPointer), (4, 0x00181063))
        self.assertAlmostEqual(data.FrameTime, 250)
        for n in (2, 0):
            ultrasound.UpdateTimeStep(0.25 * n)
            np.testing.assert_array_equal(data.pixel_array[n], greys_of(ultrasound.GetOutputDataObject(ultrasound.FLAT_IMAGE))[0])

    def test_a_stop_leaves_nothing(self):
        ultrasound = self.beating(4)
        path = self.folder / "stopped.dcm"
        writer = make(vtkSonoDicomWriter, FileName=str(path))
        writer.SetInputConnection(ultrasound.GetOutputPort(ultrasound.FLAT_IMAGE))
        writer.AddObserver("ProgressEvent", lambda *_: writer.SetAbortExecute(writer.GetProgress() > 0.4))
        warned = listen(writer, "WarningEvent")
        writer.Write()
        self.assertEqual(list(self.folder.iterdir()), [])
        self.assertIn(str(path), warned[0])
        self.assertNotEqual(writer.GetErrorCode(), 0)


class TestRefusals(DicomCase):
    def refused(self, *arguments, **settings):
        path, said = self.write(*arguments, **settings)
        self.assertEqual(len(said), 1, said)
        self.assertFalse(path.exists())
        return said[0]

    def test_what_is_no_ultrasound_image(self):
        self.assertIn("BMode", self.refused(self.chain.thorax.GetOutputPort()))
        copy = vtkImageData()
        copy.DeepCopy(self.chain.converter.GetOutputDataObject(1))
        copy.SetSpacing(1, 1, 1)
        self.assertIn("not cut or resampled", self.refused(copy))
        copy.GetFieldData().Initialize()
        self.assertIn("Ultrasound Probe", self.refused(copy))
        self.assertIn("FrameTimeMs is -1", self.refused(self.chain.converter.GetOutputPort(1), FrameTimeMs=-1))

    def test_where_nothing_can_be_written(self):
        port = self.chain.converter.GetOutputPort(1)
        name = "no folder/Bild.dcm"
        self.assertIn(str(self.folder / name), self.refused(port, name))
        writer = vtkSonoDicomWriter()
        writer.SetInputConnection(port)
        said = listen(writer)
        writer.Write()
        self.assertIn("FileName", said[0])

    def limited(self, size, then):
        """The program below, whose files may have so many bytes: what a full disk does to it."""
        program = f"""
import resource, signal, sys
sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r})
from TestDicom import *
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
chain = Chain()
sweep = sweep_of(chain, 3)
sweep.Update()
writer = make(vtkSonoDicomWriter, FileName=sys.argv[1])
writer.SetInputConnection(sweep.GetOutputPort())
said = listen(writer)
resource.setrlimit(resource.RLIMIT_FSIZE, ({size}, {size}))
{then}
writer.Write()
print(len(said), *said)
"""
        return subprocess.run([sys.executable, "-c", program, str(self.folder / "a.dcm")],
                              capture_output=True, text=True)

    def test_a_full_disk(self):
        result = self.limited(20000, "")
        self.assertRegex(result.stdout, r"(?m)^1 cannot write '.*a.dcm'.* disk is full")
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_killed_while_writing(self):
        kill = "import os; writer.AddObserver('ProgressEvent', lambda *_: os.kill(os.getpid(), 9 * (writer.GetProgress() > 0.5)))"
        result = self.limited("resource.RLIM_INFINITY", kill)
        self.assertEqual(result.returncode, -signal.SIGKILL)
        self.assertEqual([path.suffix for path in self.folder.iterdir()], [".part"])


if __name__ == "__main__":
    unittest.main()
