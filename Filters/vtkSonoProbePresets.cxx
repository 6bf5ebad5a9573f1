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

#include <functional>
#include <sstream>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkSonoProbePresets);

namespace {

using sono::ProbePreset;

/// The settings of vtkSonoProbeSource that a preset gives.
const std::vector<std::pair<const char*, std::function<double(const ProbePreset&)>>>& settings()
{
  static const std::vector<std::pair<const char*, std::function<double(const ProbePreset&)>>> all{
    { "ScanKind", [](const ProbePreset& p) { return double(p.geometry.kind); } },
    { "LineCount", [](const ProbePreset& p) { return double(p.geometry.lineCount); } },
    { "DepthMm", [](const ProbePreset& p) { return p.geometry.depthMm; } },
    { "SectorDeg", [](const ProbePreset& p) { return p.geometry.sectorDeg; } },
    { "RadiusMm", [](const ProbePreset& p) { return p.geometry.radiusMm; } },
    { "WidthMm", [](const ProbePreset& p) { return p.geometry.widthMm; } },
    { "ElevationLineCount", [](const ProbePreset& p) { return double(p.geometry.elevationLineCount); } },
    { "ElevationSectorDeg", [](const ProbePreset& p) { return p.geometry.elevationSectorDeg; } },
    { "CentreFrequencyMHz", [](const ProbePreset& p) { return p.centreFrequencyMHz; } },
    { "FractionalBandwidth", [](const ProbePreset& p) { return p.fractionalBandwidth; } },
  };
  return all;
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
    for (const auto& [name, value] : settings())
    {
      vtkNew<vtkDoubleArray> column;
      column->SetName(name);
      for (std::size_t i = 0; i < presets.size(); ++i)
      {
        column->InsertNextValue(value(presets[i].second));
        rows[i] << '\t' << value(presets[i].second);
      }
      table->AddColumn(column);
      columns += std::string("\t") + name;
    }
    this->Rows->InsertNextValue(columns);
    for (const std::ostringstream& row : rows)
    {
      this->Rows->InsertNextValue(row.str());
    }
  });
}
