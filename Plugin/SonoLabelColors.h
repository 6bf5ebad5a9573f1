#pragma once

class vtkSMSourceProxy;

/// Has the point array "Labels" shown in the labels' own colours, without shades between, where an output is a label
/// map; the colour map, which is one for all arrays of this name, takes those of the map that is shown last.
void sonoShowLabelColors(vtkSMSourceProxy* source, unsigned int port);
