#include "SonoProbeField.h"

#include "Core/Progress.h"

#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationDataObjectMetaDataKey.h"
#include "vtkNew.h"

#include <algorithm>
#include <initializer_list>
#include <string>

namespace sono {
namespace {

// "Preview" of a probe that is being moved; 0: it rests.
constexpr double coarsePreview = 1.0;
constexpr double fullPreview = 2.0;

vtkInformationDataObjectMetaDataKey* acquisitionKey()
{
  static auto* const key = vtkInformationDataObjectMetaDataKey::MakeKey("ACQUISITION", "SonoVDB");
  return key;
}

/// The array of before where it says the same: to make one costs more than to look.
bool takeBefore(const char* name, std::initializer_list<double> values, vtkFieldData* field, vtkFieldData* before)
{
  auto* array = before ? vtkDoubleArray::SafeDownCast(before->GetAbstractArray(name)) : nullptr;
  if (!array ||
      !std::equal(values.begin(), values.end(), array->GetPointer(0), array->GetPointer(array->GetNumberOfValues())))
  {
    return false;
  }
  field->AddArray(array);
  return true;
}

void writeTuple(const char* name, std::initializer_list<double> values, vtkFieldData* field, vtkFieldData* before)
{
  if (takeBefore(name, values, field, before))
  {
    return;
  }
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(static_cast<int>(values.size()));
  array->InsertNextTuple(values.begin());
  field->AddArray(array);
}

vtkDataArray* findTuple(const char* name, int components, vtkFieldData* field)
{
  vtkDataArray* array = field ? field->GetArray(name) : nullptr;
  if (!array || array->GetNumberOfTuples() < 1 || array->GetNumberOfComponents() != components)
  {
    throw Error(std::string("The input carries no ") + name +
                " in its field data; connect the output of the stage before, down from an Ultrasound Probe.");
  }
  return array;
}

vtkDataObject* announcedCarrier(vtkInformation* inInfo)
{
  vtkDataObject* carrier = inInfo ? inInfo->Get(acquisitionKey()) : nullptr;
  if (!carrier)
  {
    throw Error("The input does not say how it was scanned; connect the output of the stage before, down from an "
                "Ultrasound Probe.");
  }
  return carrier;
}

Vec3d readVector(const char* name, vtkFieldData* field)
{
  Vec3d value;
  findTuple(name, 3, field)->GetTuple(0, &value.x);
  return value;
}

} // namespace

void writeNumber(const char* name, double value, vtkFieldData* field, vtkFieldData* before)
{
  writeTuple(name, { value }, field, before);
}

void writeVector(const char* name, const Vec3d& value, vtkFieldData* field, vtkFieldData* before)
{
  writeTuple(name, { value.x, value.y, value.z }, field, before);
}

double readNumber(const char* name, vtkFieldData* field)
{
  return findTuple(name, 1, field)->GetTuple1(0);
}

void writeProbe(const ProbeField& probe, vtkFieldData* field, vtkFieldData* before)
{
  ProbeSettings::visit(probe, [field, before](const auto& value, const Parameter& parameter) {
    writeNumber(propertyName(parameter).c_str(), numberOf(value), field, before);
  });
  writeNumber("IsVolume", probe.geometry.isVolume(), field, before);
  writeNumber("IsCatheter", probe.geometry.lineOrigin() == LineOrigin::Catheter, field, before);
  writeVector("ProbePositionMm", probe.pose.positionMm, field, before);
  writeVector("ProbeAxial", probe.pose.axial, field, before);
  writeVector("ProbeLateral", probe.pose.lateral, field, before);
  writeNumber("Preview", probe.coarse ? coarsePreview : probe.preview ? fullPreview : 0.0, field, before);
  writeNumber("LinesApart", probe.linesApart, field, before);
  writeNumber("PrepareInteraction", probe.prepares ? 1.0 : 0.0, field, before);
}

ProbeField readProbe(vtkFieldData* field)
{
  ProbeField probe;
  const auto read = [field](auto& value, const Parameter& parameter) {
    value = valueOf<std::decay_t<decltype(value)>>(readNumber(propertyName(parameter).c_str(), field));
  };
  ScanGeometry::visitLayout(probe.geometry, read);
  ProbeSettings::visitPulse(probe, read);
  BeamAperture::visit(probe, read);
  if (field->HasArray("KerfMm")) // not in older files
  {
    ProbeSettings::visitElements(probe, read);
  }
  if (field->HasArray("CompoundFans"))
  {
    ScanGeometry::visitCompounding(probe.geometry, read);
  }
  if (field->HasArray("AssumedSoundSpeedMPerS"))
  {
    ScanGeometry::visitSoundSpeed(probe.geometry, read);
  }
  if (field->HasArray("ImagingMode"))
  {
    ProbeSettings::visitMode(probe, read);
  }
  probe.geometry.validate();
  probe.pose.positionMm = readVector("ProbePositionMm", field);
  probe.pose.axial = readVector("ProbeAxial", field);
  probe.pose.lateral = readVector("ProbeLateral", field);
  probe.preview = readNumber("Preview", field) != 0.0;
  probe.coarse = readNumber("Preview", field) == coarsePreview;
  probe.linesApart = field->HasArray("LinesApart") ? int(readNumber("LinesApart", field)) : 1; // not in older files
  probe.prepares = field->HasArray("PrepareInteraction") && readNumber("PrepareInteraction", field) != 0.0;
  return probe;
}

void announceFields(vtkFieldData* field, vtkInformation* outInfo)
{
  vtkNew<vtkDataObject> carrier;
  carrier->SetFieldData(field);
  outInfo->Set(acquisitionKey(), carrier);
}

vtkFieldData* announcedFields(vtkInformation* inInfo)
{
  return announcedCarrier(inInfo)->GetFieldData();
}

void announceSameFields(vtkInformation* inInfo, vtkInformation* outInfo)
{
  outInfo->Set(acquisitionKey(), announcedCarrier(inInfo));
}

} // namespace sono
