"""How the stages work as a pipeline: what they make, when they run again, how they stop."""
import os
import tempfile
import unittest

import numpy as np
from chain import Chain, count_runs, label_image, listen, make
from sonovdb.vtkSonoFilters import vtkSonoALine, vtkSonoSceneBuilder
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline, vtkTrivialProducer


def values(image, name):
    return vtk_to_numpy(image.GetPointData().GetArray(name))


class TestStages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        window, cls.messages = vtkOutputWindow.GetInstance(), vtkStringOutputWindow()
        vtkOutputWindow.SetInstance(cls.messages)
        cls.chain = Chain()
        cls.chain.converter.Update()
        vtkOutputWindow.SetInstance(window)

    def test_a_run_has_nothing_to_complain_about(self):
        self.assertEqual(self.messages.GetOutput(), "")

    def test_each_stage_says_what_it_does(self):
        """What the status bar shows instead of the class."""
        texts = [stage.GetProgressText() for stage in self.chain.stages().values()]
        self.assertTrue(all(texts), texts)
        self.assertEqual(len(set(texts)), len(texts))

    def test_traced_lines_have_one_row_a_line(self):
        lines = self.chain.tracer.GetOutputDataObject(0)
        self.assertEqual(lines.GetDimensions(), (375, 12, 1))  # 90 mm and 4 % of it in bins of 0.25 mm: 374.4
        self.assertAlmostEqual(lines.GetOrigin()[0], 0.125)    # the first bin's centre
        self.assertAlmostEqual(lines.GetSpacing()[0], 0.25)
        intensity = values(lines, "Intensity")
        self.assertTrue(np.all(np.isfinite(intensity)) and intensity.max() > 0.5 and intensity.min() >= 0)
        self.assertEqual(values(lines, "StandardError").size, intensity.size)

    def test_boundary_echoes_are_the_second_output_and_travel_with_the_first(self):
        echoes = values(self.chain.tracer.GetOutputDataObject(1), "BoundaryEcho")
        carried = self.chain.tracer.GetOutputDataObject(0).GetFieldData().GetArray("BoundaryEcho")
        self.assertEqual(echoes.shape[1], 2)
        np.testing.assert_array_equal(echoes, vtk_to_numpy(carried))

    def test_envelope_is_the_modulus_of_iq_and_bounds_rf(self):
        lines = self.chain.formation.GetOutput()
        self.assertAlmostEqual(lines.GetSpacing()[0], 1.54 / 40)  # c0 / (2 fs), eight samples a period
        envelope = values(lines, "Envelope")
        iq = values(lines, "IQ")
        np.testing.assert_allclose(envelope, np.hypot(iq[:, 0], iq[:, 1]), rtol=1e-5, atol=1e-12)
        self.assertTrue(np.all(np.abs(values(lines, "RF")) <= envelope * 1.0001 + 1e-12))
        self.assertIsNone(lines.GetFieldData().GetArray("BoundaryEcho"))

    def test_bmode_is_the_logarithm_of_the_gained_envelope(self):
        lines = self.chain.bmode.GetOutput()
        reference = lines.GetFieldData().GetArray("ReferenceAmplitude").GetValue(0)
        depth_cm = np.arange(lines.GetDimensions()[0]) * lines.GetSpacing()[0] / 10
        envelope = values(self.chain.formation.GetOutput(), "Envelope").reshape(12, -1).astype(float)
        with np.errstate(divide="ignore"):
            level = 20 * np.log10(envelope / reference) + 5 * depth_cm
        expected = np.clip(1 + level / 60, 0, 1)
        np.testing.assert_allclose(values(lines, "BMode").reshape(12, -1), expected, atol=2e-5)

    def test_picture_has_grey_inside_its_mask_only(self):
        picture = self.chain.converter.GetOutput()
        grey, mask = values(picture, "BMode"), values(picture, "Mask")
        self.assertEqual((grey.dtype, mask.dtype), (np.uint8, np.uint8))
        self.assertEqual(set(np.unique(mask)), {0, 1})
        self.assertEqual(grey[mask == 0].max(), 0)
        self.assertGreater(grey[mask == 1].max(), 200)
        sector_mm2 = np.pi * 90**2 * 60 / 360
        self.assertAlmostEqual(mask.sum() * 0.23**2 / sector_mm2, 1, delta=0.01)

    def test_one_line_as_a_table(self):
        lines = self.chain.formation.GetOutput()
        a_line = make(vtkSonoALine, Line=5)
        a_line.SetInputConnection(self.chain.formation.GetOutputPort())
        a_line.Update()
        table = a_line.GetOutput()

        def column(name):
            return vtk_to_numpy(table.GetColumnByName(name))

        envelope = values(lines, "Envelope").reshape(12, -1)
        np.testing.assert_allclose(column("Depth (mm)"), np.arange(envelope.shape[1]) * lines.GetSpacing()[0])
        np.testing.assert_array_equal(column("Envelope"), envelope[5])
        np.testing.assert_array_equal(column("RF"), values(lines, "RF").reshape(12, -1)[5])
        expected = 20 * np.log10(np.maximum(envelope[5].astype(float) / envelope.max(), 1e-10))
        np.testing.assert_allclose(column("Envelope (dB)"), expected, atol=1e-6)
        a_line.SetLine(99)
        a_line.Update()
        np.testing.assert_array_equal(column("Envelope"), envelope[11])

    def test_every_image_is_announced_as_it_is_made(self):
        whole_extent = vtkStreamingDemandDrivenPipeline.WHOLE_EXTENT()
        for name in ("thorax", "tracer", "formation", "bmode", "converter"):
            stage = self.chain.stages()[name]
            for port in range(stage.GetNumberOfOutputPorts()):
                if not stage.GetOutputDataObject(port).IsA("vtkImageData"):
                    continue
                with self.subTest(stage=name, port=port):
                    announced = stage.GetOutputInformation(port).Get(whole_extent)
                    self.assertEqual(tuple(announced), stage.GetOutputDataObject(port).GetExtent())

    def test_depths_that_are_whole_bins_but_for_rounding_are_announced_as_they_are_made(self):
        whole_extent = vtkStreamingDemandDrivenPipeline.WHOLE_EXTENT()
        chain = Chain()
        chain.tracer.SetPathsPerLine(1)
        for depth_mm in (122.5, 148.75, 157.5, 166.25):  # 4 % deeper than these are 364, 442, 468 and 494 bins of 0.35
            for bin_mm in (0.35, 0.7):
                with self.subTest(depth=depth_mm, bin=bin_mm):
                    chain.probe.SetDepthMm(depth_mm)
                    chain.tracer.SetRadialBinMm(bin_mm)
                    chain.tracer.Update()
                    self.assertEqual(chain.tracer.GetOutputDataObject(0).GetDimensions()[0],
                                     round(1.04 * depth_mm / bin_mm))
                    for port in (0, 1):
                        announced = chain.tracer.GetOutputInformation(port).Get(whole_extent)
                        self.assertEqual(tuple(announced), chain.tracer.GetOutputDataObject(port).GetExtent())


class TestRunningAgain(unittest.TestCase):
    def changed(self, change):
        """Names of the stages that run again after a change."""
        chain = Chain()
        chain.converter.Update()
        runs = {name: count_runs(stage) for name, stage in chain.stages().items()}
        change(chain)
        chain.converter.Update()
        return {name for name, times in runs.items() if times}

    def test_nothing_changed_nothing_runs(self):
        self.assertEqual(self.changed(lambda chain: None), set())

    def test_gain(self):
        self.assertEqual(self.changed(lambda chain: chain.bmode.SetGainDb(6)), {"bmode", "converter"})

    def test_tgc_slider(self):
        self.assertEqual(self.changed(lambda chain: chain.bmode.SetTgc3Db(3)), {"bmode", "converter"})

    def test_sliders_brighten_their_part(self):
        chain = Chain()
        chain.bmode.Update()
        before = values(chain.bmode.GetOutput(), "BMode").reshape(12, -1).copy()
        chain.bmode.AutomaticReferenceOff()
        reference = chain.bmode.GetOutput().GetFieldData().GetArray("ReferenceAmplitude").GetTuple1(0)
        chain.bmode.SetReferenceAmplitude(reference)
        chain.bmode.SetTgc8Db(6)
        chain.bmode.SetLateralGain1Db(12)
        chain.bmode.Update()
        lift = values(chain.bmode.GetOutput(), "BMode").reshape(12, -1) - before
        shown = (before > 0) & (before + lift < 1)
        samples = lift.shape[1]
        np.testing.assert_allclose(lift[4:, :samples // 2][shown[4:, :samples // 2]], 0, atol=2e-5)
        end = slice(int(0.95 * samples), None)
        np.testing.assert_allclose(lift[4:, end][shown[4:, end]], 0.1, atol=2e-5)  # 6 dB of 60
        np.testing.assert_allclose(lift[0, :samples // 2][shown[0, :samples // 2]], 0.2, atol=2e-5)

    def test_pixel_size(self):
        self.assertEqual(self.changed(lambda chain: chain.converter.SetPixelMm(0.5)), {"converter"})

    def test_beam_width(self):
        self.assertEqual(self.changed(lambda chain: chain.formation.SetLateralSigmaMm(2)),
                         {"formation", "bmode", "converter"})

    def test_probe(self):
        self.assertEqual(self.changed(lambda chain: chain.probe.SetDepthMm(80)),
                         {"probe", "tracer", "formation", "bmode", "converter"})

    def test_grey_map_is_applied_to_the_level(self):
        chain = Chain()
        chain.bmode.Update()
        level = values(chain.bmode.GetOutput(), "BMode").copy()
        chain.bmode.SetGreyMap("S-Shaped")
        chain.bmode.Update()
        expected = level * level * (3 - 2 * level)
        np.testing.assert_allclose(values(chain.bmode.GetOutput(), "BMode"), expected, atol=6e-5)

    def test_grey_map_of_ones_own(self):
        chain = Chain()
        chain.bmode.Update()
        level = values(chain.bmode.GetOutput(), "BMode").copy()
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "inverse.csv")
            with open(path, "w") as file:
                file.write("level,grey\n0,1\n1,0\n")
            chain.bmode.SetGreyMapFile(path)
            chain.bmode.Update()
        np.testing.assert_allclose(values(chain.bmode.GetOutput(), "BMode"), 1 - level, atol=1e-5)

    def test_grey_map_that_is_none(self):
        chain = Chain()
        said = listen(chain.bmode)
        chain.bmode.SetGreyMap("Sepia")
        chain.bmode.Update()
        self.assertEqual(len(said), 1, said)
        self.assertIn("S-Shaped", said[0])

    def test_noise_is_added_only_when_asked_for(self):
        chain = Chain()
        chain.bmode.SetNoiseDb(-60)
        chain.bmode.AutomaticReferenceOff()
        chain.bmode.SetReferenceAmplitude(0.1)
        chain.bmode.Update()
        clean = values(chain.bmode.GetOutput(), "BMode").copy()
        chain.bmode.AddNoiseOn()
        chain.bmode.Update()
        self.assertGreater(values(chain.bmode.GetOutput(), "BMode").mean(), clean.mean() + 0.01)

    def test_gain_brightens_by_its_decibels(self):
        chain = Chain()
        chain.converter.Update()
        before = values(chain.bmode.GetOutput(), "BMode").copy()
        chain.bmode.SetGainDb(6)
        chain.converter.Update()
        after = values(chain.bmode.GetOutput(), "BMode")
        between = (before > 0) & (after < 1)
        np.testing.assert_allclose(after[between] - before[between], 0.1, atol=2e-5)  # 6 dB of 60


class TestScene(unittest.TestCase):
    def test_surfaces_are_named_and_coloured(self):
        chain = Chain()
        chain.scene.SetBuildSurfaces(True)
        chain.scene.Update()
        blocks = chain.scene.GetOutput()
        names = [blocks.GetMetaData(i).Get(vtkMultiBlockDataSet.NAME()) for i in range(blocks.GetNumberOfBlocks())]
        self.assertIn("left_ventricle_myocardium", names)
        self.assertNotIn("background", names)
        table = blocks.GetFieldData().GetAbstractArray("LabelNames")
        self.assertEqual(names, [table.GetValue(i) for i in range(table.GetNumberOfValues())][1:])
        lung = blocks.GetBlock(names.index("lung_left"))
        self.assertGreater(lung.GetNumberOfCells(), 1000)
        self.assertEqual(lung.GetCellData().GetArray("Color").GetNumberOfTuples(), lung.GetNumberOfCells())

    def test_outline_shows_the_outer_faces_of_the_voxels(self):
        scene = make(vtkSonoSceneBuilder, BuildSurfaces=False)
        image = label_image(np.ones((4, 3, 2), np.uint16))
        image.SetOrigin(10, 20, 30)
        image.SetSpacing(1, 2, 3)
        scene.SetInputData(image)
        scene.Update()
        bounds = [0.0] * 6
        scene.GetOutput().GetBounds(bounds)
        np.testing.assert_allclose(bounds, [9.5, 11.5, 19, 25, 28.5, 40.5], atol=1e-5)

    def test_any_type_of_whole_numbers_will_do(self):
        voxels = np.zeros((6, 6, 6))
        voxels[2:4, 2:4, 2:4] = 7
        for kind in (np.uint8, np.int16, np.uint16, np.int32, np.float32, np.float64):
            with self.subTest(type=kind.__name__):
                scene = make(vtkSonoSceneBuilder, BuildSurfaces=False)
                scene.SetInputData(label_image(voxels.astype(kind)))
                errors = listen(scene)
                scene.Update()
                ids = scene.GetOutput().GetFieldData().GetArray("LabelIds")
                self.assertEqual((errors, [ids.GetValue(i) for i in range(2)]), ([], [0, 7]))

    def test_unmapped_labels_give_one_warning_with_their_names(self):
        scene = make(vtkSonoSceneBuilder, BuildSurfaces=False)
        voxels = np.zeros((4, 4, 4), np.uint8)
        voxels[1, 1, 1], voxels[2, 2, 2] = 21, 22
        scene.SetInputData(label_image(voxels))
        warnings = listen(scene, "WarningEvent")
        scene.Update()
        self.assertEqual(len(warnings), 1)
        for word in ("label_21", "label_22", "soft_tissue"):
            self.assertIn(word, warnings[0])

    def test_a_deep_copy_carries_the_scene(self):
        chain = Chain()
        chain.scene.Update()
        copy = vtkMultiBlockDataSet()
        copy.DeepCopy(chain.scene.GetOutput())
        producer = vtkTrivialProducer()
        producer.SetOutput(copy)
        chain.tracer.SetInputConnection(0, producer.GetOutputPort())
        errors = listen(chain.tracer)
        chain.tracer.Update()
        self.assertEqual(errors, [])


class TestStopping(unittest.TestCase):
    def test_abort_is_quiet_and_the_next_run_is_whole(self):
        chain = Chain()
        chain.tracer.Update()
        whole = values(chain.tracer.GetOutputDataObject(0), "Intensity").copy()
        chain.tracer.SetPathsPerLine(21)
        errors = listen(chain.tracer)
        stop = chain.tracer.AddObserver("ProgressEvent", lambda *_: chain.tracer.SetAbortExecuteAndUpdateTime())
        chain.tracer.Update()
        self.assertEqual(errors, [])
        self.assertIsNone(chain.tracer.GetOutputDataObject(0).GetPointData().GetArray("Intensity"))

        chain.tracer.RemoveObserver(stop)
        chain.tracer.AbortExecuteOff()
        chain.tracer.SetPathsPerLine(20)
        chain.tracer.Update()
        np.testing.assert_array_equal(values(chain.tracer.GetOutputDataObject(0), "Intensity"), whole)

    def test_progress_rises_to_the_end(self):
        chain = Chain()
        for stage in (chain.scene, chain.tracer, chain.formation):
            with self.subTest(stage=stage.GetClassName()):
                seen = []
                stage.AddObserver("ProgressEvent", lambda caller, _: seen.append(caller.GetProgress()))
                stage.Update()
                self.assertGreater(len(seen), 1)
                self.assertEqual(seen, sorted(seen))
                self.assertTrue(0 <= seen[0] and seen[-1] <= 1)


if __name__ == "__main__":
    unittest.main()
