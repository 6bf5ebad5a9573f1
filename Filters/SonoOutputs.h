#pragma once

#include "ImageResult.h"
#include "SonoProbeField.h"

class vtkFieldData;
class vtkImageData;

namespace sono {

// The stages' results as the filters give them. Field data that are on an output already stay beside what is added.
// A result travels as a handle, and as arrays unless it stays within a filter; the arrays can be made later.

enum class Carries
{
  HandleAlone,
  Arrays
};

/// Lines x bins "Intensity" and "StandardError", with the boundary echoes in the field data. `samplingMHz` is that of
/// the RF to be.
void fillTraced(const TracedResult& traced, const ProbeField& probe, double samplingMHz, Carries carries,
                vtkImageData* lines);
/// Lines x samples "BoundaryEcho", beside traced lines with arrays.
void fillEchoes(const TracedResult& traced, vtkImageData* lines, vtkImageData* echoes);
/// What fillTraced has put into some lines, as a result: the handle itself while it is that of the arrays, else what
/// the arrays say. Throws Error when an array is missing, and when `lines` do not hold the probe's.
TracedResult tracedOf(vtkImageData* lines, const ProbeField& probe, double echoSampleMm);

/// As rfOf.
TracedResult tracedHandleOf(vtkImageData* lines);

/// Lines x samples "Envelope", "RF" and "IQ".
void fillRf(const RfResult& rf, Carries carries, vtkImageData* image);
/// The handle that fillRf has left, while it is that of the arrays; else no result.
RfResult rfOf(vtkImageData* image);

/// Lines x samples "BMode", and the reference amplitude in the field data.
void fillBMode(const BModeResult& bmode, Carries carries, vtkImageData* image);
/// As rfOf.
BModeResult bmodeOf(vtkImageData* image);

/// The arrays of a result that came as a handle alone, whichever of the three it is. Nothing where it came otherwise.
void addArrays(vtkImageData* image);

/// The point arrays "BMode", "Mask" and, where there are labels, "Labels"; in the world, and flat.
void fillImage(const ImageResult& image, const ScanPicture& picture, const ProbePose& pose, vtkImageData* world,
               vtkImageData* flat);

/// The point arrays "ErrorPercent", NaN outside the mask, and "Mask"; in the world, and flat.
void fillErrorMap(const ImageResult& map, const ProbePose& pose, vtkImageData* world, vtkImageData* flat);

} // namespace sono
