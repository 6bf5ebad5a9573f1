"""Scenes in files: written, read back and cached; the body fill; names beside a VTK image."""
import os
import pathlib
import tempfile
import unittest

import numpy as np
from chain import Chain, label_image, listen, make
from sonovdb.vtkSonoFilters import (vtkSonoLabelMapReader, vtkSonoSceneBuilder, vtkSonoSceneReader,
                                    vtkSonoSceneWriter)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkMultiBlockDataSet
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter


def intensity(tracer):
    tracer.Update()
    return vtk_to_numpy(tracer.GetOutputDataObject(0).GetPointData().GetArray("Intensity")).copy()


def picture(converter):
    converter.Update()
    return vtk_to_numpy(converter.GetOutputDataObject(0).GetPointData().GetScalars()).copy()


def block_names(blocks):
    return [blocks.GetMetaData(i).Get(vtkMultiBlockDataSet.NAME()) for i in range(blocks.GetNumberOfBlocks())]


def table_of(data):
    """Names by label id."""
    field = data.GetFieldData()
    ids, names = field.GetArray("LabelIds"), field.GetAbstractArray("LabelNames")
    return {ids.GetValue(i): names.GetValue(i) for i in range(names.GetNumberOfValues())}


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, chain, name):
        """Writes the chain's scene; gives the path and the errors heard."""
        path = str(self.folder / name)
        writer = make(vtkSonoSceneWriter, FileName=path)
        writer.SetInputConnection(chain.scene.GetOutputPort())
        errors = listen(writer)
        writer.Write()
        return path, errors

    def refused(self, path, *words):
        reader = make(vtkSonoSceneReader, FileName=str(path))
        errors = listen(reader)
        reader.Update()
        self.assertEqual(len(errors), 1, errors)
        for word in (str(path), *words):
            self.assertIn(word, errors[0])
        self.assertEqual(reader.GetOutput().GetNumberOfBlocks(), 0)


class TestWrittenAndRead(InFolder):
    def test_reader_gives_what_the_builder_gave(self):
        chain = Chain()
        chain.scene.SetBuildSurfaces(True)
        path, errors = self.write(chain, "thorax.nvdb")
        self.assertEqual(errors, [])
        reader = make(vtkSonoSceneReader, FileName=path)
        errors = listen(reader)
        reader.Update()
        self.assertEqual(errors, [])
        built, read = chain.scene.GetOutput(), reader.GetOutput()
        self.assertEqual(block_names(read), block_names(built))
        self.assertEqual(table_of(read), table_of(built))
        for i in range(built.GetNumberOfBlocks()):
            np.testing.assert_array_equal(vtk_to_numpy(read.GetBlock(i).GetPoints().GetData()),
                                          vtk_to_numpy(built.GetBlock(i).GetPoints().GetData()))

        before = intensity(chain.tracer)
        chain.tracer.SetInputConnection(0, reader.GetOutputPort())
        np.testing.assert_array_equal(intensity(chain.tracer), before)
        self.assertGreater(before.max(), 0.5)

    def test_a_scans_detail_is_in_the_picture(self):
        chain = Chain()
        image = vtkImageData()
        image.ShallowCopy(chain.thorax.GetOutput())
        codes = np.random.default_rng(1).integers(88, 169, image.GetNumberOfPoints(), np.uint8)
        detail = numpy_to_vtk(codes, deep=True)
        detail.SetName("ScanDetail")
        image.GetPointData().AddArray(detail)
        plain = picture(chain.converter)
        chain.scene.SetInputData(image)
        path, errors = self.write(chain, "thorax.nvdb")
        self.assertEqual(errors, [])
        before = picture(chain.converter)
        self.assertGreater(np.abs(before.astype(int) - plain).max(), 20)
        reader = make(vtkSonoSceneReader, FileName=path)
        chain.tracer.SetInputConnection(0, reader.GetOutputPort())
        np.testing.assert_array_equal(picture(chain.converter), before)

    def test_targets_in_a_scene_from_a_file_take_any_bundled_tissue(self):
        chain = Chain()
        path, _ = self.write(chain, "thorax.nvdb")
        reader = make(vtkSonoSceneReader, FileName=path)
        sphere = make(vtkSphereSource, Radius=3.0)
        sphere.SetCenter(*(p + 30.0 * a for p, a in zip(chain.probe.GetPositionMm(), chain.probe.GetAxial())))
        chain.tracer.SetInputConnection(0, reader.GetOutputPort())
        chain.tracer.SetInputConnection(2, sphere.GetOutputPort())
        reader.Update()
        used = reader.GetOutput().GetFieldData().GetAbstractArray("LabelTissues")
        self.assertNotIn("kidney", [used.GetValue(i) for i in range(used.GetNumberOfValues())])
        chain.tracer.SetTargetTissue("kidney")
        errors = listen(chain.tracer)
        chain.tracer.Update()
        self.assertEqual(errors, [])

    def test_openvdb_file_is_written_for_others(self):
        path, errors = self.write(Chain(), "thorax.vdb")
        self.assertEqual(errors, [])
        content = pathlib.Path(path).read_bytes()
        self.assertEqual(content[:4], b" BDV")  # OpenVDB's magic number
        self.assertIn(b"left_ventricle_myocardium", content)

    def test_refused_files(self):
        path, _ = self.write(Chain(), "thorax.nvdb")
        whole = pathlib.Path(path).read_bytes()
        for kept in (len(whole) - 1, len(whole) // 2, 100, 0):
            with self.subTest(bytes=kept):
                part = self.folder / "part.nvdb"
                part.write_bytes(whole[:kept])
                self.refused(part, "cannot read")
        foreign = self.folder / "foreign.nvdb"
        foreign.write_bytes(b"id,name\n5,liver\n" * 100)
        self.refused(foreign, "cannot read")
        self.refused(self.folder / "none.nvdb", "cannot read")

    def test_writer_refuses_other_endings_folders_and_inputs(self):
        self.assertEqual(len(self.write(Chain(), "thorax.vtm")[1]), 1)
        path, errors = self.write(Chain(), "nowhere/thorax.nvdb")
        self.assertEqual(len(errors), 1, errors)
        self.assertIn(path, errors[0])
        writer = make(vtkSonoSceneWriter, FileName=str(self.folder / "empty.nvdb"))
        writer.SetInputData(vtkMultiBlockDataSet())
        errors = listen(writer)
        self.assertEqual(writer.Write(), 0)
        self.assertEqual(len(errors), 1, errors)
        self.assertIn("no ultrasound scene", errors[0])


class TestCache(InFolder):
    def test_second_build_takes_the_surfaces_from_the_folder(self):
        def build():
            """The names and bounds of its blocks; the scene itself is gone, or the next build would take that."""
            chain = Chain()
            chain.scene.SetBuildSurfaces(True)
            chain.scene.SetCacheFolder(str(self.folder / "cache"))
            errors, seen = listen(chain.scene), []
            chain.scene.AddObserver("ProgressEvent", lambda caller, _: seen.append(caller.GetProgress()))
            chain.scene.Update()
            self.assertEqual(errors, [])
            self.assertEqual(seen, sorted(seen))
            blocks = chain.scene.GetOutput()
            return block_names(blocks), [blocks.GetBlock(i).GetBounds() for i in range(blocks.GetNumberOfBlocks())]

        first = build()
        (file,) = (self.folder / "cache").iterdir()
        os.link(file, self.folder / "written")
        os.utime(file, (1, 1))
        second = build()
        self.assertTrue(os.path.samefile(file, self.folder / "written"))  # not written anew, which makes another file
        self.assertGreater(file.stat().st_mtime, 1)  # but used
        file.write_bytes(b"damaged")
        third = build()
        self.assertGreater(file.stat().st_size, 1000)
        self.assertEqual(first, second)
        self.assertEqual(first, third)

    def test_folder_that_cannot_be_made(self):
        (self.folder / "file").write_text("")
        scene = make(vtkSonoSceneBuilder, CacheFolder=str(self.folder / "file" / "cache"))
        scene.SetInputData(label_image(np.ones((4, 4, 4), np.uint8)))
        errors = listen(scene)
        listen(scene, "WarningEvent")
        scene.Update()
        self.assertEqual(len(errors), 1, errors)
        self.assertIn("cache", errors[0])


class TestBodyFill(unittest.TestCase):
    def build(self, **settings):
        """A block of label 5, 40 by 20 mm across and as high as the volume, in the middle of 0."""
        voxels = np.zeros((24, 40, 40), np.uint8)
        voxels[:, 15:25, 10:30] = 5
        image = label_image(voxels)
        image.SetSpacing(2, 2, 2)
        scene = make(vtkSonoSceneBuilder, BuildSurfaces=False, **settings)
        scene.SetInputData(image)
        self.errors = listen(scene)
        self.warnings = listen(scene, "WarningEvent")
        scene.Update()
        return scene.GetOutput()

    def test_fills_only_when_asked(self):
        self.assertEqual(set(table_of(self.build()).values()), {"background", "label_5"})
        filled = self.build(FillBody=True)
        self.assertEqual(self.errors, [])
        self.assertNotIn("skin", "".join(self.warnings))  # the bundled map knows the new labels
        self.assertEqual(set(table_of(filled).values()), {"background", "label_5", "skin", "soft_tissue"})
        tissues = filled.GetFieldData().GetAbstractArray("LabelTissues")
        self.assertEqual([tissues.GetValue(i) for i in range(tissues.GetNumberOfValues())][0], "air")

    def test_settings_arrive(self):
        for name, value, said in (("ClosingMm", 300.0, "clos"), ("WallMm", -1.0, "wall"), ("SkinMm", 30.0, "skin")):
            with self.subTest(setting=name):
                self.build(FillBody=True, **{name: value})
                self.assertEqual(len(self.errors), 1, self.errors)
                self.assertIn(said, self.errors[0])


class TestNamesBesideAVtkImage(InFolder):
    def names(self, image):
        path = str(self.folder / "torso.vti")
        writer = make(vtkXMLImageDataWriter, FileName=path)
        writer.SetInputData(image)
        writer.Write()
        (self.folder / "torso.csv").write_text("id,name\n5,liver\n6,spleen\n")
        reader = make(vtkSonoLabelMapReader, FileName=path)
        reader.Update()
        return table_of(reader.GetOutput())

    def test_table_names_labels_of_an_image_without_names(self):
        voxels = np.zeros((3, 3, 3), np.uint8)
        voxels[1, 1, 1] = 5
        self.assertEqual(self.names(label_image(voxels)), {0: "background", 5: "liver"})

    def test_the_images_own_names_come_first(self):
        chain = Chain()
        own = table_of(chain.thorax.GetOutput())
        self.assertIn(5, own)
        self.assertEqual(self.names(chain.thorax.GetOutput()), own)

    def test_appended_data_are_read_and_damaged_ones_named(self):
        """Debian's updates of expat broke VTK's own reading of these."""
        voxels = np.arange(4 * 5 * 6, dtype=np.uint8).reshape(6, 5, 4) % 7
        path = self.folder / "whole.vti"
        for encoded in (True, False):
            with self.subTest(encoded=encoded):
                writer = make(vtkXMLImageDataWriter, FileName=str(path), EncodeAppendedData=encoded)
                writer.SetDataModeToAppended()
                writer.SetInputData(label_image(voxels))
                writer.Write()
                reader = make(vtkSonoLabelMapReader, FileName=str(path))
                reader.Update()
                labels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
                self.assertEqual(labels.tolist(), voxels.ravel().tolist())
        path.write_bytes(path.read_bytes().replace(b"<Piece", b"<Piece <"))
        reader = make(vtkSonoLabelMapReader, FileName=str(path))
        said = listen(reader)
        reader.Update()
        self.assertEqual(len(said), 1, said)
        self.assertIn("whole.vti is damaged", said[0])


if __name__ == "__main__":
    unittest.main()
