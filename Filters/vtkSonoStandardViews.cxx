#include "vtkSonoStandardViews.h"

#include "Core/Error.h"
#include "Probe/StandardViews.h"
#include "SonoDataFile.h"
#include "SonoStage.h"
#include "SonoWay.h"

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
#include <string>
#include <vector>

vtkStandardNewMacro(vtkSonoStandardViews);

namespace {

using Views = std::vector<sono::StandardView>;

/// The view of the name, or the best one.
const sono::StandardView& chosenOf(const Views& obtainable, const Views& refused, const std::string& name)
{
  const auto isNamed = [&](const sono::StandardView& view) { return view.name == name; };
  const auto named =
    name.empty()
      ? std::max_element(obtainable.begin(), obtainable.end(),
                         [](const sono::StandardView& a, const sono::StandardView& b) { return a.score < b.score; })
      : std::find_if(obtainable.begin(), obtainable.end(), isNamed);
  if (named != obtainable.end())
  {
    return *named;
  }
  const auto refusal = std::find_if(refused.begin(), refused.end(), isNamed);
  if (refusal != refused.end())
  {
    throw sono::Error(sono::describe(*refusal));
  }
  if (name.empty())
  {
    throw sono::Error("No standard view is obtainable from this patient. " + sono::describe(refused.front()));
  }
  std::string names;
  for (const Views* views : { &obtainable, &refused })
  {
    for (const sono::StandardView& view : *views)
    {
      names += (names.empty() ? "" : ", ") + view.name;
    }
  }
  throw sono::Error("There is no view '" + name + "'; there are: " + names + ".");
}

/// An array with a tuple a view, of numbers or vectors.
template<class Value>
void writeOf(const char* name, const Views& views, int components, const Value& value, vtkFieldData* field)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  for (const sono::StandardView& view : views)
  {
    array->InsertNextTuple(value(view));
  }
  field->AddArray(array);
}

template<class Text>
std::vector<std::string> textsOf(const Views& views, const Text& text)
{
  std::vector<std::string> texts;
  std::transform(views.begin(), views.end(), std::back_inserter(texts), text);
  return texts;
}

} // namespace

vtkSonoStandardViews::vtkSonoStandardViews()
  : Rows(vtkSmartPointer<vtkStringArray>::New())
  , RefusedRows(vtkSmartPointer<vtkStringArray>::New())
{
  this->SetProgressText("Looking for standard views");
}

vtkSonoStandardViews::~vtkSonoStandardViews() = default;

void vtkSonoStandardViews::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FillBody: " << this->FillBody << endl;
  os << indent << "View: " << this->View << endl;
  os << indent << "Rows: " << this->Rows->GetNumberOfValues() << endl;
  os << indent << "RefusedRows: " << this->RefusedRows->GetNumberOfValues() << endl;
  os << indent << "Refusal: " << this->Refusal << endl;
}

vtkStringArray* vtkSonoStandardViews::GetRows()
{
  return this->Rows;
}

vtkStringArray* vtkSonoStandardViews::GetRefusedRows()
{
  return this->RefusedRows;
}

const char* vtkSonoStandardViews::GetRefusal()
{
  return this->Refusal.c_str();
}

int vtkSonoStandardViews::FillInputPortInformation(int, vtkInformation* info)
{
  // The composite one first: the pipeline would otherwise hand a scene over block by block.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkMultiBlockDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1); // so that one clear sentence says what is missing
  return 1;
}

int vtkSonoStandardViews::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  return vtkImageData::GetData(input[0]) ? sono::requestWholeImage(input) : 1;
}

void vtkSonoStandardViews::Find(vtkDataObject* input, vtkPolyData* way)
{
  this->Scene = sono::sceneToSearch(input, this->FillBody, this);
  const Views all = sono::findStandardViews(
    *this->Scene,
    [](const std::string& preset) -> sono::ProbeSettings {
      return sono::readProbePreset(sono::dataFile("probes/" + preset + ".json"));
    },
    sono::partOf(sono::progressOf(this), 0.5, 1.0));
  Views obtainable;
  Views refused;
  for (const sono::StandardView& view : all)
  {
    (view.refusal.empty() ? obtainable : refused).push_back(view);
  }
  using View = sono::StandardView;
  const auto row = [](const View& view) {
    return sono::rowOf(view.pose, view.depthMm, view.preset, sono::describe(view));
  };
  this->Rows = sono::namedStrings("Rows", textsOf(obtainable, row));
  this->RefusedRows = sono::namedStrings("Refused", textsOf(refused, sono::describe));

  const View& chosen = chosenOf(obtainable, refused, this->View);
  sono::writeWay(chosen.pose, chosen.depthMm, way);
  vtkFieldData* field = way->GetFieldData();
  const auto name = [](const View& view) { return view.name; };
  const auto preset = [](const View& view) { return view.preset; };
  field->AddArray(sono::namedStrings("ViewName", textsOf(obtainable, name)));
  field->AddArray(sono::namedStrings("Sentence", textsOf(obtainable, sono::describe)));
  field->AddArray(sono::namedStrings("ProbePreset", textsOf(obtainable, preset)));
  field->AddArray(this->RefusedRows);
  writeOf(
    "DepthMm", obtainable, 1, [](const View& view) { return &view.depthMm; }, field);
  writeOf(
    "Score", obtainable, 1, [](const View& view) { return &view.score; }, field);
  writeOf(
    "PlaneOffDegrees", obtainable, 1, [](const View& view) { return &view.planeOffDeg; }, field);
  writeOf(
    "MarkOffMm", obtainable, 1, [](const View& view) { return &view.markOffMm; }, field);
  writeOf(
    "ViewPositionMm", obtainable, 3, [](const View& view) { return &view.pose.positionMm.x; }, field);
  writeOf(
    "ViewAxial", obtainable, 3, [](const View& view) { return &view.pose.axial.x; }, field);
  writeOf(
    "ViewLateral", obtainable, 3, [](const View& view) { return &view.pose.lateral.x; }, field);
}

int vtkSonoStandardViews::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  this->Rows = sono::namedStrings("Rows", {});
  this->RefusedRows = sono::namedStrings("Refused", {});
  this->Refusal.clear();
  return sono::runStage(this, output, [&] {
    try
    {
      vtkDataObject* data = vtkDataObject::GetData(input[0]);
      if (!data)
      {
        throw sono::Error("No label map is connected; select one before you make the filter, or set its Input.");
      }
      this->Find(data, vtkPolyData::GetData(output));
    }
    catch (const sono::Error& error)
    {
      this->Refusal = error.what();
      throw;
    }
  });
}
