"""A client at one end of a link whose bytes are counted, a pvserver at the other: what crosses it, how quickly, and a stop that
reaches the server while it works."""
import os
import sys
import time
import unittest
import zlib

from paraview import servermanager, simple
from sonovdb.vtkSonoWidgets import vtkSonoServerStop
from vtkmodules.vtkCommonCore import vtkCommand

from link import Server

PLUGIN = os.environ["SONOVDB_PLUGIN"]
SPACING_MM = 2
STEPS = 30
FLAT = 7  # the output in the probe's own frame


class Grey(bytes):
    def __repr__(self):  # so that a test that fails does not say all
        return f"{len(self)} grey values, CRC {zlib.crc32(self):08x}"


class TestRemote(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server()
        cls.addClassCleanup(cls.server.close)
        simple.Connect("127.0.0.1", cls.server.port)
        cls.addClassCleanup(simple.Disconnect)
        simple.LoadPlugin(PLUGIN, remote=True, ns=vars(simple))
        simple.LoadPlugin(PLUGIN, remote=False, ns=vars(simple))
        cls.addClassCleanup(lambda: [delattr(cls, name) for name in ("stop", "thorax", "ultrasound")])  # while there is a connection
        # As the GUI does when there is the first of our sources: so that what is made from then on is kept for a stop.
        cls.stop = servermanager.ProxyManager().NewProxy("misc", "SonoServerStop")
        cls.stop.UpdateVTKObjects()
        cls.stop.InvokeCommand("Listen")
        before = cls.server.crossed()[0]
        cls.thorax = simple.ThoraxPhantom(Spacingmm=SPACING_MM)
        cls.thorax.UpdatePipeline()
        cls.voxels = cls.thorax.GetDataInformation().GetNumberOfPoints()
        cls.ultrasound = simple.SimulateUltrasound(Input=cls.thorax, LineCount=32, PathsPerLine=10, PixelMm=0.5)
        cls.ultrasound.UpdatePipeline()
        cls.loading = cls.server.crossed()[0] - before

    def picture(self, port=0):
        """The grey values."""
        return Grey(servermanager.Fetch(self.ultrasound, idx=port).GetPointData().GetArray("BMode"))

    def crossed(self, work):
        """The bytes that come down while something is done, and its seconds."""
        before, begin = self.server.crossed()[0], time.perf_counter()
        work()
        return self.server.crossed()[0] - before, time.perf_counter() - begin

    def test_no_label_volume_crosses(self):
        self.assertGreater(self.voxels, 1_500_000)
        self.assertLess(self.loading, self.voxels / 20)

    def test_of_a_picture_its_pixels_cross_and_ten_come_a_second(self):
        """The data, not what is drawn of them; of another gain each time. What the link takes is timed: not what is computed before,
        nor the ranges of what has come, in which Fetch() spends two thirds of its time."""
        self.picture(FLAT)
        shown = servermanager.Fetch(self.ultrasound, idx=FLAT).GetPointData()
        arrays = [shown.GetArray(i) for i in range(shown.GetNumberOfArrays())]
        size = sum(array.GetDataSize() * array.GetDataTypeSize() for array in arrays)
        self.assertGreater(size, 200_000)
        greys = set()
        times = []
        flat = servermanager.OutputPort(self.ultrasound, FLAT)
        sent = self.ultrasound.GetDataInformation(FLAT)

        def bring():
            mover = servermanager.filters.ClientServerMoveData(Input=flat, OutputDataType=sent.GetDataSetType(),
                                                               WholeExtent=sent.GetExtent()[:])
            mover.SMProxy.UpdatePipeline()
            return Grey(mover.GetClientSideObject().GetOutputDataObject(0).GetPointData().GetArray("BMode"))

        def turn():
            for step in range(STEPS):
                self.ultrasound.GainDb = 0.5 * step
                flat.UpdatePipeline()
                begin = time.perf_counter()
                greys.add(bring())
                times.append(time.perf_counter() - begin)

        down, seconds = self.crossed(turn)
        times.sort()
        print(f"{1 / times[STEPS // 2]:.1f} pictures/s cross, {STEPS / seconds:.1f} computed, too, {down / STEPS:.0f} bytes each, of which "
              f"{size} in arrays")
        self.assertEqual(len(greys), STEPS)
        self.assertLess(down / STEPS, 1.2 * size)
        self.assertLess(times[STEPS // 2], 0.1)

    def test_surfaces_for_the_probe_are_made_once_a_body(self):
        """Few triangles of it, whatever the probe does meanwhile, and others for another body."""
        manager = servermanager.ProxyManager()
        coarse = manager.NewProxy("sono_server", "SonoCoarseSurfaces")
        coarse.GetProperty("Input").AddInputConnection(self.ultrasound.SMProxy, 4)
        coarse.UpdateVTKObjects()
        coarse.CreateOutputPorts()

        def triangles(of):
            of.UpdatePipeline()
            return of.GetOutputPort(0).GetDataInformation().GetNumberOfCells()

        def version():
            coarse.UpdatePropertyInformation()
            return coarse.GetProperty("Version").GetElement(0)

        anatomy = servermanager.OutputPort(self.ultrasound, 4)
        anatomy.UpdatePipeline()
        few = triangles(coarse)
        self.assertGreater(few, 1000)
        self.assertLess(few, anatomy.GetDataInformation().GetNumberOfCells() / 2)  # which is coarse itself
        self.ultrasound.DepthMm = 120
        self.assertEqual(triangles(coarse), few)
        self.assertEqual(version(), 1)
        self.thorax.Spacingmm = 3
        self.addCleanup(setattr, self.thorax, "Spacingmm", SPACING_MM)
        self.assertNotEqual(triangles(coarse), few)
        self.assertEqual(version(), 2)

    def test_a_stop_reaches_the_server_at_work(self):
        self.ultrasound.UpdatePipeline()
        before = self.picture()
        heard = []

        def answer(*_):
            heard.append(time.perf_counter())
            if len(heard) == 3:
                vtkSonoServerStop.Ask(session)

        session = servermanager.ActiveConnection.Session
        progress = session.GetProgressHandler()
        observer = progress.AddObserver(vtkCommand.ProgressEvent, answer)
        self.ultrasound.PathsPerLine = 1_000_000  # minutes
        self.ultrasound.UpdatePipeline()
        seconds = time.perf_counter() - heard[2]
        progress.RemoveObserver(observer)
        self.assertLess(seconds, 2)
        # What was there before is still there, and nothing runs by itself.
        self.assertEqual(self.picture(), before)
        self.ultrasound.PathsPerLine = 20
        self.ultrasound.UpdatePipeline()
        self.assertNotEqual(self.picture(), before)
        # A wish that comes when nothing runs is read and forgotten.
        vtkSonoServerStop.Ask(session)
        self.ultrasound.PathsPerLine = 10
        self.assertEqual(self.picture(), before)

if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
