#include "vtkSonoThoraxSource.h"

#include "Phantoms/ThoraxPhantom.h"
#include "SonoLabelImage.h"
#include "SonoProbeField.h"
#include "SonoStage.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkSonoThoraxSource);

namespace {

std::shared_ptr<const sono::LabelVolume> makeVolume(double spacingMm)
{
  return std::make_shared<const sono::LabelVolume>(sono::makeThoraxPhantom(spacingMm));
}

} // namespace

vtkSonoThoraxSource::vtkSonoThoraxSource()
{
  this->SetNumberOfInputPorts(0);
  this->SetProgressText("Making the thorax");
}

vtkSonoThoraxSource::~vtkSonoThoraxSource() = default;

void vtkSonoThoraxSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "SpacingMm: " << this->SpacingMm << endl;
}

int vtkSonoThoraxSource::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    this->Volume = makeVolume(this->SpacingMm);
    sono::announceLabelImage(this->Volume->placement, output->GetInformationObject(0));
  });
}

int vtkSonoThoraxSource::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    const auto volume = this->Volume ? std::move(this->Volume) : makeVolume(this->SpacingMm);
    vtkImageData* image = vtkImageData::GetData(output);
    sono::imageFromLabelVolume(*volume, image);
    const sono::ProbePose pose = sono::thoraxPhantomA4C();
    sono::writeVector("A4CPositionMm", pose.positionMm, image->GetFieldData());
    sono::writeVector("A4CAxial", pose.axial, image->GetFieldData());
    sono::writeVector("A4CLateral", pose.lateral, image->GetFieldData());
  });
}
