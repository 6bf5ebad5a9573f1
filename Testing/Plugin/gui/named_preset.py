"""A probe whose preset is named, as ParaView's --script."""
from paraview.simple import *

SetActiveSource(UltrasoundProbe(Preset="linear_l14"))
