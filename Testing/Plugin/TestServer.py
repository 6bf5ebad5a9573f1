"""A client and a pvserver on this machine: the simulation runs on the server, and the first pose comes back."""
import os
import socket
import subprocess
import sys
import tempfile
import unittest

from paraview import servermanager, simple
from paraview.servermanager import Fetch

PLUGIN = os.environ["SONOVDB_PLUGIN"]


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class WithServer(unittest.TestCase):
    def start(self, command, port):
        # pvpython has begun an MPI job of its own, of which these are no part.
        environment = {name: value for name, value in os.environ.items()
                       if name.startswith("OMPI_ALLOW") or not name.startswith(("OMPI_", "PMIX_"))}
        self.server = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                       env=environment)
        self.addCleanup(self.server.stdout.close)
        self.addCleanup(self.server.wait)
        self.addCleanup(self.server.terminate)
        for line in self.server.stdout:
            if "Accepting connection" in line:
                break
        simple.Connect("127.0.0.1", port)
        simple.LoadPlugin(PLUGIN, remote=True, ns=vars(simple))
        simple.LoadPlugin(PLUGIN, remote=False, ns=vars(simple))

    def tearDown(self):
        simple.Disconnect()

    @staticmethod
    def write(path, text):
        """What was wrong."""
        writer = servermanager.ProxyManager().NewProxy("misc", "SonoTextFile")
        writer.GetProperty("FileName").SetElement(0, path)
        writer.GetProperty("Text").SetElement(0, text)
        writer.UpdateVTKObjects()
        writer.InvokeCommand("Write")
        writer.UpdatePropertyInformation()
        return writer.GetProperty("Refusal").GetElement(0)


class TestServer(WithServer):
    def setUp(self):
        port = free_port()
        self.start(["pvserver", f"--server-port={port}"], port)

    def test_simulation_runs_on_the_server(self):
        thorax = simple.ThoraxPhantom(Spacingmm=4)
        ultrasound = simple.SimulateUltrasound(Input=thorax, LineCount=12, DepthMm=90, PathsPerLine=20)
        field = Fetch(thorax).GetFieldData()
        self.assertEqual(tuple(ultrasound.PositionMm), field.GetArray("A4CPositionMm").GetTuple3(0))
        self.assertIsNone(ultrasound.GetClientSideObject())  # it lives on the server
        image = Fetch(ultrasound)
        self.assertGreater(image.GetPointData().GetArray("BMode").GetRange()[1], 200)
        self.assertGreater(Fetch(ultrasound, idx=4).GetNumberOfPoints(), 1000)
        before = image.GetPointData().GetArray("BMode").GetRange(), image.GetNumberOfPoints()
        ultrasound.GainDb = -200
        self.assertEqual(Fetch(ultrasound).GetPointData().GetArray("BMode").GetRange(), (0, 1))  # all black
        ultrasound.GainDb = 0
        image = Fetch(ultrasound)
        self.assertEqual((image.GetPointData().GetArray("BMode").GetRange(), image.GetNumberOfPoints()), before)
        # As a surface: an image would arrive at the client without the matrix that turns it.
        shown = simple.Show(ultrasound, simple.CreateView("RenderView"))
        self.assertEqual(shown.Representation, "Surface")
        self.assertEqual(tuple(shown.ColorArrayName), ("POINTS", "BMode"))
        table = simple.LabelTable(Input=simple.OutputPort(ultrasound, 4))
        table.UpdatePipeline()
        table.UpdatePropertyInformation()
        self.assertTrue(any(row.startswith("cortical_bone\t") for row in table.GetProperty("TissueRows")))

    def test_presets_and_files_are_the_servers(self):
        """A preset is found, and a text written, where the server is."""
        probe = simple.UltrasoundProbe(PresetFile="linear_l14")
        field = Fetch(probe).GetFieldData()
        self.assertEqual(field.GetArray("DepthMm").GetValue(0), 40)
        presets = simple.ProbePresets()
        presets.UpdatePipeline()
        presets.UpdatePropertyInformation()
        self.assertTrue(any(row.startswith("linear_l14\tLinear array L14-5\t0\t128\t40\t")
                            for row in presets.GetProperty("Rows")))
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "some.csv")
            for name, refused in ((path, False), (os.path.join(folder, "no", "some.csv"), True)):
                self.assertEqual(bool(self.write(name, "id,name\n1,Ä\n")), refused)
            self.assertEqual(os.listdir(folder), ["some.csv"])
            with open(path, encoding="utf-8") as file:
                self.assertEqual(file.read(), "id,name\n1,Ä\n")


class TestParallelServer(WithServer):
    def test_the_first_rank_writes_a_text(self):
        """Each rank has a folder of its own, so that all that they write is seen."""
        with tempfile.TemporaryDirectory() as first, tempfile.TemporaryDirectory() as second:
            port = free_port()
            ranks = [["-np", "1", "--wdir", folder, "pvserver", f"--server-port={port}"] for folder in (first, second)]
            self.start(["mpirun", "--oversubscribe", *ranks[0], ":", *ranks[1]], port)
            self.assertEqual(servermanager.ActiveConnection.GetNumberOfDataPartitions(), 2)
            self.assertEqual(self.write("some.csv", "id,name\n"), "")
            self.assertEqual((os.listdir(first), os.listdir(second)), (["some.csv"], []))


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
