#include "Core/KeptResults.h"
#include "Core/KeyText.h"
#include "SameSettings.h"
#include "SonoContentKey.h"
#include "SonoImagePlacement.h"
#include "SonoKeptArrays.h"
#include "SonoOutputs.h"
#include "SonoPlayed.h"
#include "SonoSettings.h"
#include "SonoStage.h"
#include "SonoUltrasoundStages.h"
#include "Trace/TraceDevice.h"
#include "vtkSonoImageFormation.h"
#include "vtkSonoRayTracer.h"
#include "vtkSonoScanConverter.h"
#include "vtkSonoSceneBuilder.h"
#include "vtkSonoUltrasound.h"

#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <algorithm>
#include <iterator>
#include <utility>

// The pictures that UltrasoundStages keeps from one run of the program to the next.

namespace sono {
namespace {

using Filter = vtkSonoUltrasound; // of the ports

constexpr const char* keptPicture = "picture";

/// A phase's picture and the fields that it has besides the acquisition.
struct PlayedPicture
{
  vtkSmartPointer<vtkPointData> arrays;
  vtkSmartPointer<vtkFieldData> fields;
  std::vector<std::string> warnings;
};

} // namespace

/// All that the picture depends on; empty where that is not known, or it is one of many.
std::string UltrasoundStages::keptKey()
{
  const bool isAlone = owner_->GetNumberOfInputConnections(Filter::TARGETS) == 0 &&
                       owner_->GetNumberOfInputConnections(Filter::SCATTERERS) == 0 &&
                       owner_->GetNumberOfInputConnections(Filter::PULSE_ECHO_FIELD) == 0;
  const DisplaySettings display = converter->DisplaySettings();
  if (!isAlone || field_.preview || owner_->GetErrorMap() || display.persistence > 0.0 ||
      settings_.tracing.timeBudgetS > 0.0)
  {
    return {};
  }
  const std::string content = contentKeyOf(owner_, Filter::LABELS_OR_SCENE);
  const std::string anatomy = content.empty() ? content : scene->SettingsKey();
  if (anatomy.empty())
  {
    return {};
  }
  try
  {
    const char* array = owner_->GetInputArrayInformation(0)->Get(vtkDataObject::FIELD_NAME());
    const std::string pulse = formation->GetPulseFileName();
    KeyText key;
    key.add(programKey()).add(content).add(anatomy).add(array ? array : "");
    key.add(double(chooseDevice(settings_.tracing).cuda)).add(double(chooseDevice(settings_.echo.device).cuda));
    key.add(pulse.empty() ? pulse : fileKey(pulse));
    describe(field_.pose, key);
    addParameters(display, key);
    return describe(settings_, key) ? key.text() : std::string();
  }
  catch (const Error&)
  {
    return {}; // said when the picture is made
  }
}

bool UltrasoundStages::findKept(int port)
{
  const std::string folder = keptFolder(scene->GetCacheFolder());
  vtkDataObject* input = owner_->GetInputDataObject(Filter::LABELS_OR_SCENE, 0);
  const bool isBuilt =
    input && isInputUpToDate(owner_, Filter::LABELS_OR_SCENE) && anatomy_->builtBlocks(input) != nullptr;
  // What is built is there sooner than a file is looked for, and its pictures are many.
  std::string key = folder.empty() || isBuilt || !vtkImageData::SafeDownCast(input) ? std::string() : keptKey();
  if (key.empty() || key != key_)
  {
    kept_.clear();
    said_.clear();
    key_ = std::move(key);
  }
  left_.erase(port);
  if (!key_.empty() && kept_.empty())
  {
    kept_ = sono::findKept(folder, keptPicture, key_).value_or(std::vector<std::string>());
  }
  if (kept_.empty() || port == Filter::IMAGE || port == Filter::FLAT_IMAGE || port == Filter::PROBE)
  {
    return !kept_.empty();
  }
  const bool isLeft = !isOutputWanted(owner_, port);
  if (isLeft)
  {
    left_.insert(port);
  }
  return isLeft;
}

bool UltrasoundStages::isLeftWanted() const
{
  return std::any_of(left_.begin(), left_.end(), [this](int port) { return isOutputWanted(owner_, port); });
}

void UltrasoundStages::givePicture(vtkPointData* arrays, vtkFieldData* fields, vtkInformationVector* output)
{
  arrays->SetActiveScalars("BMode");
  vtkImageData* world = vtkImageData::GetData(output, Filter::IMAGE);
  vtkImageData* flat = vtkImageData::GetData(output, Filter::FLAT_IMAGE);
  const ImagePlacement placement = placementOf(field_, settings_.pixelMm);
  world->GetFieldData()->Initialize();
  world->GetFieldData()->PassData(fields);
  world->GetFieldData()->PassData(acquisition_);
  writeGreySettings(settings_.bmode, world->GetFieldData());
  world->GetPointData()->ShallowCopy(arrays);
  placement.place(world);
  flat->ShallowCopy(world);
  placement.flat(field_.pose).place(flat);
  fillFlat(world, flat);
}

bool UltrasoundStages::takeKept(vtkInformationVector* output)
{
  vtkNew<vtkPointData> arrays;
  vtkNew<vtkFieldData> fields;
  if (kept_.size() != 3 || !addPackedArrays(kept_[0], arrays) || !addPackedArrays(kept_[1], fields))
  {
    return false;
  }
  givePicture(arrays, fields, output);
  for (const std::string& sentence : unpackedSentences(kept_[2]))
  {
    say(sentence);
  }
  return true;
}

/// What there is to say of the anatomy and the probe's place: not again when they are looked at after their kept
/// picture was shown.
void UltrasoundStages::say(const std::string& sentence)
{
  if (key_.empty() || said_.insert(sentence).second)
  {
    warn(owner_, sentence);
  }
}

/// The picture that was just made, with the fields that it has besides the acquisition.
void UltrasoundStages::keep(vtkFieldData* fields)
{
  // A file may have changed meanwhile, and a better picture may follow.
  if (key_.empty() || key_ != keptKey() || isRefining() || hasBetter())
  {
    return;
  }
  std::vector<std::string> warnings = anatomy_->warnings();
  std::copy_if(traceWarnings_.begin(), traceWarnings_.end(), std::back_inserter(warnings),
               [](const std::string& sentence) { return !sentence.empty(); });
  sono::keep(keptFolder(scene->GetCacheFolder()), keptPicture, key_,
             { packedArrays(pictureArrays_), packedArrays(fields), packedSentences(warnings) });
}

/// All that the picture of a phase depends on in this process; empty where it is none, or one of many.
std::string UltrasoundStages::playedKey(const Inputs& inputs)
{
  const DisplaySettings display = converter->DisplaySettings();
  if (!timeOf(inputs[Filter::LABELS_OR_SCENE]) || field_.preview || owner_->GetErrorMap() ||
      display.persistence > 0.0 || settings_.tracing.timeBudgetS > 0.0)
  {
    return {};
  }
  KeyText key;
  key.add("played picture").add(double(simulator_->scene()->id())).add(double(formation->GetMTime()));
  for (std::size_t port = 1; port < inputs.size(); ++port)
  {
    const std::vector<double> content = inputs[port] ? contentOf(inputs[port]) : std::vector<double>();
    key.add(double(content.size()));
    std::for_each(content.begin(), content.end(), [&key](double number) { key.add(number); });
  }
  key.add(tracer->GetTargetTissue());
  describe(field_.pose, key);
  addParameters(display, key);
  return describe(settings_, key) ? key.text() : std::string();
}

/// Whether an output that nobody uses stays empty: the phase's picture is there, and nothing is to be traced for it.
bool UltrasoundStages::leavesPlayed(const std::string& key, int port)
{
  if (key.empty() || !findPlayed(key) || isOutputWanted(owner_, port))
  {
    return false;
  }
  left_.insert(port);
  return true;
}

bool UltrasoundStages::takePlayed(const std::string& key, vtkInformationVector* output)
{
  const auto played = key.empty() ? nullptr : std::static_pointer_cast<const PlayedPicture>(findPlayed(key));
  if (played)
  {
    givePicture(played->arrays, played->fields, output);
    std::for_each(played->warnings.begin(), played->warnings.end(),
                  [this](const std::string& sentence) { say(sentence); });
  }
  return played != nullptr;
}

void UltrasoundStages::keepPlayed(const std::string& key, vtkFieldData* fields)
{
  if (key.empty() || isRefining() || hasBetter())
  {
    return;
  }
  const auto played = std::make_shared<PlayedPicture>();
  played->arrays = vtkSmartPointer<vtkPointData>::New();
  played->arrays->ShallowCopy(pictureArrays_);
  played->fields = vtkSmartPointer<vtkFieldData>::New();
  played->fields->ShallowCopy(fields);
  std::copy_if(traceWarnings_.begin(), traceWarnings_.end(), std::back_inserter(played->warnings),
               [](const std::string& sentence) { return !sentence.empty(); });
  sono::keepPlayed(owner_, key, played, 1024 * std::size_t(pictureArrays_->GetActualMemorySize()));
}

} // namespace sono
