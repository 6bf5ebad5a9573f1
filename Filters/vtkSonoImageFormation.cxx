#include "vtkSonoImageFormation.h"

#include "Core/Policy.h"
#include "Probe/PulseFile.h"
#include "Simulator.h"
#include "SonoFieldImage.h"
#include "SonoLineImage.h"
#include "SonoOutputs.h"
#include "SonoProbeField.h"
#include "SonoScatterers.h"
#include "SonoSettings.h"
#include "SonoStage.h"
#include "vtkSonoSceneHandle.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointSet.h"

#include <memory>

vtkStandardNewMacro(vtkSonoImageFormation);

vtkSonoImageFormation::vtkSonoImageFormation()
  : Parameters(new sono::SettingsOf<sono::EchoSettings>)
  , Simulator(new sono::Simulator)
{
  this->SetNumberOfInputPorts(3);
  this->SetProgressText("Forming echoes");
}

vtkSonoImageFormation::~vtkSonoImageFormation() = default;

void vtkSonoImageFormation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->Parameters->print(os, indent);
  os << indent << "PulseFileName: " << this->PulseFileName << endl;
}

int vtkSonoImageFormation::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 1 ? "vtkPointSet" : "vtkImageData");
  if (port > 0)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

sono::EchoSettings vtkSonoImageFormation::Settings(const sono::ProbeField& probe, double samplingMHz) const
{
  auto settings = sono::settingsIn<sono::EchoSettings>(*this->Parameters);
  settings.centreFrequencyMHz = probe.receivedMHz();
  settings.fractionalBandwidth = probe.receivedBandwidth();
  settings.imagingMode = probe.imagingMode;
  settings.aperture = probe.aperture();
  settings.samplingMHz = samplingMHz;
  settings.depthMm = probe.geometry.rangeMm();
  settings.scattererCellMm =
    probe.coarse ? sono::interactiveCellMm(settings.scattererCellMm) : settings.scattererCellMm;
  settings.interactive = probe.coarse;
  settings.validate();
  return settings;
}

std::shared_ptr<const sono::SampledPulse> vtkSonoImageFormation::ReadPulse() const
{
  return this->PulseFileName.empty() ? nullptr
                                     : std::make_shared<const sono::SampledPulse>(sono::readPulse(this->PulseFileName));
}

int vtkSonoImageFormation::RequestInformation(vtkInformation*, vtkInformationVector** input,
                                              vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    vtkFieldData* acquisition = sono::announcedFields(input[0]->GetInformationObject(0));
    const sono::ProbeField probe = sono::readProbe(acquisition);
    const sono::EchoSettings settings = this->Settings(probe, sono::readNumber("SamplingMHz", acquisition));
    vtkInformation* outInfo = output->GetInformationObject(0);
    sono::announceLineImage(sono::shownLayout(probe.geometry, settings.sampleCount(), settings.sampleMm()), 1, outInfo);
    sono::announceFields(acquisition, outInfo);
  });
}

int vtkSonoImageFormation::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  sono::requestWholeImage(input, 2);
  return sono::requestWholeImage(input);
}

int vtkSonoImageFormation::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    vtkImageData* input0 = vtkImageData::GetData(input[0]);
    const sono::ProbeField probe = sono::readProbe(input0->GetFieldData());
    sono::EchoSettings settings = this->Settings(probe, sono::readNumber("SamplingMHz", input0->GetFieldData()));
    sono::announceDevice(sono::chooseDevice(settings.device));
    if (vtkImageData* field = vtkImageData::GetData(input[2]))
    {
      settings.field = std::make_shared<const sono::PulseEchoField>(sono::fieldFromImage(field));
    }
    settings.pulse = this->ReadPulse();
    this->Simulator->setScene(vtkSonoSceneHandle::Get(input0->GetFieldData()));
    const sono::TracedResult traced = sono::tracedOf(input0, probe, settings.sampleMm());
    const sono::RfResult rf =
      this->Simulator->formRf(sono::makeScanLines(probe.geometry, probe.pose), traced, settings,
                              sono::pointScatterers(vtkPointSet::GetData(input[1])), sono::progressOf(this));
    sono::fillRf(rf, probe, vtkImageData::GetData(output));
  });
}
