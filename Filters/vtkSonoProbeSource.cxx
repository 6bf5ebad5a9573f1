#include "vtkSonoProbeSource.h"

#include "Core/Progress.h"
#include "SonoDataFile.h"
#include "SonoProbeField.h"
#include "SonoStage.h"

#include "vtkCellArray.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

vtkStandardNewMacro(vtkSonoProbeSource);

namespace {

/// A plain word is the name of a bundled preset.
std::string presetPath(const std::string& preset)
{
  if (preset.find_first_of("./\\") != std::string::npos)
  {
    return preset;
  }
  std::string names;
  for (const std::string& name : sono::dataFiles("probes", ".json"))
  {
    if (name == preset)
    {
      return sono::dataFile("probes/" + name + ".json");
    }
    names += (names.empty() ? "" : ", ") + name;
  }
  throw sono::Error("There is no probe preset '" + preset + "'; choose one of " + names + ", or name a JSON file.");
}

} // namespace

vtkSonoProbeSource::vtkSonoProbeSource()
{
  this->SetNumberOfInputPorts(0);
  this->SetProgressText("Placing the probe");
}

vtkSonoProbeSource::~vtkSonoProbeSource() = default;

void vtkSonoProbeSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto printVector = [&](const char* name, const double* v) {
    os << indent << name << ": " << v[0] << " " << v[1] << " " << v[2] << endl;
  };
  os << indent << "PresetFile: " << this->PresetFile << endl;
  os << indent << "ScanKind: " << this->ScanKind << endl;
  os << indent << "LineCount: " << this->LineCount << endl;
  os << indent << "DepthMm: " << this->DepthMm << endl;
  os << indent << "SectorDeg: " << this->SectorDeg << endl;
  os << indent << "RadiusMm: " << this->RadiusMm << endl;
  os << indent << "WidthMm: " << this->WidthMm << endl;
  os << indent << "ElevationLineCount: " << this->ElevationLineCount << endl;
  os << indent << "ElevationSectorDeg: " << this->ElevationSectorDeg << endl;
  printVector("PositionMm", this->PositionMm);
  printVector("Axial", this->Axial);
  printVector("Lateral", this->Lateral);
  os << indent << "CentreFrequencyMHz: " << this->CentreFrequencyMHz << endl;
  os << indent << "FractionalBandwidth: " << this->FractionalBandwidth << endl;
  os << indent << "Preview: " << this->Preview << endl;
}

sono::ProbeField vtkSonoProbeSource::Probe() const
{
  sono::ProbeField probe;
  if (this->PresetFile.empty())
  {
    if (this->ScanKind < LINEAR || this->ScanKind > RADIAL)
    {
      throw sono::Error("ScanKind is " + std::to_string(this->ScanKind) +
                        " but must be 0 (linear), 1 (phased sector), 2 (curvilinear), 3 (matrix) or 4 (radial).");
    }
    probe.geometry = { static_cast<sono::ScanKind>(this->ScanKind),
                       this->LineCount,
                       this->DepthMm,
                       this->SectorDeg,
                       this->RadiusMm,
                       this->WidthMm,
                       this->ElevationLineCount,
                       this->ElevationSectorDeg };
    probe.centreFrequencyMHz = this->CentreFrequencyMHz;
    probe.fractionalBandwidth = this->FractionalBandwidth;
  }
  else
  {
    const sono::ProbePreset preset = sono::readProbePreset(presetPath(this->PresetFile));
    probe.geometry = preset.geometry;
    probe.centreFrequencyMHz = preset.centreFrequencyMHz;
    probe.fractionalBandwidth = preset.fractionalBandwidth;
  }
  probe.geometry.validate();
  probe.preview = this->Preview;

  const auto vector = [](const double* v) { return sono::Vec3d(v[0], v[1], v[2]); };
  const sono::ProbePose pose{ vector(this->PositionMm), vector(this->Axial), vector(this->Lateral) };
  probe.pose = pose.orthonormalized();
  return probe;
}

int vtkSonoProbeSource::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    vtkNew<vtkFieldData> field;
    sono::writeProbe(this->Probe(), field);
    sono::announceFields(field, output->GetInformationObject(0));
  });
}

int vtkSonoProbeSource::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    const sono::ProbeField probe = this->Probe();
    const sono::ProbePose& pose = probe.pose;
    const sono::Vec3d elevation = glm::cross(pose.axial, pose.lateral);
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> lines;
    for (const std::vector<sono::Vec3d>& polyline : sono::scanOutline(probe.geometry))
    {
      lines->InsertNextCell(static_cast<int>(polyline.size()));
      for (const sono::Vec3d& p : polyline)
      {
        const sono::Vec3d world = pose.positionMm + p.x * pose.lateral + p.y * elevation + p.z * pose.axial;
        lines->InsertCellPoint(points->InsertNextPoint(&world.x));
      }
    }
    vtkPolyData* polyData = vtkPolyData::GetData(output);
    polyData->SetPoints(points);
    polyData->SetLines(lines);
    sono::writeProbe(probe, polyData->GetFieldData());
  });
}
