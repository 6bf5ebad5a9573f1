"""Channel data: PyMUST computes the same signals; files are read back, and beamformed they give our picture's speckle."""
import pathlib
import tempfile
import unittest

import h5py
import numpy as np
import peers
from chain import Chain, listen, make, write_labels
from sonovdb.vtkSonoFilters import (vtkSonoChannelData, vtkSonoImageFormation, vtkSonoLabelMapReader, vtkSonoLineWriter,
                                    vtkSonoProbeSource, vtkSonoRayTracer, vtkSonoSceneBuilder)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData

SPEED = 1.54  # mm/us

SIMUS = """
import sys
import numpy as np
np.concat = getattr(np, "concat", np.concatenate)  # of NumPy 2
import pymust
given = np.load(sys.argv[1])
param = pymust.utils.Param()
for name in ("fc", "bandwidth", "pitch", "width", "kerf", "c", "fs", "radius", "height", "focus"):
    param[name] = float(given[name])
param.Nelements = int(given["elements"])
options = pymust.utils.Options()
options.FullFrequencyDirectivity = True
options.FrequencyStep = float(given["step"])
f = np.linspace(0, 2 * param.fc, 4001)
spectrum = param.getPulseSpectrumFunction()(2 * np.pi * f) * param.getProbeFunction()(2 * np.pi * f) ** 2
t = np.arange(-500, 501) * 8e-9 * 3e6 / param.fc
pulse = (spectrum * np.exp(-2j * np.pi * t[:, None] * f)).real.sum(axis=1)
rf = []
for delays in given["delays"]:
    places = [1e-3 * given[axis][None] for axis in ("xz" if given["flat"] else "xyz")]
    rf.append(pymust.simus(*places, given["amplitude"][None], 1e-6 * delays[None], param.copy(), options)[0].T)
longest = max(len(signals[0]) for signals in rf)  # each record is as long as its delays want
rf = [np.pad(signals, ((0, 0), (0, longest - signals.shape[1]))) for signals in rf]
np.savez(sys.argv[2], rf=np.array(rf), t=1e6 * t, pulse=pulse / abs(pulse).max())
"""

DASMTX = """
import sys
import numpy as np
np.concat = getattr(np, "concat", np.concatenate)  # of NumPy 2
import pymust
given = np.load(sys.argv[1])
param = pymust.utils.Param()
param.fc, param.fs, param.pitch = float(given["fc"]), float(given["fs"]), float(given["pitch"])
param.c, param.radius, param.fnumber = 1540, np.inf, 0
param.Nelements = given["iq"].shape[2]
x, z = 1e-3 * given["x"], 1e-3 * given["z"]
summed = 0
for iq, delays in zip(given["iq"], given["delays"]):
    summed = summed + pymust.dasmtx(iq, x, z, 1e-6 * delays[None], param.copy()) @ iq.ravel(order="F")
np.save(sys.argv[2], summed.reshape(x.shape, order="F"))
"""

READ_BY_ZEA = """
import sys
import numpy as np
from zea import File
with File(sys.argv[1]) as file:
    spec = file.validate_spec()
    np.savez(sys.argv[2], rf=file.data.raw_data[0, ..., 0], delays=spec.scan.t0_delays,
             elements=spec.probe.probe_geometry, focus=spec.scan.focus_distances)
"""


READ_BY_PYUFF = """
import sys
import numpy as np
import pyuff_ustb
data = pyuff_ustb.Uff(sys.argv[1]).read("channel_data")
np.savez(sys.argv[2], rf=data.data[..., 0], counts=[data.N_waves, data.N_elements], source=data.sequence[1].source.z,
         time=data.initial_time)
"""


def cloud(places, amplitude):
    """Scatterers as points with amplitudes."""
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(places, dtype=float), deep=True))
    data = vtkPolyData()
    data.SetPoints(points)
    array = numpy_to_vtk(np.asarray(amplitude, dtype=float), deep=True)
    array.SetName("Amplitude")
    data.GetPointData().AddArray(array)
    return data


PHASED = dict(ScanKind=1, SectorDeg=75.0, CentreFrequencyMHz=2.72, FractionalBandwidth=0.74, ApertureMm=19.2,
              ElementWidthMm=0.25, ElevationApertureMm=14.0, ElevationFocusMm=60.0, DepthMm=80.0)
LINEAR = dict(ScanKind=0, WidthMm=38.13, CentreFrequencyMHz=7.6, FractionalBandwidth=0.77, ApertureMm=10.0,
              ElementWidthMm=0.27, ElevationApertureMm=5.0, ElevationFocusMm=18.0, DepthMm=50.0)
ELEMENTS = {1: 64, 0: 128}


def probe_of(**settings):
    return make(vtkSonoProbeSource, PositionMm=(0, 0, 0), Axial=(0, 0, 1), Lateral=(1, 0, 0), **settings)


class Channels:
    """The output of the filter."""

    def __init__(self, algorithm):
        algorithm.Update()
        self.image = algorithm.GetOutput()
        size = self.image.GetDimensions()
        self.rf = vtk_to_numpy(self.image.GetPointData().GetArray("RF")).reshape(size[::-1])
        self.sampling = 1 / self.image.GetSpacing()[0]

    def field(self, name):
        return vtk_to_numpy(self.image.GetFieldData().GetArray(name))


def of_points(probe, places, amplitude, **settings):
    channels = make(vtkSonoChannelData, **settings)
    channels.SetInputConnection(probe.GetOutputPort())
    channels.SetInputDataObject(1, cloud(places, amplitude))
    return channels


class FolderCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


@peers.needs("pymust")
class TestPyMust(FolderCase):
    def compare(self, array, places, amplitude, flat=True, step=1.0, **settings):
        """The rms difference of ours and simus's, of simus's, but for a factor of each transmit: simus's scale goes with
        its step of frequencies, which the delays decide."""
        probe = probe_of(**array)
        elements = ELEMENTS[array["ScanKind"]]
        ours = of_points(probe, places, amplitude, Flat=flat, ElementCount=elements, **settings)
        delays = Channels(ours).field("TransmitDelaysUs")
        width, face = array["ElementWidthMm"], 19.2 if array["ScanKind"] else 38.4
        pitch = face / elements
        np.savez(self.folder / "given.npz", fc=1e6 * array["CentreFrequencyMHz"],
                 bandwidth=100 * array["FractionalBandwidth"], pitch=1e-3 * pitch, width=1e-3 * width,
                 kerf=1e-3 * (pitch - width), c=1e3 * SPEED, fs=4e6 * array["CentreFrequencyMHz"], radius=np.inf,
                 height=1e-3 * array["ElevationApertureMm"], focus=1e-3 * array["ElevationFocusMm"], elements=elements,
                 step=step, delays=delays, flat=flat, x=places[:, 0], y=places[:, 1], z=places[:, 2],
                 amplitude=amplitude)
        peers.run(SIMUS, self.folder / "given.npz", self.folder / "made.npz")
        made = np.load(self.folder / "made.npz")
        pulse = self.folder / "pulse.csv"
        np.savetxt(pulse, np.stack([made["t"], made["pulse"]], axis=1), delimiter=",", header="time_us,amplitude",
                   comments="")
        ours.SetPulseFileName(str(pulse))
        rf = Channels(ours).rf
        count = min(rf.shape[-1], made["rf"].shape[-1])
        error, all_of_it = 0.0, 0.0
        for a, b in zip(rf[..., :count].astype(float), made["rf"][..., :count].astype(float)):
            scaled = b / np.linalg.norm(b)
            error += np.linalg.norm(scaled - a * (np.vdot(a, scaled) / np.vdot(a, a))) ** 2
            all_of_it += 1
        found = np.sqrt(error / all_of_it)
        print(f"{self.id()}: {100 * found:.3f} %")
        return found

    def test_three_points(self):
        for array, places in ((PHASED, [[0, 0, 30], [8, 0, 50], [-6, 0, 70]]),
                              (LINEAR, [[0, 0, 15], [8, 0, 30], [-12, 0, 40]])):
            for kind in (vtkSonoChannelData.PLANE_WAVES, vtkSonoChannelData.DIVERGING_WAVES,
                         vtkSonoChannelData.FOCUSED_WAVES):
                found = self.compare(array, np.array(places, dtype=float), np.array([1.0, 2.0, 3.0]), TransmitKind=kind,
                                     TransmitCount=3, TransmitSpanDeg=24.0)
                self.assertLess(found, 0.02)

    def test_a_cyst(self):
        random = np.random.default_rng(1)
        for array, depth, radius in ((PHASED, 50.0, 6.0), (LINEAR, 25.0, 4.0)):
            places = np.stack([random.uniform(-15, 15, 4000), np.zeros(4000),
                               random.uniform(depth - 15, depth + 15, 4000)], axis=1)
            places = places[np.hypot(places[:, 0], places[:, 2] - depth) > radius]
            amplitude = random.normal(size=len(places))
            self.assertLess(self.compare(array, places, amplitude, TransmitCount=2, TransmitSpanDeg=10.0), 0.02)

    def test_a_lens(self):
        """In the image plane, where simus counts the way across it once; its own lens is the same over 20 of its
        frequencies, which its step makes few."""
        for array, places in ((PHASED, [[0, 1e-3, 40], [8, 1e-3, 50], [-6, 1e-3, 70]]),
                              (LINEAR, [[0, 1e-3, 15], [8, 1e-3, 30], [-12, 1e-3, 40]])):
            found = self.compare(array, np.array(places), np.ones(3), flat=False, step=0.1, TransmitCount=2,
                                 TransmitSpanDeg=10.0)
            self.assertLess(found, 0.02)


def analytic_of(rf):
    spectrum = np.fft.fft(rf, axis=-1)
    spectrum[..., rf.shape[-1] // 2:] = 0
    return 2 * np.fft.ifft(spectrum, axis=-1)


def delay_and_sum(channels, x, z, carrier_mhz):
    """The analytic signals of plane waves and elements, each at the time of a place, summed."""
    analytic, fs = analytic_of(channels.rf), channels.sampling
    count = analytic.shape[-1]
    elements = channels.field("ElementPositionsMm")
    pass_us = channels.field("PassUs")[0]
    out = np.zeros(x.shape, dtype=complex)
    receive = np.hypot(x[..., None] - elements[:, 0], z[..., None]) / SPEED
    carrier = 2 * np.pi * carrier_mhz
    for t, angle in enumerate(channels.field("TransmitAnglesRad")):
        time = pass_us + (x * np.sin(angle) + z * np.cos(angle)) / SPEED
        for n in range(len(elements)):
            place = (time + receive[..., n]) * fs
            first = np.clip(place.astype(int), 0, count - 2)
            share = place - first
            # Between samples of the demodulated signal.
            signal = analytic[t, n]
            a = signal[first] * np.exp(-1j * carrier * first / fs)
            b = signal[first + 1] * np.exp(-1j * carrier * (first + 1) / fs)
            out += ((1 - share) * a + share * b) * np.exp(1j * carrier * place / fs)
    return out


def width(correlation, step):
    """Where a correlation, from shift 0 on, falls to half, times 2."""
    c = np.abs(correlation) / np.abs(correlation[0])
    k = int(np.argmax(c < 0.5))
    return 2 * step * (k - 1 + (c[k - 1] - 0.5) / (c[k - 1] - c[k]))


def speckle_widths(iq, angle_step, depth_step, depth):
    """Lateral and axial width of the autocorrelation of lines x samples, in mm."""
    lateral = [np.vdot(iq[:len(iq) - k], iq[k:]) / (len(iq) - k) for k in range(len(iq) // 2)]
    samples = iq.shape[1]
    axial = [np.vdot(iq[:, :samples - k], iq[:, k:]) / (samples - k) for k in range(samples // 2)]
    return width(np.array(lateral), angle_step * depth), width(np.array(axial), depth_step)


class TestScene(FolderCase):
    @classmethod
    def setUpClass(cls):
        cls.chain = Chain()
        cls.chain.tracer.Update()

    def channels_of(self, **settings):
        channels = make(vtkSonoChannelData, ScatterersPerCell=1, **settings)
        channels.SetInputConnection(self.chain.tracer.GetOutputPort())
        return channels

    def written(self, name, algorithm):
        path = self.folder / name
        writer = make(vtkSonoLineWriter, FileName=str(path))
        writer.SetInputConnection(algorithm.GetOutputPort())
        said = listen(writer)
        writer.Write()
        self.assertEqual(said, [])
        return path

    def test_files_hold_signals_delays_and_elements(self):
        for kind, sign in ((vtkSonoChannelData.PLANE_WAVES, np.inf), (vtkSonoChannelData.DIVERGING_WAVES, -1),
                           (vtkSonoChannelData.FOCUSED_WAVES, 1)):
            algorithm = self.channels_of(TransmitKind=kind, TransmitCount=3, TransmitSpanDeg=20.0, ElementCount=16)
            channels = Channels(algorithm)
            self.assertGreater(np.abs(channels.rf).max(), 0)
            distance = 1e-3 * channels.field("TransmitDistanceMm")[0]
            with h5py.File(self.written("Herz für zea.hdf5", algorithm)) as file:
                raw = file["tracks/track_0/data/raw_data"]
                scan = file["tracks/track_0/scan"]
                np.testing.assert_array_equal(raw[0, ..., 0], np.swapaxes(channels.rf, 1, 2))
                np.testing.assert_allclose(scan["t0_delays"], 1e-6 * channels.field("TransmitDelaysUs"), atol=1e-12)
                np.testing.assert_allclose(file["probe/probe_geometry"], 1e-3 * channels.field("ElementPositionsMm"),
                                           atol=1e-8)
                self.assertAlmostEqual(scan["sampling_frequency"][()] / (1e6 * channels.sampling), 1, places=6)
                np.testing.assert_allclose(np.degrees(scan["polar_angles"]), [-10, 0, 10], atol=1e-5)
                expected = np.inf if np.isinf(sign) else sign * distance
                np.testing.assert_allclose(scan["focus_distances"], np.full(3, expected), rtol=1e-6)
            with h5py.File(self.written("Herz für USTB.uff", algorithm)) as file:
                data = file["channel_data"]
                np.testing.assert_array_equal(data["data"][0], channels.rf)
                self.assertEqual(data.attrs["class"], "uff.channel_data")
                self.assertAlmostEqual(data["initial_time"][0, 0], -1e-6 * channels.field("PassUs")[0], delta=1e-12)
                self.assertEqual(sorted(data["sequence"]), [f"sequence_000{n}" for n in (1, 2, 3)])
                source = data["sequence/sequence_0003/source"]
                angle = np.radians(10) + (np.pi if sign == -1 else 0)
                self.assertAlmostEqual(source["azimuth"][0, 0], angle, places=6)

    @peers.needs("zea")
    def test_zea_reads_them(self):
        algorithm = self.channels_of(TransmitCount=2, ElementCount=8)
        peers.run(READ_BY_ZEA, self.written("a.hdf5", algorithm), self.folder / "read.npz")
        read = np.load(self.folder / "read.npz")
        np.testing.assert_array_equal(read["rf"], np.swapaxes(Channels(algorithm).rf, 1, 2))

    @peers.needs("pyuff_ustb")
    def test_pyuff_reads_them(self):
        algorithm = self.channels_of(TransmitCount=2, TransmitKind=vtkSonoChannelData.DIVERGING_WAVES, ElementCount=8)
        channels = Channels(algorithm)
        peers.run(READ_BY_PYUFF, self.written("a.uff", algorithm), self.folder / "read.npz")
        with np.load(self.folder / "read.npz") as read:
            np.testing.assert_array_equal(read["rf"], np.transpose(channels.rf, (2, 1, 0)))
            self.assertEqual(list(read["counts"]), [2, 8])
            self.assertLess(read["source"], 0)
            self.assertAlmostEqual(float(read["time"]), -1e-6 * channels.field("PassUs")[0], delta=1e-12)

    def test_bad_input_gets_one_sentence(self):
        def sentence(algorithm):
            said = listen(algorithm)
            algorithm.Update()
            self.assertEqual(len(said), 1, said)
            return said[0]
        self.assertIn("500 elements", sentence(self.channels_of(ElementCount=500)))
        self.assertIn("transmitCount is 0", sentence(self.channels_of(TransmitCount=0)))
        alone = make(vtkSonoChannelData)
        alone.SetInputConnection(self.chain.probe.GetOutputPort())
        self.assertIn("nothing to hear", sentence(alone))
        other = make(vtkSonoChannelData)
        other.SetInputDataObject(vtkImageData())
        self.assertIn("Ultrasound Probe", sentence(other))


class TestSpeckle(FolderCase):
    """A cloud of points in gel, 20 a resolution cell: our lines with the computed beam focused at a depth, and the
    channels of 25 plane waves, which together focus there."""
    DEPTH, SPAN, STEP = 60.0, 12.0, 0.05
    ANGLES = np.radians(np.linspace(-9, 9, 73))

    def setUp(self):
        super().setUp()
        folder = self.folder / "gel"
        folder.mkdir()
        path = write_labels(folder / "gel.vti", np.full((90, 30, 60), 1, np.uint16))
        (folder / "labels.csv").write_text("id,name\n1,gel\n")
        reader = make(vtkSonoLabelMapReader)
        reader.AddFileName(path)
        scene = make(vtkSonoSceneBuilder, BuildSurfaces=False)
        scene.SetInputConnection(reader.GetOutputPort())
        array = dict(PHASED, LineCount=73, SectorDeg=18.0, DepthMm=75.0, TransmitFocusMm=self.DEPTH)
        place = np.array([30.0, 15.0, 0.0])
        self.carrier = array["CentreFrequencyMHz"]
        probe = make(vtkSonoProbeSource, PositionMm=tuple(place), Axial=(0, 0, 1), Lateral=(1, 0, 0), **array)
        self.tracer = make(vtkSonoRayTracer, PathsPerLine=10)
        self.tracer.SetInputConnection(0, scene.GetOutputPort())
        self.tracer.SetInputConnection(1, probe.GetOutputPort())
        random = np.random.default_rng(5)
        count = 9000
        places = np.stack([random.uniform(-12, 12, count), np.zeros(count),
                           random.uniform(self.DEPTH - 9, self.DEPTH + 9, count)], axis=1)
        self.points = cloud(places + place, random.normal(size=count))

    def lines(self):
        formation = make(vtkSonoImageFormation, Beam=vtkSonoImageFormation.COMPUTED_BEAM)
        formation.SetInputConnection(self.tracer.GetOutputPort())
        formation.SetInputDataObject(1, self.points)
        formation.Update()
        image = formation.GetOutput()
        size = image.GetDimensions()
        parts = vtk_to_numpy(image.GetPointData().GetArray("IQ")).reshape(size[1], size[0], 2)
        step = image.GetSpacing()[0]
        first, last = (int((self.DEPTH + side * self.SPAN / 2) / step) for side in (-1, 1))
        return (parts[:, first:last, 0] + 1j * parts[:, first:last, 1]), step

    def channels(self):
        algorithm = make(vtkSonoChannelData, TransmitCount=25, TransmitSpanDeg=18.0)
        algorithm.SetInputConnection(self.tracer.GetOutputPort())
        algorithm.SetInputDataObject(1, self.points)
        return Channels(algorithm)

    def places(self):
        depths = np.arange(self.DEPTH - self.SPAN / 2, self.DEPTH + self.SPAN / 2, self.STEP)
        return np.sin(self.ANGLES)[:, None] * depths, np.cos(self.ANGLES)[:, None] * depths

    def beamformed(self):
        return delay_and_sum(self.channels(), *self.places(), self.carrier)

    def check_widths(self, beamformed):
        lines, step = self.lines()
        turn = self.ANGLES[1] - self.ANGLES[0]
        ours = speckle_widths(lines, turn, step, self.DEPTH)
        found = speckle_widths(beamformed, turn, self.STEP, self.DEPTH)
        print(f"lateral {found[0]:.3f} and {ours[0]:.3f} mm, axial {found[1]:.4f} and {ours[1]:.4f} mm")
        self.assertLess(abs(found[0] / ours[0] - 1), 0.1)
        self.assertLess(abs(found[1] / ours[1] - 1), 0.1)

    def test_beamformed_speckle_is_as_wide_as_the_picture_s(self):
        self.check_widths(self.beamformed())

    @peers.needs("pymust")
    def test_beamformed_by_pymust_it_is_as_wide(self):
        channels = self.channels()
        samples = np.arange(channels.rf.shape[-1]) / channels.sampling
        iq = analytic_of(channels.rf) * np.exp(-2j * np.pi * self.carrier * samples)
        x, z = self.places()
        np.savez(self.folder / "given.npz", iq=np.swapaxes(iq, 1, 2), delays=channels.field("TransmitDelaysUs"), x=x,
                 z=z, fc=1e6 * self.carrier, fs=1e6 * channels.sampling, pitch=1e-3 * PHASED["ApertureMm"] / 64)
        peers.run(DASMTX, self.folder / "given.npz", self.folder / "made.npy")
        self.check_widths(np.load(self.folder / "made.npy"))

    def test_beamformed_it_lies_where_the_picture_has_it(self):
        """Envelopes of the same points go up and down together, most where nothing is shifted."""
        lines, step = self.lines()
        beamformed = np.abs(self.beamformed())
        depths = self.DEPTH - self.SPAN / 2 + self.STEP * np.arange(beamformed.shape[1])
        shown = (int((self.DEPTH - self.SPAN / 2) / step) + np.arange(lines.shape[1])) * step

        def correlation(deeper, lines_over):
            envelope = np.array([np.interp(depths + deeper, shown, np.abs(line)) for line in lines])
            inner = slice(2, -2)
            return np.corrcoef(np.roll(envelope, lines_over, axis=0)[inner].ravel(), beamformed[inner].ravel())[0, 1]

        def peak(before, here, behind):
            return 0.5 * (before - behind) / (before - 2 * here + behind)

        here = correlation(0, 0)
        deeper = 0.05 * peak(correlation(-0.05, 0), here, correlation(0.05, 0))
        aside = peak(correlation(0, -1), here, correlation(0, 1))
        print(f"correlation of envelopes {here:.3f}, shifted by {deeper:.4f} mm and {aside:.3f} lines")
        self.assertLess(abs(deeper), 0.02)
        self.assertLess(abs(aside), 0.2)  # of 0.25 degrees


if __name__ == "__main__":
    unittest.main()
