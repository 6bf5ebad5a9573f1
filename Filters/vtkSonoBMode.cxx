#include "vtkSonoBMode.h"

#include "Image/BMode.h"
#include "SonoLineImage.h"
#include "SonoProbeField.h"
#include "SonoStage.h"

#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"

vtkStandardNewMacro(vtkSonoBMode);

vtkSonoBMode::vtkSonoBMode()
{
  this->SetProgressText("Making grey");
}

vtkSonoBMode::~vtkSonoBMode() = default;

void vtkSonoBMode::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TgcDbPerCm: " << this->TgcDbPerCm << endl;
  os << indent << "TgcPoints (mm, dB):";
  for (const auto& [depthMm, gainDb] : this->TgcPoints)
  {
    os << " (" << depthMm << ", " << gainDb << ")";
  }
  os << endl;
  os << indent << "GainDb: " << this->GainDb << endl;
  os << indent << "AutomaticReference: " << this->AutomaticReference << endl;
  os << indent << "ReferenceAmplitude: " << this->ReferenceAmplitude << endl;
  os << indent << "DynamicRangeDb: " << this->DynamicRangeDb << endl;
  os << indent << "RejectDb: " << this->RejectDb << endl;
  os << indent << "GreyMap: " << this->GreyMap << endl;
  os << indent << "AddNoise: " << this->AddNoise << endl;
  os << indent << "NoiseDb: " << this->NoiseDb << endl;
  os << indent << "NoiseSeed: " << this->NoiseSeed << endl;
}

void vtkSonoBMode::AddTgcPoint(double depthMm, double gainDb)
{
  this->TgcPoints.emplace_back(depthMm, gainDb);
  this->Modified();
}

void vtkSonoBMode::RemoveAllTgcPoints()
{
  if (!this->TgcPoints.empty())
  {
    this->TgcPoints.clear();
    this->Modified();
  }
}

sono::BModeSettings vtkSonoBMode::Settings() const
{
  sono::BModeSettings settings;
  settings.tgcDbPerCm = this->TgcDbPerCm;
  settings.tgcCurve = this->TgcPoints;
  settings.gainDb = this->GainDb;
  settings.automaticReference = this->AutomaticReference;
  settings.referenceAmplitude = this->ReferenceAmplitude;
  settings.dynamicRangeDb = this->DynamicRangeDb;
  settings.rejectDb = this->RejectDb;
  settings.greyMap = static_cast<sono::GreyMap>(this->GreyMap);
  if (this->AddNoise)
  {
    settings.noiseDb = this->NoiseDb;
  }
  settings.noiseSeed = static_cast<std::uint64_t>(this->NoiseSeed);
  return settings;
}

int vtkSonoBMode::RequestInformation(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    // Extent, origin and spacing are the input's, which the pipeline has copied.
    vtkInformation* outInfo = output->GetInformationObject(0);
    sono::announceFields(sono::announcedFields(input[0]->GetInformationObject(0)), outInfo);
  });
}

int vtkSonoBMode::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  return sono::requestWholeImage(input);
}

int vtkSonoBMode::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    vtkImageData* lines = vtkImageData::GetData(input[0]);
    const sono::ProbeField probe = sono::readProbe(lines->GetFieldData());
    const sono::LineImageLayout layout = sono::lineImageLayout(lines, probe.geometry.totalLineCount());
    const std::vector<float> envelope =
      sono::lineValues("Envelope", lines->GetPointData(), std::size_t(layout.lineCount) * layout.sampleCount);
    const sono::BModeLines result =
      sono::makeBMode(envelope, layout.lineCount, layout.sampleCount, layout.sampleMm, this->Settings());

    vtkImageData* image = vtkImageData::GetData(output);
    sono::setLineImageLayout(layout, image);
    image->GetPointData()->SetScalars(sono::lineArray("BMode", result.grey));
    sono::writeNumber("ReferenceAmplitude", result.referenceAmplitude, image->GetFieldData());
  });
}
