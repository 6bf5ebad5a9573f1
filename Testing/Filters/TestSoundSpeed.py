"""A scanner that assumes another speed of sound shows the same echoes to another scale, whichever output is asked for."""
import pathlib
import tempfile
import unittest

import numpy as np
from chain import Chain, label_image, listen, make, owner
from sonovdb.vtkSonoFilters import vtkSonoALine, vtkSonoProbeSource, vtkSonoSweep, vtkSonoUltrasound
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkPassThrough

WALL = 30.0  # mm of tissue at 1600 m/s before the wall
SPEED = 1600.0
TABLE = """tissue,impedance_MRayl,sound_speed_m_per_s,attenuation_dB_per_cm_MHz,mu0,sigma0,mu1,tau,gamma,source
air,0.0004,330,1.2,0,0,0,1,0,test
near,1.6,1600,0.3,0.5,0.1,0.5,1,0,test
far,3.2,1600,0.3,0.5,0.1,0.5,1,0,test
"""
PROBE = {"ScanKind": 0, "LineCount": 16, "WidthMm": 16.0, "DepthMm": 40.0, "CentreFrequencyMHz": 5.0,
         "PositionMm": (20.0, 20.0, -0.5), "Axial": (0.0, 0.0, 1.0), "Lateral": (1.0, 0.0, 0.0)}
REST = {"PathsPerLine": 20, "PixelMm": 0.1, "BuildSurfaces": False, "FillBody": 0, "DynamicRangeDb": 90.0,
        "AutomaticReference": False, "ReferenceAmplitude": 2.0}


def floats(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name))


class TestSoundSpeed(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        tissues, names = pathlib.Path(folder.name, "tissues.csv"), pathlib.Path(folder.name, "labels.csv")
        tissues.write_text(TABLE)
        names.write_text("pattern,tissue\nLabel 1,near\nLabel 2,far\n")
        self.files = {"TissueTableFile": str(tissues), "LabelTissueFile": str(names), "FallbackTissue": "near",
                      "OutsideTissue": "air"}
        voxels = np.full((60, 40, 40), 1, np.uint16)
        voxels[int(WALL):] = 2
        self.labels = label_image(voxels)

    def simulated(self, **settings):
        filter_ = make(vtkSonoUltrasound, **{**PROBE, **REST, **self.files, **settings})
        filter_.SetInputData(self.labels)
        return filter_

    @staticmethod
    def output(filter_, port):
        filter_.Update(port)
        return filter_.GetOutputDataObject(port)

    def test_image_labels_lines_and_a_line_show_the_wall_at_one_place(self):
        for assumed in (1450.0, 1540.0, 1650.0):
            with self.subTest(assumed=assumed):
                filter_, shown = self.simulated(AssumedSoundSpeedMPerS=assumed), WALL * assumed / SPEED
                flat = self.output(filter_, vtkSonoUltrasound.FLAT_IMAGE)
                width, height, _ = flat.GetDimensions()
                self.assertAlmostEqual(flat.GetBounds()[3], 40.0, delta=0.051)  # the depth is that of the picture
                rows = flat.GetOrigin()[1] + 0.1 * np.arange(height)
                grey, labels = (floats(flat, name).reshape(height, width)[:, width // 2] for name in ("BMode", "Labels"))
                self.assertAlmostEqual(rows[100:][grey[100:].argmax()], shown, delta=0.11)
                self.assertAlmostEqual(rows[labels == 2].min(), shown, delta=0.11)
                for port, name in ((vtkSonoUltrasound.RF_LINES, "Envelope"), (vtkSonoUltrasound.BMODE_LINES, "BMode")):
                    lines = self.output(filter_, port)
                    line = floats(lines, name).reshape(16, -1)[8]
                    mm = lines.GetOrigin()[0] + lines.GetSpacing()[0] * np.arange(line.size)
                    self.assertAlmostEqual(mm[500:][line[500:].argmax()], shown, delta=0.11)
                    self.assertAlmostEqual(mm[-1], 40.0, delta=0.03)
                a_line = make(vtkSonoALine, Line=8)
                a_line.SetInputData(self.output(filter_, vtkSonoUltrasound.RF_LINES))
                a_line.Update()
                table = a_line.GetOutput()
                depth, envelope = (vtk_to_numpy(table.GetColumnByName(name)) for name in ("Depth (mm)", "Envelope"))
                self.assertAlmostEqual(depth[500:][envelope[500:].argmax()], shown, delta=0.11)
                # Traced lines are by depth in the body, whatever a scanner takes for it.
                traced = self.output(filter_, vtkSonoUltrasound.TRACED_LINES)
                self.assertEqual(traced.GetSpacing()[0], 0.25)
                errors = self.output(self.simulated(AssumedSoundSpeedMPerS=assumed, ErrorMap=True),
                                     vtkSonoUltrasound.ERROR_MAP)
                np.testing.assert_array_equal(floats(errors, "Mask"), floats(flat, "Mask"))

    def test_the_stages_one_by_one_show_the_same(self):
        """Also where only arrays come from the stage before."""
        whole = self.simulated(AssumedSoundSpeedMPerS=1450.0)
        chain = Chain()
        chain.scene.SetInputData(self.labels)
        settings = {**PROBE, **REST, **self.files, "AssumedSoundSpeedMPerS": 1450.0}
        for name in ("MaxCollisions", "CoherenceMm", "TgcDbPerCm"):  # a chest's, in the filter of all stages
            settings[name] = getattr(owner(whole, name), "Get" + name)()
        for name, value in settings.items():
            stage = next(s for s in chain.stages().values() if hasattr(s, "Set" + name))
            getattr(stage, "Set" + name)(value)
        picture = self.output(whole, vtkSonoUltrasound.IMAGE)
        for plain in (False, True):
            if plain:
                between = [vtkPassThrough() for _ in range(3)]
                stages = (chain.tracer, chain.formation, chain.bmode, chain.converter)
                for copy, stage, after in zip(between, stages, stages[1:]):
                    copy.SetDeepCopyInput(True)
                    copy.SetInputConnection(stage.GetOutputPort())
                    copy.Update()
                    first = copy.GetOutputDataObject(0).GetPointData().GetArray(0)
                    first.Modified()  # no longer known as the stage's result
                    after.SetInputConnection(0, copy.GetOutputPort())
            chain.converter.Update()
            for name in ("BMode", "Labels", "Mask"):
                np.testing.assert_array_equal(floats(chain.converter.GetOutput(), name), floats(picture, name))
            for lines in (chain.formation.GetOutput(), chain.bmode.GetOutput(), chain.tracer.GetOutputDataObject(1)):
                self.assertAlmostEqual(lines.GetSpacing()[0], 1.45 / 80.0, places=12)

    def test_the_same_samples_to_another_scale(self):
        """28 mm at 1400 m/s take as long as 30.8 at 1540: nothing is traced again, but all is shown elsewhere."""
        filter_ = self.simulated(DepthMm=30.8)
        before = self.output(filter_, vtkSonoUltrasound.RF_LINES)
        spacing, envelope = before.GetSpacing()[0], floats(before, "Envelope").copy()
        owner(filter_, "DepthMm").SetDepthMm(28.0)
        owner(filter_, "DepthMm").SetAssumedSoundSpeedMPerS(1400.0)
        after = self.output(filter_, vtkSonoUltrasound.RF_LINES)
        np.testing.assert_array_equal(floats(after, "Envelope"), envelope)
        self.assertAlmostEqual(after.GetSpacing()[0], spacing * 1400.0 / 1540.0, places=12)

    def test_a_sweep_shows_its_poses_alike(self):
        points, poses = vtkPoints(), vtkPolyData()
        points.InsertNextPoint(20.0, 20.0, -0.5)
        poses.SetPoints(points)
        for name, direction in (("Axial", (0, 0, 1)), ("Lateral", (1, 0, 0))):
            array = vtkDoubleArray()
            array.SetName(name)
            array.SetNumberOfComponents(3)
            array.InsertNextTuple(direction)
            poses.GetPointData().AddArray(array)
        probe = make(vtkSonoProbeSource, AssumedSoundSpeedMPerS=1450.0, **PROBE)
        sweep = make(vtkSonoSweep, PixelMm=0.1)
        for name, value in {**REST, **self.files}.items():
            if name not in ("PixelMm", "BuildSurfaces"):
                getattr(owner(sweep, name), "Set" + name)(value)
        sweep.SetInputData(0, self.labels)
        sweep.SetInputConnection(1, probe.GetOutputPort())
        sweep.SetInputData(2, poses)
        sweep.Update()
        alone = self.output(self.simulated(AssumedSoundSpeedMPerS=1450.0), vtkSonoUltrasound.IMAGE)
        for name in ("BMode", "Labels"):
            np.testing.assert_array_equal(floats(sweep.GetOutput(), name), floats(alone, name))

    def test_what_is_out_of_range_is_refused(self):
        for value in (1399.0, 1701.0, float("nan")):
            probe = make(vtkSonoProbeSource, AssumedSoundSpeedMPerS=value)
            heard = listen(probe)
            probe.Update()
            self.assertEqual(len(heard), 1)
            self.assertIn("assumedSoundSpeedMPerS", heard[0])
            self.assertIn("1400", heard[0])


if __name__ == "__main__":
    unittest.main()
