"""Clients of others get the newest picture where it stands, and say where the probe is."""
import contextlib
import pathlib
import socket
import struct
import subprocess
import tempfile
import time
import unittest

import numpy as np
import peers
from TestDicom import greys_of
from TestTracked import rotation, transform
from chain import Chain, listen, make
from igtl import messages, transform_message
from sonovdb.vtkSonoFilters import vtkSonoLiveLink
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData

EXAMPLES = pathlib.Path("/usr/share/doc/openigtlink-examples/examples")
RAS = np.diag([-1.0, -1.0, 1.0, 1.0])

RECEIVE = """
import sys
import numpy as np
import pyigtl
client = pyigtl.OpenIGTLinkClient("127.0.0.1", int(sys.argv[1]))
image = client.wait_for_message("SonoVDB", timeout=20)
probe = client.wait_for_message("SonoProbeToReference", timeout=20)
np.savez(sys.argv[2], image=image.image, place=image.ijk_to_world_matrix, world=image.world_coordinate_system,
         probe=probe.matrix)
"""

SEND = """
import sys
import numpy as np
import pyigtl
client = pyigtl.OpenIGTLinkClient("127.0.0.1", int(sys.argv[1]))
for matrix in np.load(sys.argv[2]):
    client.send_message(pyigtl.TransformMessage(matrix, device_name=sys.argv[3]), wait=True)
client.wait_for_message("SonoVDB", timeout=20)
"""


def wait_until(happens, seconds=20):
    end = time.monotonic() + seconds
    while not happens():
        if time.monotonic() > end:
            return False
        time.sleep(0.01)
    return True


class LinkCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.chain = Chain()
        cls.chain.converter.SetPixelMm(0.5)
        link = make(vtkSonoLiveLink, Port=0)
        link.SetInputConnection(cls.chain.converter.GetOutputPort())
        said = listen(link)
        link.Update()
        if said and "without OpenIGTLink" in said[0]:
            raise unittest.SkipTest(said[0])

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def link(self, port=1, **settings):
        link = make(vtkSonoLiveLink, **{"Port": 0, **settings})
        link.SetInputConnection(self.chain.converter.GetOutputPort(port))
        self.said = listen(link)
        link.Update()
        self.addCleanup(self.close, link)
        return link

    def close(self, link):
        link.ActiveOff()
        link.Update()
        self.assertEqual(link.GetOpenPort(), 0)

    @contextlib.contextmanager
    def example(self, source, *arguments):
        """A client that the library brings, built and run; the file of what it says."""
        program, log = self.folder / "client", self.folder / "log"
        subprocess.run(["g++", "-w", str(EXAMPLES / source), "-I/usr/include/openigtlink", "-lOpenIGTLink", "-o",
                        str(program)], check=True)
        with open(log, "w") as file:
            client = subprocess.Popen([str(program), *map(str, arguments)], stdout=file, stderr=file)
        try:
            yield log
        finally:
            client.kill()
            client.wait()

    def connect(self, link):
        connection = socket.create_connection(("127.0.0.1", link.GetOpenPort()), timeout=20)
        self.addCleanup(connection.close)
        self.assertTrue(wait_until(lambda: "1 client," in link.GetStatus()), link.GetStatus())
        return connection


class TestSending(LinkCase):
    @peers.needs("pyigtl")
    def test_pyigtl_gets_the_picture_in_its_place(self):
        for port in (0, 1):
            link = self.link(port)
            self.assertEqual(self.said, [])
            peers.run(RECEIVE, link.GetOpenPort(), self.folder / "read.npz")
            read = np.load(self.folder / "read.npz")
            world = self.chain.converter.GetOutput()
            np.testing.assert_array_equal(read["image"][0], greys_of(world)[0])
            self.assertEqual(read["world"], "ras")
            for index in ((0, 0, 0), (40, 120, 0), (world.GetDimensions()[0] - 1, 0, 0)):
                wanted = [0, 0, 0]
                world.TransformIndexToPhysicalPoint(*index, wanted)
                found = (RAS @ read["place"] @ [*index, 1])[:3]
                np.testing.assert_allclose(found, wanted, atol=0.01)
            pose = RAS @ read["probe"]
            field = world.GetFieldData()
            for column, name, tolerance in ((3, "ProbePositionMm", 0.01), (1, "ProbeAxial", 1e-5), (0, "ProbeLateral", 1e-5)):
                np.testing.assert_allclose(pose[:3, column], field.GetArray(name).GetTuple3(0), atol=tolerance)
            self.assertAlmostEqual(np.linalg.det(pose[:3, :3]), 1, places=5)
            self.close(link)

    @unittest.skipUnless(EXAMPLES.exists(), "openigtlink-examples is not installed")
    def test_the_library_s_own_client_gets_it(self):
        link = self.link()
        width, height, _ = self.chain.converter.GetOutput().GetDimensions()
        with self.example("Receiver/ReceiveClient.cxx", "127.0.0.1", link.GetOpenPort()) as log:
            self.assertTrue(wait_until(lambda: "TRANSFORM" in log.read_text()), log.read_text())
            self.assertIn(f"({width}, {height}, 1)", log.read_text())

    def test_a_slow_client_gets_the_newest(self):
        """One that does not read: nobody waits for it, what it gets later is whole, and the last is the newest."""
        link = self.link()
        connection = self.connect(link)
        longest = 0
        for n in range(60):
            self.chain.bmode.SetGainDb(-10 + 0.5 * n)
            self.chain.converter.Update()
            begin = time.perf_counter()
            link.Update()
            longest = max(longest, time.perf_counter() - begin)
        self.assertLess(longest, 0.5)
        received = list(messages(connection))
        pictures = [body for device, body in received if device == "SonoVDB"]
        self.assertLess(len(pictures), 40)
        self.assertEqual(len(received), 2 * len(pictures))
        newest = greys_of(self.chain.converter.GetOutput())[0].tobytes()
        self.assertEqual(pictures[-1][-len(newest):], newest)
        self.assertNotEqual(pictures[0], pictures[-1])


class TestReceiving(LinkCase):
    def poses(self):
        return [transform(rotation((1, 2, 3), 10.0 * n), (5.0 * n, -7, 11)) for n in range(1, 4)]

    def check_pose(self, link, matrix):
        wanted = RAS @ matrix
        found = np.reshape(link.GetReceivedPose(), (3, 3))
        np.testing.assert_allclose(found[0], wanted[:3, 3], atol=0.01)
        np.testing.assert_allclose(found[1], wanted[:3, 1], atol=1e-5)
        np.testing.assert_allclose(found[2], wanted[:3, 0], atol=1e-5)

    @peers.needs("pyigtl")
    def test_pyigtl_moves_the_probe(self):
        link = self.link()
        np.save(self.folder / "poses.npy", self.poses())
        peers.run(SEND, link.GetOpenPort(), self.folder / "poses.npy", "ProbeToReference")
        self.assertTrue(wait_until(lambda: link.GetReceivedCount() == 3), link.GetStatus())
        self.check_pose(link, self.poses()[-1])

    @unittest.skipUnless(EXAMPLES.exists(), "openigtlink-examples is not installed")
    def test_the_library_s_own_tracker_moves_the_probe(self):
        link = self.link(Transform="Tracker")
        with self.example("Tracker/TrackerClient.cxx", "127.0.0.1", link.GetOpenPort(), 50):
            self.assertTrue(wait_until(lambda: link.GetReceivedCount() >= 5), link.GetStatus())
        position, axial, lateral = np.reshape(link.GetReceivedPose(), (3, 3))
        np.testing.assert_allclose([axial @ axial, lateral @ lateral, axial @ lateral], [1, 1, 0], atol=1e-6)
        self.assertGreater(np.abs(position).max(), 0)

    def test_in_parts_and_among_others(self):
        """Bytes come as the network likes, and messages of other kinds between them."""
        link = self.link(Transform="StylusToWorld")
        connection = self.connect(link)
        other = struct.pack(">H12s20sQQQ", 2, b"STATUS", b"tracker", 0, 100000, 0) + bytes(100000)
        data = b"".join(other + transform_message("StylusToWorld", matrix) for matrix in self.poses())
        for begin in range(0, len(data), 7919):
            connection.sendall(data[begin:begin + 7919])
        self.assertTrue(wait_until(lambda: link.GetReceivedCount() == 3), link.GetStatus())
        self.check_pose(link, self.poses()[-1])

    def test_what_it_does_not_follow(self):
        link = self.link()
        connection = self.connect(link)
        for message, word in (
                (transform_message("ToolToTracker", np.eye(4)), "'ToolToTracker', and the probe follows"),
                (transform_message("ProbeToReference", np.eye(4), change=1), "it is damaged"),
                (transform_message("ProbeToReference", np.diag([1, 1, -1, 1])), "it mirrors"),
                (transform_message("ToolToTracker", np.eye(4)), "'ToolToTracker'"),
                (transform_message("ProbeToReference", 2 * np.eye(4)), "scales"),
                (transform_message("ProbeToReference", np.nan * np.eye(4)), "it mirrors")):
            connection.sendall(message)
            self.assertTrue(wait_until(lambda: word in link.GetStatus()), (word, link.GetStatus()))
        self.assertEqual(link.GetReceivedCount(), 0)
        connection.sendall(transform_message("ProbeToReference", np.eye(4)))
        self.assertTrue(wait_until(lambda: link.GetReceivedCount() == 1))
        self.assertTrue(link.GetStatus().endswith("1 pose received."), link.GetStatus())

    def test_who_speaks_another_language(self):
        link = self.link()
        connection = self.connect(link)
        connection.sendall(b"GET / HTTP/1.1\r\nHost: somebody who mistook the port\r\n\r\n" * 3)
        self.assertTrue(wait_until(lambda: "0 clients" in link.GetStatus()))
        self.assertIn("no OpenIGTLink message", link.GetStatus())

    def test_a_client_that_goes(self):
        link = self.link()
        for _ in range(3):
            self.connect(link).close()
            self.assertTrue(wait_until(lambda: "0 clients" in link.GetStatus()))
        self.chain.bmode.SetGainDb(self.chain.bmode.GetGainDb() + 1)
        link.Update()
        self.assertEqual(self.said, [])


class TestRefusals(LinkCase):
    def test_one_sentence_each(self):
        first = self.link()
        self.link(Port=first.GetOpenPort())
        self.assertEqual(len(self.said), 1)
        self.assertIn(f"Port {first.GetOpenPort()} is in use", self.said[0])
        self.link(Transform="ATransformWithALongName")
        self.assertIn("up to 20 characters", self.said[0])
        self.link(Port=70000)
        self.assertIn("Port is 70000", self.said[0])
        link = self.link()
        copy = vtkImageData()
        copy.DeepCopy(self.chain.converter.GetOutput())
        copy.GetFieldData().Initialize()
        link.SetInputDataObject(copy)
        link.Update()
        self.assertIn("Ultrasound Probe", self.said[0])

    def test_it_passes_the_image_on(self):
        link = self.link()
        np.testing.assert_array_equal(greys_of(link.GetOutput()), greys_of(self.chain.converter.GetOutputDataObject(1)))
        self.assertEqual(vtk_to_numpy(link.GetOutput().GetPointData().GetArray("Labels")).max() > 0, True)

    def test_other_computers_do_not_reach_it(self):
        """The kernel's list of sockets: it listens at 127.0.0.1 alone."""
        link = self.link()
        sockets = [line.split()[1].split(":") for line in pathlib.Path("/proc/net/tcp").read_text().splitlines()[1:]
                   if line.split()[3] == "0A"]
        self.assertEqual([address for address, port in sockets if int(port, 16) == link.GetOpenPort()], ["0100007F"])

    def test_another_port(self):
        link = self.link()
        before = link.GetOpenPort()
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        link.SetPort(port)
        link.Update()
        self.assertEqual(link.GetOpenPort(), port)
        with self.assertRaises(ConnectionRefusedError):
            socket.create_connection(("127.0.0.1", before), timeout=5)


if __name__ == "__main__":
    unittest.main()
