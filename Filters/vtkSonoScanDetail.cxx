#include "vtkSonoScanDetail.h"

#include "Core/KeyText.h"
#include "Scene/AddScan.h"
#include "SonoContentKey.h"
#include "SonoDataFile.h"
#include "SonoLabelImage.h"
#include "SonoSettings.h"
#include "SonoSharedArray.h"
#include "SonoStage.h"

#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkShortArray.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkSonoScanDetail);

namespace {

template<class Value>
void copyFloats(const Value* values, std::vector<float>& to)
{
  std::transform(values, values + to.size(), to.begin(), [](Value v) { return static_cast<float>(v); });
}

/// The scan of an image; `converted` holds its values where they are no floats.
sono::IntensityView scanFromImage(vtkImageData* image, std::vector<float>& converted)
{
  vtkDataArray* values = image ? image->GetPointData()->GetScalars() : nullptr;
  if (!values || values->GetNumberOfComponents() != 1 || values->GetNumberOfTuples() != image->GetNumberOfPoints() ||
      image->GetNumberOfPoints() == 0)
  {
    throw sono::Error("The scan has no point scalars with one component; connect a CT or MR, not a colour image.");
  }
  sono::IntensityView scan;
  scan.placement = sono::placementOfImage(image);
  scan.count = std::size_t(values->GetNumberOfTuples());
  if (auto* floats = vtkFloatArray::SafeDownCast(values))
  {
    scan.values = floats->GetPointer(0);
  }
  else if (auto* shorts = vtkShortArray::SafeDownCast(values))
  {
    const auto keep = [array = vtkSmartPointer<vtkDataArray>(values)](const std::int16_t*) {};
    scan.shorts = { std::shared_ptr<const std::int16_t>(shorts->GetPointer(0), keep), scan.count };
  }
  else
  {
    converted.resize(scan.count);
    switch (values->GetDataType())
    {
      vtkTemplateMacro(copyFloats(static_cast<const VTK_TT*>(values->GetVoidPointer(0)), converted));
      default:
        throw sono::Error("The scan's scalars are not numeric; connect a CT or MR.");
    }
    scan.values = converted.data();
  }
  if (scan.values && !sono::rangeOf(scan.values, scan.count).finite)
  {
    throw sono::Error("The scan holds values that are not finite; correct them or choose another one.");
  }
  auto* modality = vtkStringArray::SafeDownCast(image->GetFieldData()->GetAbstractArray("Modality"));
  if (modality && modality->GetNumberOfValues() == 1)
  {
    scan.modality = modality->GetValue(0);
  }
  return scan;
}

} // namespace

vtkSonoScanDetail::vtkSonoScanDetail()
  : Parameters(new sono::SettingsOf<sono::ScanDetailSettings>)
{
  this->SetNumberOfInputPorts(2);
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS,
                               vtkDataSetAttributes::AttributeTypes::SCALARS);
  this->SetProgressText("Adding the scan");
}

vtkSonoScanDetail::~vtkSonoScanDetail() = default;

void vtkSonoScanDetail::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->Parameters->print(os, indent);
  os << indent << "LabelTissueFile: " << this->LabelTissueFile << endl;
}

int vtkSonoScanDetail::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1); // so that one clear sentence says what is missing
  return 1;
}

int vtkSonoScanDetail::RequestInformation(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    sono::requireConnected(input[0], "No label map is connected; set the filter's Input.");
    sono::requireConnected(input[1], "No scan is connected; give the CT or MR that was segmented.");
    vtkDataObject::SetPointDataActiveScalarInfo(output->GetInformationObject(0), VTK_UNSIGNED_SHORT, 1);
  });
}

std::string vtkSonoScanDetail::ContentKey()
{
  const std::string labels = sono::contentKeyOf(this, 0);
  const std::string scan = labels.empty() ? labels : sono::contentKeyOf(this, 1);
  if (scan.empty())
  {
    return {};
  }
  try
  {
    const char* array = this->GetInputArrayInformation(0)->Get(vtkDataObject::FIELD_NAME());
    sono::KeyText key;
    key.add("scan added").add(labels).add(scan).add(array ? array : "");
    sono::addParameters(sono::settingsIn<sono::ScanDetailSettings>(*this->Parameters), key);
    key.add(sono::fileKey(sono::chosenOrBundled(this->LabelTissueFile, "label_tissues.csv")));
    return key.add(sono::fileKey(sono::dataFile("tissues.csv"))).text();
  }
  catch (const sono::Error&)
  {
    return {}; // said when the table is read
  }
}

int vtkSonoScanDetail::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  if (sono::isAskedNothing(output->GetInformationObject(0)))
  {
    for (int port : { 0, 1 })
    {
      if (vtkInformation* inInfo = input[port]->GetInformationObject(0))
      {
        sono::askNothing(inInfo);
      }
    }
    return 1;
  }
  return sono::requestWholeImage(input, 0) && sono::requestWholeImage(input, 1);
}

int vtkSonoScanDetail::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    if (sono::isAskedNothing(output->GetInformationObject(0)))
    {
      return sono::giveNothing(output->GetInformationObject(0));
    }
    const sono::Progress progress = sono::progressOf(this);
    sono::LabelVolume volume =
      sono::labelVolumeFromImage(vtkImageData::GetData(input[0]), sono::labelArrayOf(this, input));
    const auto map = sono::LabelTissueMap::read(sono::chosenOrBundled(this->LabelTissueFile, "label_tissues.csv"));
    const auto table = sono::TissueTable::read(sono::dataFile("tissues.csv"));
    std::vector<float> converted;
    sono::AddedScan added =
      sono::addScan(volume, scanFromImage(vtkImageData::GetData(input[1]), converted), map, table,
                    sono::settingsIn<sono::ScanDetailSettings>(*this->Parameters), sono::partOf(progress, 0.1, 0.95));
    std::for_each(added.notices.begin(), added.notices.end(),
                  [this](const std::string& sentence) { sono::warn(this, sentence); });
    vtkImageData* image = vtkImageData::GetData(output);
    sono::imageFromLabelVolume(std::move(volume), image);
    std::uint8_t least = 255;
    std::uint8_t most = 0;
    for (const std::uint8_t code : added.detail)
    {
      least = std::min(least, code);
      most = std::max(most, code);
    }
    const sono::SharedSpan<std::uint8_t> codes(std::move(added.detail));
    const auto detail = sono::sharedArray<vtkUnsignedCharArray>(sono::scanDetailArray, codes);
    sono::tellRange(least, most, detail);
    image->GetPointData()->AddArray(detail);
  });
}
