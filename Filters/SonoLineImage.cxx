#include "SonoLineImage.h"

#include "Core/Progress.h"

#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>

namespace sono {
namespace {

vtkDataArray* findArray(const char* name, vtkFieldData* arrays, int components)
{
  vtkDataArray* array = arrays->GetArray(name);
  if (!array || array->GetNumberOfComponents() != components)
  {
    throw Error(std::string("The input has no array '") + name + "'; connect the output of the stage before.");
  }
  return array;
}

/// All components one after the other.
std::vector<float> floatsOf(vtkDataArray* array)
{
  std::vector<float> values(static_cast<std::size_t>(array->GetNumberOfValues()));
  // The stages' own arrays are copied as they are; a user's may be of any type.
  if (auto* floats = vtkFloatArray::SafeDownCast(array))
  {
    std::copy_n(floats->GetPointer(0), values.size(), values.begin());
    return values;
  }
  const int components = array->GetNumberOfComponents();
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const auto tuple = static_cast<vtkIdType>(i) / components;
    values[i] =
      static_cast<float>(array->GetComponent(tuple, static_cast<int>(static_cast<vtkIdType>(i) % components)));
  }
  return values;
}

} // namespace

LineImageLayout shownLayout(const ScanGeometry& geometry, int sampleCount, double sampleMm)
{
  return { sampleCount, geometry.totalLineCount(), 0.0, sampleMm * geometry.shownPerRange() };
}

double rangeSampleMm(const ScanGeometry& geometry, const LineImageLayout& shown)
{
  return shown.sampleMm / geometry.shownPerRange();
}

void announceLineImage(const LineImageLayout& layout, int components, vtkInformation* outInfo)
{
  const int extent[6] = { 0, layout.sampleCount - 1, 0, layout.lineCount - 1, 0, 0 };
  const double origin[3] = { layout.firstMm, 0.0, 0.0 };
  const double spacing[3] = { layout.sampleMm, 1.0, 1.0 };
  outInfo->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  outInfo->Set(vtkDataObject::ORIGIN(), origin, 3);
  outInfo->Set(vtkDataObject::SPACING(), spacing, 3);
  vtkDataObject::SetPointDataActiveScalarInfo(outInfo, VTK_FLOAT, components);
}

void setLineImageLayout(const LineImageLayout& layout, vtkImageData* image)
{
  image->GetPointData()->Initialize(); // VTK keeps the scalars of the run before
  image->SetDimensions(layout.sampleCount, layout.lineCount, 1);
  image->SetOrigin(layout.firstMm, 0.0, 0.0);
  image->SetSpacing(layout.sampleMm, 1.0, 1.0);
}

LineImageLayout lineImageLayout(vtkImageData* image, int lineCount)
{
  const int* size = image->GetDimensions();
  if (size[1] != lineCount || size[2] != 1 || size[0] < 1)
  {
    throw Error("The input holds " + std::to_string(size[1]) + " scan lines but its probe has " +
                std::to_string(lineCount) + "; connect the stage before without a cut or resampling between.");
  }
  return { size[0], size[1], image->GetOrigin()[0], image->GetSpacing()[0] };
}

vtkSmartPointer<vtkFloatArray> lineArray(const char* name, const std::vector<float>& values)
{
  auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetName(name);
  array->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

vtkSmartPointer<vtkFloatArray> lineArray(const char* name, const std::vector<std::complex<float>>& values)
{
  auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(2);
  array->SetComponentName(0, "Real");
  array->SetComponentName(1, "Imaginary");
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  // The standard lays a complex number out as its two parts.
  const auto* parts = reinterpret_cast<const float*>(values.data());
  std::copy(parts, parts + 2 * values.size(), array->GetPointer(0));
  return array;
}

std::vector<float> lineValues(const char* name, vtkFieldData* arrays, std::size_t count)
{
  vtkDataArray* array = findArray(name, arrays, 1);
  if (std::size_t(array->GetNumberOfTuples()) != count)
  {
    throw Error(std::string("The array '") + name +
                "' does not fit its image; connect the output of the stage before.");
  }
  return floatsOf(array);
}

std::vector<std::complex<float>> complexLineValues(const char* name, vtkFieldData* arrays)
{
  vtkDataArray* array = findArray(name, arrays, 2);
  const std::vector<float> parts = floatsOf(array);
  std::vector<std::complex<float>> values(parts.size() / 2);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    values[i] = { parts[2 * i], parts[2 * i + 1] };
  }
  return values;
}

} // namespace sono
