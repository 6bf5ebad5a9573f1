#include "vtkSonoRayTracer.h"

#include "Echo/FormRf.h"
#include "SonoLineImage.h"
#include "SonoPaths.h"
#include "SonoProbeField.h"
#include "SonoStage.h"
#include "SonoTargets.h"
#include "Trace/ProbeContact.h"
#include "Trace/RecordPaths.h"
#include "Trace/Trace.h"
#include "vtkSonoSceneHandle.h"

#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>

vtkStandardNewMacro(vtkSonoRayTracer);

namespace {

/// The grid of the RF samples, which the boundary echoes share.
sono::EchoSettings rfGrid(double samplingMHz, double depthMm)
{
  sono::EchoSettings grid;
  grid.samplingMHz = samplingMHz;
  grid.depthMm = depthMm;
  return grid;
}

constexpr int previewPaths = 60;
constexpr double previewSamplesPerPeriod = 4.0;

/// Of the RF of this probe.
double rfSamplingMHz(double settingMHz, const sono::ProbeField& probe)
{
  return probe.preview ? std::min(settingMHz, previewSamplesPerPeriod * probe.centreFrequencyMHz) : settingMHz;
}

/// The tissues by the numbers that recorded paths give them.
std::vector<std::string> mediaNames(const sono::Scene& scene, const std::vector<sono::TargetSurface>& targets)
{
  std::vector<std::string> names;
  for (const sono::Tissue& tissue : scene.tissues())
  {
    names.push_back(tissue.name);
  }
  for (const sono::TargetSurface& target : targets)
  {
    names.push_back(target.tissue.name);
  }
  return names;
}

} // namespace

vtkSonoRayTracer::vtkSonoRayTracer()
{
  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(4);
  this->SetProgressText("Tracing");
}

vtkSonoRayTracer::~vtkSonoRayTracer() = default;

void vtkSonoRayTracer::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "InterfaceModel: " << this->InterfaceModel << endl;
  os << indent << "Sampling: " << this->Sampling << endl;
  os << indent << "PathsPerLine: " << this->PathsPerLine << endl;
  os << indent << "MaxCollisions: " << this->MaxCollisions << endl;
  os << indent << "CoherenceMm: " << this->CoherenceMm << endl;
  os << indent << "Deterministic: " << this->Deterministic << endl;
  os << indent << "LobeMeanDeg: " << this->LobeMeanDeg << endl;
  os << indent << "Device: " << this->Device << endl;
  os << indent << "LobeSigmaDeg: " << this->LobeSigmaDeg << endl;
  os << indent << "LobeMinDeg: " << this->LobeMinDeg << endl;
  os << indent << "LobeMaxDeg: " << this->LobeMaxDeg << endl;
  os << indent << "RadialBinMm: " << this->RadialBinMm << endl;
  os << indent << "SamplingMHz: " << this->SamplingMHz << endl;
  os << indent << "RouletteDb: " << this->RouletteDb << endl;
  os << indent << "TargetTissue: " << this->TargetTissue << endl;
  os << indent << "NumberOfShownPaths: " << this->NumberOfShownPaths << endl;
  os << indent << "Seed: " << this->Seed << endl;
}

int vtkSonoRayTracer::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 0 ? "vtkMultiBlockDataSet" : "vtkPolyData");
  if (port == 2)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int vtkSonoRayTracer::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port >= 2 ? "vtkPolyData" : "vtkImageData");
  return 1;
}

sono::TraceSettings vtkSonoRayTracer::Settings(const sono::ProbeField& probe) const
{
  sono::TraceSettings settings;
  settings.device = static_cast<sono::Device>(this->Device);
  settings.model = static_cast<sono::InterfaceModel>(this->InterfaceModel);
  settings.sampling = static_cast<sono::Sampling>(this->Sampling);
  settings.pathsPerLine = probe.preview ? std::min(this->PathsPerLine, previewPaths) : this->PathsPerLine;
  settings.interactive = probe.preview;
  settings.maxCollisions = this->MaxCollisions;
  settings.coherenceMm = this->CoherenceMm;
  settings.deterministic = this->Deterministic;
  settings.lobeMeanRad = vtkMath::RadiansFromDegrees(this->LobeMeanDeg);
  settings.lobeSigmaRad = vtkMath::RadiansFromDegrees(this->LobeSigmaDeg);
  settings.lobeMinRad = vtkMath::RadiansFromDegrees(this->LobeMinDeg);
  settings.lobeMaxRad = vtkMath::RadiansFromDegrees(this->LobeMaxDeg);
  settings.frequencyMHz = probe.centreFrequencyMHz;
  settings.depthMm = probe.geometry.depthMm;
  settings.radialBinMm = this->RadialBinMm;
  settings.echoSampleMm = rfGrid(rfSamplingMHz(this->SamplingMHz, probe), settings.depthMm).sampleMm();
  settings.rouletteDb = this->RouletteDb;
  settings.seed = static_cast<std::uint64_t>(this->Seed);
  settings.validate();
  return settings;
}

int vtkSonoRayTracer::RequestInformation(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    vtkNew<vtkFieldData> acquisition;
    acquisition->ShallowCopy(sono::announcedFields(input[1]->GetInformationObject(0)));
    const sono::ProbeField probe = sono::readProbe(acquisition);
    const double samplingMHz = rfSamplingMHz(this->SamplingMHz, probe);
    sono::writeNumber("SamplingMHz", samplingMHz, acquisition);
    const sono::TraceSettings settings = this->Settings(probe);
    const int lineCount = probe.geometry.totalLineCount();
    const int binCount = static_cast<int>(std::ceil(settings.depthMm / settings.radialBinMm));
    const int echoCount = rfGrid(samplingMHz, settings.depthMm).sampleCount();

    vtkInformation* lines = output->GetInformationObject(0);
    vtkInformation* echoes = output->GetInformationObject(1);
    sono::announceLineImage({ binCount, lineCount, settings.radialBinMm / 2.0, settings.radialBinMm }, 1, lines);
    sono::announceLineImage({ echoCount, lineCount, 0.0, settings.echoSampleMm }, 2, echoes);
    sono::announceFields(acquisition, lines);
    sono::announceFields(acquisition, echoes);
  });
}

int vtkSonoRayTracer::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    vtkMultiBlockDataSet* blocks = vtkMultiBlockDataSet::GetData(input[0]);
    const auto scene = vtkSonoSceneHandle::Get(blocks);
    const auto tissues = vtkSonoSceneHandle::GetTissues(blocks->GetFieldData());
    const sono::ProbeField probe = sono::readProbe(vtkPolyData::GetData(input[1])->GetFieldData());
    const std::vector<sono::TargetSurface> targets =
      sono::targetSurfaces(vtkPolyData::GetData(input[2]), this->TargetTissue, *tissues);
    const sono::TraceSettings settings = this->Settings(probe);
    sono::announceDevice(settings.device);
    const std::vector<sono::ScanLine> scanLines = sono::makeScanLines(probe.geometry, probe.pose);
    const std::string warning = probe.preview ? std::string() : sono::probeContactWarning(*scene, scanLines);
    if (!warning.empty())
    {
      sono::warn(this, warning);
    }
    const sono::TracedLines traced = sono::trace(*scene, scanLines, settings, sono::progressOf(this), targets);
    if (!probe.preview)
    {
      sono::prepareInteractive(*scene, scanLines, settings);
    }
    if (this->NumberOfShownPaths != 0)
    {
      const auto paths = sono::recordPaths(*scene, scanLines, settings, this->NumberOfShownPaths, targets);
      sono::fillPaths(paths, vtkPolyData::GetData(output, 2));
      sono::fillHits(paths, mediaNames(*scene, targets), vtkPolyData::GetData(output, 3));
    }

    vtkImageData* lines = vtkImageData::GetData(output, 0);
    sono::setLineImageLayout({ traced.binCount, traced.lineCount, traced.binMm / 2.0, traced.binMm }, lines);
    lines->GetPointData()->SetScalars(sono::lineArray("Intensity", traced.intensity));
    lines->GetPointData()->AddArray(sono::lineArray("StandardError", traced.standardError));

    vtkImageData* echoes = vtkImageData::GetData(output, 1);
    const auto boundaryEcho = sono::lineArray("BoundaryEcho", traced.boundaryEcho);
    sono::setLineImageLayout({ traced.echoCount, traced.lineCount, 0.0, traced.echoSampleMm }, echoes);
    echoes->GetPointData()->SetScalars(boundaryEcho);
    for (vtkImageData* image : { lines, echoes })
    {
      sono::writeProbe(probe, image->GetFieldData());
      sono::writeNumber("SamplingMHz", rfSamplingMHz(this->SamplingMHz, probe), image->GetFieldData());
    }
    lines->GetFieldData()->AddArray(boundaryEcho);
  });
}
