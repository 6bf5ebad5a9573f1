#include "vtkSonoRayTracer.h"

#include "Core/Policy.h"
#include "Echo/FormRf.h"
#include "Simulator.h"
#include "SonoLineImage.h"
#include "SonoOutputs.h"
#include "SonoPaths.h"
#include "SonoProbeField.h"
#include "SonoSettings.h"
#include "SonoStage.h"
#include "SonoTargets.h"
#include "Trace/CollisionLimit.h"
#include "Trace/ProbeContact.h"
#include "Trace/TraceDevice.h"
#include "vtkSonoSceneHandle.h"

#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

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

} // namespace

vtkSonoRayTracer::vtkSonoRayTracer()
  : Parameters(new sono::SettingsOf<sono::TraceSettings>)
  , Simulator(new sono::Simulator)
{
  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(4);
  this->SetProgressText("Tracing");
}

vtkSonoRayTracer::~vtkSonoRayTracer() = default;

void vtkSonoRayTracer::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->Parameters->print(os, indent);
  os << indent << "SamplingMHz: " << this->SamplingMHz << endl;
  os << indent << "TargetTissue: " << this->TargetTissue << endl;
  os << indent << "NumberOfShownPaths: " << this->NumberOfShownPaths << endl;
}

int vtkSonoRayTracer::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 0 ? "vtkMultiBlockDataSet" : "vtkPolyData");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1); // of the first two: so that one clear sentence says what is missing
  return 1;
}

int vtkSonoRayTracer::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port >= 2 ? "vtkPolyData" : "vtkImageData");
  return 1;
}

double vtkSonoRayTracer::RfSamplingMHz(const sono::ProbeField& probe) const
{
  const double samplingMHz = sono::rfSamplingMHz(this->SamplingMHz, probe.receivedMHz());
  return probe.coarse ? sono::interactiveSamplingMHz(samplingMHz, probe.receivedMHz()) : samplingMHz;
}

sono::TraceSettings vtkSonoRayTracer::Settings(const sono::ProbeField& probe) const
{
  auto settings = sono::settingsIn<sono::TraceSettings>(*this->Parameters);
  if (probe.preview)
  {
    settings.pathsPerLine =
      std::min(settings.pathsPerLine, probe.coarse ? sono::interactivePaths : sono::interactiveDevicePaths);
    settings.targetErrorDb = 0.0;
    settings.timeBudgetS = 0.0;
  }
  if (probe.coarse)
  {
    settings.radialBinMm = sono::interactiveBinMm(settings.radialBinMm);
    settings.rouletteDb = sono::interactiveRouletteDb(settings.rouletteDb);
  }
  settings.interactive = probe.preview;
  settings.frequencyMHz = probe.centreFrequencyMHz;
  settings.fractionalBandwidth = probe.receivedBandwidth();
  settings.imagingMode = probe.imagingMode;
  settings.facePressureKPa = probe.facePressureKPa;
  settings.aperture = probe.aperture();
  settings.depthMm = probe.geometry.rangeMm();
  settings.echoSampleMm = rfGrid(this->RfSamplingMHz(probe), settings.depthMm).sampleMm();
  settings.validate();
  return settings;
}

int vtkSonoRayTracer::RequestInformation(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    sono::requireConnected(input[0], "No anatomy is connected; give an Ultrasound Scene.");
    sono::requireConnected(input[1], "No probe is connected; give an Ultrasound Probe.");
    vtkNew<vtkFieldData> acquisition;
    acquisition->ShallowCopy(sono::announcedFields(input[1]->GetInformationObject(0)));
    const sono::ProbeField probe = sono::readProbe(acquisition);
    const double samplingMHz = this->RfSamplingMHz(probe);
    sono::writeNumber("SamplingMHz", samplingMHz, acquisition);
    const sono::TraceSettings settings = this->Settings(probe);
    const int lineCount = probe.geometry.totalLineCount();

    vtkInformation* lines = output->GetInformationObject(0);
    vtkInformation* echoes = output->GetInformationObject(1);
    sono::announceLineImage({ settings.binCount(), lineCount, settings.radialBinMm / 2.0, settings.radialBinMm }, 1,
                            lines);
    sono::announceLineImage(sono::shownLayout(probe.geometry, settings.echoCount(), settings.echoSampleMm), 2, echoes);
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
    sono::announceDevice(sono::chooseDevice(settings));
    const std::vector<sono::ScanLine> scanLines = sono::makeScanLines(probe.geometry, probe.pose);
    const std::string warning = probe.preview ? std::string() : sono::probeContactWarning(*scene, scanLines);
    if (!warning.empty())
    {
      sono::warn(this, warning);
    }
    const sono::Progress progress = sono::progressOf(this);
    const double share = this->NumberOfShownPaths != 0 ? 0.9 : 1.0;
    this->Simulator->setScene(scene);
    const sono::TracedResult traced =
      this->Simulator->trace(scanLines, settings, targets, sono::partOf(progress, 0.0, share));
    const std::string limit =
      probe.preview ? std::string() : sono::collisionLimitWarning(*scene, scanLines, settings, targets);
    if (!limit.empty())
    {
      sono::warn(this, limit);
    }
    if (probe.prepares && !probe.preview)
    {
      this->Simulator->prepareInteractive(scanLines, settings);
    }
    if (this->NumberOfShownPaths != 0)
    {
      sono::TraceSettings shown = settings;
      shown.pathsPerLine = traced.layout().paths;
      const auto paths =
        this->Simulator->paths(scanLines, shown, this->NumberOfShownPaths, targets, sono::partOf(progress, share, 1.0));
      sono::fillPaths(*paths, vtkPolyData::GetData(output, 2));
      sono::fillHits(*paths, sono::mediaNames(*scene, targets), vtkPolyData::GetData(output, 3));
    }
    vtkImageData* lines = vtkImageData::GetData(output, 0);
    sono::fillTraced(traced, probe, this->RfSamplingMHz(probe), lines);
    vtkImageData* echoes = vtkImageData::GetData(output, 1);
    sono::fillEchoes(traced, probe, lines, echoes);
    sono::writeProbe(probe, echoes->GetFieldData());
    sono::writeNumber("SamplingMHz", this->RfSamplingMHz(probe), echoes->GetFieldData());
  });
}
