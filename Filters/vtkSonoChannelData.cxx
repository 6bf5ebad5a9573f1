#include "vtkSonoChannelData.h"

#include "Channels/ScenePoints.h"
#include "SimulateChannels.h"
#include "SonoChannelImage.h"
#include "SonoOutputs.h"
#include "SonoProbeField.h"
#include "SonoScatterers.h"
#include "SonoSettings.h"
#include "SonoStage.h"
#include "vtkSonoSceneHandle.h"

#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointSet.h"

#include <memory>

vtkStandardNewMacro(vtkSonoChannelData);

namespace {

/// The picture's, as vtkSonoImageFormation would have them.
sono::EchoSettings echoSettings(const sono::ProbeField& probe, double samplingMHz, std::uint64_t seed)
{
  sono::EchoSettings echo;
  echo.centreFrequencyMHz = probe.centreFrequencyMHz;
  echo.fractionalBandwidth = probe.fractionalBandwidth;
  echo.aperture = probe.aperture();
  echo.samplingMHz = samplingMHz;
  echo.depthMm = probe.geometry.rangeMm();
  echo.seed = seed;
  return echo;
}

std::shared_ptr<const sono::SampledPulse> pulseIn(const std::string& path)
{
  return path.empty() ? nullptr : std::make_shared<const sono::SampledPulse>(sono::readPulse(path));
}

} // namespace

vtkSonoChannelData::vtkSonoChannelData()
  : Parameters(new sono::SettingsOf<sono::ChannelSettings>)
{
  this->SetNumberOfInputPorts(2);
  this->SetProgressText("Receiving channels");
}

vtkSonoChannelData::~vtkSonoChannelData() = default;

void vtkSonoChannelData::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->Parameters->print(os, indent);
  os << indent << "PulseFileName: " << this->PulseFileName << endl;
}

int vtkSonoChannelData::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 1 ? "vtkPointSet" : "vtkDataObject");
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int vtkSonoChannelData::RequestInformation(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    vtkFieldData* acquisition = sono::announcedFields(input[0]->GetInformationObject(0));
    const sono::ProbeField probe = sono::readProbe(acquisition);
    const sono::ChannelPlan plan(sono::settingsIn<sono::ChannelSettings>(*this->Parameters), probe,
                                 pulseIn(this->PulseFileName));
    vtkInformation* outInfo = output->GetInformationObject(0);
    sono::announceChannels(plan, outInfo);
    sono::announceFields(acquisition, outInfo);
  });
}

int vtkSonoChannelData::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  return sono::requestWholeImage(input);
}

sono::ChannelPoints vtkSonoChannelData::Points(vtkDataObject* input, const sono::ProbeField& probe,
                                               vtkPointSet* scatterers)
{
  const std::shared_ptr<const sono::PointScatterers> points = sono::pointScatterers(scatterers);
  auto* lines = vtkImageData::SafeDownCast(input);
  if (!lines)
  {
    if (!points)
    {
      throw sono::Error("A probe alone has nothing to hear: connect traced lines in its place, or scatterers besides.");
    }
    return sono::channelPoints(*points, probe.pose);
  }
  const auto& settings = sono::settingsIn<sono::ChannelSettings>(*this->Parameters);
  const sono::EchoSettings echo =
    echoSettings(probe, sono::readNumber("SamplingMHz", lines->GetFieldData()), settings.seed);
  const std::shared_ptr<const sono::Scene> scene = vtkSonoSceneHandle::Get(lines->GetFieldData());
  const sono::TracedResult traced = sono::tracedOf(lines, probe, echo.sampleMm());
  sono::EchoSources sources;
  sources.scene = scene.get();
  sources.traced = &traced.host();
  sources.points = points.get();
  return sono::scenePoints(sources, probe, probe.pose, echo, settings.scatterersPerCell,
                           sono::partOf(sono::progressOf(this), 0.0, 0.2));
}

int vtkSonoChannelData::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    vtkDataObject* input0 = vtkDataObject::GetData(input[0]);
    const sono::ProbeField probe = sono::readProbe(input0->GetFieldData());
    const sono::ChannelPlan plan(sono::settingsIn<sono::ChannelSettings>(*this->Parameters), probe,
                                 pulseIn(this->PulseFileName));
    sono::announceDevice(sono::chooseDevice(plan.settings.device));
    const sono::ChannelPoints points = this->Points(input0, probe, vtkPointSet::GetData(input[1]));
    vtkImageData* image = vtkImageData::GetData(output);
    image->GetFieldData()->RemoveArray("BoundaryEcho"); // it came along from the lines
    sono::fillChannels(plan, sono::simulateChannels(plan, points, sono::partOf(sono::progressOf(this), 0.2, 1.0)),
                       image);
    sono::writeProbe(probe, image->GetFieldData());
  });
}
