"""Simulate Ultrasound as a proxy: its first pose, state files, traces, and what it says when something is missing."""
import math
import os
import pathlib
import sys
import tempfile
import unittest

import numpy as np
from paraview import servermanager, simple, smstate, smtrace
from paraview.servermanager import Fetch
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIntArray, vtkOutputWindow, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkImageData

PLUGIN = os.environ["SONOVDB_PLUGIN"]
simple.LoadPlugin(PLUGIN, remote=False, ns=vars(simple))
QUICK = {"LineCount": 12, "DepthMm": 90, "PathsPerLine": 20, "BuildSurfaces": 0}


def make_ultrasound(**settings):
    thorax = simple.ThoraxPhantom(registrationName="thorax", Spacingmm=4)
    return simple.SimulateUltrasound(registrationName="ultrasound", Input=thorax, **{**QUICK, **settings})


def grey_now(ultrasound):
    image = ultrasound.GetClientSideObject().GetOutputDataObject(0)
    return vtk_to_numpy(image.GetPointData().GetArray("BMode")).copy()


def grey(ultrasound):
    ultrasound.UpdatePipeline()
    return vtk_to_numpy(Fetch(ultrasound).GetPointData().GetArray("BMode")).copy()


PHASE_BOUNDS = [-145, 145, -105, 105, -124, 124]
POSE = {"PositionMm": [87, -86, -45], "Axial": [-0.5, 0.65, 0.545], "Lateral": [0.84, 0.33, 0.42]}


def errors_of(proxy, **settings):
    """What a filter complains about while it gets these settings and runs."""
    heard = []

    def on_error(_object, _event, text):
        heard.append(text)

    on_error.CallDataType = "string0"
    tag = proxy.GetClientSideObject().AddObserver("ErrorEvent", on_error)
    for name, value in settings.items():
        setattr(proxy, name, value)
    proxy.UpdatePipeline()
    proxy.GetClientSideObject().RemoveObserver(tag)
    return heard


def bare_organ():
    """A ball of label 1, liver, radius 60 mm around (120, 120, 120), with one of label 2, a rib, in its middle."""
    z, y, x = np.mgrid[0:60, 0:60, 0:60] * 4.0
    r = np.sqrt((x - 120)**2 + (y - 120)**2 + (z - 120)**2)
    image = vtkImageData()
    image.SetDimensions(60, 60, 60)
    image.SetSpacing(4, 4, 4)
    voxels = numpy_to_vtk(np.select([r < 8, r < 60], [2, 1], 0).astype(np.uint8).ravel(), deep=True)
    voxels.SetName("Labels")
    image.GetPointData().SetScalars(voxels)
    ids, names = vtkIntArray(), vtkStringArray()
    for array, name, values in ((ids, "LabelIds", (1, 2)), (names, "LabelNames", ("liver", "rib_left_5"))):
        array.SetName(name)
        for value in values:
            array.InsertNextValue(value)
        image.GetFieldData().AddArray(array)
    return image


class TestUltrasound(unittest.TestCase):
    def tearDown(self):
        for proxy in list(simple.GetSources().values()):
            simple.Delete(proxy)

    def test_picture_and_the_other_outputs(self):
        ultrasound = make_ultrasound(NumberOfShownPaths=5)
        self.assertGreater(grey(ultrasound).max(), 200)
        self.assertEqual([ultrasound.GetOutputPort(i).GetDataInformation().GetDataSetTypeAsString() for i in range(10)],
                         4 * ["vtkImageData"] + ["vtkMultiBlockDataSet", "vtkPolyData", "vtkPolyData"]
                         + 2 * ["vtkImageData"] + ["vtkPolyData"])
        self.assertEqual(Fetch(ultrasound, idx=6).GetNumberOfCells(), 5)
        self.assertGreater(Fetch(ultrasound, idx=9).GetNumberOfCells(), 5)
        self.assertEqual(Fetch(ultrasound, idx=8).GetNumberOfPoints(), 0)
        ultrasound.ErrorMap = 1
        self.assertEqual(Fetch(ultrasound, idx=8).GetPointData().GetArray("ErrorPercent").GetNumberOfTuples(),
                         Fetch(ultrasound).GetNumberOfPoints())

    def test_a_new_one_stands_where_the_acoustic_window_is(self):
        ultrasound = make_ultrasound()
        window = Fetch(simple.AcousticWindow(Input=simple.FindSource("thorax"))).GetFieldData()
        for name, array in (("PositionMm", "ProbePositionMm"), ("Axial", "ProbeAxial"),
                            ("Lateral", "ProbeLateral")):
            self.assertEqual(tuple(getattr(ultrasound, name)), window.GetArray(array).GetTuple3(0))

    def test_a_pose_that_was_given_stays(self):
        self.assertEqual(list(make_ultrasound(PositionMm=[80, -86, -45]).PositionMm), [80, -86, -45])

    def test_a_probe_that_was_not_moved_is_placed_anew_when_the_body_is_filled(self):
        """A liver, radius 60 mm, with a rib in it: bare first, then in 10 mm of body wall. With the probe for a liver."""
        def make():
            producer = simple.PVTrivialProducer(registrationName="organ")
            producer.GetClientSideObject().SetOutput(bare_organ())
            return simple.SimulateUltrasound(registrationName="ultrasound", Input=producer, FillBody=0, **QUICK)

        def distance(ultrasound):
            return math.dist(ultrasound.PositionMm, (120, 120, 120))

        untouched = make()
        self.assertAlmostEqual(distance(untouched), 60, delta=6)
        self.assertEqual(untouched.ScanKind, "Curvilinear")
        untouched.FillBody = 1
        self.assertAlmostEqual(distance(untouched), 70, delta=6)
        self.tearDown()
        moved = make()
        moved.PositionMm = [120, 55, 120]
        moved.FillBody = 1
        self.assertEqual(list(moved.PositionMm), [120, 55, 120])

    def test_gain_does_not_build_or_trace_again(self):
        ultrasound = make_ultrasound()
        before = grey(ultrasound)

        def made():
            outputs = ultrasound.GetClientSideObject()
            return (outputs.GetOutputDataObject(4).GetFieldData().GetAbstractArray("SonoScene").GetMTime(),
                    outputs.GetOutputDataObject(3).GetPointData().GetArray("Intensity").GetMTime())

        scene_and_lines = made()
        ultrasound.GainDb = 10
        self.assertFalse((grey(ultrasound) == before).all())
        self.assertEqual(made(), scene_and_lines)

    def test_a_scene_is_not_handed_on_anew_with_each_picture(self):
        """By ParaView's own filter between the two, a hundred surfaces a time; a scene that changed is."""
        scene = simple.UltrasoundScene(Input=simple.ThoraxPhantom(Spacingmm=4))
        ultrasound = simple.SimulateUltrasound(Input=scene, LineCount=12, DepthMm=90, PathsPerLine=20)
        first = grey(ultrasound)
        between = ultrasound.GetClientSideObject().GetInputAlgorithm(0, 0)
        self.assertEqual(between.GetClassName(), "vtkPVPostFilter")
        runs = []
        between.AddObserver("StartEvent", lambda *_: runs.append(True))
        for moved in (1, 2, 3):
            ultrasound.PositionMm = [ultrasound.PositionMm[0] + moved, *ultrasound.PositionMm[1:]]
            ultrasound.GetClientSideObject().Update(0)
        moved = grey_now(ultrasound)
        self.assertNotEqual(moved.tobytes(), first.tobytes())
        self.assertEqual(runs, [])
        scene.FallbackTissue = "liver"
        ultrasound.UpdatePipeline()
        self.assertEqual(len(runs), 1)

    def test_state_file_brings_the_picture_back(self):
        before = grey(make_ultrasound(GainDb=3, Tgc5Db=12, GreyMap="S-Shaped", **POSE))
        with tempfile.TemporaryDirectory() as folder:
            path = str(pathlib.Path(folder, "ultrasound.pvsm"))
            simple.SaveState(path)
            self.tearDown()
            simple.LoadState(path)
        again = simple.FindSource("ultrasound")
        self.assertEqual(list(again.PositionMm), POSE["PositionMm"])
        self.assertTrue((grey(again) == before).all())

    def test_pictures_are_coloured_by_what_their_points_hold(self):
        """And not by one of the many field arrays that say how they were made."""
        ultrasound = make_ultrasound()
        beating = simple.ThoraxPhantom(Spacingmm=4, Phases=2)
        for source, port, kind, wanted in (
                (ultrasound, 0, "UniformGrid", {"BMode", "Labels", "Mask"}), (ultrasound, 7, "UniformGrid", {"BMode", "Labels", "Mask"}),
                (ultrasound, 1, "UniformGrid", {"BMode"}), (ultrasound, 2, "UniformGrid", {"Envelope", "IQ", "RF"}),
                (ultrasound, 3, "UniformGrid", {"AttenuationNpPerMHz", "Intensity", "StandardError"}),
                (beating, 0, "UniformGrid", {"DisplacementMm", "Labels"}), (simple.Needle(), 0, "Geometry", {"Tissue"})):
            simple.OutputPort(source, port).UpdatePipeline()
            shown = servermanager.ProxyManager().NewProxy("representations", kind + "Representation")
            shown.GetProperty("Input").SetInputConnection(0, source.SMProxy, port)
            shown.UpdateVTKObjects()
            arrays = shown.GetProperty("ColorArrayName").FindDomain("vtkSMRepresentedArrayListDomain")
            arrays.Update(shown.GetProperty("ColorArrayName"))
            self.assertEqual({arrays.GetString(i) for i in range(arrays.GetNumberOfStrings())}, wanted)

    def test_a_named_preset_survives_states_and_traces(self):
        def lines():
            return Fetch(simple.FindSource("ultrasound"), idx=5).GetFieldData().GetArray("WidthMm").GetValue(0)

        smtrace.start_trace()
        make_ultrasound(PresetFile="linear_l14").UpdatePipeline()
        texts = [smtrace.stop_trace(), smstate.get_state()]
        self.assertEqual(lines(), 38.7096)
        for text in texts:
            self.tearDown()
            exec(compile(text, "text", "exec"), {})
            self.assertEqual(simple.FindSource("ultrasound").PresetFile, "linear_l14")
            simple.FindSource("ultrasound").UpdatePipeline()
            self.assertEqual(lines(), 38.7096)

    def test_python_state_brings_the_picture_back(self):
        before = grey(make_ultrasound(GainDb=3, **POSE))
        state = smstate.get_state()
        self.tearDown()
        exec(compile(state, "state", "exec"), {})
        self.assertTrue((grey(simple.FindSource("ultrasound")) == before).all())

    def test_a_state_that_cannot_be_written_ends_its_trace(self):
        """ParaView recorded on, and deleted views for 15 s, since it collects garbage at each proxy of a trace."""
        labels, manager = make_ultrasound().Input, servermanager.ProxyManager()
        manager.UnRegisterProxy("sources", manager.GetProxyName("sources", labels.SMProxy), labels.SMProxy)
        self.assertRaises(smtrace.Untraceable, smstate.get_state)
        self.assertIsNone(servermanager.vtkSMTrace.GetActiveTracer())

    def test_trace_replays(self):
        smtrace.start_trace()
        before = grey(make_ultrasound(GainDb=4, LobeSigmaDeg=8))
        trace = smtrace.stop_trace()
        self.assertIn("SimulateUltrasound", trace)
        self.tearDown()
        exec(compile(trace, "trace", "exec"), {})
        again = simple.FindSource("ultrasound")
        self.assertEqual((again.GainDb, again.LobeSigmaDeg), (4, 8))
        self.assertTrue((grey(again) == before).all())

    def test_state_file_whose_data_are_gone(self):
        """One sentence says which file is missing; the filter is silent and empty, and comes back when that is mended."""
        rows = []

        def on_error(_window, _event, text):
            rows.append(text)

        on_error.CallDataType = "string0"
        with tempfile.TemporaryDirectory() as folder:
            labels, state = pathlib.Path(folder, "labels.vti"), str(pathlib.Path(folder, "gone.pvsm"))
            simple.SaveData(str(labels), proxy=simple.ThoraxPhantom(Spacingmm=5))
            reader = simple.LabelMapReader(registrationName="labels.vti", FileName=str(labels))
            before = grey(simple.SimulateUltrasound(registrationName="ultrasound", Input=reader, **QUICK))
            simple.SaveState(state)
            self.tearDown()
            labels.rename(labels.with_name("moved.vti"))
            window = vtkOutputWindow.GetInstance()
            tag = window.AddObserver("ErrorEvent", on_error)
            simple.LoadState(state)
            reader, ultrasound = simple.FindSource("labels.vti"), simple.FindSource("ultrasound")
            for _ in range(2):
                ultrasound.UpdatePipeline()
            window.RemoveObserver(tag)
            (sentence,) = rows
            self.assertIn(str(labels), sentence)
            self.assertIn("name a label map", sentence)
            self.assertEqual(ultrasound.GetDataInformation().GetNumberOfPoints(), 0)
            reader.FileName = str(labels.with_name("moved.vti"))
            self.assertTrue((grey(ultrasound) == before).all())

    def test_phases_play_in_the_animation(self):
        with tempfile.TemporaryDirectory() as folder:
            files = [str(pathlib.Path(folder, f"phase_{i}.vti")) for i in range(2)]
            for file, size in zip(files, (4, 5)):
                simple.SaveData(file, proxy=simple.ResampleToImage(Input=simple.ThoraxPhantom(Spacingmm=size),
                                                                   UseInputBounds=0, SamplingBounds=PHASE_BOUNDS,
                                                                   SamplingDimensions=[60, 45, 50]),
                                PointDataArrays=["Labels"])
            reader = simple.LabelMapReader(FileName=files)
            ultrasound = simple.SimulateUltrasound(Input=reader, **QUICK, **POSE)
            scene = simple.GetAnimationScene()
            scene.UpdateAnimationUsingDataTimeSteps()
            self.assertEqual(list(simple.GetTimeKeeper().TimestepValues), [0, 1])
            pictures = []
            for time in (0, 1, 0):
                scene.AnimationTime = time
                ultrasound.UpdatePipeline(time)
                pictures.append(grey_now(ultrasound))
        self.assertFalse((pictures[0] == pictures[1]).all())
        self.assertTrue((pictures[0] == pictures[2]).all())

    def test_folder_of_masks_is_opened(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, voxels in (("liver", "0 1 1 0"), ("spleen", "0 0 0 1")):
                pathlib.Path(folder, name + ".nrrd").write_text("NRRD0004\ntype: uchar\nencoding: ascii\ndimension: 3\n"
                                                                f"sizes: 4 1 1\n\n{voxels}\n")
            for reader in (simple.OpenDataFile(folder), simple.MaskFolderReader(FileName=folder)):
                self.assertEqual(reader.GetXMLName(), "SonoMaskFolderReader")
                reader.UpdatePipeline()
                image = reader.GetClientSideObject().GetOutputDataObject(0)
                self.assertEqual(list(vtk_to_numpy(image.GetPointData().GetArray("Labels"))), [0, 1, 1, 2])
            factory = servermanager.vtkSMProxyManager.GetProxyManager().GetReaderFactory()  # what File > Open asks
            readers = factory.GetReaders(str(pathlib.Path(folder, "liver.nrrd")), servermanager.ActiveConnection.Session)
            names = [readers.GetString(i) for i in range(readers.GetNumberOfStrings())]
            self.assertIn("SonoMaskFolderReader", names)
            self.assertIn("SonoLabelMapReader", names)

    def test_no_label_map_selected(self):
        """The menus offer the filters only for what can be their input; a script may go without."""
        for make, setting in ((simple.SimulateUltrasound, "LateralSigmaMm"),
                              (simple.AcousticWindow, "CentreFrequencyMHz")):
            simple.SetActiveSource(None)
            (sentence,) = errors_of(make(), **{setting: 2})
            self.assertIn("No label map is connected", sentence)

    def test_input_that_holds_no_labels(self):
        (sentence,) = errors_of(simple.SimulateUltrasound(Input=simple.Wavelet(), **QUICK))
        self.assertIn("RTData", sentence)
        self.assertIn("whole number", sentence)

    def test_switching_the_input(self):
        ultrasound = make_ultrasound()
        first = grey(ultrasound)
        ultrasound.Input = simple.ThoraxPhantom(Spacingmm=5)
        self.assertFalse((grey(ultrasound) == first).all())
        ultrasound.Input = simple.UltrasoundScene(Input=simple.FindSource("thorax"), BuildSurfaces=0)
        self.assertTrue((grey(ultrasound) == first).all())

    def test_first_display_of_the_outputs(self):
        """A bold outline of the probe; paths and hits in colours that lie over 80 dB until a person sets others."""
        ultrasound = make_ultrasound(NumberOfShownPaths=5)
        view = simple.CreateView("RenderView")
        self.addCleanup(simple.Delete, view)  # the animation would render it

        def show(port):
            return simple.Show(simple.OutputPort(ultrasound, port), view)

        self.assertEqual(show(5).LineWidth, 3)
        for port in (1, 2, 3, 5):
            self.assertEqual((show(port).Diffuse, show(port).PointSize), (1, 2), port)
        for points in ([-80, 0], [-50, -10]):
            for port in (6, 9):
                shown = show(port)
                self.assertEqual((shown.Diffuse, shown.PointSize), (0, 4))
                colors = simple.GetColorTransferFunction("IntensityDb")
                self.assertEqual([colors.RGBPoints[0], colors.RGBPoints[-4]], points)
                simple.Delete(shown)
            colors.RescaleTransferFunction(-50, -10)

    def test_a_second_one_of_the_same_label_map(self):
        """ParaView's Python names the array of the active source, the first one's image, before it sets the input."""
        first = make_ultrasound()
        before = grey(first)
        second = simple.SimulateUltrasound(Input=simple.FindSource("thorax"), **QUICK)
        self.assertTrue((grey(second) == before).all())

    def test_the_plugin_is_loaded_twice(self):
        before = grey(make_ultrasound())
        simple.LoadPlugin(PLUGIN, remote=False, ns=vars(simple))
        self.tearDown()
        self.assertTrue((grey(make_ultrasound()) == before).all())


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
