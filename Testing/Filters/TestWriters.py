"""What goes wrong while a sequence is written: each writer says one clear sentence and leaves no file that looks whole."""
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

from chain import Chain, listen, make
from sonovdb.vtkSonoFilters import vtkSonoDicomWriter, vtkSonoLineWriter, vtkSonoTrackedWriter
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline

# Class, settings and the name of a file; what it takes are pictures but for lines.
WRITERS = {
    "DICOM": (vtkSonoDicomWriter, {}, "a.dcm"),
    "masks": (vtkSonoDicomWriter, {"LabelMasks": True}, "a.dcm"),
    "MetaImage": (vtkSonoTrackedWriter, {}, "a.igs.mha"),
    "NRRD": (vtkSonoTrackedWriter, {}, "a.igs.nrrd"),
    "zea": (vtkSonoLineWriter, {}, "a.hdf5"),
    "UFF": (vtkSonoLineWriter, {}, "a.uff"),
}


class Steps(VTKPythonAlgorithmBase):
    """Images as time steps."""

    def __init__(self, images):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkImageData")
        self.images = images

    def RequestInformation(self, _request, _input, output):
        info = output.GetInformationObject(0)
        info.Set(Pipeline.WHOLE_EXTENT(), self.images[0].GetExtent(), 6)
        times = [0.04 * n for n in range(len(self.images))]
        info.Set(Pipeline.TIME_STEPS(), times, len(times))
        info.Set(Pipeline.TIME_RANGE(), [times[0], times[-1]], 2)
        return 1

    def RequestData(self, _request, _input, output):
        info = output.GetInformationObject(0)
        n = round(info.Get(Pipeline.UPDATE_TIME_STEP()) / 0.04) if info.Has(Pipeline.UPDATE_TIME_STEP()) else 0
        vtkImageData.GetData(output, 0).DeepCopy(self.images[n])
        return 1


def inputs(chain):
    """A picture and lines, and both of another depth."""
    made = []
    for depth in (90.0, 60.0):
        chain.probe.SetDepthMm(depth)
        chain.converter.Update()
        images = vtkImageData(), vtkImageData()
        images[0].DeepCopy(chain.converter.GetOutputDataObject(1))
        images[1].DeepCopy(chain.formation.GetOutput())
        made.append(images)
    chain.probe.SetDepthMm(90.0)
    return made


def writer_of(name, folder, images, file_name=None):
    kind, settings, default = WRITERS[name]
    writer = make(kind, FileName=str(pathlib.Path(folder, file_name or default)), **settings)
    steps = Steps(images)
    writer.SetInputConnection(steps.GetOutputPort())
    writer.steps = steps  # for as long
    return writer


# A program of its own, which may be refused room or be killed: NAME, FOLDER, what then.
PROGRAM = """
import os, resource, signal, sys
sys.path.insert(0, {here!r})
from TestWriters import *
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
chain = Chain()
(picture, lines), _ = inputs(chain)
writer = writer_of({name!r}, {folder!r}, 4 * [lines if {name!r} in ("zea", "UFF") else picture])
said = listen(writer)
{then}
writer.Write()
print(len(said), *said)
"""


class TestWriters(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.chain = Chain()
        cls.chain.converter.SetPixelMm(0.5)
        (cls.picture, cls.lines), (cls.other_picture, cls.other_lines) = inputs(cls.chain)

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def each(self):
        for name in WRITERS:
            with self.subTest(writer=name):
                isLines = name in ("zea", "UFF")
                yield name, self.lines if isLines else self.picture, self.other_lines if isLines else self.other_picture

    def refused(self, writer):
        said = listen(writer)
        self.assertEqual(writer.Write(), 0)
        self.assertNotEqual(writer.GetErrorCode(), 0)
        self.assertEqual(len(said), 1, said)
        self.assertEqual(list(self.folder.iterdir()), [])
        return said[0]

    def test_names_in_any_language(self):
        for name, image, _ in self.each():
            file_name = "Jörgs Schwenk 超音波 " + WRITERS[name][2]
            self.assertEqual(writer_of(name, self.folder, 2 * [image], file_name).Write(), 1)
            self.assertTrue((self.folder / file_name).exists())
            for path in self.folder.iterdir():
                path.unlink()

    def test_no_right_to_write(self):
        for name, image, _ in self.each():
            for folder in ("/proc/self", "/nowhere"):  # where not even the administrator may
                said = self.refused(writer_of(name, folder, [image]))
                self.assertIn(f"cannot write '{folder}/a.", said)
                self.assertIn("choose another folder", said)

    def test_no_pictures(self):
        for name, _, _ in self.each():
            self.assertRegex(self.refused(writer_of(name, self.folder, [vtkImageData()])),
                             "connect|Ultrasound Probe|there are no")

    def test_pictures_of_unequal_size(self):
        for name, image, other in self.each():
            self.assertRegex(self.refused(writer_of(name, self.folder, [image, image, other])),
                             r"(picture|frame) 3 has .* and the first .*; keep the probe's depth")

    def run_apart(self, name, then):
        program = PROGRAM.format(here=str(pathlib.Path(__file__).parent), name=name, folder=str(self.folder), then=then)
        return subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)

    def test_a_full_disk(self):
        for name, _, _ in self.each():
            result = self.run_apart(name, "resource.setrlimit(resource.RLIMIT_FSIZE, (100000, 100000))")
            self.assertRegex(result.stdout, r"(?m)^1 cannot write '.*/a\..*' ?.* disk is full", result.stderr)
            self.assertEqual(list(self.folder.iterdir()), [])

    def test_killed_while_writing(self):
        kill = ("writer.AddObserver('ProgressEvent', lambda *_: "
                "os.kill(os.getpid(), 9 * (writer.GetProgress() > 0.6)))")
        for name, _, _ in self.each():
            result = self.run_apart(name, kill)
            self.assertEqual(result.returncode, -signal.SIGKILL, result.stderr)
            self.assertEqual({path.suffix for path in self.folder.iterdir()}, {".part"})
            for path in self.folder.iterdir():
                path.unlink()


if __name__ == "__main__":
    unittest.main()
