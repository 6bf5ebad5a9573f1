"""The calibration phantom: its labels, its wires as surfaces and as scatterers, and what a probe sees of them."""
import unittest

import numpy as np
from chain import listen, make
from sonovdb.vtkSonoFilters import (vtkSonoImageFormation, vtkSonoPhantomSource, vtkSonoProbeSource, vtkSonoRayTracer,
                                    vtkSonoSceneBuilder)
from vtkmodules.util.numpy_support import vtk_to_numpy


def coarse(**settings):
    return make(vtkSonoPhantomSource, SpacingMm=2.0, ThicknessMm=20.0, **settings)


def names(image):
    array = image.GetFieldData().GetAbstractArray("LabelNames")
    return {array.GetValue(i) for i in range(array.GetNumberOfValues())}


class TestPhantom(unittest.TestCase):
    def test_has_labels_wires_and_three_views(self):
        source = coarse()
        source.Update()
        image, surfaces, scatterers = (source.GetOutputDataObject(port) for port in range(3))
        self.assertLessEqual({"phantom_gel", "phantom_p6", "phantom_anechoic"}, names(image))
        places = [image.GetFieldData().GetArray(f"View{view}PositionMm").GetTuple3(0) for view in (1, 2, 3)]
        self.assertEqual(places, [(-45.0, 0.0, 0.0), (0.0, 0.0, 0.0), (45.0, 0.0, 0.0)])
        self.assertEqual(surfaces.GetFieldData().GetAbstractArray("Tissue").GetValue(0), "phantom_nylon")
        self.assertEqual(surfaces.GetNumberOfCells(), 75 * 28)  # prisms of eight sides
        self.assertEqual(scatterers.GetNumberOfPoints() % 75, 0)

    def test_wires_as_voxels_leave_the_other_ports_empty(self):
        source = coarse(WiresAsVoxels=True)
        source.Update()
        self.assertIn("phantom_nylon", names(source.GetOutputDataObject(0)))
        self.assertEqual([source.GetOutputDataObject(port).GetNumberOfPoints() for port in (1, 2)], [0, 0])

    def test_objects(self):
        for phantom, tissue in ((1, "water"), (2, "cortical_bone"), (3, "liver"), (4, "phantom_speckle")):
            with self.subTest(phantom=phantom):
                source = coarse(Phantom=phantom)
                source.Update()
                image = source.GetOutputDataObject(0)
                self.assertIn(tissue, names(image))
                self.assertIsNotNone(image.GetFieldData().GetArray("View1Axial"))

    def test_a_probe_sees_its_wires_where_the_table_has_them(self):
        source = coarse()
        scene = make(vtkSonoSceneBuilder, BuildSurfaces=False)
        scene.SetInputConnection(source.GetOutputPort(0))
        # An odd number of lines: the middle one lies on the axis, and so do the vertical wires.
        probe = make(vtkSonoProbeSource, ScanKind=1, LineCount=3, DepthMm=60.0, SectorDeg=20.0)
        probe.SetPositionMm((0.0, 0.0, 0.0))
        probe.SetAxial((0.0, 0.0, 1.0))
        probe.SetLateral((1.0, 0.0, 0.0))
        tracer = make(vtkSonoRayTracer, PathsPerLine=10)
        tracer.SetInputConnection(0, scene.GetOutputPort())
        tracer.SetInputConnection(1, probe.GetOutputPort())
        formation = make(vtkSonoImageFormation, ScattererLevelDb=-60.0)
        formation.SetInputConnection(0, tracer.GetOutputPort())
        formation.SetInputConnection(1, source.GetOutputPort(2))
        formation.Update()
        image = formation.GetOutputDataObject(0)
        envelope = np.hypot(*vtk_to_numpy(image.GetPointData().GetArray("IQ")).T).reshape(3, -1)[1]
        step = image.GetSpacing()[0]
        for depth in (10.0, 20.0, 30.0, 40.0, 50.0):
            near = slice(int((depth - 2) / step), int((depth + 2) / step))
            self.assertAlmostEqual((near.start + np.argmax(envelope[near])) * step, depth, delta=0.05)

    def test_bad_settings_are_one_sentence(self):
        for settings, word in ((dict(SpacingMm=0.01), "voxel size"), (dict(ThicknessMm=0.0), "thickness"),
                               (dict(ViewPitchMm=100.0), "views"), (dict(Phantom=7), "phantom"),
                               (dict(TargetFile="nowhere.csv"), "nowhere.csv"),
                               (dict(WireEchoPerMm=-1.0), "echo of the wires"),
                               (dict(Phantom=2, SphereDiameterMm=0.0), "diameter"),
                               (dict(Phantom=2, SphereDepthMm=2.0), "depth of the sphere")):
            with self.subTest(settings=settings):
                source = vtkSonoPhantomSource()
                for name, value in {"SpacingMm": 2.0, **settings}.items():
                    getattr(source, "Set" + name)(value)
                errors = listen(source)
                source.Update()
                self.assertEqual(len(errors), 1, errors)
                self.assertIn(word, errors[0])


if __name__ == "__main__":
    unittest.main()
