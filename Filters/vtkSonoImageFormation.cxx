#include "vtkSonoImageFormation.h"

#include "Core/Policy.h"
#include "Simulator.h"
#include "SonoFieldImage.h"
#include "SonoLineImage.h"
#include "SonoOutputs.h"
#include "SonoProbeField.h"
#include "SonoSettings.h"
#include "SonoStage.h"
#include "vtkSonoSceneHandle.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"

#include <memory>
#include <vector>

vtkStandardNewMacro(vtkSonoImageFormation);

namespace {

/// Null where no scatterers are connected.
std::shared_ptr<const sono::PointScatterers> pointScatterers(vtkPointSet* points)
{
  if (!points || points->GetNumberOfPoints() == 0)
  {
    return nullptr;
  }
  vtkDataArray* amplitude = points->GetPointData()->GetArray("Amplitude");
  if (!amplitude || amplitude->GetNumberOfComponents() != 1)
  {
    throw sono::Error("The scatterers have no point array 'Amplitude' with one component; add it, for example with a "
                      "Calculator.");
  }
  std::vector<sono::PointScatterer> scatterers(static_cast<std::size_t>(points->GetNumberOfPoints()));
  for (std::size_t i = 0; i < scatterers.size(); ++i)
  {
    const auto id = static_cast<vtkIdType>(i);
    points->GetPoint(id, &scatterers[i].positionMm.x);
    scatterers[i].amplitude = static_cast<float>(amplitude->GetTuple1(id));
  }
  return std::make_shared<const sono::PointScatterers>(scatterers);
}

} // namespace

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

sono::EchoSettings vtkSonoImageFormation::Settings(vtkFieldData* acquisition) const
{
  const sono::ProbeField probe = sono::readProbe(acquisition);
  auto settings = sono::settingsIn<sono::EchoSettings>(*this->Parameters);
  settings.centreFrequencyMHz = probe.centreFrequencyMHz;
  settings.fractionalBandwidth = probe.fractionalBandwidth;
  settings.aperture = probe.aperture();
  settings.samplingMHz = sono::readNumber("SamplingMHz", acquisition);
  settings.depthMm = probe.geometry.depthMm;
  settings.scattererCellMm =
    probe.preview ? sono::interactiveCellMm(settings.scattererCellMm) : settings.scattererCellMm;
  settings.validate();
  return settings;
}

int vtkSonoImageFormation::RequestInformation(vtkInformation*, vtkInformationVector** input,
                                              vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    vtkFieldData* acquisition = sono::announcedFields(input[0]->GetInformationObject(0));
    const sono::EchoSettings settings = this->Settings(acquisition);
    const int lineCount = sono::readProbe(acquisition).geometry.totalLineCount();
    vtkInformation* outInfo = output->GetInformationObject(0);
    sono::announceLineImage({ settings.sampleCount(), lineCount, 0.0, settings.sampleMm() }, 1, outInfo);
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
    sono::EchoSettings settings = this->Settings(input0->GetFieldData());
    sono::announceDevice(sono::chooseDevice(settings.device));
    if (vtkImageData* field = vtkImageData::GetData(input[2]))
    {
      settings.field = std::make_shared<const sono::PulseEchoField>(sono::fieldFromImage(field));
    }
    if (!this->PulseFileName.empty())
    {
      settings.pulse = std::make_shared<const sono::SampledPulse>(sono::readPulse(this->PulseFileName));
    }
    this->Simulator->setScene(vtkSonoSceneHandle::Get(input0->GetFieldData()));
    const sono::TracedResult traced = sono::tracedOf(input0, probe, settings.sampleMm());
    const sono::RfResult rf =
      this->Simulator->formRf(sono::makeScanLines(probe.geometry, probe.pose), traced, settings,
                              pointScatterers(vtkPointSet::GetData(input[1])), sono::progressOf(this));
    sono::fillRf(rf, sono::isInner(this) ? sono::Carries::HandleAlone : sono::Carries::Arrays,
                 vtkImageData::GetData(output));
  });
}
