#include "vtkSonoAcousticWindow.h"

#include "Core/KeptResults.h"
#include "Core/KeyText.h"
#include "Probe/AcousticWindow.h"
#include "SonoContentKey.h"
#include "SonoDataFile.h"
#include "SonoKeptArrays.h"
#include "SonoStage.h"
#include "SonoWay.h"
#include "vtkSonoSceneBuilder.h"

#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

vtkStandardNewMacro(vtkSonoAcousticWindow);

namespace {

constexpr const char* keptKind = "window";

/// The pose that the data bring along.
std::optional<sono::ProbePose> carriedPose(vtkFieldData* field)
{
  sono::ProbePose pose;
  const std::pair<const char*, sono::Vec3d*> parts[] = { { "A4CPositionMm", &pose.positionMm },
                                                         { "A4CAxial", &pose.axial },
                                                         { "A4CLateral", &pose.lateral } };
  for (const auto& [name, value] : parts)
  {
    vtkDataArray* array = field->GetArray(name);
    if (!array || array->GetNumberOfTuples() != 1 || array->GetNumberOfComponents() != 3)
    {
      return std::nullopt;
    }
    array->GetTuple(0, &value->x);
  }
  return pose.orthonormalized();
}

sono::ProbeSettings probeFor(const std::string& preset, double frequencyMHz)
{
  if (!preset.empty())
  {
    return sono::readProbePreset(sono::dataFile("probes/" + preset + ".json"));
  }
  sono::ProbeSettings any;
  any.centreFrequencyMHz = frequencyMHz;
  return any;
}

/// With the probe for the target, or the one for deep targets where that shows next to nothing.
std::vector<sono::AcousticWindow> findWindows(const sono::Scene& scene, const sono::WindowTarget& target,
                                              double frequencyMHz, std::string& preset)
{
  constexpr double littlePercent = 10.0;
  std::vector<sono::AcousticWindow> windows;
  preset = target.preset;
  try
  {
    windows = sono::findAcousticWindows(scene, target, probeFor(preset, frequencyMHz));
  }
  catch (const sono::Error&)
  {
    if (target.deepPreset.empty())
    {
      throw;
    }
  }
  if (!target.deepPreset.empty() && (windows.empty() || windows.front().seenPercent < littlePercent))
  {
    windows = sono::findAcousticWindows(scene, target, probeFor(target.deepPreset, frequencyMHz));
    preset = target.deepPreset;
  }
  return windows;
}

/// An array with a tuple a window.
template<class Value>
void writeAll(const char* name, const std::vector<sono::AcousticWindow>& windows, const Value& value,
              vtkFieldData* field)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  if constexpr (std::is_same_v<decltype(value(windows[0])), const sono::Vec3d&>)
  {
    array->SetNumberOfComponents(3);
    for (const sono::AcousticWindow& window : windows)
    {
      array->InsertNextTuple(&value(window).x);
    }
  }
  else
  {
    for (const sono::AcousticWindow& window : windows)
    {
      array->InsertNextValue(value(window));
    }
  }
  field->AddArray(array);
}

} // namespace

vtkSonoAcousticWindow::vtkSonoAcousticWindow()
  : Rows(vtkSmartPointer<vtkStringArray>::New())
  , Targets(vtkSmartPointer<vtkStringArray>::New())
{
  this->SetProgressText("Looking for an acoustic window");
}

vtkSonoAcousticWindow::~vtkSonoAcousticWindow() = default;

void vtkSonoAcousticWindow::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FillBody: " << this->FillBody << endl;
  os << indent << "Target: " << this->Target << endl;
  os << indent << "Candidate: " << this->Candidate << endl;
  os << indent << "ChooseTarget: " << this->ChooseTarget << endl;
  os << indent << "TargetMm: " << this->TargetMm[0] << " " << this->TargetMm[1] << " " << this->TargetMm[2] << endl;
  os << indent << "CentreFrequencyMHz: " << this->CentreFrequencyMHz << endl;
  os << indent << "CacheFolder: " << this->CacheFolder << endl;
  os << indent << "Rows: " << this->Rows->GetNumberOfValues() << endl;
  os << indent << "Targets: " << this->Targets->GetNumberOfValues() << endl;
  os << indent << "Refusal: " << this->Refusal << endl;
}

vtkStringArray* vtkSonoAcousticWindow::GetRows()
{
  return this->Rows;
}

vtkStringArray* vtkSonoAcousticWindow::GetTargets()
{
  return this->Targets;
}

const char* vtkSonoAcousticWindow::GetRefusal()
{
  return this->Refusal.c_str();
}

int vtkSonoAcousticWindow::FillInputPortInformation(int, vtkInformation* info)
{
  // The composite one first: the pipeline would otherwise hand a scene over block by block.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkMultiBlockDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1); // so that one clear sentence says what is missing
  return 1;
}

int vtkSonoAcousticWindow::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  this->Kept.clear();
  this->Key.clear();
  if (!vtkImageData::GetData(input[0]))
  {
    return 1;
  }
  const std::string folder = sono::keptFolder(this->CacheFolder);
  this->Key = folder.empty() ? std::string() : this->KeptKey();
  if (!this->Key.empty())
  {
    this->Kept = sono::findKept(folder, keptKind, this->Key).value_or(std::vector<std::string>());
  }
  if (!this->Kept.empty())
  {
    sono::askNothing(input[0]->GetInformationObject(0));
    return 1;
  }
  return sono::requestWholeImage(input);
}

/// All that the windows depend on; empty where that is not known.
std::string vtkSonoAcousticWindow::KeptKey()
try
{
  const std::string content = sono::contentKeyOf(this, 0);
  vtkNew<vtkSonoSceneBuilder> builder;
  builder->SetFillBody(this->FillBody);
  const std::string anatomy = content.empty() ? content : builder->SettingsKey();
  if (anatomy.empty())
  {
    return {};
  }
  const char* array = this->GetInputArrayInformation(0)->Get(vtkDataObject::FIELD_NAME());
  sono::KeyText key;
  key.add(sono::programKey()).add(content).add(anatomy).add(array ? array : "");
  key.add(this->Target).add(double(this->Candidate)).add(this->CentreFrequencyMHz).add(double(this->ChooseTarget));
  key.add(this->TargetMm[0]).add(this->TargetMm[1]).add(this->TargetMm[2]);
  for (const std::string& preset : sono::dataFiles("probes", ".json"))
  {
    key.add(preset).add(sono::fileKey(sono::dataFile("probes/" + preset + ".json")));
  }
  return key.text();
}
catch (const sono::Error&)
{
  return {}; // said when the file is read
}

/// False where nothing was found earlier.
bool vtkSonoAcousticWindow::TakeKept(vtkPolyData* way)
{
  vtkNew<vtkFieldData> own;
  if (this->Kept.size() != 2 || !sono::addPackedArrays(this->Kept[1], own) ||
      !sono::addPackedArrays(this->Kept[0], way->GetFieldData()))
  {
    return false;
  }
  this->Rows = vtkStringArray::SafeDownCast(own->GetAbstractArray("Rows"));
  this->Targets = vtkStringArray::SafeDownCast(own->GetAbstractArray("Targets"));
  vtkDataArray* ends = own->GetArray("Ends");
  sono::Vec3d begin;
  sono::Vec3d end;
  ends->GetTuple(0, &begin.x);
  ends->GetTuple(1, &end.x);
  sono::drawWay(begin, end, way);
  return true;
}

void vtkSonoAcousticWindow::Keep(vtkPolyData* way)
{
  if (this->Key.empty() || this->Key != this->KeptKey()) // a file may have changed meanwhile
  {
    return;
  }
  vtkNew<vtkFieldData> own;
  vtkNew<vtkDoubleArray> ends;
  ends->SetName("Ends");
  ends->SetNumberOfComponents(3);
  for (const vtkIdType point : { 0, 1 })
  {
    ends->InsertNextTuple(way->GetPoint(point));
  }
  for (vtkAbstractArray* array : std::initializer_list<vtkAbstractArray*>{ this->Rows, this->Targets, ends })
  {
    own->AddArray(array);
  }
  sono::keep(sono::keptFolder(this->CacheFolder), keptKind, this->Key,
             { sono::packedArrays(way->GetFieldData()), sono::packedArrays(own) });
}

void vtkSonoAcousticWindow::Find(vtkDataObject* input, vtkPolyData* way)
{
  this->Scene = sono::sceneToSearch(input, this->FillBody, this);
  const std::shared_ptr<const sono::Scene> scene = this->Scene;
  this->Targets = sono::namedStrings("Targets", sono::windowTargetNames(*scene));
  const bool isFree = !this->ChooseTarget && this->Target.empty();
  const auto carried = isFree ? carriedPose(input->GetFieldData()) : std::nullopt;
  const sono::WindowTarget target =
    this->ChooseTarget ? sono::windowTarget(sono::Vec3d(this->TargetMm[0], this->TargetMm[1], this->TargetMm[2]))
                       : sono::windowTarget(*scene, this->Target);
  std::vector<sono::AcousticWindow> windows(carried ? 1 : 0);
  std::vector<std::string> sentences{ "The pose that the label map brings along." };
  std::string preset;
  if (carried)
  {
    windows[0].pose = *carried;
  }
  else
  {
    windows = findWindows(*scene, target, this->CentreFrequencyMHz, preset);
    sentences.clear();
    std::transform(windows.begin(), windows.end(), std::back_inserter(sentences),
                   [&](const sono::AcousticWindow& window) { return sono::describe(window, target); });
  }
  std::vector<std::string> rows;
  for (std::size_t i = 0; i < windows.size(); ++i)
  {
    rows.push_back(sono::rowOf(windows[i].pose, windows[i].depthMm, preset, sentences[i]));
  }
  this->Rows = sono::namedStrings("Rows", rows);
  if (std::size_t(this->Candidate) >= windows.size())
  {
    throw sono::Error("Candidate is " + std::to_string(this->Candidate) +
                      ", and the windows that were found are 0 to " + std::to_string(windows.size() - 1) + ".");
  }

  const sono::AcousticWindow& chosen = windows[std::size_t(this->Candidate)];
  constexpr double shownMm = 100.0; // of a pose that names no depth
  sono::writeWay(chosen.pose, carried ? shownMm : chosen.depthMm, way);
  vtkFieldData* field = way->GetFieldData();
  using Window = sono::AcousticWindow;
  const auto vectors = [&](const char* name, sono::Vec3d sono::ProbePose::*part) {
    writeAll(
      name, windows, [&](const Window& w) -> const sono::Vec3d& { return w.pose.*part; }, field);
  };
  vectors("CandidatePositionMm", &sono::ProbePose::positionMm);
  vectors("CandidateAxial", &sono::ProbePose::axial);
  vectors("CandidateLateral", &sono::ProbePose::lateral);
  if (!carried)
  {
    writeAll(
      "DepthMm", windows, [](const Window& w) { return w.depthMm; }, field);
    writeAll(
      "SeenPercent", windows, [](const Window& w) { return w.seenPercent; }, field);
    writeAll(
      "LossDb", windows, [](const Window& w) { return w.lossDb; }, field);
    writeAll(
      "InsidePercent", windows, [](const Window& w) { return w.insidePercent; }, field);
  }
  field->AddArray(sono::namedStrings("Sentence", sentences));
  field->AddArray(sono::namedStrings("ProbePreset", { preset }));
}

int vtkSonoAcousticWindow::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  this->Rows = sono::namedStrings("Rows", {});
  this->Refusal.clear();
  return sono::runStage(this, output, [&] {
    try
    {
      if (!(this->CentreFrequencyMHz > 0.0))
      {
        throw sono::Error("CentreFrequencyMHz must be above 0.");
      }
      vtkDataObject* data = vtkDataObject::GetData(input[0]);
      if (!data)
      {
        throw sono::Error("No label map is connected; select one before you make the filter, or set its Input.");
      }
      vtkPolyData* way = vtkPolyData::GetData(output);
      if (!this->TakeKept(way))
      {
        this->Find(data, way);
        this->Keep(way);
      }
    }
    catch (const sono::Error& error)
    {
      this->Refusal = error.what();
      throw;
    }
  });
}
