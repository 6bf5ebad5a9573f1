#include "SonoChannelImage.h"

#include "SonoLineImage.h"
#include "SonoProbeField.h"

#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <string>

namespace sono {
namespace {

void writeRows(const char* name, const std::vector<double>& values, std::size_t components, vtkFieldData* field)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(static_cast<int>(components));
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size() / components));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  field->AddArray(array);
}

std::vector<double> readRows(const char* name, std::size_t count, vtkFieldData* field)
{
  vtkDataArray* array = field->GetArray(name);
  if (!array || std::size_t(array->GetNumberOfValues()) != count)
  {
    throw Error(std::string("The input's field data have no ") + name +
                " that fits its channels; connect the output of Ultrasound Channel Data without a cut between.");
  }
  std::vector<double> values;
  for (vtkIdType row = 0; row < array->GetNumberOfTuples(); ++row)
  {
    for (int component = 0; component < array->GetNumberOfComponents(); ++component)
    {
      values.push_back(array->GetComponent(row, component));
    }
  }
  return values;
}

} // namespace

void announceChannels(const ChannelPlan& plan, vtkInformation* outInfo)
{
  const int extent[6] = {
    0, plan.sampleCount - 1, 0, plan.pieces.elements - 1, 0, int(plan.transmits.each.size()) - 1
  };
  const double origin[3] = { 0.0, 0.0, 0.0 };
  const double spacing[3] = { 1.0 / plan.samplingMHz, 1.0, 1.0 };
  outInfo->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  outInfo->Set(vtkDataObject::ORIGIN(), origin, 3);
  outInfo->Set(vtkDataObject::SPACING(), spacing, 3);
  vtkDataObject::SetPointDataActiveScalarInfo(outInfo, VTK_FLOAT, 1);
}

void fillChannels(const ChannelPlan& plan, const ChannelData& data, vtkImageData* image)
{
  image->GetPointData()->Initialize();
  image->SetDimensions(data.sampleCount, data.elementCount, data.transmitCount);
  image->SetOrigin(0.0, 0.0, 0.0);
  image->SetSpacing(1.0 / data.samplingMHz, 1.0, 1.0);
  image->GetPointData()->SetScalars(lineArray("RF", data.rf));
  vtkFieldData* field = image->GetFieldData();
  std::vector<double> places;
  for (const Vec3d& centre : plan.elements.centresMm)
  {
    places.insert(places.end(), { centre.x, centre.y, centre.z });
  }
  const std::size_t elements = plan.elements.centresMm.size();
  writeRows("ElementPositionsMm", places, 3, field);
  writeRows("ElementAzimuthsRad", plan.elements.azimuthsRad, 1, field);
  writeRows("TransmitDelaysUs", plan.transmits.delaysUs, elements, field);
  writeRows("TransmitWeights", { plan.transmits.weights.begin(), plan.transmits.weights.end() }, elements, field);
  std::vector<double> angles;
  for (const Transmit& transmit : plan.transmits.each)
  {
    angles.push_back(transmit.angleRad);
  }
  writeRows("TransmitAnglesRad", angles, 1, field);
  writeNumber("TransmitDistanceMm", plan.transmits.each.front().distanceMm, field);
  writeNumber("TransmitKindNumber", double(plan.transmits.each.front().kind), field);
  writeNumber("PassUs", plan.transmits.passUs, field);
  writeNumber("ChannelSamplingMHz", data.samplingMHz, field);
  writeNumber("ElementHeightMm", plan.elements.heightMm, field);
  writeNumber("ChannelElementWidthMm", plan.elements.widthMm, field);
}

bool holdsChannels(vtkImageData* image)
{
  return image->GetFieldData()->GetArray("TransmitDelaysUs") != nullptr;
}

ChannelLayout channelLayout(vtkImageData* image)
{
  vtkFieldData* field = image->GetFieldData();
  const int* size = image->GetDimensions();
  ChannelLayout out;
  out.sampleCount = size[0];
  const std::size_t elements = std::size_t(size[1]);
  const std::size_t transmits = std::size_t(size[2]);
  out.samplingMHz = readNumber("ChannelSamplingMHz", field);
  const std::vector<double> places = readRows("ElementPositionsMm", 3 * elements, field);
  for (std::size_t n = 0; n < elements; ++n)
  {
    out.elements.centresMm.push_back({ places[3 * n], places[3 * n + 1], places[3 * n + 2] });
  }
  out.elements.azimuthsRad = readRows("ElementAzimuthsRad", elements, field);
  out.elements.widthMm = readNumber("ChannelElementWidthMm", field);
  out.elements.heightMm = readNumber("ElementHeightMm", field);
  out.transmits.delaysUs = readRows("TransmitDelaysUs", transmits * elements, field);
  const std::vector<double> weights = readRows("TransmitWeights", transmits * elements, field);
  out.transmits.weights.assign(weights.begin(), weights.end());
  out.transmits.passUs = readNumber("PassUs", field);
  const double distanceMm = readNumber("TransmitDistanceMm", field);
  const auto kind = TransmitKind(int(readNumber("TransmitKindNumber", field)));
  for (const double angle : readRows("TransmitAnglesRad", transmits, field))
  {
    out.transmits.each.push_back({ kind, angle, distanceMm });
  }
  return out;
}

} // namespace sono
