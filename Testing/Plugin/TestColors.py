"""The colour map of grey levels: it shows what ParaView's own does, and is found, changed and kept in states like it."""
import os
import pathlib
import sys
import tempfile
import unittest

import numpy as np
from paraview import simple, smstate
from paraview.modules.vtkRemotingViews import vtkPVDiscretizableColorTransferFunction
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction

simple.LoadPlugin(os.environ["SONOVDB_PLUGIN"], remote=False, ns=vars(simple))
from sonovdb.vtkSonoWidgets import vtkSonoColorTable

COLORS = (1, 2, 3, 4)  # components of what is asked for: VTK's LUMINANCE to RGBA
VALUE_COLORS = 1  # VTK_COLOR_MODE_MAP_SCALARS


def fill(table, discretize, log):
    """Colours, and an opacity that changes at each level."""
    opacity = vtkPiecewiseFunction()
    for level, alpha in ((0, 0), (1, 1), (40, 0.2), (255, 0.9)):
        opacity.AddPoint(level, alpha)
    for level, color in ((1, (0.1, 0, 0.3)), (90, (0.2, 0.7, 0)), (255, (1, 1, 0.8))):
        table.AddRGBPoint(level, *color)
    table.SetScalarOpacityFunction(opacity)
    table.EnableOpacityMappingOn()
    table.SetDiscretize(discretize)
    table.SetUseLogScale(log)
    table.Build()
    return table


def mapped(table, values, components, component=0):
    array = numpy_to_vtk(values, deep=True)
    return vtk_to_numpy(table.MapScalars(array, VALUE_COLORS, component, components)).copy()


class TestColors(unittest.TestCase):
    def test_colours_are_those_of_paraviews_map(self):
        random = np.random.default_rng(4)
        for discretize, log in ((1, 0), (0, 0), (1, 1)):
            own = fill(vtkSonoColorTable(), discretize, log)
            paraviews = fill(vtkPVDiscretizableColorTransferFunction(), discretize, log)
            for components in COLORS:
                for values in (random.integers(0, 256, 5000, np.uint8), np.arange(100, dtype=np.uint8),
                               random.integers(0, 256, (700, 3), np.uint8), random.integers(0, 300, 700, np.uint16),
                               random.uniform(-5, 260, 700).astype(np.float32)):
                    component = values.ndim - 1
                    expected = mapped(paraviews, values, components, component)
                    self.assertEqual(expected.size, len(values) * components)
                    np.testing.assert_array_equal(mapped(own, values, components, component), expected)
            self.assertGreater(len(np.unique(mapped(own, np.arange(256, dtype=np.uint8), 4)[:, 3])), 50)

    def test_images_are_shown_by_it(self):
        ultrasound = simple.SimulateUltrasound(registrationName="ultrasound", Input=simple.ThoraxPhantom(Spacingmm=4),
                                               LineCount=12, DepthMm=90, PathsPerLine=20)
        view = simple.CreateView("RenderView")
        for port in (0, 7):  # in the body and flat
            shown = simple.Show(simple.OutputPort(ultrasound, port), view)
            colors = shown.LookupTable
            self.assertEqual(colors.GetXMLName(), "SonoColorTable")
            self.assertEqual(shown.ColorArrayName[1], "BMode")
        self.assertEqual(colors.SMProxy, simple.GetColorTransferFunction("BMode").SMProxy)
        self.assertEqual(colors.GetClientSideObject().GetClassName(), "vtkSonoColorTable")
        self.assertEqual([colors.RGBPoints[0], colors.RGBPoints[-4]], [0, 255])
        for part in ("ScalarOpacityFunction", "TransferFunction2D"):  # as ParaView's own has them
            self.assertIsNotNone(getattr(colors, part))
        levels = np.arange(256, dtype=np.uint8)
        grey = mapped(colors.GetClientSideObject(), np.tile(levels, 2), 4)[:256]
        np.testing.assert_allclose(grey[:, 0], levels, atol=1)  # steps of 256 colours
        np.testing.assert_array_equal(grey[:, 3], np.where(levels > 0, 255, 0))
        # As a person changes it, and as states keep it.
        self.assertTrue(colors.ApplyPreset("Viridis (matplotlib)", True))
        changed = mapped(colors.GetClientSideObject(), np.tile(levels, 2), 4)
        self.assertFalse((changed[:256] == grey).all())
        state = smstate.get_state()
        self.assertIn("GetColorTransferFunction('BMode')", state)
        with tempfile.TemporaryDirectory() as folder:
            file = str(pathlib.Path(folder, "state.pvsm"))
            simple.SaveState(file)
            for load in (lambda: simple.LoadState(file), lambda: exec(state, {})):
                simple.ResetSession()
                load()
                again = simple.GetColorTransferFunction("BMode")
                shades = mapped(again.GetClientSideObject(), np.tile(levels, 2), 4).astype(int)
                np.testing.assert_allclose(shades, changed, atol=1)  # a state is text: its numbers are rounded


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
