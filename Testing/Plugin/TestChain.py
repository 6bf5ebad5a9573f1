"""The chain of proxies makes the picture, keeps it through a state file, and says what is wrong with bad input."""
import os
import pathlib
import sys
import tempfile
import unittest

import numpy
from paraview import simple, smtrace
from paraview.servermanager import Fetch
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

simple.LoadPlugin(os.environ["SONOVDB_PLUGIN"], remote=False, ns=vars(simple))


def make_chain():
    """The last stage of a small chain, registered as in the GUI."""
    thorax = simple.ThoraxPhantom(registrationName="thorax", Spacingmm=4)
    field = Fetch(thorax).GetFieldData()
    probe = simple.UltrasoundProbe(
        registrationName="probe", LineCount=12, Depthmm=90, Sectordeg=60,
        Positionmm=field.GetArray("A4CPositionMm").GetTuple3(0), Axial=field.GetArray("A4CAxial").GetTuple3(0),
        Lateral=field.GetArray("A4CLateral").GetTuple3(0))
    scene = simple.UltrasoundScene(registrationName="scene", Input=thorax)
    traced = simple.UltrasoundRayTracer(registrationName="traced", Scene=scene, Probe=probe, PathsperLine=20)
    rf = simple.UltrasoundImageFormation(registrationName="rf", Input=traced)
    bmode = simple.UltrasoundBMode(registrationName="bmode", Input=rf, TGC5dB=12)
    return simple.ScanConverter(registrationName="picture", Input=bmode)


def grey(picture):
    picture.UpdatePipeline()
    return vtk_to_numpy(Fetch(picture).GetPointData().GetArray("BMode")).copy()


def said_by(proxy, event, **settings):
    """What a stage says while it gets these settings and runs."""
    heard = []

    def on_event(_object, _event, text):
        heard.append(text)

    on_event.CallDataType = "string0"
    stage = proxy.GetClientSideObject()
    tag = stage.AddObserver(event, on_event)
    for name, value in settings.items():
        setattr(proxy, name, value)
    proxy.UpdatePipeline()
    stage.RemoveObserver(tag)
    return heard


def errors_of(proxy, **settings):
    return said_by(proxy, "ErrorEvent", **settings)


def place_in(organ, labels):
    """A voxel's centre in the world that is deep in a label of an image without rotation."""
    field = labels.GetFieldData()
    names, ids = field.GetAbstractArray("LabelNames"), field.GetArray("LabelIds")
    (label,) = (ids.GetTuple1(i) for i in range(ids.GetNumberOfTuples()) if names.GetValue(i) == organ)
    inside = numpy.flatnonzero(vtk_to_numpy(labels.GetPointData().GetScalars()) == label)
    places = numpy.array([labels.GetPoint(int(i)) for i in inside])
    return list(places[numpy.argmin(numpy.linalg.norm(places - places.mean(axis=0), axis=1))])


class TestChain(unittest.TestCase):
    def tearDown(self):
        for proxy in list(simple.GetSources().values()):
            simple.Delete(proxy)

    def test_picture(self):
        picture = make_chain()
        pixels = grey(picture)
        self.assertGreater(pixels.max(), 200)
        self.assertEqual({picture.PointData[i].Name for i in range(len(picture.PointData))}, {"BMode", "Mask", "Labels"})

    def test_scene_is_saved_and_opened_as_any_data(self):
        pixels = grey(make_chain())
        with tempfile.TemporaryDirectory() as folder:
            path = str(pathlib.Path(folder, "thorax.nvdb"))
            simple.SaveData(path, proxy=simple.FindSource("scene"))
            opened = simple.OpenDataFile(path)
            self.assertEqual(opened.GetXMLName(), "SonoSceneReader")
            simple.FindSource("traced").Scene = opened
            self.assertTrue((grey(simple.FindSource("picture")) == pixels).all())

    def test_pictures_are_saved_with_the_transducer_on_top(self):
        flat = simple.OutputPort(make_chain(), 1)
        with tempfile.TemporaryDirectory() as folder:
            path = str(pathlib.Path(folder, "flat.png"))
            simple.SaveData(path, proxy=flat)
            simple.SaveData(path.replace("png", "tif"), proxy=flat, Array=["POINTS", "Labels"])
            self.assertTrue(pathlib.Path(folder, "flat.tif").is_file())
            reader = vtkPNGReader()
            reader.SetFileName(path)
            reader.Update()
        image = Fetch(simple.FindSource("picture"), idx=1)
        width, height, _ = image.GetDimensions()
        from_top = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).reshape(height, width)[::-1]
        pixels = vtk_to_numpy(image.GetPointData().GetArray("BMode")).reshape(height, width)
        self.assertTrue((from_top == pixels).all())
        # A flat view looks along z with the smaller depths on top.
        self.assertLess(image.GetPoint(0)[1], image.GetPoint(width * (height - 1))[1])
        for kind in ("png", "jpg", "tiff", "exr"):
            writer = simple.CreateWriter(path.replace("png", kind), flat)
            self.assertEqual(writer.GetClientSideObject().GetClassName(), "vtkSonoPictureWriter")
        other = simple.CreateWriter(path, simple.Wavelet())
        self.assertEqual(other.GetClientSideObject().GetClassName(), "vtkPNGWriter")

    def test_default_probe_sees_the_thorax(self):
        make_chain()
        posed = simple.FindSource("probe")
        fresh = simple.UltrasoundProbe()
        for name, tolerance in (("Positionmm", 0.05), ("Axial", 1e-3), ("Lateral", 1e-3)):
            for mine, theirs in zip(getattr(fresh, name), getattr(posed, name)):
                self.assertAlmostEqual(mine, theirs, delta=tolerance)

    def test_target_can_be_connected_and_taken_away(self):
        bare = grey(make_chain())
        posed, traced = simple.FindSource("probe"), simple.FindSource("traced")
        place = [p + 40 * a for p, a in zip(posed.Positionmm, posed.Axial)]
        traced.Targets = simple.Sphere(Center=place, Radius=8, ThetaResolution=24, PhiResolution=24)
        with_target = grey(simple.FindSource("picture"))
        self.assertFalse((with_target == bare).all())
        traced.Targets = None
        self.assertTrue((grey(simple.FindSource("picture")) == bare).all())

    def test_ray_paths_are_the_third_output(self):
        make_chain()
        traced = simple.FindSource("traced")
        traced.NumberofShownPaths = 7
        self.assertEqual(Fetch(traced, idx=2).GetNumberOfCells(), 7)

    def test_scatterers_of_ones_own(self):
        bare = grey(make_chain())
        posed = simple.FindSource("probe")
        place = [p + 40 * a for p, a in zip(posed.Positionmm, posed.Axial)]
        points = simple.Calculator(Input=simple.PointSource(Center=place, Radius=0, NumberOfPoints=1),
                                   Function="10", ResultArrayName="Amplitude")
        simple.FindSource("rf").Scatterers = points
        self.assertFalse((grey(simple.FindSource("picture")) == bare).all())

    def test_both_outputs_of_the_tracer(self):
        make_chain()
        traced = simple.FindSource("traced")
        self.assertIsNotNone(Fetch(traced, idx=0).GetPointData().GetArray("Intensity"))
        self.assertIsNotNone(Fetch(traced, idx=1).GetPointData().GetArray("BoundaryEcho"))

    def test_state_file_brings_the_picture_back(self):
        before = grey(make_chain())
        with tempfile.TemporaryDirectory() as folder:
            path = str(pathlib.Path(folder, "chain.pvsm"))
            simple.SaveState(path)
            self.tearDown()
            self.assertIsNone(simple.FindSource("picture"))
            simple.LoadState(path)
        self.assertEqual(simple.FindSource("bmode").TGC5dB, 12)
        self.assertTrue((grey(simple.FindSource("picture")) == before).all())

    def test_label_array_can_be_chosen(self):
        make_chain()
        simple.FindSource("scene").Labels = ["POINTS", "Labels"]
        self.assertEqual(errors_of(simple.FindSource("scene")), [])

    def test_label_array_is_found_in_a_source_that_has_not_run(self):
        scene = simple.UltrasoundScene(Input=simple.ThoraxPhantom(Spacingmm=5), BuildSurfaces=0)
        self.assertEqual(errors_of(scene), [])
        self.assertEqual(scene.GetDataInformation().GetNumberOfPoints(), 8)

    def test_missing_file(self):
        reader = simple.LabelMapReader()
        (sentence,) = errors_of(reader, FileName="nowhere/no.nii.gz")  # told as soon as the file is named
        self.assertIn("nowhere/no.nii.gz", sentence)

    def test_image_that_holds_no_labels(self):
        wavelet = simple.Wavelet()
        wavelet.UpdatePipeline()
        (sentence,) = errors_of(simple.UltrasoundScene(Input=wavelet))
        self.assertIn("whole number", sentence)
        self.assertIn("RTData", sentence)

    def test_unknown_tissue(self):
        make_chain()
        scene = simple.FindSource("scene")
        scene.OutsideTissue = "unobtainium"
        scene.FallbackTissue = "unobtainium"
        (sentence,) = errors_of(scene)
        self.assertIn("unobtainium", sentence)

    def test_probe_wholly_outside_the_volume(self):
        make_chain()
        probe = simple.FindSource("probe")
        probe.Positionmm, probe.Axial, probe.Lateral = (1e4, 0, 0), (1, 0, 0), (0, 1, 0)
        (sentence,) = errors_of(simple.FindSource("traced"))
        self.assertIn("probe", sentence)

    def test_pose_is_kept_in_state_files_and_traces(self):
        make_chain()
        pose = {"Positionmm": [120.5, -30.25, 17], "Axial": [-1, 0, 0], "Lateral": [0, 0.6, 0.8],
                "Depthmm": 75}

        def check():
            for name, value in pose.items():
                found = getattr(simple.FindSource("probe"), name)
                self.assertEqual(found if name == "Depthmm" else list(found), value)

        smtrace.start_trace()
        modified = smtrace.PropertiesModified(simple.FindSource("probe"))  # as Apply and the probe's panel do
        for name, value in pose.items():
            setattr(simple.FindSource("probe"), name, value)
        modified.finalize()
        trace = smtrace.stop_trace()
        with tempfile.TemporaryDirectory() as folder:
            path = str(pathlib.Path(folder, "chain.pvsm"))
            simple.SaveState(path)
            self.tearDown()
            simple.LoadState(path)
        check()
        self.tearDown()
        make_chain()
        exec(trace, {})
        check()

    def test_moving_probe_has_a_coarse_picture_in_the_same_place(self):
        fine = grey(make_chain())
        size = Fetch(simple.FindSource("picture")).GetBounds()
        probe = simple.FindSource("probe")
        probe.Preview = 1
        coarse = grey(simple.FindSource("picture"))
        self.assertLess(coarse.size, fine.size / 3)
        for one, other in zip(Fetch(simple.FindSource("picture")).GetBounds(), size):
            self.assertAlmostEqual(one, other, delta=0.5)
        self.assertGreater(coarse.max(), 200)
        probe.Preview = 0
        self.assertTrue((grey(simple.FindSource("picture")) == fine).all())  # nothing of the movement stays

    def test_probe_in_a_place_where_it_hears_nothing(self):
        make_chain()
        traced, posed = simple.FindSource("traced"), simple.FindSource("probe")
        on_skin, axial = list(posed.Positionmm), list(posed.Axial)

        def warnings_at(position):
            posed.Positionmm = position
            return said_by(traced, "WarningEvent")

        self.assertEqual(warnings_at(on_skin), [])
        (sentence,) = warnings_at([p - 60 * a for p, a in zip(on_skin, axial)])
        self.assertIn("mm off the body", sentence)
        for organ in ("sternum", "lung_left"):
            (sentence,) = warnings_at(place_in(organ, Fetch(simple.FindSource("thorax"))))
            self.assertIn(f"inside '{organ}'", sentence)
            self.assertIn("move the probe onto the skin", sentence)
            posed.Preview = 1
            self.assertEqual(said_by(traced, "WarningEvent"), [])  # not at every step of the way
            posed.Preview = 0

    def test_zero_sized_image(self):
        wavelet = simple.Wavelet()
        nothing = simple.ProgrammableFilter(Input=wavelet, Script="output.Initialize()")
        nothing.UpdatePipeline()
        (sentence,) = errors_of(simple.UltrasoundScene(Input=nothing))
        self.assertIn("no voxels", sentence)


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
