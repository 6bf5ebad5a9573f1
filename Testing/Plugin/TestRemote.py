"""A client at one end of a link whose bytes are counted, a pvserver at the other: what crosses it, how quickly, and a stop that
reaches the server while it works."""
import os
import sys
import time
import unittest

from paraview import servermanager, simple
from sonovdb.vtkSonoWidgets import vtkSonoServerStop
from vtkmodules.vtkCommonCore import vtkCommand

from link import Server

PLUGIN = os.environ["SONOVDB_PLUGIN"]
SPACING_MM = 2


class TestRemote(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server()
        cls.addClassCleanup(cls.server.__exit__)
        simple.Connect("127.0.0.1", cls.server.link.port)
        cls.addClassCleanup(simple.Disconnect)
        simple.LoadPlugin(PLUGIN, remote=True, ns=vars(simple))
        simple.LoadPlugin(PLUGIN, remote=False, ns=vars(simple))
        before = cls.server.link.down
        cls.thorax = simple.ThoraxPhantom(Spacingmm=SPACING_MM)
        cls.thorax.UpdatePipeline()
        cls.voxels = cls.thorax.GetDataInformation().GetNumberOfPoints()
        cls.ultrasound = simple.SimulateUltrasound(Input=cls.thorax, LineCount=32, PathsPerLine=10, Pixelmm=0.5)
        cls.ultrasound.UpdatePipeline()
        cls.loading = cls.server.link.down - before

    def crossed(self, work):
        """The bytes that come down while something is done, and its seconds."""
        before, begin = self.server.link.down, time.perf_counter()
        work()
        return self.server.link.down - before, time.perf_counter() - begin

    def test_no_label_volume_crosses(self):
        self.assertGreater(self.voxels, 2_000_000)
        self.assertLess(self.loading, self.voxels / 20)

    def test_of_a_picture_its_pixels_cross_and_ten_come_a_second(self):
        flat = servermanager.OutputPort(self.ultrasound, 7)
        mover = servermanager.filters.ClientServerMoveData(Input=flat)
        shape = flat.GetDataInformation()
        mover.OutputDataType = shape.GetDataSetType()
        position = list(self.ultrasound.PositionMm)
        pictures = []

        def move():
            for step in range(30):
                self.ultrasound.PositionMm = [position[0] + 0.01 * step, *position[1:]]
                mover.UpdatePipeline()
                picture = mover.GetClientSideObject().GetOutputDataObject(0)
                pictures.append(picture.GetPointData().GetArray("BMode"))

        move()
        pictures.clear()
        down, seconds = self.crossed(move)
        print(f"{30 / seconds:.1f} pictures/s, {down / 30:.0f} bytes each")


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
