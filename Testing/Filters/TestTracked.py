"""Tracked sequences of PLUS: what is written is read by others, and poses that others recorded drive the probe."""
import pathlib
import tempfile
import unittest

import numpy as np
from TestDicom import greys_of, sweep_of
from chain import Chain, listen, make
from sonovdb.vtkSonoFilters import vtkSonoSweep, vtkSonoTrackedReader, vtkSonoTrackedWriter
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkMetaImageReader, vtkNrrdReader

RECORDED = pathlib.Path(__file__).parents[2].parent / "shared/data/pluslib/BoneUltrasound_L14.igs.mha"


def rotation(axis, degrees):
    """By Rodrigues' formula."""
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    across = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(degrees)
    return np.eye(3) + np.sin(angle) * across + (1 - np.cos(angle)) * across @ across


def transform(turn, shift):
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, shift
    return matrix


def text(matrix):
    return " ".join(repr(float(number)) for number in np.ravel(matrix))


def entries(path, between):
    """The header's entries, as a person reads them."""
    lines = path.read_bytes().split(b"\nElementDataFile" if between == " = " else b"\n\n")[0].decode().splitlines()
    return dict(line.split(between, 1) for line in lines if between in line)


def poses_of(reader):
    """Positions, axial and lateral directions."""
    reader.Update()
    points = reader.GetOutput()
    return [np.array([points.GetPoint(n) for n in range(points.GetNumberOfPoints())])] + [
        vtk_to_numpy(points.GetPointData().GetArray(name)) for name in ("Axial", "Lateral")]


class TrackedCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


class TestWriting(TrackedCase):
    @classmethod
    def setUpClass(cls):
        cls.chain = Chain()
        cls.sweep = sweep_of(cls.chain, 3)
        cls.sweep.Update()

    def write(self, name, port=None, **settings):
        path = self.folder / name
        writer = make(vtkSonoTrackedWriter, FileName=str(path), **settings)
        writer.SetInputConnection(port or self.sweep.GetOutputPort())
        said = listen(writer)
        self.assertEqual(writer.Write() == 0, bool(said))
        self.assertEqual(list(self.folder.glob("*.part")), [])
        return path, said

    def test_others_find_the_pictures(self):
        for name, kind in (("Schwenk für PLUS.igs.mha", vtkMetaImageReader), ("Schwenk.igs.nrrd", vtkNrrdReader)):
            path, said = self.write(name)
            self.assertEqual(said, [])
            reader = kind()
            reader.SetFileName(str(path))
            reader.Update()
            width, height, count = reader.GetOutput().GetDimensions()
            pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).reshape(count, height, width)
            np.testing.assert_array_equal(pixels, greys_of(self.sweep.GetOutput()))

    def test_transforms_place_the_pixels(self):
        """By the header alone, of a pixel: where the sweep's own table of poses has it."""
        used = self.sweep.GetOutputDataObject(1)
        pose = {name: vtk_to_numpy(used.GetColumnByName(name)) for name in
                (part + axis for part in ("Position", "Axial", "Lateral") for axis in "XYZ")}
        for name, between in (("a.igs.mha", " = "), ("a.igs.nrrd", ":=")):
            said = entries(self.write(name, FrameTimeMs=50)[0], between)
            for n in range(3):
                begin = f"Seq_Frame{n:04d}_"
                to_probe, to_world = (np.array(said[begin + key].split(), float).reshape(4, 4)
                                      for key in ("ImageToProbeTransform", "ProbeToReferenceTransform"))
                column, row = 40, 120
                found = (to_world @ to_probe @ [column, row, 0, 1])[:3]
                origin, spacing = self.sweep.GetOutput().GetOrigin(), self.sweep.GetOutput().GetSpacing()
                position, axial, lateral = (np.array([pose[part + axis][n] for axis in "XYZ"])
                                            for part in ("Position", "Axial", "Lateral"))
                wanted = (position + (origin[0] + column * spacing[0]) * lateral
                          + (origin[1] + row * spacing[1]) * axial)
                np.testing.assert_allclose(found, wanted, atol=1e-5)
                self.assertAlmostEqual(np.linalg.det(to_world[:3, :3]), 1, places=6)
                self.assertAlmostEqual(float(said[begin + "Timestamp"]), 0.05 * n)

    def test_there_and_back(self):
        for name in ("a.igs.mha", "a.igs.nrrd"):
            reader = make(vtkSonoTrackedReader, FileName=str(self.write(name)[0]))
            position, axial, lateral = poses_of(reader)
            used = self.sweep.GetOutputDataObject(1)
            for part, found in (("Position", position), ("Axial", axial), ("Lateral", lateral)):
                for n, axis in enumerate("XYZ"):
                    np.testing.assert_allclose(found[:, n], vtk_to_numpy(used.GetColumnByName(part + axis)), atol=1e-6)
            again = make(vtkSonoSweep, PixelMm=0.5)
            again.GetRayTracer().SetPathsPerLine(10)
            for port in (0, 1):
                again.SetInputConnection(port, self.sweep.GetInputConnection(port, 0))
            again.SetInputConnection(2, reader.GetOutputPort())
            again.Update()
            difference = greys_of(again.GetOutput()).astype(int) - greys_of(self.sweep.GetOutput())
            self.assertLess(np.mean(np.abs(difference) > 1), 0.01)  # digits that a decimal number does not carry

    def test_a_still_image_has_the_probe_s_pose(self):
        path, said = self.write("still.igs.mha", self.chain.converter.GetOutputPort(1))
        self.assertEqual(said, [])
        position, axial, _ = poses_of(make(vtkSonoTrackedReader, FileName=str(path)))
        np.testing.assert_allclose(position, [self.chain.probe.GetPositionMm()], atol=1e-6)

    def test_refusals(self):
        for name, word in (("a.csv", ".igs.mha"), ("no folder/a.igs.mha", "no folder")):
            path, said = self.write(name)
            self.assertEqual(len(said), 1)
            self.assertIn(word, said[0])
            self.assertFalse(path.exists())


class TestReading(TrackedCase):
    """A probe that turns about z, seen by a tracker that is moved about as well."""

    TURNS = (0, 20, 40)
    TRACKER = transform(rotation((1, 2, 3), 70), (100, -50, 20))
    CALIBRATION = transform(rotation((0, 1, 1), 30), (3, 4, 5))  # ours to the marker on the probe
    REGISTRATION = transform(rotation((1, 0, 0), -25), (-7, 8, 9))

    def recorded(self, between=" = ", valid=(True, True, True), name="recorded.igs.mha"):
        probe = [transform(rotation((0, 0, 1), turn), (turn, 10, 5)) for turn in self.TURNS]
        head = ["ObjectType = Image", "NDims = 3", "DimSize = 2 2 3", "ElementType = MET_UCHAR"]
        if between == ":=":
            head = ["NRRD0004", "type: uchar", "dimension: 3", "sizes: 2 2 3", "encoding: raw"]
        for n, to_reference in enumerate(probe):
            moved = self.TRACKER @ transform(rotation((0, 1, 0), 5 * n), (n, 0, 0))  # the reference is not still
            head += [f"Seq_Frame{n:04d}_{key}{between}{value}" for key, value in (
                ("ProbeToTrackerTransform", text(moved @ to_reference)),
                ("ProbeToTrackerTransformStatus", "OK" if valid[n] else "INVALID"),
                ("ReferenceToTrackerTransform", text(moved)), ("ReferenceToTrackerTransformStatus", "OK"),
                ("Timestamp", str(10 + n / 8)))]
        path = self.folder / name
        end = "\nElementDataFile = LOCAL\n" if between == " = " else "\n\n"
        path.write_bytes(("\n".join(head) + end).encode() + bytes(range(12)))
        return path, probe

    def read(self, path, **settings):
        reader = make(vtkSonoTrackedReader, FileName=str(path))
        for name, matrix in settings.items():
            getattr(reader, "Set" + name)(np.ravel(matrix).tolist())
        return reader

    def test_poses_come_by_way_of_the_tracker(self):
        for between, name in ((" = ", "a.igs.mha"), (":=", "a.igs.nrrd")):
            path, probe = self.recorded(between, name=name)
            reader = self.read(path, Calibration=self.CALIBRATION, Registration=self.REGISTRATION)
            position, axial, lateral = poses_of(reader)
            for n, to_reference in enumerate(probe):
                pose = self.REGISTRATION @ to_reference @ self.CALIBRATION
                np.testing.assert_allclose(position[n], pose[:3, 3], atol=1e-9)
                np.testing.assert_allclose(axial[n], pose[:3, 1], atol=1e-9)
                np.testing.assert_allclose(lateral[n], pose[:3, 0], atol=1e-9)
            times = vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("TimeS"))
            np.testing.assert_array_equal(times, [10, 10.125, 10.25])

    def test_frames_that_were_not_seen(self):
        reader = self.read(self.recorded(valid=(True, False, True))[0])
        warned = listen(reader, "WarningEvent")
        position, _, _ = poses_of(reader)
        np.testing.assert_allclose(position, [[0, 10, 5], [40, 10, 5]], atol=1e-9)
        self.assertEqual(list(vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("Frame"))), [0, 2])
        self.assertIn("1 of 3 frames", warned[0])

    def refused(self, reader):
        said = listen(reader)
        reader.Update()
        self.assertEqual(len(said), 1, said)
        self.assertEqual(reader.GetOutput().GetNumberOfPoints(), 0)
        return said[0]

    def test_one_sentence_each(self):
        path, _ = self.recorded()
        reader = self.read(path)
        reader.SetTransform("StylusToTracker")
        self.assertIn("ProbeToTracker, ReferenceToTracker", self.refused(reader))
        reader = self.read(path)
        reader.SetTransform("probe")
        self.assertIn("as ProbeToReference", self.refused(reader))
        self.assertIn("mirror", self.refused(self.read(path, Calibration=np.diag([1, 1, -1, 1]))))
        self.assertIn("not there", self.refused(self.read(self.folder / "none.igs.mha")))
        self.assertIn("saw nothing", self.refused(self.read(self.recorded(valid=3 * [False])[0])))
        self.assertIn("FileName", self.refused(vtkSonoTrackedReader()))
        for old, new, word in ((b"_Timestamp = 10.0", b"_Timestamp = ten", "'ten'"),
                               (b"TrackerTransform = ", b"TrackerTransform = 1 ", "17 numbers")):
            broken = self.folder / "broken.igs.mha"
            broken.write_bytes(self.recorded()[0].read_bytes().replace(old, new))
            self.assertIn(word, self.refused(self.read(broken)))
        broken.write_bytes(b"NDims = 3\nElementDataFile = LOCAL\n")
        self.assertIn("no tracked sequence", self.refused(self.read(broken)))

    @unittest.skipUnless(RECORDED.exists(), "the recorded sweep is not there")
    def test_a_recorded_sweep(self):
        """21 frames of a hand-held probe: the relative pose of two frames, which header and reader must agree upon."""
        position, axial, lateral = poses_of(self.read(RECORDED))
        self.assertEqual(len(position), 21)
        head = RECORDED.read_bytes().split(b"\nElementDataFile")[0].decode()
        said = dict(line.split(" = ", 1) for line in head.splitlines())
        for n in (0, 20):
            probe, reference = (np.array(said[f"Seq_Frame{n:04d}_{name}ToTrackerTransform"].split(), float).reshape(4, 4)
                                for name in ("Probe", "Reference"))
            pose = np.linalg.solve(reference, probe)
            np.testing.assert_allclose(position[n], pose[:3, 3], atol=0.01)
            np.testing.assert_allclose(axial[n], pose[:3, 1], atol=1e-4)


if __name__ == "__main__":
    unittest.main()
