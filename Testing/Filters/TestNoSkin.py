"""A body without skin: what is said of it, and that the window is found on the skin that a fill puts there."""
import math
import unittest

import numpy as np
from chain import label_image, listen, make
from sonovdb.vtkSonoFilters import vtkSonoAcousticWindow, vtkSonoSceneBuilder, vtkSonoUltrasound
from vtkmodules.vtkCommonCore import vtkIntArray, vtkStringArray

MIDDLE = (120.0, 120.0, 120.0)
RADIUS_MM = 60.0
WALL_MM = 10.0  # the default


def liver():
    """A ball with a rib in it, so that it counts as a trunk and gets a body wall, not a bath."""
    z, y, x = np.mgrid[0:60, 0:60, 0:60] * 4.0
    r = np.sqrt((x - MIDDLE[0])**2 + (y - MIDDLE[1])**2 + (z - MIDDLE[2])**2)
    image = label_image(np.select([r < 8, r < RADIUS_MM], [2, 1], 0).astype(np.uint8))
    image.SetSpacing(4, 4, 4)
    ids, names = vtkIntArray(), vtkStringArray()
    for array, name, values in ((ids, "LabelIds", (1, 2)), (names, "LabelNames", ("liver", "rib_left_5"))):
        array.SetName(name)
        for value in values:
            array.InsertNextValue(value)
        image.GetFieldData().AddArray(array)
    return image


class TestNoSkin(unittest.TestCase):
    def setUp(self):
        self.ultrasound = vtkSonoUltrasound()
        self.ultrasound.SetInputDataObject(0, liver())
        self.scene = self.ultrasound.GetSceneBuilder()
        self.scene.SetBuildSurfaces(False)
        self.errors = listen(self.ultrasound)
        self.warnings = listen(self.ultrasound, "WarningEvent")

    def window_mm(self):
        """How far from the middle the window is that Find Window's search finds: in the filter's own anatomy."""
        window = make(vtkSonoAcousticWindow, Target="liver", CacheFolder="")
        window.SetInputConnection(self.ultrasound.GetOutputPort(4))
        window.Update()
        return math.dist(window.GetOutput().GetFieldData().GetArray("ProbePositionMm").GetTuple3(0), MIDDLE)

    def test_what_is_said(self):
        for mode, words in ((vtkSonoSceneBuilder.FILL_OFF, "set Fill Body to Auto or On, and press Find Window"),
                            (vtkSonoSceneBuilder.FILL_AUTO, "its body was filled")):
            with self.subTest(mode=mode):
                self.warnings.clear()
                self.scene.SetFillBody(mode)
                self.ultrasound.Update(4)
                self.assertEqual(len([said for said in self.warnings if words in said]), 1, self.warnings)
        self.assertEqual(self.errors, [])

    def test_the_window_is_looked_for_on_the_skin_that_there_is(self):
        self.scene.SetFillBody(vtkSonoSceneBuilder.FILL_OFF)
        self.assertAlmostEqual(self.window_mm(), RADIUS_MM, delta=6)
        for mode in (vtkSonoSceneBuilder.FILL_ON, vtkSonoSceneBuilder.FILL_AUTO):
            self.scene.SetFillBody(mode)
            self.assertAlmostEqual(self.window_mm(), RADIUS_MM + WALL_MM, delta=6)


if __name__ == "__main__":
    unittest.main()
