#include "vtkSonoPulseEchoField.h"

#include "Probe/ArrayAperture.h"
#include "Probe/ArrayBeam.h"
#include "Probe/PulseEchoFieldFile.h"
#include "SonoFieldImage.h"
#include "SonoStage.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"

#include <limits>

vtkStandardNewMacro(vtkSonoPulseEchoField);

namespace {

/// A property of 0 means that there is no focus.
double focusMm(double property)
{
  return property == 0.0 ? std::numeric_limits<double>::infinity() : property;
}

} // namespace

vtkSonoPulseEchoField::vtkSonoPulseEchoField()
{
  this->SetNumberOfInputPorts(0);
  this->SetProgressText("Computing the beam");
}

vtkSonoPulseEchoField::~vtkSonoPulseEchoField() = default;

void vtkSonoPulseEchoField::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << endl;
  os << indent << "ElementCount: " << this->ElementCount << endl;
  os << indent << "ElementWidthMm: " << this->ElementWidthMm << endl;
  os << indent << "ElementHeightMm: " << this->ElementHeightMm << endl;
  os << indent << "KerfMm: " << this->KerfMm << endl;
  os << indent << "FaceRadiusMm: " << this->FaceRadiusMm << endl;
  os << indent << "TransmitFocusMm: " << this->TransmitFocusMm << endl;
  os << indent << "ElevationFocusMm: " << this->ElevationFocusMm << endl;
  os << indent << "Apodization: " << this->Apodization << endl;
  os << indent << "CentreFrequencyMHz: " << this->CentreFrequencyMHz << endl;
  os << indent << "FractionalBandwidth: " << this->FractionalBandwidth << endl;
  os << indent << "AttenuationDbPerCmMHz: " << this->AttenuationDbPerCmMHz << endl;
  os << indent << "DepthMm: " << this->DepthMm << endl;
}

sono::ArrayAperture vtkSonoPulseEchoField::Aperture() const
{
  if (this->Apodization != BOXCAR && this->Apodization != HANN)
  {
    throw sono::Error("Apodization is " + std::to_string(this->Apodization) + " but must be 0 (boxcar) or 1 (Hann).");
  }
  sono::ArrayAperture aperture;
  aperture.elementCount = this->ElementCount;
  aperture.elementWidthMm = this->ElementWidthMm;
  aperture.elementHeightMm = this->ElementHeightMm;
  aperture.kerfMm = this->KerfMm;
  aperture.faceRadiusMm = this->FaceRadiusMm;
  aperture.transmitFocusMm = focusMm(this->TransmitFocusMm);
  aperture.elevationFocusMm = focusMm(this->ElevationFocusMm);
  aperture.apodization = static_cast<sono::Apodization>(this->Apodization);
  aperture.centreFrequencyMHz = this->CentreFrequencyMHz;
  aperture.fractionalBandwidth = this->FractionalBandwidth;
  aperture.attenuationDbPerCmMHz = this->AttenuationDbPerCmMHz;
  return aperture;
}

void vtkSonoPulseEchoField::Compute(const sono::ArrayAperture& aperture, const sono::FieldGrid& grid)
{
  if (this->FieldsArray && *this->FieldsArray == aperture && this->Field->grid() == grid)
  {
    return;
  }
  this->Field =
    std::make_shared<const sono::PulseEchoField>(sono::pulseEchoField(aperture, grid, sono::progressOf(this)));
  this->FieldsArray = std::make_shared<const sono::ArrayAperture>(aperture);
}

int vtkSonoPulseEchoField::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    vtkInformation* outInfo = output->GetInformationObject(0);
    if (this->FileName.empty())
    {
      sono::announceFieldImage(sono::suggestedFieldGrid(this->Aperture(), this->DepthMm), outInfo);
      return;
    }
    // Its size stands in the file alone, which this pass therefore reads, again after each change.
    this->FieldsArray.reset();
    this->Field = std::make_shared<const sono::PulseEchoField>(sono::readPulseEchoField(this->FileName));
    sono::announceFieldImage(this->Field->grid(), outInfo);
  });
}

int vtkSonoPulseEchoField::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    if (this->FileName.empty())
    {
      const sono::ArrayAperture aperture = this->Aperture();
      this->Compute(aperture, sono::suggestedFieldGrid(aperture, this->DepthMm));
    }
    sono::imageFromField(*this->Field, vtkImageData::GetData(output));
  });
}
