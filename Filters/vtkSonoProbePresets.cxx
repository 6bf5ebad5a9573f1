#include "vtkSonoProbePresets.h"

#include "Core/Progress.h"
#include "Probe/ScanGeometry.h"
#include "SonoDataFile.h"
#include "SonoStage.h"

#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <sstream>
#include <string>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkSonoProbePresets);

namespace {

using sono::ProbePreset;

struct Setting
{
  std::string name;
  double value;
};

/// The settings of vtkSonoProbeSource that a preset gives.
std::vector<Setting> settingsOf(const sono::ProbeSettings& preset)
{
  std::vector<Setting> settings;
  sono::ProbeSettings::visitPreset(preset, [&settings](const auto& value, const sono::Parameter& parameter) {
    settings.push_back({ sono::propertyName(parameter), sono::numberOf(value) });
  });
  return settings;
}

} // namespace

vtkSonoProbePresets::vtkSonoProbePresets()
  : Rows(vtkSmartPointer<vtkStringArray>::New())
{
  this->SetNumberOfInputPorts(0);
}

vtkSonoProbePresets::~vtkSonoProbePresets() = default;

void vtkSonoProbePresets::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << endl;
  os << indent << "Rows: " << this->Rows->GetNumberOfValues() << endl;
  os << indent << "Refusal: " << this->Refusal << endl;
}

vtkStringArray* vtkSonoProbePresets::GetRows()
{
  return this->Rows;
}

const char* vtkSonoProbePresets::GetRefusal()
{
  return this->Refusal.c_str();
}

int vtkSonoProbePresets::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    this->Rows->Reset();
    this->Refusal.clear();
    std::vector<std::pair<std::string, ProbePreset>> presets;
    for (const std::string& name : sono::dataFiles("probes", ".json"))
    {
      presets.emplace_back(name, sono::readProbePreset(sono::dataFile("probes/" + name + ".json")));
    }
    if (!this->FileName.empty())
    {
      try
      {
        presets.emplace_back(this->FileName, sono::readProbePreset(this->FileName));
      }
      catch (const sono::Error& error)
      {
        this->Refusal = error.what();
        throw;
      }
    }

    vtkNew<vtkStringArray> files;
    files->SetName("Preset");
    vtkNew<vtkStringArray> names;
    names->SetName("Name");
    std::string columns = "Preset\tName";
    std::vector<std::ostringstream> rows(presets.size());
    for (std::size_t i = 0; i < presets.size(); ++i)
    {
      files->InsertNextValue(presets[i].first);
      names->InsertNextValue(presets[i].second.name);
      rows[i].precision(10);
      rows[i] << presets[i].first << '\t' << presets[i].second.name;
    }
    vtkTable* table = vtkTable::GetData(output);
    table->AddColumn(files);
    table->AddColumn(names);
    const std::vector<Setting> settings = settingsOf({});
    for (std::size_t s = 0; s < settings.size(); ++s)
    {
      vtkNew<vtkDoubleArray> column;
      column->SetName(settings[s].name.c_str());
      for (std::size_t i = 0; i < presets.size(); ++i)
      {
        const double value = settingsOf(presets[i].second)[s].value;
        column->InsertNextValue(value);
        rows[i] << '\t' << value;
      }
      table->AddColumn(column);
      columns += "\t" + settings[s].name;
    }
    this->Rows->InsertNextValue(columns);
    for (const std::ostringstream& row : rows)
    {
      this->Rows->InsertNextValue(row.str());
    }
  });
}
