"""The filter that chains all stages makes what they make, and runs only those that a change concerns."""
import time
import unittest

import numpy as np
from chain import Chain, label_image, listen, make, owner
from sonovdb.vtkSonoFilters import (vtkSonoLabelMapReader, vtkSonoPulseEchoField, vtkSonoSceneBuilder,
                                    vtkSonoUltrasound)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline, vtkTrivialProducer
from vtkmodules.vtkFiltersSources import vtkSphereSource

SETTINGS = {"LineCount": 12, "DepthMm": 90.0, "SectorDeg": 60.0, "PathsPerLine": 20, "BuildSurfaces": False}
# What the stages' own defaults differ in.
CHEST = {"MaxCollisions": 20, "CoherenceMm": 20.0, "LobeSigmaDeg": 6.0}
IMAGE, BMODE_LINES, RF_LINES, TRACED_LINES, ANATOMY, PROBE, RAY_PATHS, FLAT_IMAGE = range(8)
BOUNDARY_HITS = 9
RAW = {TRACED_LINES: "Intensity", RF_LINES: "RF"}


def values(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name)).copy()


class Ultrasound:
    """The filter on the coarse thorax of a chain of stages, with the same settings."""

    def __init__(self, **settings):
        self.stages = Chain()
        self.filter = make(vtkSonoUltrasound, **{**SETTINGS, **settings})
        for part in ("PositionMm", "Axial", "Lateral"):
            getattr(self.filter.GetProbe(), "Set" + part)(*getattr(self.stages.probe, "Get" + part)())
        self.filter.SetInputConnection(self.stages.thorax.GetOutputPort())

    def output(self, port=IMAGE):
        self.filter.Update(port)
        return self.filter.GetOutputDataObject(port)


class TestOutputs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.ultrasound = Ultrasound(NumberOfShownPaths=7)
        cls.filter, cls.chain = cls.ultrasound.filter, cls.ultrasound.stages
        for name, value in CHEST.items():
            getattr(cls.chain.tracer, "Set" + name)(value)
        cls.chain.bmode.SetTgcDbPerCm(3)
        cls.errors = listen(cls.filter)
        for port in range(cls.filter.GetNumberOfOutputPorts()):
            cls.filter.Update(port)
        cls.chain.converter.Update()

    def test_it_says_nothing(self):
        self.assertEqual(self.errors, [])

    def test_image_and_lines_are_those_of_the_stages(self):
        for port, stage, names in ((IMAGE, self.chain.converter, ("BMode", "Mask", "Labels")),
                                   (BMODE_LINES, self.chain.bmode, ("BMode",)),
                                   (RF_LINES, self.chain.formation, ("RF", "IQ", "Envelope")),
                                   (TRACED_LINES, self.chain.tracer, ("Intensity", "StandardError"))):
            made, expected = self.filter.GetOutputDataObject(port), stage.GetOutputDataObject(0)
            for place in ("GetOrigin", "GetSpacing", "GetDimensions"):
                self.assertEqual(getattr(made, place)(), getattr(expected, place)())
            for name in names:
                with self.subTest(port=port, array=name):
                    np.testing.assert_array_equal(values(made, name), values(expected, name))

    def test_image_stands_in_the_world(self):
        made, expected = (image.GetDirectionMatrix() for image in
                          (self.filter.GetOutputDataObject(IMAGE), self.chain.converter.GetOutput()))
        for row in range(3):
            for column in range(3):
                self.assertEqual(made.GetElement(row, column), expected.GetElement(row, column))

    def test_flat_image_is_the_same_in_the_probes_frame(self):
        image, flat = (self.filter.GetOutputDataObject(port) for port in (IMAGE, FLAT_IMAGE))
        np.testing.assert_array_equal(values(flat, "BMode"), values(image, "BMode"))
        position, axial, lateral = (np.array(getattr(self.chain.probe, "Get" + name)())
                                    for name in ("PositionMm", "Axial", "Lateral"))
        axial /= np.linalg.norm(axial)
        lateral -= (lateral @ axial) * axial
        lateral /= np.linalg.norm(lateral)
        for index in ((0, 0), (100, 30), (17, 200)):
            in_world, in_flat = [0.0] * 3, [0.0] * 3
            image.TransformContinuousIndexToPhysicalPoint(*index, 0, in_world)
            flat.TransformContinuousIndexToPhysicalPoint(*index, 0, in_flat)
            np.testing.assert_allclose(position + in_flat[0] * lateral + in_flat[1] * axial, in_world, atol=1e-9)
            self.assertAlmostEqual(in_flat[2], 0)

    def test_black_is_one_inside_and_zero_outside(self):
        image = self.filter.GetOutputDataObject(IMAGE)
        grey, mask = values(image, "BMode"), values(image, "Mask")
        self.assertEqual((grey[mask == 1].min(), grey[mask == 0].max()), (1, 0))

    def test_anatomy_probe_and_paths(self):
        self.assertEqual(self.filter.GetOutputDataObject(ANATOMY).GetNumberOfBlocks(), 1)  # the box
        self.assertEqual(self.filter.GetOutputDataObject(PROBE).GetNumberOfCells(), 2)
        self.assertEqual(self.filter.GetOutputDataObject(RAY_PATHS).GetNumberOfCells(), 7)

    def test_boundary_hits_are_those_of_the_paths(self):
        """A path changes its number of bounces where it hits; each hit names two tissues and lies on a corner's way."""
        paths, hits = (self.filter.GetOutputDataObject(port) for port in (RAY_PATHS, BOUNDARY_HITS))
        self.assertGreater(hits.GetNumberOfPoints(), 14)
        self.assertEqual(hits.GetNumberOfCells(), hits.GetNumberOfPoints())
        lines = vtk_to_numpy(paths.GetCellData().GetArray("Line"))
        self.assertEqual(set(values(hits, "Line")), set(lines))
        normals = vtk_to_numpy(hits.GetPointData().GetNormals())
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-5)
        names = [hits.GetPointData().GetAbstractArray(name) for name in ("FromTissue", "ToTissue")]
        pairs = {tuple(array.GetValue(i) for array in names) for i in range(hits.GetNumberOfPoints())}
        self.assertIn(("skin", "fat"), pairs | {pair[::-1] for pair in pairs})
        self.assertTrue(all(before != behind for before, behind in pairs))
        self.assertTrue((values(hits, "IncidenceDeg") <= 90).all())
        self.assertTrue((values(hits, "PathMm") >= 0.99 * values(hits, "DepthMm")).all())
        bright = values(hits, "Intensity") > 1e-10  # less is shown as that
        np.testing.assert_allclose(values(hits, "IntensityDb")[bright], 20 * np.log10(values(hits, "Intensity")[bright]),
                                   atol=1e-3)
        # Where each path's first corner with another bounce lies, up to the voxel that a hit lies beside its face.
        corners = vtk_to_numpy(paths.GetPoints().GetData())
        hit_points = vtk_to_numpy(hits.GetPoints().GetData())
        first = hit_points[values(hits, "Bounce") == 0]
        for cell in range(7):
            ids = paths.GetCell(cell).GetPointIds()
            bounces = [values(paths, "Bounce")[ids.GetId(i)] for i in range(ids.GetNumberOfIds())]
            later = [i for i, bounce in enumerate(bounces) if bounce > 0] or [len(bounces)]
            corner = corners[ids.GetId(later[0] - 1)]
            self.assertLess(np.linalg.norm(first - corner, axis=1).min(), 4.0)

    def test_every_image_is_announced_as_it_is_made(self):
        for port in (IMAGE, BMODE_LINES, RF_LINES, TRACED_LINES, FLAT_IMAGE):
            with self.subTest(port=port):
                announced = self.filter.GetOutputInformation(port).Get(vtkStreamingDemandDrivenPipeline.WHOLE_EXTENT())
                self.assertEqual(tuple(announced), self.filter.GetOutputDataObject(port).GetExtent())

    def test_stages_can_be_connected_to_its_outputs(self):
        self.chain.formation.SetInputConnection(self.filter.GetOutputPort(TRACED_LINES))
        errors = listen(self.chain.formation)
        self.chain.formation.Update()
        self.assertEqual(errors, [])
        np.testing.assert_array_equal(values(self.chain.formation.GetOutput(), "RF"),
                                      values(self.filter.GetOutputDataObject(RF_LINES), "RF"))

    def test_a_scene_will_do_as_input(self):
        scene = make(vtkSonoSceneBuilder, BuildSurfaces=False)
        scene.SetInputConnection(self.chain.thorax.GetOutputPort())
        ultrasound = Ultrasound()
        ultrasound.filter.SetInputConnection(scene.GetOutputPort())
        np.testing.assert_array_equal(values(ultrasound.output(), "BMode"),
                                      values(self.filter.GetOutputDataObject(IMAGE), "BMode"))


class TestWhatIsMade(unittest.TestCase):
    """An output is made when somebody asks for it."""

    def test_the_lines_are_made_when_they_are_asked_for(self):
        ultrasound = Ultrasound()
        image = values(ultrasound.output(IMAGE), "BMode").copy()
        for port, name in ((RF_LINES, "RF"), (BMODE_LINES, "BMode"), (TRACED_LINES, "Intensity")):
            lines = ultrasound.filter.GetOutputDataObject(port)
            self.assertEqual(lines.GetPointData().GetNumberOfArrays(), 0)
            self.assertGreater(len(values(ultrasound.output(port), name)), 0)
        np.testing.assert_array_equal(values(ultrasound.filter.GetOutputDataObject(IMAGE), "BMode"), image)

    def test_what_nobody_asks_for_keeps_its_data(self):
        ultrasound = Ultrasound()
        ultrasound.output(IMAGE)
        rf = values(ultrasound.output(RF_LINES), "RF").copy()
        ultrasound.filter.GetRayTracer().SetPathsPerLine(30)
        ultrasound.output(IMAGE)
        np.testing.assert_array_equal(values(ultrasound.filter.GetOutputDataObject(RF_LINES), "RF"), rf)
        self.assertFalse(np.array_equal(values(ultrasound.output(RF_LINES), "RF"), rf))

    def texts_of(self, ultrasound):
        """What the filter says it is at, from now on."""
        texts = []
        ultrasound.filter.AddObserver("ProgressEvent", lambda *_: texts.append(ultrasound.filter.GetProgressText()))
        return texts

    def test_lines_after_the_image_are_those_that_it_was_made_from(self):
        ultrasound = Ultrasound()
        texts = self.texts_of(ultrasound)
        ultrasound.output(IMAGE)
        self.assertIn("Tracing", texts)
        texts.clear()
        rf = values(ultrasound.output(RF_LINES), "RF")
        self.assertNotIn("Tracing", texts)
        alone = Ultrasound()
        np.testing.assert_array_equal(rf, values(alone.output(RF_LINES), "RF"))

    def test_a_short_preview_tells_no_progress(self):
        ultrasound = Ultrasound()
        ultrasound.output(IMAGE)
        told = []
        ultrasound.filter.AddObserver("ProgressEvent", lambda *_: told.append(ultrasound.filter.GetProgress()))
        for preview, paths in ((False, 30), (True, 40)):
            ultrasound.filter.GetProbe().SetPreview(preview)
            ultrasound.filter.GetRayTracer().SetPathsPerLine(paths)
            told.clear()
            begin = time.monotonic()
            ultrasound.output(IMAGE)
            # Its executive tells the beginning and the end. A machine that takes longer is told so.
            amid = [progress for progress in told if 0.0 < progress < 1.0]
            if preview and time.monotonic() - begin < 1.0:
                self.assertEqual(amid, [])
            elif not preview:
                self.assertGreater(len(amid), 0)

    def test_asking_for_the_probe_simulates_nothing(self):
        ultrasound = Ultrasound()
        texts = self.texts_of(ultrasound)
        self.assertEqual(ultrasound.output(PROBE).GetNumberOfCells(), 2)
        self.assertNotIn("Tracing", texts)


class TestRunningAgain(unittest.TestCase):
    """An array keeps its modification time where its stage did not run."""

    PORTS = {BMODE_LINES: "BMode", RF_LINES: "RF", TRACED_LINES: "Intensity", IMAGE: "BMode"}

    def times(self, ultrasound):
        made = {port: ultrasound.output(port).GetPointData().GetArray(name).GetMTime()
                for port, name in self.PORTS.items()}
        made[ANATOMY] = ultrasound.output(ANATOMY).GetFieldData().GetAbstractArray("SonoScene").GetMTime()
        return made

    def changed(self, change):
        """The outputs that are made again after a change."""
        ultrasound = Ultrasound()
        before = self.times(ultrasound)
        change(ultrasound.filter)
        return {port for port, time in self.times(ultrasound).items() if time != before[port]}

    def test_nothing_changed_nothing_runs(self):
        self.assertEqual(self.changed(lambda _: None), set())
        self.assertEqual(self.changed(lambda ultrasound: ultrasound.Modified()), set())

    def test_gain_does_not_trace_again(self):
        self.assertEqual(self.changed(lambda ultrasound: owner(ultrasound, "GainDb").SetGainDb(6)), {BMODE_LINES, IMAGE})
        self.assertEqual(self.changed(lambda ultrasound: ultrasound.GetBMode().SetTgc3Db(3)), {BMODE_LINES, IMAGE})

    def test_pixel_size_makes_the_image_only(self):
        self.assertEqual(self.changed(lambda ultrasound: owner(ultrasound, "PixelMm").SetPixelMm(0.5)), {IMAGE})

    def test_beam_width_forms_echoes_again(self):
        self.assertEqual(self.changed(lambda ultrasound: owner(ultrasound, "LateralSigmaMm").SetLateralSigmaMm(2)), {RF_LINES, BMODE_LINES, IMAGE})

    def test_pose_keeps_the_anatomy(self):
        self.assertEqual(self.changed(lambda ultrasound: owner(ultrasound, "PositionMm").SetPositionMm(80, -86, -45)),
                         {TRACED_LINES, RF_LINES, BMODE_LINES, IMAGE})

    def test_tissues_change_everything(self):
        self.assertEqual(self.changed(lambda ultrasound: owner(ultrasound, "FillBody").SetFillBody(True)),
                         {ANATOMY, TRACED_LINES, RF_LINES, BMODE_LINES, IMAGE})


class TestOptionalInputs(unittest.TestCase):
    """What else may be scanned goes to the stage that takes it, and is gone when it is taken away."""

    def setUp(self):
        self.ultrasound = Ultrasound()
        self.chain = self.ultrasound.stages
        for name, value in CHEST.items():
            getattr(self.chain.tracer, "Set" + name)(value)
        self.place = np.array(self.chain.probe.GetPositionMm()) + 40 * np.array(self.chain.probe.GetAxial())

    def expect_as_in_the_chain(self, port, stage, stage_port, source, changed):
        """The source's output on an optional port, and on the stage's port in the chain."""
        bare = {output: values(self.ultrasound.output(output), name) for output, name in RAW.items()}
        self.ultrasound.filter.SetInputConnection(port, source.GetOutputPort())
        stage.SetInputConnection(stage_port, source.GetOutputPort())
        self.chain.formation.Update()
        for output, made_by in ((TRACED_LINES, self.chain.tracer), (RF_LINES, self.chain.formation)):
            with self.subTest(output=output):
                made = values(self.ultrasound.output(output), RAW[output])
                np.testing.assert_array_equal(made, values(made_by.GetOutputDataObject(0), RAW[output]))
                self.assertEqual((made != bare[output]).any(), output in changed)
        self.ultrasound.filter.RemoveAllInputConnections(port)
        for output, name in RAW.items():
            np.testing.assert_array_equal(values(self.ultrasound.output(output), name), bare[output])

    def test_targets(self):
        sphere = make(vtkSphereSource, Radius=8.0, Center=tuple(self.place), ThetaResolution=32, PhiResolution=32)
        self.expect_as_in_the_chain(vtkSonoUltrasound.TARGETS, self.chain.tracer, 2, sphere, {TRACED_LINES, RF_LINES})
        other = make(vtkSphereSource, Radius=4.0, Center=tuple(self.place), ThetaResolution=32, PhiResolution=32)
        self.expect_as_in_the_chain(vtkSonoUltrasound.TARGETS, self.chain.tracer, 2, other, {TRACED_LINES, RF_LINES})

    def test_point_scatterers(self):
        points, amplitude = vtkPoints(), numpy_to_vtk(np.ones(1, np.float32), deep=True)
        points.InsertNextPoint(self.place)
        amplitude.SetName("Amplitude")
        cloud = vtkPolyData()
        cloud.SetPoints(points)
        cloud.GetPointData().AddArray(amplitude)
        source = vtkTrivialProducer()
        source.SetOutput(cloud)
        self.expect_as_in_the_chain(vtkSonoUltrasound.SCATTERERS, self.chain.formation, 1, source, {RF_LINES})

    def test_pulse_echo_field(self):
        field = make(vtkSonoPulseEchoField, ElementCount=8, ElementHeightMm=3.0, TransmitFocusMm=20.0,
                     ElevationFocusMm=20.0, FractionalBandwidth=0.0, DepthMm=90.0)
        self.expect_as_in_the_chain(vtkSonoUltrasound.PULSE_ECHO_FIELD, self.chain.formation, 2, field, {RF_LINES})


class TestStages(unittest.TestCase):
    def test_a_given_stage_takes_the_place_of_the_filters_own(self):
        ultrasound = Ultrasound()
        before = values(ultrasound.output(), "BMode")
        bmode = make(type(ultrasound.filter.GetBMode()), GainDb=10.0, TgcDbPerCm=3.0)
        ultrasound.filter.SetBMode(bmode)
        self.assertIs(ultrasound.filter.GetBMode(), bmode)
        brighter = values(ultrasound.output(), "BMode")
        self.assertGreater(brighter.mean(), before.mean())
        bmode.SetGainDb(0.0)
        np.testing.assert_array_equal(values(ultrasound.output(), "BMode"), before)
        ultrasound.filter.SetBMode(None)
        self.assertIs(ultrasound.filter.GetBMode(), bmode)

    def test_one_device_and_one_pixel_size_for_all(self):
        ultrasound = Ultrasound(PixelMm=0.5)
        ultrasound.filter.ErrorMapOn()
        ultrasound.filter.GetRayTracer().SetDevice(1)
        image = ultrasound.output()
        self.assertEqual(ultrasound.filter.GetImageFormation().GetDevice(), 1)
        self.assertEqual(image.GetDimensions(), ultrasound.output(8).GetDimensions())

    def test_paths_and_scatterers_have_seeds_of_their_own(self):
        ultrasound = Ultrasound()
        intensity, rf = (values(ultrasound.output(port), RAW[port]) for port in (TRACED_LINES, RF_LINES))
        ultrasound.filter.GetImageFormation().SetScattererSeed(2)
        np.testing.assert_array_equal(values(ultrasound.output(TRACED_LINES), "Intensity"), intensity)
        self.assertTrue((values(ultrasound.output(RF_LINES), "RF") != rf).any())
        ultrasound.filter.GetRayTracer().SetPathSeed(2)
        self.assertTrue((values(ultrasound.output(TRACED_LINES), "Intensity") != intensity).any())


class TestChangingInput(unittest.TestCase):
    def test_another_label_map_and_back(self):
        ultrasound = Ultrasound()
        first = values(ultrasound.output(), "BMode")
        other = vtkImageData()
        other.DeepCopy(ultrasound.stages.thorax.GetOutput())
        vtk_to_numpy(other.GetPointData().GetScalars())[...] = 0
        other.GetPointData().GetScalars().SetValue(0, 1)
        ultrasound.filter.SetInputData(other)
        self.assertFalse((values(ultrasound.output(), "BMode") == first).all())
        ultrasound.filter.SetInputConnection(ultrasound.stages.thorax.GetOutputPort())
        np.testing.assert_array_equal(values(ultrasound.output(), "BMode"), first)

    def test_another_label_map_while_it_runs(self):
        """The next run takes what was connected meanwhile; the one under way says at most that it lost its input."""
        ultrasound = Ultrasound()
        whole = values(ultrasound.output(), "BMode")
        coarse = make(type(ultrasound.stages.thorax), SpacingMm=5.0)
        for moment in (0, 1, 2):  # before the data are made, while they are
            with self.subTest(moment=moment):
                events = []

                def switch(*_):
                    events.append(1)
                    if len(events) == moment + 1:
                        ultrasound.filter.SetInputConnection(coarse.GetOutputPort())

                ultrasound.filter.GetRayTracer().SetPathsPerLine(21)
                tag = ultrasound.filter.AddObserver("ProgressEvent", switch)
                errors = listen(ultrasound.filter)
                ultrasound.filter.Update()
                ultrasound.filter.RemoveObserver(tag)
                self.assertLessEqual(len(errors), 1)
                ultrasound.filter.GetRayTracer().SetPathsPerLine(20)
                self.assertFalse((values(ultrasound.output(), "BMode") == whole).all())
                ultrasound.filter.SetInputConnection(ultrasound.stages.thorax.GetOutputPort())
                np.testing.assert_array_equal(values(ultrasound.output(), "BMode"), whole)

    def test_abort_is_quiet_and_the_next_run_is_whole(self):
        ultrasound = Ultrasound()
        whole = values(ultrasound.output(), "BMode")
        errors = listen(ultrasound.filter)
        for name, value in (("PathsPerLine", 21), ("FillBody", True)):  # stops the tracer, the scene
            with self.subTest(changed=name):
                before = getattr(owner(ultrasound.filter, name), "Get" + name)()
                getattr(owner(ultrasound.filter, name), "Set" + name)(value)
                stop = ultrasound.filter.AddObserver(
                    "ProgressEvent", lambda *_: ultrasound.filter.SetAbortExecuteAndUpdateTime())
                ultrasound.filter.Update()
                ultrasound.filter.RemoveObserver(stop)
                ultrasound.filter.AbortExecuteOff()
                getattr(owner(ultrasound.filter, name), "Set" + name)(before)
                np.testing.assert_array_equal(values(ultrasound.output(), "BMode"), whole)
        self.assertEqual(errors, [])


class TestBadInput(unittest.TestCase):
    def expect(self, ultrasound, *words):
        said = listen(ultrasound)
        ultrasound.Update()
        self.assertEqual(len(said), 1, said)
        for word in words:
            self.assertIn(word.lower(), said[0].lower())

    def test_the_sentence_of_the_stage_is_its_own(self):
        for name, value, word in (("LineCount", 0, "lineCount"), ("PathsPerLine", 0, "pathsPerLine"),
                                  ("PixelMm", 0.0, "pixelMm"), ("TissueTableFile", "nowhere.csv", "nowhere.csv"),
                                  ("DynamicRangeDb", 0.0, "range")):
            with self.subTest(setting=name):
                self.expect(Ultrasound(**{name: value}).filter, word)

    def test_a_failure_is_over_once_its_cause_is(self):
        ultrasound = Ultrasound(PathsPerLine=0)
        self.expect(ultrasound.filter, "pathsPerLine")
        ultrasound.filter.GetRayTracer().SetPathsPerLine(20)
        said = listen(ultrasound.filter)
        self.assertGreater(values(ultrasound.output(), "BMode").max(), 200)
        self.assertEqual(said, [])

    def test_an_image_without_labels(self):
        ultrasound = vtkSonoUltrasound()
        ultrasound.SetInputData(label_image(np.full((3, 3, 3), 0.37, np.float32)))
        self.expect(ultrasound, "0.37", "whole number")

    def test_an_empty_image(self):
        ultrasound = vtkSonoUltrasound()
        ultrasound.SetInputData(vtkImageData())
        self.expect(ultrasound, "no voxels")

    def test_a_label_map_that_cannot_be_read(self):
        """The reader says so; the filter has nothing to add."""
        reader, ultrasound = make(vtkSonoLabelMapReader, FileName="nowhere/no.nii.gz"), vtkSonoUltrasound()
        ultrasound.SetInputConnection(reader.GetOutputPort())
        of_reader, of_filter = listen(reader), listen(ultrasound)
        ultrasound.Update()
        self.assertEqual((len(of_reader), of_filter), (1, []))



class TestWarnings(unittest.TestCase):
    """What the stages inside warn of is an event of the filter, once each time that it is found."""

    def setUp(self):
        self.ultrasound = Ultrasound()
        self.warnings = listen(self.ultrasound.filter, "WarningEvent")

    def test_a_probe_off_the_skin(self):
        self.ultrasound.output()
        self.assertEqual(self.warnings, [])
        position = np.array(self.ultrasound.stages.probe.GetPositionMm())
        axial = np.array(self.ultrasound.stages.probe.GetAxial())
        for run, distance_mm in enumerate((40, 50), start=1):
            self.ultrasound.filter.GetProbe().SetPositionMm(*(position - distance_mm * axial / np.linalg.norm(axial)))
            self.ultrasound.output()
            self.assertEqual(len(self.warnings), run, self.warnings)
            self.assertIn("skin", self.warnings[-1])
        self.ultrasound.filter.GetBMode().SetGainDb(5)  # of the same lines
        self.ultrasound.output()
        self.assertEqual(len(self.warnings), 2)

    def test_labels_without_a_tissue(self):
        self.ultrasound.filter.SetInputDataObject(label_image(np.full((20, 20, 20), 21, np.uint8)))
        self.ultrasound.filter.GetProbe().SetPositionMm(10, 10, 0)
        self.ultrasound.filter.GetProbe().SetAxial(0, 0, 1)
        self.ultrasound.filter.GetProbe().SetLateral(1, 0, 0)
        self.ultrasound.output()
        self.assertEqual(sum("label_21" in sentence for sentence in self.warnings), 1, self.warnings)


if __name__ == "__main__":
    unittest.main()
