"""A heart that beats: the thorax has time steps, and its walls' speckle rides on the displacement that it brings."""
import tempfile
import unittest

import numpy as np
from chain import listen
from sonovdb.vtkSonoFilters import vtkSonoLabelMapReader, vtkSonoThoraxSource, vtkSonoUltrasound
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

TIME_STEPS = vtkStreamingDemandDrivenPipeline.TIME_STEPS()


def beating(phases):
    source = vtkSonoThoraxSource()
    source.SetSpacingMm(3)
    source.SetPhases(phases)
    source.UpdateInformation()
    return source


def arrays(source, time):
    source.UpdateTimeStep(time)
    points = source.GetOutput().GetPointData()
    return [vtk_to_numpy(points.GetArray(name)).copy() for name in ("Labels", "DisplacementMm")]


class TestMotion(unittest.TestCase):
    def test_the_thorax_beats(self):
        source = beating(4)
        self.assertEqual(source.GetOutputInformation(0).Get(TIME_STEPS), (0, 0.25, 0.5, 0.75))
        still, rest = arrays(source, 0.0)
        moved, displacement = arrays(source, 0.25)
        self.assertEqual(np.abs(rest).max(), 0)
        self.assertGreater(np.linalg.norm(displacement, axis=1).max(), 8)
        self.assertGreater(np.count_nonzero(still != moved), 1000)
        named = vtk_to_numpy(source.GetOutput().GetFieldData().GetArray("MovingLabels"))
        self.assertIn(12, named)  # the left ventricle's myocardium
        self.assertNotIn(18, named)  # its blood

    def test_it_stands_still_by_itself(self):
        source = beating(1)
        source.Update()
        self.assertFalse(source.GetOutputInformation(0).Has(TIME_STEPS))
        self.assertIsNone(source.GetOutput().GetPointData().GetArray("DisplacementMm"))

    def test_a_file_keeps_it(self):
        source = beating(4)
        with tempfile.TemporaryDirectory() as folder:
            reader = vtkSonoLabelMapReader()
            for phase in range(2):
                source.UpdateTimeStep(phase / 4)
                writer = vtkXMLImageDataWriter()
                writer.SetInputData(source.GetOutput())
                writer.SetFileName(f"{folder}/phase{phase}.vti")
                writer.Write()
                reader.AddFileName(writer.GetFileName())
            for phase in range(2):
                for kept, made in zip(arrays(reader, phase), arrays(source, phase / 4)):
                    np.testing.assert_array_equal(kept, made)
                named = [vtk_to_numpy(of.GetOutput().GetFieldData().GetArray("MovingLabels")) for of in (reader, source)]
                np.testing.assert_array_equal(*named)

    def test_a_field_of_two_components_is_refused(self):
        source = beating(1)
        source.Update()
        image = vtkImageData()
        image.DeepCopy(source.GetOutput())
        field = numpy_to_vtk(np.zeros((image.GetNumberOfPoints(), 2), np.float32), deep=True)
        field.SetName("DisplacementMm")
        image.GetPointData().AddArray(field)
        ultrasound = vtkSonoUltrasound()
        ultrasound.SetInputDataObject(0, image)
        said = listen(ultrasound)
        ultrasound.Update()
        self.assertTrue(any("DisplacementMm" in sentence and "three" in sentence for sentence in said), said)


if __name__ == "__main__":
    unittest.main()
