#include "vtkSonoImageFormation.h"

#include "Echo/FormRf.h"
#include "SonoLineImage.h"
#include "SonoProbeField.h"
#include "SonoStage.h"
#include "vtkSonoSceneHandle.h"

#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"

vtkStandardNewMacro(vtkSonoImageFormation);

namespace {

sono::TracedLines tracedLines(vtkImageData* image, const sono::ProbeField& probe, double echoSampleMm)
{
  const sono::LineImageLayout layout = sono::lineImageLayout(image, probe.geometry.lineCount);
  const std::size_t count = std::size_t(layout.lineCount) * layout.sampleCount;
  sono::TracedLines traced;
  traced.lineCount = layout.lineCount;
  traced.binCount = layout.sampleCount;
  traced.binMm = layout.sampleMm;
  traced.intensity = sono::lineValues("Intensity", image->GetPointData(), count);
  traced.standardError = sono::lineValues("StandardError", image->GetPointData(), count);
  traced.boundaryEcho = sono::complexLineValues("BoundaryEcho", image->GetFieldData());
  traced.echoCount = static_cast<int>(traced.boundaryEcho.size() / layout.lineCount);
  traced.echoSampleMm = echoSampleMm;
  return traced;
}

} // namespace

vtkSonoImageFormation::vtkSonoImageFormation() = default;
vtkSonoImageFormation::~vtkSonoImageFormation() = default;

void vtkSonoImageFormation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "LateralSigmaMm: " << this->LateralSigmaMm << endl;
  os << indent << "ElevationalSigmaMm: " << this->ElevationalSigmaMm << endl;
  os << indent << "ScattererCellMm: " << this->ScattererCellMm << endl;
  os << indent << "ScattererLevelDb: " << this->ScattererLevelDb << endl;
  os << indent << "Seed: " << this->Seed << endl;
}

sono::EchoSettings vtkSonoImageFormation::Settings(vtkFieldData* acquisition) const
{
  const sono::ProbeField probe = sono::readProbe(acquisition);
  sono::EchoSettings settings;
  settings.centreFrequencyMHz = probe.centreFrequencyMHz;
  settings.fractionalBandwidth = probe.fractionalBandwidth;
  settings.samplingMHz = sono::readNumber("SamplingMHz", acquisition);
  settings.depthMm = probe.geometry.depthMm;
  settings.lateralSigmaMm = this->LateralSigmaMm;
  settings.elevationalSigmaMm = this->ElevationalSigmaMm;
  settings.scattererCellMm = this->ScattererCellMm;
  settings.scattererLevelDb = this->ScattererLevelDb;
  settings.seed = static_cast<std::uint64_t>(this->Seed);
  settings.validate();
  return settings;
}

int vtkSonoImageFormation::RequestInformation(vtkInformation*, vtkInformationVector** input,
                                              vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    vtkFieldData* acquisition = sono::announcedFields(input[0]->GetInformationObject(0));
    const sono::EchoSettings settings = this->Settings(acquisition);
    const int lineCount = sono::readProbe(acquisition).geometry.lineCount;
    vtkInformation* outInfo = output->GetInformationObject(0);
    sono::announceLineImage({ settings.sampleCount(), lineCount, 0.0, settings.sampleMm() }, 1, outInfo);
    sono::announceFields(acquisition, outInfo);
  });
}

int vtkSonoImageFormation::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  return sono::requestWholeImage(input);
}

int vtkSonoImageFormation::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    vtkImageData* traced = vtkImageData::GetData(input[0]);
    const sono::ProbeField probe = sono::readProbe(traced->GetFieldData());
    const sono::EchoSettings settings = this->Settings(traced->GetFieldData());
    const auto scene = vtkSonoSceneHandle::Get(traced->GetFieldData());
    const sono::RfLines lines =
      sono::formRf(*scene, sono::makeScanLines(probe.geometry, probe.pose),
                   tracedLines(traced, probe, settings.sampleMm()), settings, sono::progressOf(this));

    vtkImageData* image = vtkImageData::GetData(output);
    sono::setLineImageLayout({ lines.sampleCount, lines.lineCount, 0.0, lines.sampleMm }, image);
    image->GetPointData()->SetScalars(sono::lineArray("Envelope", lines.envelope()));
    image->GetPointData()->AddArray(sono::lineArray("RF", lines.rf()));
    image->GetPointData()->AddArray(sono::lineArray("IQ", lines.iq));
    image->GetFieldData()->RemoveArray("BoundaryEcho"); // it came along from the input and is part of RF now
  });
}
