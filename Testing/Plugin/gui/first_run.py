"""A label map that takes seconds to simulate, as ParaView's --script."""
from paraview.simple import *

thorax = ThoraxPhantom(registrationName="thorax", Spacingmm=2)
thorax.UpdatePipeline()
SetActiveSource(thorax)
