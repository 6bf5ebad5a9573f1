#include "SonoLabelImage.h"

#include "Core/LargeMemory.h"
#include "Core/Progress.h"
#include "SonoSharedArray.h"

#include "vtkAlgorithm.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkInformationInformationVectorKey.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkMath.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedShortArray.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>

namespace sono {
namespace {

/// Row-major, as VTK wants it; Mat3d is column-major.
std::array<double, 9> rowMajor(const Mat3d& direction)
{
  std::array<double, 9> rows{};
  for (int r = 0; r < 3; ++r)
  {
    for (int c = 0; c < 3; ++c)
    {
      rows[3 * r + c] = direction[c][r];
    }
  }
  return rows;
}

std::string nameOf(vtkDataArray* array)
{
  return array->GetName() ? std::string("The array '") + array->GetName() + "'" : std::string("The image's array");
}

void addLabels(vtkUnsignedShortArray* voxels, const std::vector<LabelInfo>& labels, vtkImageData* image)
{
  if (!labels.empty()) // each occurs
  {
    const auto [least, most] = std::minmax_element(labels.begin(), labels.end(),
                                                   [](const LabelInfo& a, const LabelInfo& b) { return a.id < b.id; });
    tellRange(least->id, most->id, voxels);
  }
  image->GetPointData()->SetScalars(voxels);
  writeLabelTable(labels, image->GetFieldData());
}

template<class Value>
void copyWholeNumbers(const Value* values, std::size_t count, vtkDataArray* array, std::vector<std::uint16_t>& voxels)
{
  if constexpr (std::is_same_v<Value, unsigned char> || std::is_same_v<Value, unsigned short>)
  {
    voxels = roomFor<std::uint16_t>(count);
    voxels.assign(values, values + count);
    return;
  }
  voxels = largeVector<std::uint16_t>(count);
  for (std::size_t i = 0; i < voxels.size(); ++i)
  {
    const auto value = static_cast<double>(values[i]);
    if (!(value >= 0.0 && value <= 65535.0) || value != std::floor(value))
    {
      std::ostringstream message;
      message << nameOf(array) << " holds no labels, as its value " << value
              << " is not a whole number from 0 to 65535; connect a label map or choose another array.";
      throw Error(message.str());
    }
    voxels[i] = static_cast<std::uint16_t>(value);
  }
}

} // namespace

GridPlacement placementOfImage(vtkImageData* image)
{
  auto* frame = vtkStringArray::SafeDownCast(image->GetFieldData()->GetAbstractArray(frameOfReferenceArray));
  int extent[6];
  image->GetExtent(extent);
  GridPlacement placement;
  image->GetDimensions(&placement.size.x);
  image->TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4], &placement.originMm.x);
  image->GetSpacing(&placement.spacingMm.x);
  for (int r = 0; r < 3; ++r)
  {
    for (int c = 0; c < 3; ++c)
    {
      placement.direction[c][r] = image->GetDirectionMatrix()->GetElement(r, c);
    }
  }
  placement.frameOfReference = frame && frame->GetNumberOfValues() == 1 ? frame->GetValue(0) : std::string();
  return placement;
}

void placeImage(const GridPlacement& placement, vtkImageData* image)
{
  image->SetDimensions(placement.size.x, placement.size.y, placement.size.z);
  image->SetOrigin(&placement.originMm.x);
  image->SetSpacing(&placement.spacingMm.x);
  image->SetDirectionMatrix(rowMajor(placement.direction).data());
  if (!placement.frameOfReference.empty())
  {
    vtkNew<vtkStringArray> frame;
    frame->SetName(frameOfReferenceArray);
    frame->InsertNextValue(placement.frameOfReference);
    image->GetFieldData()->AddArray(frame);
  }
}

std::vector<std::uint8_t> scanDetailOf(vtkImageData* image)
{
  auto* codes = vtkUnsignedCharArray::SafeDownCast(image->GetPointData()->GetArray(scanDetailArray));
  if (!codes)
  {
    return {};
  }
  auto detail = roomFor<std::uint8_t>(std::size_t(codes->GetNumberOfValues()));
  detail.assign(codes->GetPointer(0), codes->GetPointer(0) + codes->GetNumberOfValues());
  return detail;
}

std::shared_ptr<const TissueMotion> motionOf(vtkImageData* image, const LabelVolume& volume)
{
  vtkDataArray* field = image->GetPointData()->GetArray(displacementArray);
  if (!field)
  {
    return nullptr;
  }
  if (field->GetNumberOfComponents() != 3)
  {
    throw Error("The array 'DisplacementMm' of the label image has " + std::to_string(field->GetNumberOfComponents()) +
                " components; give it three, mm along the world's left, posterior and superior axes.");
  }
  std::vector<Vec3f> displacementMm(static_cast<std::size_t>(field->GetNumberOfTuples()));
  for (std::size_t i = 0; i < displacementMm.size(); ++i)
  {
    double u[3];
    field->GetTuple(static_cast<vtkIdType>(i), u);
    displacementMm[i] = Vec3f(float(u[0]), float(u[1]), float(u[2]));
  }
  const GridPlacement placement = placementOfImage(image);
  std::set<int> moving;
  if (vtkDataArray* ids = image->GetFieldData()->GetArray(movingLabelsArray))
  {
    for (vtkIdType i = 0; i < ids->GetNumberOfValues(); ++i)
    {
      moving.insert(int(ids->GetVariantValue(i).ToInt()));
    }
    return std::make_shared<const TissueMotion>(placement, displacementMm, moving);
  }
  constexpr float leastMm = 0.05f;
  const Vec3i offset(glm::round(volume.placement.indexFromWorld(placement.originMm))); // of a body that was filled up
  for (int k = 0; k < placement.size.z; ++k)
  {
    for (int j = 0; j < placement.size.y; ++j)
    {
      for (int i = 0; i < placement.size.x; ++i)
      {
        const Vec3i& size = placement.size;
        const Vec3i& whole = volume.placement.size;
        const Vec3i v = Vec3i(i, j, k) + offset;
        if (glm::length(displacementMm[std::size_t(i) + std::size_t(size.x) * (j + std::size_t(size.y) * k)]) > leastMm)
        {
          moving.insert(volume.voxels[std::size_t(v.x) + std::size_t(whole.x) * (v.y + std::size_t(whole.y) * v.z)]);
        }
      }
    }
  }
  for (const LabelInfo& label : volume.labels)
  {
    if (label.tissue == "blood")
    {
      moving.erase(label.id);
    }
  }
  return std::make_shared<const TissueMotion>(placement, displacementMm, moving);
}

void addMotion(const std::vector<Vec3f>& displacementMm, const std::set<int>& movingLabels, vtkImageData* image)
{
  vtkNew<vtkFloatArray> field;
  field->SetName(displacementArray);
  field->SetNumberOfComponents(3);
  field->SetNumberOfTuples(static_cast<vtkIdType>(displacementMm.size()));
  std::copy(displacementMm.begin(), displacementMm.end(), reinterpret_cast<Vec3f*>(field->GetPointer(0)));
  image->GetPointData()->AddArray(field);
  vtkNew<vtkIntArray> ids;
  ids->SetName(movingLabelsArray);
  for (const int id : movingLabels)
  {
    ids->InsertNextValue(id);
  }
  image->GetFieldData()->AddArray(ids);
}

void announceLabelImage(const GridPlacement& placement, vtkInformation* outInfo)
{
  const Vec3i& size = placement.size;
  const int extent[6] = { 0, size.x - 1, 0, size.y - 1, 0, size.z - 1 };
  outInfo->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  outInfo->Set(vtkDataObject::ORIGIN(), &placement.originMm.x, 3);
  outInfo->Set(vtkDataObject::SPACING(), &placement.spacingMm.x, 3);
  outInfo->Set(vtkDataObject::DIRECTION(), rowMajor(placement.direction).data(), 9);
  vtkDataObject::SetPointDataActiveScalarInfo(outInfo, VTK_UNSIGNED_SHORT, 1);
}

void tellRange(double low, double high, vtkDataArray* array)
{
  const double range[2] = { low, high };
  vtkNew<vtkInformationVector> components;
  components->SetNumberOfInformationObjects(1);
  components->GetInformationObject(0)->Set(vtkDataArray::COMPONENT_RANGE(), range, 2);
  array->GetInformation()->Set(vtkAbstractArray::PER_COMPONENT(), components);
  array->GetInformation()->Set(vtkAbstractArray::PER_FINITE_COMPONENT(), components);
}

void imageFromLabelVolume(const LabelVolume& volume, vtkImageData* image)
{
  placeImage(volume.placement, image);

  vtkNew<vtkUnsignedShortArray> labels;
  labels->SetName("Labels");
  labels->SetNumberOfValues(static_cast<vtkIdType>(volume.voxels.size()));
  std::copy(volume.voxels.begin(), volume.voxels.end(), labels->GetPointer(0));
  addLabels(labels, volume.labels, image);
}

void imageFromLabelVolume(LabelVolume&& volume, vtkImageData* image)
{
  placeImage(volume.placement, image);
  const SharedSpan<std::uint16_t> voxels(std::move(volume.voxels));
  addLabels(sharedArray<vtkUnsignedShortArray>("Labels", voxels), volume.labels, image);
}

vtkDataArray* labelArrayOf(vtkAlgorithm* algorithm, vtkInformationVector** input)
{
  vtkPointData* arrays = vtkImageData::GetData(input[0])->GetPointData();
  if (arrays->GetNumberOfArrays() == 1)
  {
    return arrays->GetArray(0);
  }
  // ParaView names no array for an input that has not run yet, or that of another input.
  const char* name = algorithm->GetInputArrayInformation(0)->Get(vtkDataObject::FIELD_NAME());
  vtkDataArray* named = name && *name ? arrays->GetArray(name) : nullptr;
  return named ? named : arrays->GetScalars();
}

LabelVolume labelVolumeFromImage(vtkImageData* image, vtkDataArray* labels)
{
  if (!image || image->GetNumberOfPoints() == 0)
  {
    throw Error("The label image has no voxels; connect a label map with at least one voxel along every axis.");
  }
  if (!labels || labels->GetNumberOfComponents() != 1 || labels->GetNumberOfTuples() != image->GetNumberOfPoints())
  {
    throw Error("The label image has no point array with one component to take labels from; connect a label map.");
  }
  LabelVolume volume;
  volume.placement = placementOfImage(image);
  volume.placement.validate("the label image");
  switch (labels->GetDataType())
  {
    vtkTemplateMacro(copyWholeNumbers(static_cast<const VTK_TT*>(labels->GetVoidPointer(0)),
                                      volume.placement.voxelCount(), labels, volume.voxels));
    default:
      throw Error(nameOf(labels) + " is not numeric and holds no labels; choose another array.");
  }
  volume.labels = labelTableOf(image->GetFieldData());
  volume.collectLabels();
  return volume;
}

std::vector<LabelInfo> labelTableOf(vtkFieldData* field)
{
  std::vector<LabelInfo> table;
  vtkDataArray* ids = field->GetArray("LabelIds");
  auto* names = vtkStringArray::SafeDownCast(field->GetAbstractArray("LabelNames"));
  vtkDataArray* colors = field->GetArray("LabelColors");
  auto* codes = vtkStringArray::SafeDownCast(field->GetAbstractArray("LabelCodes"));
  if (!ids || !names || names->GetNumberOfValues() != ids->GetNumberOfTuples())
  {
    return table;
  }
  for (vtkIdType row = 0; row < ids->GetNumberOfTuples(); ++row)
  {
    LabelInfo label;
    label.id = static_cast<int>(ids->GetTuple1(row));
    label.name = names->GetValue(row);
    label.code = codes && row < codes->GetNumberOfValues() ? codes->GetValue(row) : std::string();
    if (colors && colors->GetNumberOfComponents() == 3 && row < colors->GetNumberOfTuples())
    {
      const double* rgb = colors->GetTuple3(row);
      label.color = { float(rgb[0]), float(rgb[1]), float(rgb[2]) };
      label.hasColor = true;
    }
    table.push_back(label);
  }
  return table;
}

void writeLabelTable(const std::vector<LabelInfo>& labels, vtkFieldData* field)
{
  vtkNew<vtkIntArray> ids;
  vtkNew<vtkStringArray> names;
  vtkNew<vtkFloatArray> colors;
  vtkNew<vtkStringArray> tissues;
  ids->SetName("LabelIds");
  names->SetName("LabelNames");
  colors->SetName("LabelColors");
  vtkNew<vtkStringArray> codes;
  tissues->SetName("LabelTissues");
  codes->SetName("LabelCodes");
  colors->SetNumberOfComponents(3);
  for (const LabelInfo& label : labels)
  {
    ids->InsertNextValue(label.id);
    names->InsertNextValue(label.name);
    colors->InsertNextTuple(displayColor(label).data());
    codes->InsertNextValue(label.code);
    if (!label.tissue.empty())
    {
      tissues->InsertNextValue(label.tissue);
    }
  }
  field->AddArray(ids);
  field->AddArray(names);
  field->AddArray(colors);
  const bool isCoded =
    std::any_of(labels.begin(), labels.end(), [](const LabelInfo& label) { return !label.code.empty(); });
  if (isCoded)
  {
    field->AddArray(codes);
  }
  if (tissues->GetNumberOfValues() == names->GetNumberOfValues())
  {
    field->AddArray(tissues);
  }
}

std::array<float, 3> displayColor(const LabelInfo& label)
{
  if (label.hasColor)
  {
    return label.color;
  }
  constexpr double goldenRatio = 0.6180339887498949; // steps of it spread hues evenly, however many there are
  const double hsv[3] = { std::fmod(label.id * goldenRatio, 1.0), 0.55, 0.9 };
  double rgb[3];
  vtkMath::HSVToRGB(hsv, rgb);
  return { float(rgb[0]), float(rgb[1]), float(rgb[2]) };
}

} // namespace sono
