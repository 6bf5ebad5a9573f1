"""Foreign readers find in zea's and USTB's files the lines, their places and the probe that they came from."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np
import peers
from chain import Chain, listen, make
from sonovdb.vtkSonoFilters import (vtkSonoBMode, vtkSonoLineWriter, vtkSonoProbeSource, vtkSonoThoraxSource,
                                    vtkSonoUltrasound)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkPassThrough

# Files are read and B-mode is made by zea alone.
READ_BY_ZEA = """
import sys
import numpy as np
from zea import File
from zea.ops import EnvelopeDetect, LogCompress
with File(sys.argv[1]) as file:
    spec = file.validate_spec()
    data = file.data.beamformed_data
    values = np.asarray(data.values[:1])
    envelope = EnvelopeDetect()(data=values)["data"]
    decibels = LogCompress(clip=False)(data=envelope)["data"]
    np.savez(sys.argv[2], iq=values[0, ..., 0] + 1j * values[0, ..., 1], decibels=np.asarray(decibels)[0],
             speed=spec.scan.sound_speed, elements=len(spec.probe.probe_geometry))
"""

READ_BY_PYMUST = """
import sys
import h5py
import numpy as np
import pymust
with h5py.File(sys.argv[1]) as file:
    values = file["tracks/track_0/data/beamformed_data/values"][0]
np.save(sys.argv[2], pymust.bmode(values[..., 0] + 1j * values[..., 1], 60))
"""

READ_BY_PYUFF = """
import sys
import numpy as np
import pyuff_ustb
data = pyuff_ustb.Uff(sys.argv[1]).read("b_data")
np.savez(sys.argv[2], iq=np.squeeze(data.data), places=data.scan.xyz, modulation=data.modulation_frequency,
         elements=data.probe.N_elements)
"""


def iq_of(lines):
    """Lines x samples."""
    samples, count, _ = lines.GetDimensions()
    parts = vtk_to_numpy(lines.GetPointData().GetArray("IQ")).reshape(count, samples, 2)
    return parts[..., 0] + 1j * parts[..., 1]


class LineCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.chain = Chain()
        cls.chain.formation.Update()
        cls.lines = cls.chain.formation.GetOutput()
        cls.iq = iq_of(cls.lines)

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, port=None, **settings):
        """Writes lines; the file's path and what the writer said."""
        path = self.folder / name
        writer = make(vtkSonoLineWriter, FileName=str(path), **settings)
        port = port or self.chain.formation.GetOutputPort()
        writer.SetInputDataObject(port) if isinstance(port, vtkImageData) else writer.SetInputConnection(port)
        said = listen(writer)
        self.assertEqual(writer.Write() == 0, bool(said))
        self.assertEqual(list(self.folder.glob("*.part")), [])
        return path, said

    def written(self, *arguments, **settings):
        path, said = self.write(*arguments, **settings)
        self.assertEqual(said, [])
        return path

    def places(self):
        """Of 12 lines of a sector of 60 degrees, lines x samples x 3, in m."""
        angles = np.radians(-30 + 60 / 11 * np.arange(12))[:, None]
        depth = 1e-3 * self.lines.GetSpacing()[0] * np.arange(self.iq.shape[1])
        return np.stack([depth * np.sin(angles), 0 * depth * angles, depth * np.cos(angles)], axis=-1)

    def focus_of(self, delays, weights, elements, speed):
        """The depth on the axis where the waves of all elements are at once, in m: by search."""
        depths = np.linspace(0.03, 0.12, 9001)
        ways = np.hypot(elements[:, 0][:, None], depths - elements[:, 2][:, None])
        times = (delays[:, None] + ways / speed)[weights > 0]
        return depths[np.argmin(np.ptp(times, axis=0))]


class TestZea(LineCase):
    def test_it_holds_the_lines_and_their_places(self):
        with h5py.File(self.written("Herz für zea.hdf5")) as file:
            data = file["tracks/track_0/data/beamformed_data"]
            self.assertEqual(data["values"].shape, (1, self.iq.shape[1], 12, 2))
            np.testing.assert_array_equal(data["values"][0, ..., 0] + 1j * data["values"][0, ..., 1], self.iq.T)
            np.testing.assert_allclose(data["coordinates"], np.moveaxis(self.places(), 0, 1), atol=1e-8)
            self.assertEqual([label.decode() for label in data["labels"]], ["I", "Q"])
            self.assertIn("imulated", file.attrs["us_machine"] + file.attrs["description"])

    def test_elements_send_the_lines(self):
        with h5py.File(self.written("probe.hdf5")) as file:
            scan, probe = file["tracks/track_0/scan"], file["probe"]
            elements = probe["probe_geometry"][:]
            width = probe["element_width"][()]
            self.assertAlmostEqual(1e3 * width, self.chain.probe.GetElementWidthMm(), places=5)
            aperture = 1e3 * (np.ptp(elements[:, 0]) + width)
            self.assertAlmostEqual(aperture, self.chain.probe.GetApertureMm(), delta=1e3 * width)
            np.testing.assert_allclose(np.degrees(scan["polar_angles"]), -30 + 60 / 11 * np.arange(12), atol=1e-4)
            speed = scan["sound_speed"][()]
            self.assertEqual(speed, 1540)
            step = 1e-3 * self.lines.GetSpacing()[0]
            self.assertAlmostEqual(scan["sampling_frequency"][()] * 2 * step, speed, delta=0.01)
            self.assertEqual(scan["demodulation_frequency"][()], 1e6 * self.chain.probe.GetCentreFrequencyMHz())
            self.assertEqual(scan["t0_delays"][:].min(), 0)
        # The line straight ahead of a probe with one: what its delays focus on.
        straight = make(vtkSonoProbeSource, LineCount=1, DepthMm=90.0)
        self.chain.tracer.SetInputConnection(1, straight.GetOutputPort())
        self.addCleanup(self.chain.tracer.SetInputConnection, 1, self.chain.probe.GetOutputPort())
        with h5py.File(self.written("straight.hdf5")) as file:
            scan = file["tracks/track_0/scan"]
            found = self.focus_of(scan["t0_delays"][0], scan["tx_apodizations"][0], elements, speed)
            self.assertAlmostEqual(1e3 * found, straight.GetTransmitFocusMm(), delta=0.1)
            middle = scan["initial_times"][0]  # the wave passes the face's middle then
            self.assertAlmostEqual(middle, scan["t0_delays"][0].max(), delta=1e-9)

    def test_the_pose_is_the_probe_s(self):
        with h5py.File(self.written("pose.hdf5")) as file:
            pose = file["metadata/probe_pose"]
            w, x, y, z = pose["rotation"][0]
            position = 1e-3 * np.array(self.chain.probe.GetPositionMm())
            np.testing.assert_allclose(pose["translation"][0], position, atol=1e-7)
        self.assertAlmostEqual(w * w + x * x + y * y + z * z, 1, places=6)
        axial = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])  # of (0, 0, 1)
        lateral = np.array([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)])  # of (1, 0, 0)
        for found, wanted in ((axial, self.lines.GetFieldData().GetArray("ProbeAxial")),
                              (lateral, self.lines.GetFieldData().GetArray("ProbeLateral"))):
            np.testing.assert_allclose(found, wanted.GetTuple3(0), atol=1e-6)

    def test_each_time_step_is_a_frame(self):
        thorax = make(vtkSonoThoraxSource, SpacingMm=4.0, Phases=3)
        ultrasound = make(vtkSonoUltrasound, PathsPerLine=5, LineCount=6)
        ultrasound.SetInputConnection(thorax.GetOutputPort())
        for part in ("PositionMm", "Axial", "Lateral"):
            getattr(ultrasound.GetProbe(), "Set" + part)(getattr(self.chain.probe, "Get" + part)())
        with h5py.File(self.written("cine.hdf5", ultrasound.GetOutputPort(ultrasound.RF_LINES))) as file:
            data = file["tracks/track_0/data/beamformed_data"]
            np.testing.assert_allclose(data["timestamps"], [0, 1 / 3, 2 / 3], atol=1e-6)
            reader = vtkPassThrough()
            reader.SetInputConnection(ultrasound.GetOutputPort(ultrasound.RF_LINES))
            for n in (0, 2):
                reader.UpdateTimeStep(n / 3)
                iq = iq_of(reader.GetOutput())
                np.testing.assert_array_equal(data["values"][n, ..., 0], iq.real.T)

    def compare(self, decibels, greys=0.0):
        """Their B-mode (samples x lines, dB) is ours, above -50 dB and but for the gain; without TGC, noise, smoothing
        or a grey map. `greys` is a step of theirs, which is rounded off."""
        bmode = make(vtkSonoBMode, DynamicRangeDb=100.0, TgcDbPerCm=0.0, GainDb=-20.0)
        bmode.SetInputConnection(self.chain.formation.GetOutputPort())
        bmode.Update()
        ours = vtk_to_numpy(bmode.GetOutput().GetPointData().GetArray("BMode")).reshape(self.iq.shape).T
        self.assertLess(ours.max(), 1)
        shown = decibels > decibels.max() - 50
        self.assertGreater(shown.sum(), 10000)
        difference = 100 * (ours[shown] - ours.max()) - (decibels[shown] + 0.5 * greys - decibels.max())
        self.assertLess(np.abs(difference).max(), 0.5)

    @peers.needs("zea")
    def test_zea_makes_our_picture(self):
        peers.run(READ_BY_ZEA, self.written("a.hdf5"), self.folder / "read.npz")
        read = np.load(self.folder / "read.npz")
        np.testing.assert_array_equal(read["iq"], self.iq.T)
        self.assertEqual((float(read["speed"]), int(read["elements"])), (1540, 64))
        self.compare(read["decibels"])

    @peers.needs("pymust")
    def test_pymust_makes_our_picture(self):
        peers.run(READ_BY_PYMUST, self.written("a.hdf5"), self.folder / "read.npy")
        step = 60 / 255
        self.compare(step * np.load(self.folder / "read.npy").astype(float), step)


class TestUff(LineCase):
    def test_it_holds_the_lines_and_their_places(self):
        """As MATLAB has them, which names the fastest axis first."""
        with h5py.File(self.written("Herz für USTB.uff")) as file:
            data = file["b_data"]
            self.assertEqual(data.attrs["class"], "uff.beamformed_data")
            self.assertEqual(data["data/real"].shape, (1, 1, 1, self.iq.size))
            np.testing.assert_array_equal(data["data/real"][0, 0, 0] + 1j * data["data/imag"][0, 0, 0], self.iq.ravel())
            found = np.stack([data["scan"][axis][:] for axis in "xyz"], axis=-1)
            np.testing.assert_allclose(found, self.places().reshape(-1, 3), atol=1e-8)
            self.assertEqual("".join(map(chr, data["info"][:, 0])),
                             "Simulated from labelled anatomy; nobody was scanned.")

    @peers.needs("pyuff_ustb")
    def test_pyuff_reads_it(self):
        peers.run(READ_BY_PYUFF, self.written("a.uff"), self.folder / "read.npz")
        read = np.load(self.folder / "read.npz")
        np.testing.assert_array_equal(read["iq"], self.iq.ravel())
        np.testing.assert_allclose(read["places"], self.places().reshape(-1, 3), atol=1e-8)
        self.assertEqual((float(read["modulation"]), int(read["elements"])),
                         (1e6 * self.chain.probe.GetCentreFrequencyMHz(), 64))


class TestRefusals(LineCase):
    def refused(self, *arguments, **settings):
        path, said = self.write(*arguments, **settings)
        self.assertEqual(len(said), 1, said)
        self.assertFalse(path.exists())
        return said[0]

    def test_one_sentence_each(self):
        self.assertIn(".hdf5 (zea)", self.refused("lines.csv"))
        name = "no folder/lines.uff"
        self.assertIn(str(self.folder / name), self.refused(name))
        self.assertIn("FrameTimeMs is -1", self.refused("lines.uff", FrameTimeMs=-1))
        copy = vtkImageData()
        copy.DeepCopy(self.lines)
        copy.GetPointData().RemoveArray("IQ")
        self.assertIn("'IQ'", self.refused("lines.hdf5", copy))
        copy.GetFieldData().Initialize()
        self.assertIn("Ultrasound Probe", self.refused("lines.hdf5", copy))

    def test_a_full_disk(self):
        program = f"""
import resource, signal, sys
sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r})
from TestLines import *
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
chain = Chain()
chain.formation.Update()
writer = make(vtkSonoLineWriter, FileName=sys.argv[1])
writer.SetInputConnection(chain.formation.GetOutputPort())
said = listen(writer)
resource.setrlimit(resource.RLIMIT_FSIZE, (200000, 200000))
writer.Write()
print(len(said), *said)
"""
        for name in ("a.hdf5", "a.uff"):
            result = subprocess.run([sys.executable, "-c", program, str(self.folder / name)],
                                    capture_output=True, text=True)
            self.assertRegex(result.stdout, rf"(?m)^1 cannot write '.*{name}'.* disk is full")
            self.assertEqual((list(self.folder.iterdir()), result.returncode), ([], 0))


if __name__ == "__main__":
    unittest.main()
