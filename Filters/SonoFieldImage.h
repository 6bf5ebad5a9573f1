#pragma once

#include "Probe/PulseEchoField.h"

class vtkImageData;
class vtkInformation;

namespace sono {

/// A pulse-echo field as an image in the frame of a scan line: x lateral, y elevational, z depth, all mm, with the
/// scalars "PulseEchoWeight" (largest value 1).
void announceFieldImage(const FieldGrid& grid, vtkInformation* outInfo);
void imageFromField(const PulseEchoField& field, vtkImageData* image);

/// The other way, for an image from anywhere. Throws Error when it has no point array "PulseEchoWeight" with one
/// component, when its axes are turned, and as PulseEchoField does.
PulseEchoField fieldFromImage(vtkImageData* image);

} // namespace sono
