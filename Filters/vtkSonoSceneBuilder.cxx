#include "vtkSonoSceneBuilder.h"

#include "Labels/AssignTissues.h"
#include "Labels/BodyFill.h"
#include "Labels/LabelCode.h"
#include "Labels/ReadLabelMap.h"
#include "Labels/TissueTable.h"
#include "Scene/SceneFile.h"
#include "SonoDataFile.h"
#include "SonoLabelImage.h"
#include "SonoSceneBlocks.h"
#include "SonoSettings.h"
#include "SonoStage.h"
#include "vtkSonoSceneHandle.h"

#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"

vtkStandardNewMacro(vtkSonoSceneBuilder);

namespace {

/// What to say of tissues that are guesses; empty when none is.
std::string warningOfGuesses(const std::vector<sono::LabelInfo>& labels)
{
  std::string guesses;
  bool nameless = false;
  for (const sono::LabelInfo& label : labels)
  {
    if (label.guessed)
    {
      guesses += (guesses.empty() ? "" : ", ") + label.name + " (" + label.tissue + ")";
      nameless = nameless || sono::saysNothing(label.name);
    }
  }
  if (guesses.empty())
  {
    return {};
  }
  return "These labels' tissues are guesses, to be changed in View > Ultrasound Tissues: " + guesses + "." +
         (nameless
            ? " The label map does not name them all: choose a list of names in its reader (Label Names), or put a "
              "table beside the file."
            : "");
}

} // namespace

vtkSonoSceneBuilder::vtkSonoSceneBuilder()
  : Parameters(new sono::SettingsOf<sono::BodyFillSettings>)
{
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS,
                               vtkDataSetAttributes::AttributeTypes::SCALARS);
  this->SetProgressText("Building the anatomy");
}

vtkSonoSceneBuilder::~vtkSonoSceneBuilder() = default;

void vtkSonoSceneBuilder::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TissueTableFile: " << this->TissueTableFile << endl;
  os << indent << "LabelTissueFile: " << this->LabelTissueFile << endl;
  os << indent << "LabelTableFile: " << this->LabelTableFile << endl;
  os << indent << "FallbackTissue: " << this->FallbackTissue << endl;
  os << indent << "OutsideTissue: " << this->OutsideTissue << endl;
  os << indent << "FillBody: " << this->FillBody << endl;
  this->Parameters->print(os, indent);
  os << indent << "CacheFolder: " << this->CacheFolder << endl;
  os << indent << "BuildSurfaces: " << this->BuildSurfaces << endl;
}

int vtkSonoSceneBuilder::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

vtkDataArray* vtkSonoSceneBuilder::LabelArray(vtkInformationVector** input)
{
  vtkPointData* arrays = vtkImageData::GetData(input[0])->GetPointData();
  if (arrays->GetNumberOfArrays() == 1)
  {
    return arrays->GetArray(0); // whatever name the property has kept from the input before
  }
  // ParaView names no array for an input that has not run yet.
  const char* name = this->GetInputArrayInformation(0)->Get(vtkDataObject::FIELD_NAME());
  return name && !*name ? arrays->GetScalars() : this->GetInputArrayToProcess(0, input);
}

int vtkSonoSceneBuilder::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  return sono::requestWholeImage(input);
}

sono::LabelVolume vtkSonoSceneBuilder::ReadLabels(vtkInformationVector** input)
{
  const sono::Progress progress = sono::progressOf(this);
  sono::LabelVolume volume = sono::labelVolumeFromImage(vtkImageData::GetData(input[0]), this->LabelArray(input));
  sono::report(progress, 0.05);
  if (this->FillBody)
  {
    const auto& settings = sono::settingsIn<sono::BodyFillSettings>(*this->Parameters);
    sono::fillBody(volume, settings, sono::partOf(progress, 0.05, 0.1));
  }
  if (!this->LabelTableFile.empty())
  {
    sono::readLabelTable(this->LabelTableFile, volume);
  }
  return volume;
}

int vtkSonoSceneBuilder::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    const sono::Progress progress = sono::progressOf(this);
    sono::LabelVolume volume = this->ReadLabels(input);
    const auto table = std::make_shared<const sono::TissueTable>(
      sono::TissueTable::read(sono::chosenOrBundled(this->TissueTableFile, "tissues.csv")));
    const auto map = sono::LabelTissueMap::read(sono::chosenOrBundled(this->LabelTissueFile, "label_tissues.csv"));
    sono::assignTissues(volume, map, *table, this->FallbackTissue);
    const std::string warning = warningOfGuesses(volume.labels);
    if (!warning.empty())
    {
      sono::warn(this, warning);
    }
    std::vector<std::uint8_t> detail = sono::scanDetailOf(vtkImageData::GetData(input[0]));
    const bool cached = this->BuildSurfaces && !this->CacheFolder.empty();
    const std::shared_ptr<const sono::Scene> scene =
      cached ? sono::makeCachedScene(std::move(volume), *table, this->OutsideTissue, this->CacheFolder,
                                     sono::partOf(progress, 0.1, 0.6), std::move(detail))
             : std::make_shared<const sono::Scene>(std::move(volume), *table, this->OutsideTissue, std::move(detail));
    vtkMultiBlockDataSet* blocks = vtkMultiBlockDataSet::GetData(output);
    if (this->BuildSurfaces)
    {
      // Several labels at a time; the blocks are then made one by one.
      scene->buildAll(sono::partOf(progress, cached ? 0.6 : 0.1, cached ? 0.65 : 0.6));
      sono::addLabelSurfaces(*scene, blocks, sono::partOf(progress, cached ? 0.65 : 0.6, 1.0));
    }
    else
    {
      sono::addOutline(*scene, blocks);
    }
    sono::writeLabelTable(scene->volume().labels, blocks->GetFieldData());
    vtkSonoSceneHandle::Attach(scene, table, blocks);
  });
}
