#include "vtkSonoThoraxSource.h"

#include "Phantoms/ThoraxPhantom.h"
#include "SonoLabelImage.h"
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

vtkSonoThoraxSource::~vtkSonoThoraxSource() = default;

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
    const double begun = std::floor(asked * this->Phases + 1e-9) / this->Phases;
    const double phase = std::clamp(begun, 0.0, double(this->Phases - 1) / this->Phases);
    const auto volume = this->Volume && phase == 0.0 ? std::move(this->Volume) : makeVolume(this->SpacingMm, phase);
    this->Volume = nullptr;
    vtkImageData* image = vtkImageData::GetData(output);
    sono::imageFromLabelVolume(*volume, image);
    if (this->Phases > 1)
    {
      sono::addMotion(sono::thoraxDisplacementMm(volume->placement, atPhase(phase)), sono::thoraxMovingLabels(), image);
      image->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), phase);
    }
    const sono::ProbePose pose = sono::thoraxPhantomA4C();
    sono::writeVector("A4CPositionMm", pose.positionMm, image->GetFieldData());
    sono::writeVector("A4CAxial", pose.axial, image->GetFieldData());
    sono::writeVector("A4CLateral", pose.lateral, image->GetFieldData());
  });
}
