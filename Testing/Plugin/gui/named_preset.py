"""A probe whose preset is named, as ParaView's --script."""
from paraview.simple import *

SetActiveSource(UltrasoundProbe(PresetFile="linear_l14"))
