#pragma once

#include "ImageResult.h"
#include "SonoProbeField.h"

#include "vtkSmartPointer.h"

class vtkImageData;
class vtkPointData;
class vtkPolyData;

namespace sono {

// The stages' results as the filters give them. Field data that are on an output already stay beside what is added.
// A result travels as a handle beside its arrays.

/// The outline of what is scanned and the transducer's face, see vtkSonoProbeSource.
void fillProbe(const ProbeField& probe, vtkPolyData* polyData);

/// How many paths lines got, and how exact their picture is where that was asked for.
void writeReached(const TracedLines& layout, vtkFieldData* fields);
/// What a picture of grey levels was made with, for who writes it beside the picture: "GainDb", "DynamicRangeDb",
/// "TgcDbPerCm".
void writeGreySettings(const BModeSettings& settings, vtkFieldData* fields);
/// Lines x bins "Intensity" and "StandardError", with the boundary echoes in the field data. `samplingMHz` is that of
/// the RF to be.
void fillTraced(const TracedResult& traced, const ProbeField& probe, double samplingMHz, vtkImageData* lines);
/// Lines x samples "BoundaryEcho", beside traced lines.
void fillEchoes(const TracedResult& traced, const ProbeField& probe, vtkImageData* lines, vtkImageData* echoes);
/// What fillTraced has put into some lines, as a result: the handle itself while it is that of the arrays, else what
/// the arrays say. Throws Error when an array is missing, and when `lines` do not hold the probe's.
TracedResult tracedOf(vtkImageData* lines, const ProbeField& probe, double echoSampleMm);

/// Of what fillTraced has put into lines, and the stages behind them have kept, the arrays by range: the rest is empty.
/// Throws Error where one does not fit so many lines.
TracedLines rangeArraysOf(vtkImageData* lines, int lineCount);

/// As rfOf.
TracedResult tracedHandleOf(vtkImageData* lines);

/// Lines x samples "Envelope", "RF" and "IQ".
void fillRf(const RfResult& rf, const ProbeField& probe, vtkImageData* image);
/// The handle that fillRf has left, while it is that of the arrays; else no result.
RfResult rfOf(vtkImageData* image);

/// Lines x samples "BMode", and the reference amplitude in the field data.
void fillBMode(const BModeResult& bmode, const ProbeField& probe, vtkImageData* image);
/// As rfOf.
BModeResult bmodeOf(vtkImageData* image);

/// Size and place of an image in the world; and flat, with the world's field data. Neither needs pixels, which a GPU
/// may be making meanwhile.
void placeImage(const ImageResult& image, const ProbePose& pose, vtkImageData* world);
void placeFlat(const ImageResult& image, const ProbePose& pose, vtkImageData* world, vtkImageData* flat);

/// "BMode", the scalars, "Mask" and, where there are labels, "Labels".
vtkSmartPointer<vtkPointData> pictureArrays(const ScanPicture& picture);

/// "ErrorPercent", the scalars, NaN outside the mask, and "Mask".
vtkSmartPointer<vtkPointData> errorArrays(const ImageResult& map);

} // namespace sono
