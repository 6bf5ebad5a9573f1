"""A beating heart that is played again in ParaView, which updates all outputs of a filter, whatever is shown."""
import gc
import os
import sys
import unittest

from paraview import simple
from paraview.servermanager import Fetch
from paraview.vtk.util.numpy_support import vtk_to_numpy

simple.LoadPlugin(os.environ["SONOVDB_PLUGIN"], remote=False, ns=vars(simple))
TIMES = (0.0, 0.5)


def heart():
    thorax = simple.ThoraxPhantom(Spacingmm=5, Phases=len(TIMES))
    return simple.SimulateUltrasound(Input=thorax, LineCount=16, PathsPerLine=8, BuildSurfaces=0)


class TestPlayed(unittest.TestCase):
    def tearDown(self):
        for proxy in list(simple.GetSources().values()):
            simple.Delete(proxy)

    def lines_made(self, ultrasound):
        """Whether the B-mode lines were made, and the time of the picture's array, another one for each that is made."""
        made = ultrasound.GetClientSideObject()
        lines = [made.GetOutputDataObject(port) for port in range(made.GetNumberOfOutputPorts())
                 if made.GetOutputDataObject(port).IsA("vtkImageData")]
        return made.GetOutputDataObject(0).GetPointData().GetArray("BMode").GetMTime(), sum(
            image.GetPointData().GetArray("BMode") is not None for image in lines)

    def test_the_second_play_makes_nothing(self):
        ultrasound = heart()
        seen = []
        for time in TIMES + TIMES:
            ultrasound.UpdatePipeline(time)
            seen.append(self.lines_made(ultrasound))
        first, second = seen[:len(TIMES)], seen[len(TIMES):]
        self.assertEqual([when for when, _ in second], [when for when, _ in first])
        self.assertTrue(all(made == 2 for _, made in second), second)  # the image and the flat image alone

    def test_an_output_that_is_wanted_later_is_that_phases(self):
        ultrasound = heart()
        for time in TIMES + TIMES:
            ultrasound.UpdatePipeline(time)
        grey = []
        for producer in (ultrasound, heart()):
            lines = simple.OutputPort(producer, self.port(producer))
            shown = simple.Calculator(Input=lines, Function="1")
            shown.UpdatePipeline(TIMES[1])
            grey.append(vtk_to_numpy(Fetch(shown).GetPointData().GetArray("BMode")))
        self.assertGreater(len(grey[0]), 1000)
        self.assertTrue((grey[0] == grey[1]).all())

    def test_an_output_whose_only_user_is_gone_is_nobodys(self):
        ultrasound = heart()
        lines = ultrasound.GetClientSideObject().GetOutputDataObject(self.port(ultrasound))
        for time in TIMES:
            ultrasound.UpdatePipeline(time)
        shown = simple.Calculator(Input=simple.OutputPort(ultrasound, self.port(ultrasound)), Function="1")
        for time in TIMES:
            ultrasound.UpdatePipeline(time)
            self.assertGreater(lines.GetNumberOfPoints(), 1000)
        gone = []
        shown.GetClientSideObject().AddObserver("DeleteEvent", lambda *_: gone.append(True))
        simple.Delete(shown)
        del shown
        gc.collect()
        self.assertEqual(gone, [True])
        for time in TIMES:
            ultrasound.UpdatePipeline(time)
            self.assertEqual(lines.GetNumberOfPoints(), 0)

    @staticmethod
    def port(producer):
        return next(i for i in range(10) if producer.SMProxy.GetOutputPortName(i) == "B-Mode Lines")


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
