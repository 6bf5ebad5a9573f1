#include "vtkSonoThoraxSource.h"

#include "Phantoms/ThoraxPhantom.h"
#include "SonoLabelImage.h"
#include "SonoPlayed.h"
#include "SonoProbeField.h"
#include "SonoStage.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cmath>
#include <vector>

vtkStandardNewMacro(vtkSonoThoraxSource);

namespace {

using Pipeline = vtkStreamingDemandDrivenPipeline;

sono::ThoraxParameters atPhase(double phase)
{
  sono::ThoraxParameters parameters;
  parameters.phase = phase;
  return parameters;
}

std::shared_ptr<const sono::LabelVolume> makeVolume(double spacingMm, double phase)
{
  return std::make_shared<const sono::LabelVolume>(sono::makeThoraxPhantom(spacingMm, atPhase(phase)));
}

} // namespace

vtkSonoThoraxSource::vtkSonoThoraxSource()
{
  this->SetNumberOfInputPorts(0);
  this->SetProgressText("Making the thorax");
}

vtkSonoThoraxSource::~vtkSonoThoraxSource()
{
  sono::dropPlayed(this);
}

void vtkSonoThoraxSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "SpacingMm: " << this->SpacingMm << endl;
  os << indent << "Phases: " << this->Phases << endl;
}

int vtkSonoThoraxSource::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    vtkInformation* outInfo = output->GetInformationObject(0);
    sono::dropPlayed(this); // they are of other settings
    this->Volume = makeVolume(this->SpacingMm, 0.0);
    sono::announceLabelImage(this->Volume->placement, outInfo);
    outInfo->Remove(Pipeline::TIME_STEPS());
    outInfo->Remove(Pipeline::TIME_RANGE());
    if (this->Phases > 1)
    {
      std::vector<double> times;
      for (int phase = 0; phase < this->Phases; ++phase)
      {
        times.push_back(double(phase) / this->Phases);
      }
      const double range[2] = { times.front(), times.back() };
      outInfo->Set(Pipeline::TIME_STEPS(), times.data(), this->Phases);
      outInfo->Set(Pipeline::TIME_RANGE(), range, 2);
    }
  });
}

int vtkSonoThoraxSource::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    vtkInformation* outInfo = output->GetInformationObject(0);
    const double asked =
      this->Phases > 1 && outInfo->Has(Pipeline::UPDATE_TIME_STEP()) ? outInfo->Get(Pipeline::UPDATE_TIME_STEP()) : 0.0;
    // The last phase that has begun.
    const int phase = std::clamp(int(std::floor(asked * this->Phases + 1e-9)), 0, this->Phases - 1);
    const double time = double(phase) / this->Phases;
    vtkImageData* image = vtkImageData::GetData(output);
    if (this->Phases > 1 && sono::takePlayedPhase(this, phase, image))
    {
      image->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
      return;
    }
    const auto volume = this->Volume && phase == 0 ? std::move(this->Volume) : makeVolume(this->SpacingMm, time);
    this->Volume = nullptr;
    sono::imageFromLabelVolume(*volume, image);
    if (this->Phases > 1)
    {
      sono::addMotion(sono::thoraxDisplacementMm(volume->placement, atPhase(time)), sono::thoraxMovingLabels(), image);
      image->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    }
    const sono::ProbePose pose = sono::thoraxPhantomA4C();
    sono::writeVector("A4CPositionMm", pose.positionMm, image->GetFieldData());
    sono::writeVector("A4CAxial", pose.axial, image->GetFieldData());
    sono::writeVector("A4CLateral", pose.lateral, image->GetFieldData());
    if (this->Phases > 1)
    {
      sono::keepPlayedPhase(this, phase, image);
    }
  });
}
