#include "vtkSonoSceneBuilder.h"

#include "Core/KeptResults.h"
#include "Core/KeyText.h"
#include "Labels/BodyFill.h"
#include "Labels/LabelTable.h"
#include "Labels/PrepareBody.h"
#include "Labels/ReadLabelMap.h"
#include "Labels/TissueTable.h"
#include "Scene/ScanDetail.h"
#include "Scene/SceneFile.h"
#include "SonoContentKey.h"
#include "SonoDataFile.h"
#include "SonoLabelImage.h"
#include "SonoPlayed.h"
#include "SonoSceneBlocks.h"
#include "SonoSettings.h"
#include "SonoSharedAnatomy.h"
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

#include <algorithm>
#include <optional>
#include <utility>

vtkStandardNewMacro(vtkSonoSceneBuilder);

vtkSonoSceneBuilder::vtkSonoSceneBuilder()
  : Parameters(new sono::SettingsOf<sono::BodyFillSettings>)
{
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS,
                               vtkDataSetAttributes::AttributeTypes::SCALARS);
  this->SetProgressText("Building the anatomy");
}

vtkSonoSceneBuilder::~vtkSonoSceneBuilder()
{
  sono::dropPlayed(this);
}

void vtkSonoSceneBuilder::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TissueTableFile: " << this->TissueTableFile << endl;
  os << indent << "LabelTissueFile: " << this->LabelTissueFile << endl;
  os << indent << "LabelTableFile: " << this->LabelTableFile << endl;
  os << indent << "TissueTableText: " << this->TissueTableText << endl;
  os << indent << "LabelTableText: " << this->LabelTableText << endl;
  os << indent << "FallbackTissue: " << this->FallbackTissue << endl;
  os << indent << "OutsideTissue: " << this->OutsideTissue << endl;
  os << indent << "FillBody: " << this->FillBody << endl;
  this->Parameters->print(os, indent);
  os << indent << "CacheFolder: " << this->CacheFolder << endl;
  os << indent << "BuildSurfaces: " << this->BuildSurfaces << endl;
}

void vtkSonoSceneBuilder::Warn(const std::string& sentence)
{
  this->Warnings.push_back(sentence);
  sono::warn(this, sentence);
}

void vtkSonoSceneBuilder::LimitKeptPhasesMegabytes(double megabytes)
{
  sono::setPlayedLimitBytes(std::size_t(std::max(0.0, megabytes) * 1e6));
}

double vtkSonoSceneBuilder::GetKeptPhasesMegabytes()
{
  return 1e-6 * double(sono::playedLimitBytes());
}

double vtkSonoSceneBuilder::GetPhasesMegabytesNow()
{
  return 1e-6 * double(sono::playedBytes());
}

void vtkSonoSceneBuilder::ClearCache()
{
  const std::string folder = sono::keptFolder(this->CacheFolder);
  if (!folder.empty())
  {
    sono::trimCacheFolder(folder, 0);
  }
}

std::string vtkSonoSceneBuilder::SettingsKey()
{
  try
  {
    sono::KeyText key;
    key.add("anatomy");
    key.add(this->TissueTableText.empty() ? sono::fileKey(sono::chosenOrBundled(this->TissueTableFile, "tissues.csv"))
                                          : this->TissueTableText);
    key.add(sono::fileKey(sono::chosenOrBundled(this->LabelTissueFile, "label_tissues.csv")));
    key.add(this->LabelTableText.empty() && !this->LabelTableFile.empty() ? sono::fileKey(this->LabelTableFile)
                                                                          : this->LabelTableText);
    key.add(this->FallbackTissue).add(this->OutsideTissue).add(double(this->FillBody));
    sono::addParameters(sono::settingsIn<sono::BodyFillSettings>(*this->Parameters), key);
    return key.text();
  }
  catch (const sono::Error&)
  {
    return {}; // said when the table is read
  }
}

int vtkSonoSceneBuilder::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

int vtkSonoSceneBuilder::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  return sono::requestWholeImage(input);
}

sono::TissueTable vtkSonoSceneBuilder::ReadTissues() const
{
  return this->TissueTableText.empty()
           ? sono::TissueTable::read(sono::chosenOrBundled(this->TissueTableFile, "tissues.csv"))
           : sono::TissueTable::parse(this->TissueTableText, "the tissue editor's tissues");
}

sono::LabelVolume vtkSonoSceneBuilder::ReadLabels(vtkInformationVector** input)
{
  const sono::Progress progress = sono::progressOf(this);
  sono::LabelVolume volume =
    sono::labelVolumeFromImage(vtkImageData::GetData(input[0]), sono::labelArrayOf(this, input));
  sono::report(progress, 0.05);
  if (this->FillBody == FILL_ON)
  {
    const auto& settings = sono::settingsIn<sono::BodyFillSettings>(*this->Parameters);
    sono::fillBody(volume, settings, sono::partOf(progress, 0.05, 0.1));
  }
  if (!this->LabelTableText.empty())
  {
    sono::describeLabels(sono::parseLabels(this->LabelTableText, "the tissue editor's labels"), volume);
  }
  else if (!this->LabelTableFile.empty())
  {
    sono::readLabelTable(this->LabelTableFile, volume);
  }
  return volume;
}

void vtkSonoSceneBuilder::AssignTissues(const sono::TissueTable& table, sono::LabelVolume& volume)
{
  const auto map = sono::LabelTissueMap::read(sono::chosenOrBundled(this->LabelTissueFile, "label_tissues.csv"));
  for (const std::string& sentence :
       sono::prepareBody(volume, map, table, this->FallbackTissue, sono::BodyFillMode(this->FillBody),
                         sono::settingsIn<sono::BodyFillSettings>(*this->Parameters)))
  {
    this->Warn(sentence);
  }
}

sono::SharedAnatomy vtkSonoSceneBuilder::Build(vtkInformationVector** input, bool cached)
{
  const sono::Progress progress = sono::progressOf(this);
  this->Warnings.clear();
  sono::LabelVolume volume = this->ReadLabels(input);
  const auto table = std::make_shared<const sono::TissueTable>(this->ReadTissues());
  const sono::GridPlacement placement = volume.placement;
  this->AssignTissues(*table, volume);
  std::vector<std::uint8_t> detail = sono::scanDetailOf(vtkImageData::GetData(input[0]));
  if (!detail.empty() && volume.placement.size != placement.size)
  {
    detail = sono::detailOnLargerGrid(detail, placement, volume.placement);
  }
  const std::shared_ptr<const sono::TissueMotion> motion = sono::motionOf(vtkImageData::GetData(input[0]), volume);
  const std::shared_ptr<const sono::Scene> scene =
    cached
      ? sono::makeCachedScene(std::move(volume), *table, this->OutsideTissue, this->CacheFolder,
                              sono::partOf(progress, 0.1, 0.6), std::move(detail), motion)
      : std::make_shared<const sono::Scene>(std::move(volume), *table, this->OutsideTissue, std::move(detail), motion);
  return { scene, table, this->Warnings };
}

int vtkSonoSceneBuilder::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    const sono::Progress progress = sono::progressOf(this);
    const bool cached = this->BuildSurfaces && !this->CacheFolder.empty() && this->CacheFolder != "auto";
    vtkDataArray* labels = sono::labelArrayOf(this, input);
    const std::string key = this->SettingsKey();
    std::optional<sono::SharedAnatomy> anatomy =
      key.empty() ? std::nullopt : sono::findAnatomy(vtkImageData::GetData(input[0]), labels, key);
    if (anatomy)
    {
      std::for_each(anatomy->warnings.begin(), anatomy->warnings.end(),
                    [this](const std::string& sentence) { sono::warn(this, sentence); });
    }
    else
    {
      anatomy = this->Build(input, cached);
      ++this->BuiltAnatomies;
      sono::shareAnatomy(vtkImageData::GetData(input[0]), labels, key, *anatomy, this);
    }
    const std::shared_ptr<const sono::Scene>& scene = anatomy->scene;
    vtkMultiBlockDataSet* blocks = vtkMultiBlockDataSet::GetData(output);
    if (sono::takePlayedBlocks(*scene, this->BuildSurfaces, blocks))
    {
      return;
    }
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
    vtkSonoSceneHandle::Attach(scene, anatomy->tissues, blocks);
    sono::keepPlayedBlocks(vtkImageData::GetData(input[0]), *scene, this->BuildSurfaces, blocks, this);
  });
}
