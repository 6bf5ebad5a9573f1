"""A client of the Live Link moves the probe in ParaView's window, and gets the pictures that this makes. Needs Xvfb and
python3-xlib; run by ctest -L gui."""
import pathlib
import socket
import sys
import tempfile
import threading
import time
import unittest

import numpy as np
from guicase import PLAYBACKS, GuiCase
from person import Person

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "Filters"))
import igtl  # noqa: E402


class TestGuiLink(GuiCase):
    # The bundled apical view's, in RAS, where x and y have the other sign.
    START = np.array([-87.8, 86.5, -45.0])

    def pose(self, n):
        """The view's directions, moved by a millimetre each."""
        axial = np.array([0.53, -0.65, 0.545])
        lateral = np.array([-0.843, -0.333, 0.423])
        axial /= np.linalg.norm(axial)
        lateral -= lateral @ axial * axial
        lateral /= np.linalg.norm(lateral)
        matrix = np.eye(4)
        matrix[:3] = np.stack([lateral, axial, np.cross(lateral, axial), self.START + n * lateral], axis=1)
        return matrix

    def test_a_client_moves_the_probe(self):
        failures, received = [], []
        with tempfile.TemporaryDirectory() as folder:
            person = Person(self, folder)
            home = pathlib.Path(folder)

            def follow():
                try:
                    person.await_file("port.txt")
                    time.sleep(2)
                    port = int((home / "port.txt").read_text())
                    with socket.create_connection(("127.0.0.1", port)) as connection:
                        for n in range(1, 31):  # quicker than pictures are made
                            connection.sendall(igtl.transform_message("ProbeToReference", self.pose(n)))
                            time.sleep(0.02)
                        received.extend(igtl.messages(connection, silence=10))
                except Exception as failure:  # to be told by the test, not by the thread
                    failures.append(failure)
                person.close_window()

            following = threading.Thread(target=follow)
            following.start()
            done = self.paraview(folder, f"--script={PLAYBACKS / 'link.py'}")
            person.ended.set()
            following.join()
            self.assertEqual(failures, [], done.stdout)
            pictures = np.loadtxt(home / "pictures.txt")
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertNotIn("ERR|", done.stdout)
        ras = np.diag([-1.0, -1.0, 1.0])
        last = ras @ self.pose(30)[:3, 3]
        moved = pictures[np.linalg.norm(pictures[:, :3] - ras @ self.START, axis=1) > 0.5]
        self.assertLess(len(np.unique(moved[:, :3], axis=0)), 30)  # the newest pose alone counts
        self.assertGreater(moved[:, 3].sum(), 0)  # coarse on the way
        np.testing.assert_allclose(pictures[-1], [*last, 0], atol=0.01)  # and fine where it rests
        probes = [np.frombuffer(body, ">f4").reshape(4, 3).T for device, body in received
                  if device == "SonoProbeToReference"]
        np.testing.assert_allclose(probes[-1], self.pose(30)[:3], atol=0.01)
        images = [body for device, body in received if device == "SonoVDB"]
        self.assertEqual(len(images), len(probes))
        self.assertGreater(len(images), 2)


if __name__ == "__main__":
    unittest.main()
