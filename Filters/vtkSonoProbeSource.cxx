#include "vtkSonoProbeSource.h"

#include "Core/Device.h"
#include "Core/Policy.h"
#include "Core/Progress.h"
#include "SonoDataFile.h"
#include "SonoOutputs.h"
#include "SonoProbeField.h"
#include "SonoSettings.h"
#include "SonoStage.h"

#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <utility>

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

bool runsOnGpu(int device)
{
  try
  {
    return sono::chooseDevice(static_cast<sono::Device>(device)).cuda;
  }
  catch (const std::exception&) // a GPU that is wanted and not there: the stage that traces says so
  {
    return false;
  }
}

/// Leaves of a matrix's volume one plane; the second one is across the array.
void takePlane(bool isSecond, sono::ProbeField& probe)
{
  probe.geometry.elevationLineCount = 1;
  if (isSecond)
  {
    std::swap(probe.geometry.sectorDeg, probe.geometry.elevationSectorDeg);
    std::swap(probe.apertureMm, probe.elevationApertureMm);
    probe.pose.lateral = glm::cross(probe.pose.axial, probe.pose.lateral);
  }
}

} // namespace

vtkSonoProbeSource::vtkSonoProbeSource()
  : Parameters(new sono::SettingsOf<sono::ProbeSettings>)
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
  this->Parameters->print(os, indent);
  printVector("PositionMm", this->PositionMm);
  printVector("Axial", this->Axial);
  printVector("Lateral", this->Lateral);
  os << indent << "MatrixPlane: " << this->MatrixPlane << endl;
  os << indent << "Preview: " << this->Preview << endl;
  os << indent << "Device: " << this->Device << endl;
  os << indent << "PrepareInteraction: " << this->PrepareInteraction << endl;
}

void vtkSonoProbeSource::SetNumber(const char* name, double value)
{
  if (this->Parameters->set(name, value))
  {
    this->Modified();
  }
}

void vtkSonoProbeSource::UseDevice(int device)
{
  if (this->Device != device)
  {
    this->Device = device;
    this->Modified();
  }
}

sono::ProbeField vtkSonoProbeSource::Probe() const
{
  return this->ProbeAt(this->PositionMm, this->Axial, this->Lateral, this->Preview);
}

sono::ProbeField vtkSonoProbeSource::ProbeAt(const double positionMm[3], const double axial[3], const double lateral[3],
                                             bool preview) const
{
  sono::ProbeField probe;
  static_cast<sono::ProbeSettings&>(probe) = this->PresetFile.empty()
                                               ? sono::settingsIn<sono::ProbeSettings>(*this->Parameters)
                                               : sono::readProbePreset(presetPath(this->PresetFile));
  const auto& given = sono::settingsIn<sono::ProbeSettings>(*this->Parameters);
  probe.geometry.assumedSoundSpeedMPerS = given.geometry.assumedSoundSpeedMPerS;
  probe.preview = preview;
  probe.coarse = preview && !runsOnGpu(this->Device);
  probe.geometry.compoundFans = probe.coarse ? 1 : given.geometry.compoundFans;
  if (probe.coarse)
  {
    probe.linesApart = sono::interactiveLinesApart(probe.geometry.lineCount);
    probe.geometry.lineCount = (probe.geometry.lineCount + probe.linesApart - 1) / probe.linesApart;
  }
  probe.geometry.compoundSpanDeg = given.geometry.compoundSpanDeg;
  probe.imagingMode = given.imagingMode;
  probe.facePressureKPa = given.facePressureKPa;
  probe.geometry.validate();
  probe.prepares = this->PrepareInteraction;

  const auto vector = [](const double* v) { return sono::Vec3d(v[0], v[1], v[2]); };
  const sono::ProbePose pose{ vector(positionMm), vector(axial), vector(lateral) };
  probe.pose = pose.orthonormalized();
  if (this->MatrixPlane != WHOLE_VOLUME && probe.geometry.isMatrix())
  {
    takePlane(this->MatrixPlane == SECOND_PLANE, probe);
  }
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
  return sono::runStage(this, output, [&] { sono::fillProbe(this->Probe(), vtkPolyData::GetData(output)); });
}
