#pragma once

class vtkSMRenderViewProxy;
class vtkSMSourceProxy;

/// What a click on an ultrasound image means.
struct SonoPickedLine
{
  vtkSMSourceProxy* plot = nullptr; ///< the A-Line whose line it is to be; null where nothing was hit
  int line = -1;
};

/// The scan line nearest to a place of the view, in display pixels, on the foremost image there, flat or in the body;
/// and the A-Line that plots a line of the same scan. Nothing beside the scanned area, on a volume, and where no A-Line
/// takes its lines from that image's stages.
SonoPickedLine sonoPickLine(vtkSMRenderViewProxy* view, int x, int y);
