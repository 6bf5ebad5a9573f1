#pragma once

#include "Probe/ScanGeometry.h"

#include "vtkSmartPointer.h"

#include <complex>
#include <string>
#include <vector>

class vtkFieldData;
class vtkFloatArray;
class vtkImageData;
class vtkInformation;

namespace sono {

/// Layout of lines x samples as a vtkImageData: x is the depth in mm, y the number of the scan line, one z.
struct LineImageLayout
{
  int sampleCount = 0;
  int lineCount = 0;
  double firstMm = 0.0;  ///< depth of the first sample
  double sampleMm = 1.0; ///< distance of two samples
};

/// Of a probe's lines whose samples, from range 0 on, are `sampleMm` of range apart: where its scanner shows them.
LineImageLayout shownLayout(const ScanGeometry& geometry, int sampleCount, double sampleMm);
/// The other way: the range between two samples, mm.
double rangeSampleMm(const ScanGeometry& geometry, const LineImageLayout& shown);

void announceLineImage(const LineImageLayout& layout, int components, vtkInformation* outInfo);
/// Of an image that has no arrays then.
void setLineImageLayout(const LineImageLayout& layout, vtkImageData* image);

/// Throws Error when the image does not hold `lineCount` whole lines, as after a cut.
LineImageLayout lineImageLayout(vtkImageData* image, int lineCount);

/// Values as an array, complex ones as two components "Real" and "Imaginary".
vtkSmartPointer<vtkFloatArray> lineArray(const char* name, const std::vector<float>& values);
vtkSmartPointer<vtkFloatArray> lineArray(const char* name, const std::vector<std::complex<float>>& values);

/// The other way; throw Error naming the array when it is missing or has another size.
std::vector<float> lineValues(const char* name, vtkFieldData* arrays, std::size_t count);
std::vector<std::complex<float>> complexLineValues(const char* name, vtkFieldData* arrays);

} // namespace sono
