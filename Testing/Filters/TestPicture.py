"""Pictures hold what the image holds, the first row on top; what no picture holds is refused with a sentence."""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from chain import Chain, listen, shown_deeper
from sonovdb.vtkSonoFilters import vtkSonoPictureWriter
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkImageData
from vtkmodules.vtkIOImage import vtkPNGReader, vtkTIFFReader

MARKED = np.arange(35, dtype=np.uint8).reshape(5, 7)
MARKED[0, 0] = 255  # on top on the left


def image_of(pixels):
    """A vtkImageData whose point (i, j) is the pixel [j, i]."""
    image = vtkImageData()
    image.SetDimensions(pixels.shape[1], pixels.shape[0], 1)
    array = numpy_to_vtk(pixels.reshape(pixels.shape[0] * pixels.shape[1], -1), deep=True)
    array.SetName("Pixels")
    image.GetPointData().SetScalars(array)
    return image


def read_png(path):
    """By libpng alone: rows from the top."""
    reader = vtkPNGReader()
    reader.SetFileName(str(path))
    reader.Update()
    width, height, _ = reader.GetOutput().GetDimensions()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).reshape(height, width, -1).squeeze()[::-1]


def converted(path, kind, ending):
    """The file as oiiotool hands it on."""
    to = path.with_suffix(f".converted.{ending}")
    subprocess.run(["oiiotool", str(path), "-d", kind, "-o", str(to)], check=True)
    return to


def read_tif(path):
    """By libtiff alone: rows as they come in the file."""
    reader = vtkTIFFReader()
    reader.SetFileName(str(path))
    reader.Update()
    width, height, _ = reader.GetOutput().GetDimensions()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).reshape(height, width)


class PictureCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, image, name, array=None):
        """Writes a picture; its path and what the writer said."""
        writer = vtkSonoPictureWriter()
        writer.SetInputDataObject(image)
        writer.SetFileName(str(self.folder / name))
        if array:
            writer.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, array)
        said = listen(writer)
        writer.Write()
        self.assertEqual(writer.GetErrorCode() == 0, not said)
        return self.folder / name, said

    def written(self, *arguments):
        path, said = self.write(*arguments)
        self.assertEqual(said, [])
        return path


class TestPixels(PictureCase):
    def test_greys_colours_and_labels_are_what_they_were(self):
        colours = np.stack([MARKED, MARKED[::-1], 255 - MARKED], axis=2)
        labels = 1000 * MARKED.astype(np.uint16)
        for pixels in (MARKED, colours, labels):
            with self.subTest(shape=pixels.shape, type=pixels.dtype):
                read = read_png(self.written(image_of(pixels), "picture.png"))
                self.assertEqual(read.dtype, pixels.dtype)
                np.testing.assert_array_equal(read, pixels)
                tif = self.written(image_of(pixels), "picture.tif")
                np.testing.assert_array_equal(read_png(converted(tif, str(pixels.dtype), "png")), pixels)

    def test_floats_are_what_they_were(self):
        pixels = MARKED.astype(np.float32) * 1.1
        pixels[4, 6] = np.nan  # at the bottom on the right
        np.testing.assert_array_equal(read_tif(self.written(image_of(pixels), "picture.tif")), pixels)
        exr = self.written(image_of(pixels), "picture.exr")
        np.testing.assert_array_equal(read_tif(converted(exr, "float", "tif")), pixels)

    def test_greys_in_exr_are_fractions(self):
        exr = self.written(image_of(MARKED), "picture.exr")
        np.testing.assert_array_equal(read_png(converted(exr, "uint8", "png")), MARKED)
        fractions = read_tif(converted(exr, "float", "tif"))
        np.testing.assert_allclose(fractions, MARKED / 255, atol=2 ** -11)  # a half's rounding

    def test_a_file_tells_the_size_of_a_pixel(self):
        image = image_of(MARKED)
        image.SetSpacing(0.25, 0.5, 1)
        about = subprocess.run(["oiiotool", "--info", "-v", str(self.written(image, "picture.tif"))],
                               check=True, capture_output=True, text=True).stdout
        self.assertIn("XResolution: 40", about)
        self.assertIn("YResolution: 20", about)
        self.assertRegex(about, r'ResolutionUnit: "cm"')


class TestFlatImage(PictureCase):
    """Twelve lines over 60 degrees, 90 mm deep, in pixels of 0.5 mm."""

    def setUp(self):
        super().setUp()
        self.chain = Chain()
        self.chain.converter.SetPixelMm(0.5)
        self.chain.converter.Update()
        self.flat = self.chain.converter.GetOutputDataObject(1)

    def places(self, picture):
        """Lateral and depth of each pixel, in mm, if the transducer's face is on top and in the middle."""
        rows, columns = picture.shape
        return (np.arange(columns)[None, :] - (columns - 1) / 2) * 0.5, np.arange(rows)[:, None] * 0.5

    def test_the_transducer_is_on_top(self):
        picture = read_png(self.written(self.flat, "flat.png"))
        lateral, depth = self.places(picture)
        radius, angle = np.hypot(lateral, depth), np.degrees(np.arctan2(lateral, depth))
        inside = (radius < 88) & (radius > 2) & (np.abs(angle) < 29)
        outside = (radius > 92) | ((np.abs(angle) > 31) & (radius > 4))
        self.assertTrue((picture[inside] > 0).all())
        self.assertTrue((picture[outside] == 0).all())
        self.assertGreater(np.unique(picture).size, 50)

    def test_the_labels_are_those_of_the_body_there(self):
        labels = self.chain.thorax.GetOutput()
        picture = read_png(self.written(self.flat, "labels.png", "Labels"))
        lateral, depth = self.places(picture)
        position, axial, right = (np.array(getattr(self.chain.probe, "Get" + name)())
                                  for name in ("PositionMm", "Axial", "Lateral"))
        axial /= np.linalg.norm(axial)
        right -= (right @ axial) * axial
        right /= np.linalg.norm(right)
        found = set()
        for row, column in ((r, c) for r in range(20, 150, 13) for c in range(5, picture.shape[1], 7)):
            x, y = lateral[0, column], depth[row, 0]
            if np.hypot(x, y) > 85 or abs(np.degrees(np.arctan2(x, y))) > 28:
                continue
            # What is shown lies deeper than its pixel, as the traced lines say.
            range_mm, line = np.hypot(x, y), (np.degrees(np.arctan2(x, y)) + 30) / 60 * 11
            longer = 1 + shown_deeper(self.chain.tracer.GetOutput(), line, range_mm) / range_mm
            place, seen = position + longer * (x * right + y * axial), set()
            for shift in np.array(np.meshgrid(*3 * [(-0.4, 0.4)])).T.reshape(-1, 3):  # a pixel may be half a pixel off
                point = labels.FindPoint(place + shift)
                seen.add(int(labels.GetPointData().GetScalars().GetTuple1(point)))
            self.assertIn(picture[row, column], seen)
            found.add(picture[row, column])
        self.assertGreater(len(found), 5)


class TestRefusals(PictureCase):
    def refused(self, image, name, *arguments):
        path, said = self.write(image, name, *arguments)
        self.assertEqual(len(said), 1, said)
        self.assertFalse(path.is_file())
        return said[0]

    def test_what_no_picture_holds(self):
        volume = vtkImageData()
        volume.SetDimensions(2, 2, 2)
        volume.AllocateScalars(3, 1)
        self.assertIn("2 slices", self.refused(volume, "volume.png"))
        self.assertIn("double", self.refused(image_of(MARKED.astype(float)), "double.tif"))
        self.assertIn("2 components", self.refused(image_of(np.stack([MARKED, MARKED], axis=2)), "two.png"))
        self.assertIn("no such point array", self.refused(image_of(MARKED), "none.png", "None"))

    def test_what_the_format_does_not_hold(self):
        self.assertIn("png cannot hold", self.refused(image_of(MARKED.astype(np.float32)), "float.png"))
        self.assertIn("openexr cannot hold", self.refused(image_of(MARKED.astype(np.uint16)), "labels.exr"))
        self.assertIn("jpeg cannot hold", self.refused(image_of(MARKED.astype(np.uint16)), "labels.jpg"))

    def test_where_nothing_can_be_written(self):
        for name in ("picture.unknown", "picture", "nowhere/picture.png"):
            with self.subTest(name=name):
                self.assertIn(str(self.folder / name), self.refused(image_of(MARKED), name))
        writer = vtkSonoPictureWriter()
        writer.SetInputDataObject(image_of(MARKED))
        said = listen(writer)
        writer.Write()
        self.assertIn("FileName", said[0])


class TestLoading(unittest.TestCase):
    def test_filters_load_without_openimageio(self):
        maps = subprocess.run([sys.executable, "-c", "import paraview, sonovdb.vtkSonoFilters\n"
                               "print(open('/proc/self/maps').read())"],
                              check=True, capture_output=True, text=True).stdout
        self.assertTrue(re.search("libvtkSonoFilters", maps))
        self.assertIsNone(re.search("OpenImageIO|opencv|sonoPictures", maps))


if __name__ == "__main__":
    unittest.main()
