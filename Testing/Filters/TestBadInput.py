"""Bad input gives one sentence that names the fault and the way out, and no output."""
import pathlib
import tempfile
import unittest

import numpy as np
from chain import Chain, label_image, listen, make
from sonovdb.vtkSonoFilters import (vtkSonoLabelMapReader, vtkSonoProbeSource, vtkSonoScanConverter,
                                    vtkSonoSceneBuilder, vtkSonoThoraxSource)
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersGeneral import vtkTransformFilter
from vtkmodules.vtkFiltersSources import vtkPlaneSource, vtkSphereSource
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter


class TestBadInput(unittest.TestCase):
    def expect(self, stage, *words):
        """The stage says one sentence with these words, in any case."""
        said = listen(stage)
        stage.Update()
        self.assertEqual(len(said), 1, said)
        for word in words:
            self.assertIn(word.lower(), said[0].lower())

    def scene_of(self, voxels, **settings):
        scene = make(vtkSonoSceneBuilder, BuildSurfaces=False, **settings)
        scene.SetInputData(label_image(voxels))
        return scene

    def test_missing_file(self):
        self.expect(make(vtkSonoLabelMapReader, FileName="nowhere/no.nii.gz"), "nowhere/no.nii.gz")

    def test_missing_vtk_image(self):
        self.expect(make(vtkSonoLabelMapReader, FileName="nowhere/no.vti"), "nowhere/no.vti")

    def test_too_many_pixels(self):
        chain = Chain()
        chain.converter.SetPixelMm(0.001)
        self.expect(chain.converter, "pixelMm", "larger")

    def test_label_map_without_labels(self):
        chain = Chain()
        chain.converter.SetInputDataObject(1, label_image(np.full((3, 3, 3), 0.37, np.float32)))
        self.expect(chain.converter, "0.37", "whole number")

    def test_failure_is_told_once(self):
        """The executive does not add its own message, for which the window has no use."""
        window, messages = vtkOutputWindow.GetInstance(), vtkStringOutputWindow()
        vtkOutputWindow.SetInstance(messages)
        self.scene_of(np.full((3, 3, 3), 0.37, np.float32)).Update()
        vtkOutputWindow.SetInstance(window)
        self.assertEqual(messages.GetOutput().count("ERROR:"), 1, messages.GetOutput())
        self.assertIn("0.37", messages.GetOutput())

    def test_failure_is_told_again_only_after_a_change(self):
        reader = make(vtkSonoLabelMapReader, FileName="nowhere/no.nii.gz")
        said = listen(reader)
        for _ in range(3):
            reader.Update()
        self.assertEqual(len(said), 1)
        reader.Modified()
        reader.Update()
        self.assertEqual(len(said), 2)

    def test_what_is_downstream_of_a_failure_is_silent_and_empty(self):
        chain = Chain()
        stages = [chain.scene, chain.tracer, chain.formation, chain.bmode, chain.converter]
        said = [listen(stage) for stage in stages]
        chain.converter.Update()
        pixels = chain.converter.GetOutput().GetNumberOfPoints()
        self.assertGreater(pixels, 0)
        chain.scene.SetTissueTableFile("nowhere.csv")
        for _ in range(2):
            chain.converter.Update()
        self.assertEqual([len(sentences) for sentences in said], [1, 0, 0, 0, 0])
        self.assertEqual(chain.converter.GetOutput().GetNumberOfPoints(), 0)
        chain.scene.SetTissueTableFile("")
        chain.converter.Update()
        self.assertEqual(chain.converter.GetOutput().GetNumberOfPoints(), pixels)
        self.assertEqual([len(sentences) for sentences in said], [1, 0, 0, 0, 0])

    def test_file_that_comes_and_goes(self):
        """The size of the image is announced before it is read."""
        with tempfile.TemporaryDirectory() as folder:
            path = str(pathlib.Path(folder, "labels.vti"))
            writer = make(vtkXMLImageDataWriter, FileName=path)
            writer.SetInputData(label_image(np.full((3, 4, 5), 7, np.uint8)))
            writer.Write()
            reader = make(vtkSonoLabelMapReader, FileName=path)
            scene = make(vtkSonoSceneBuilder, BuildSurfaces=False)
            scene.SetInputConnection(reader.GetOutputPort())
            said = [listen(reader), listen(scene)]
            for name, points in ((path, 8), (path + "x", 0), (path, 8)):
                reader.SetFileName(name)
                scene.Update()
                self.assertEqual(scene.GetOutput().GetNumberOfPoints(), points)
        self.assertEqual([len(sentences) for sentences in said], [1, 0])

    def test_target_that_is_not_closed(self):
        chain, plane = Chain(), vtkPlaneSource()
        chain.tracer.SetInputConnection(2, plane.GetOutputPort())
        self.expect(chain.tracer, "not a closed surface")

    def test_target_of_an_unknown_tissue(self):
        chain, sphere = Chain(), vtkSphereSource()
        chain.tracer.SetInputConnection(2, sphere.GetOutputPort())
        chain.tracer.SetTargetTissue("unobtainium")
        self.expect(chain.tracer, "unobtainium", "tissue table")

    def test_too_many_shown_paths(self):
        chain = Chain()
        chain.tracer.SetNumberOfShownPaths(-1)
        self.expect(chain.tracer, "paths")

    def test_scatterers_without_amplitude(self):
        chain, sphere = Chain(), vtkSphereSource()
        chain.formation.SetInputConnection(1, sphere.GetOutputPort())
        self.expect(chain.formation, "'Amplitude'")

    def test_no_file_named(self):
        self.expect(vtkSonoLabelMapReader(), "FileName")

    def test_thorax_spacing_out_of_range(self):
        self.expect(make(vtkSonoThoraxSource, SpacingMm=0.01), "0.5", "5")

    def test_float_image_that_holds_no_labels(self):
        self.expect(self.scene_of(np.full((3, 3, 3), 0.37, np.float32)), "'Labels'", "0.37", "whole number")

    def test_negative_and_not_finite_values(self):
        self.expect(self.scene_of(np.full((3, 3, 3), -1024, np.int16)), "-1024")
        self.expect(self.scene_of(np.full((3, 3, 3), np.nan)), "nan")

    def test_colour_image(self):
        scene = vtkSonoSceneBuilder()
        image = vtkImageData()
        image.SetDimensions(2, 2, 2)
        image.AllocateScalars(3, 3)
        scene.SetInputData(image)
        self.expect(scene, "one component")

    def test_zero_sized_image(self):
        scene = vtkSonoSceneBuilder()
        scene.SetInputData(vtkImageData())
        self.expect(scene, "no voxels")

    def test_unknown_tissue(self):
        voxels = np.zeros((3, 3, 3), np.uint8)
        voxels[1, 1, 1] = 9
        self.expect(self.scene_of(voxels, FallbackTissue="unobtainium"), "unobtainium")

    def test_missing_tissue_table(self):
        self.expect(self.scene_of(np.zeros((3, 3, 3), np.uint8), TissueTableFile="nowhere.csv"), "nowhere.csv")
        self.expect(self.scene_of(np.zeros((3, 3, 3), np.uint8), LabelTissueFile="nowhere.csv"), "nowhere.csv")

    def test_probe_wholly_outside_the_volume(self):
        chain = Chain()
        chain.probe.SetPositionMm(1e4, 0, 0)
        chain.probe.SetAxial(1, 0, 0)
        chain.probe.SetLateral(0, 1, 0)
        self.expect(chain.tracer, "probe")

    def test_probe_settings_out_of_range(self):
        for name, value in (("LineCount", 0), ("DepthMm", 0.0), ("SectorDeg", 180.0), ("ScanKind", 7)):
            with self.subTest(setting=name):
                self.expect(make(vtkSonoProbeSource, **{name: value}), name)

    def test_probe_directions_parallel(self):
        probe = vtkSonoProbeSource()
        probe.SetAxial(0, 0, 1)
        probe.SetLateral(0, 0, 3)
        self.expect(probe, "lateral")

    def test_missing_preset(self):
        self.expect(make(vtkSonoProbeSource, PresetFile="nowhere.json"), "nowhere.json")

    def test_surfaces_that_were_moved(self):
        chain = Chain()
        shift = vtkTransform()
        shift.Translate(1, 0, 0)
        moved = make(vtkTransformFilter, Transform=shift)
        moved.SetInputConnection(chain.scene.GetOutputPort())
        chain.tracer.SetInputConnection(0, moved.GetOutputPort())
        self.expect(chain.tracer, "moved or cut", "Ultrasound Scene")

    def test_tracer_settings_out_of_range(self):
        for name, value, said in (("PathsPerLine", 0, "pathsPerLine"), ("RadialBinMm", 0.0, "radialBinMm"),
                                  ("LobeSigmaDeg", -1.0, "lobeSigmaDeg")):
            with self.subTest(setting=name):
                chain = Chain()
                getattr(chain.tracer, "Set" + name)(value)
                self.expect(chain.tracer, said)

    def test_image_that_was_never_scanned(self):
        converter = vtkSonoScanConverter()
        converter.SetInputData(label_image(np.zeros((1, 4, 4), np.float32), "BMode"))
        self.expect(converter, "Ultrasound Probe")

    def test_pixels_out_of_range(self):
        chain = Chain()
        chain.converter.SetPixelMm(0)
        self.expect(chain.converter, "pixelMm")


if __name__ == "__main__":
    unittest.main()
