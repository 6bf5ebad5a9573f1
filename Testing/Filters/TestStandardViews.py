"""Standard views: poses by name from labels alone, and why there is none."""
import unittest

import numpy as np
from chain import label_image, listen, make
from sonovdb.vtkSonoFilters import vtkSonoSceneBuilder, vtkSonoStandardViews, vtkSonoThoraxSource
from vtkmodules.vtkCommonDataModel import vtkImageData


def texts(array):
    return [array.GetValue(i) for i in range(array.GetNumberOfValues())]


def numbers(field, name):
    array = field.GetArray(name)
    return np.array([array.GetTuple(i) for i in range(array.GetNumberOfTuples())])


class TestStandardViews(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.thorax = make(vtkSonoThoraxSource, SpacingMm=2.0)
        cls.thorax.Update()

    def views(self, **settings):
        views = make(vtkSonoStandardViews, **settings)
        views.SetInputConnection(self.thorax.GetOutputPort())
        views.Update()
        return views

    def test_the_pose_of_the_view_that_is_named(self):
        views = self.views(View="A4C")
        field = views.GetOutput().GetFieldData()
        names = texts(field.GetAbstractArray("ViewName"))
        at = names.index("A4C")
        for own, of_all in (("ProbePositionMm", "ViewPositionMm"), ("ProbeAxial", "ViewAxial"),
                            ("ProbeLateral", "ViewLateral")):
            np.testing.assert_array_equal(numbers(field, own)[0], numbers(field, of_all)[at])
        known = self.thorax.GetOutput().GetFieldData()  # the pose that the thorax was drawn around
        normal, drawn = (np.cross(numbers(of, axial)[0], numbers(of, lateral)[0])
                         for of, axial, lateral in ((field, "ProbeAxial", "ProbeLateral"), (known, "A4CAxial", "A4CLateral")))
        self.assertGreater(normal @ drawn, np.cos(np.radians(5)))
        self.assertEqual(views.GetOutput().GetNumberOfCells(), 1)
        self.assertEqual(texts(field.GetAbstractArray("ProbePreset"))[at], "phased_p4-2")
        for name in ("Score", "DepthMm", "PlaneOffDegrees", "MarkOffMm"):
            self.assertEqual(len(numbers(field, name)), len(names))
        self.assertLess(numbers(field, "PlaneOffDegrees")[at], 5)

    def test_rows_are_those_that_are_obtainable_and_sentences_for_the_others(self):
        views = self.views()
        rows, refused = texts(views.GetRows()), texts(views.GetRefusedRows())
        self.assertEqual(len(rows) + len(refused), 13)
        self.assertTrue(rows[0].startswith("A4C, apical four-chamber: shows"))
        for row in rows:
            self.assertEqual(len(row.split("\t")), 12)
        cava = next(row for row in refused if row.startswith("IVC"))
        self.assertIn("not obtainable from this patient. It needs the inferior vena cava", cava)
        field = views.GetOutput().GetFieldData()  # of the best one
        best = np.argmax(numbers(field, "Score"))
        np.testing.assert_array_equal(numbers(field, "ProbePositionMm")[0], numbers(field, "ViewPositionMm")[best])

    def test_a_scene_will_do(self):
        scene = make(vtkSonoSceneBuilder, BuildSurfaces=False)
        scene.SetInputConnection(self.thorax.GetOutputPort())
        of_scene = make(vtkSonoStandardViews)
        of_scene.SetInputConnection(scene.GetOutputPort())
        of_scene.Update()
        self.assertEqual(texts(of_scene.GetRows()), texts(self.views().GetRows()))

    def test_what_is_wrong_is_said(self):
        ball = np.zeros((24, 24, 24), np.uint8)
        ball[6:18, 6:18, 6:18] = 1
        for view, connect, word in (("IVC", True, "needs the inferior vena cava"), ("A6C", True, "no view 'A6C'; there are: A4C"),
                                    ("", label_image(ball), "No standard view is obtainable"),
                                    ("", vtkImageData(), "no voxels"), ("", None, "No label map is connected")):
            with self.subTest(word=word):
                views = make(vtkSonoStandardViews, View=view)
                if connect is True:
                    views.SetInputConnection(self.thorax.GetOutputPort())
                elif connect is not None:
                    views.SetInputData(connect)
                said = listen(views)
                views.Update()
                self.assertEqual(len(said), 1, said)
                self.assertIn(word, said[0])
                self.assertIn(word, views.GetRefusal())

    def test_stops_when_asked(self):
        views = make(vtkSonoStandardViews)
        views.SetInputConnection(self.thorax.GetOutputPort())
        views.AddObserver("ProgressEvent", lambda *_: views.GetProgress() > 0.6 and views.SetAbortExecute(1))
        said = listen(views)
        views.Update()
        self.assertEqual(said, [])
        self.assertEqual(views.GetOutput().GetNumberOfCells(), 0)


if __name__ == "__main__":
    unittest.main()
