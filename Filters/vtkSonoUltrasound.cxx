#include "vtkSonoUltrasound.h"

#include "SonoContentKey.h"
#include "SonoStage.h"
#include "SonoUltrasoundStages.h"
#include "vtkSonoBMode.h"
#include "vtkSonoImageFormation.h"
#include "vtkSonoProbeSource.h"
#include "vtkSonoRayTracer.h"
#include "vtkSonoScanConverter.h"
#include "vtkSonoSceneBuilder.h"

#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkExecutive.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkObjectFactory.h"

#include <algorithm>
#include <type_traits>

vtkStandardNewMacro(vtkSonoUltrasound);

namespace {

/// The output that somebody asks for; the image where nobody does.
int portAsked(vtkInformation* request)
{
  return std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()));
}

/// Whether an output is made when another is asked for. Those that are not keep their data until they are asked for.
bool isMadeFor(int asked, int port)
{
  const auto isImage = [](int p) { return p == vtkSonoUltrasound::IMAGE || p == vtkSonoUltrasound::FLAT_IMAGE; };
  return port == asked || (isImage(asked) && isImage(port));
}

} // namespace

vtkSonoUltrasound::vtkSonoUltrasound()
  : Inside(new sono::UltrasoundStages(this))
{
  this->SetNumberOfInputPorts(4);
  this->SetNumberOfOutputPorts(10);
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS,
                               vtkDataSetAttributes::AttributeTypes::SCALARS);
}

vtkSonoUltrasound::~vtkSonoUltrasound() = default;

void vtkSonoUltrasound::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  for (vtkAlgorithm* stage : this->Inside->withSettings())
  {
    os << indent << stage->GetClassName() << ":" << endl;
    stage->PrintSelf(os, indent.GetNextIndent());
  }
  os << indent << "ErrorMap: " << this->ErrorMap << endl;
  os << indent << "SharedProbe: " << this->SharedProbe << endl;
  os << indent << "Freeze: " << this->Freeze << endl;
  os << indent << "StoreFolder: " << this->StoreFolder << endl;
  os << indent << "HeartRate: " << this->HeartRate << endl;
  os << indent << "Progressive: " << this->Progressive << endl;
}

template<class Stage>
void vtkSonoUltrasound::Replace(vtkSmartPointer<Stage>& own, Stage* given)
{
  if (given && given != own)
  {
    own = given;
    if constexpr (std::is_same_v<Stage, vtkSonoSceneBuilder>)
    {
      this->Inside->listenToBuilder();
    }
    this->Modified();
  }
}

#define sonoStage(type, name, member)                                                                                  \
  void vtkSonoUltrasound::Set##name(type* stage)                                                                       \
  {                                                                                                                    \
    this->Replace(this->Inside->member, stage);                                                                        \
  }                                                                                                                    \
  type* vtkSonoUltrasound::Get##name()                                                                                 \
  {                                                                                                                    \
    return this->Inside->member;                                                                                       \
  }
sonoStage(vtkSonoSceneBuilder, SceneBuilder, scene);
sonoStage(vtkSonoProbeSource, Probe, probe);
sonoStage(vtkSonoRayTracer, RayTracer, tracer);
sonoStage(vtkSonoImageFormation, ImageFormation, formation);
sonoStage(vtkSonoBMode, BMode, bmode);
sonoStage(vtkSonoScanConverter, ScanConverter, converter);
#undef sonoStage

void vtkSonoUltrasound::SetProgressive(bool progressive)
{
  const bool isUnfinished = this->IsRefining() || this->Inside->hasBetter();
  this->Progressive = progressive;
  if (isUnfinished && !progressive)
  {
    this->Modified();
  }
}

bool vtkSonoUltrasound::IsRefining()
{
  return this->Inside->isRefining();
}

bool vtkSonoUltrasound::HasBetter()
{
  return this->Inside->offerBetter();
}

void vtkSonoUltrasound::PrepareMoving()
{
  this->Inside->prepareMoving();
}

bool vtkSonoUltrasound::MakeAhead(const double positionMm[3], const double axial[3], const double lateral[3])
{
  return this->Inside->makeAhead(positionMm, axial, lateral);
}

bool vtkSonoUltrasound::IsAheadReady()
{
  return this->Inside->isAheadReady();
}

vtkMTimeType vtkSonoUltrasound::GetMTime()
{
  if (this->Inside->isLeftWanted() || (this->Progressive && this->Inside->isBetterOffered()))
  {
    this->MTime.Modified(); // without telling: nothing has changed but who looks, or what is known
  }
  vtkMTimeType time = this->Superclass::GetMTime();
  for (vtkAlgorithm* stage : this->Inside->withSettings())
  {
    time = std::max(time, stage->GetMTime());
  }
  return time;
}

int vtkSonoUltrasound::FillInputPortInformation(int port, vtkInformation* info)
{
  switch (port)
  {
    case LABELS_OR_SCENE:
      // The composite one first: the pipeline would otherwise hand a scene over block by block.
      info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkMultiBlockDataSet");
      info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
      break;
    case TARGETS:
      info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
      break;
    case SCATTERERS:
      info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPointSet");
      break;
    default:
      info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  }
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1); // of the first: so that one clear sentence says what is missing
  return 1;
}

int vtkSonoUltrasound::FillOutputPortInformation(int port, vtkInformation* info)
{
  const bool isPolyData = port == PROBE || port == RAY_PATHS || port == BOUNDARY_HITS;
  const char* type = port == ANATOMY ? "vtkMultiBlockDataSet" : isPolyData ? "vtkPolyData" : "vtkImageData";
  info->Set(vtkDataObject::DATA_TYPE_NAME(), type);
  return 1;
}

int vtkSonoUltrasound::RequestInformation(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    if (!vtkDataObject::GetData(input[LABELS_OR_SCENE]))
    {
      throw sono::Error("No label map is connected; select one before you make the filter, or set its Input.");
    }
    this->Inside->announce(input, output);
  });
}

int vtkSonoUltrasound::RequestUpdateExtent(vtkInformation* request, vtkInformationVector** input, vtkInformationVector*)
{
  if (this->Inside->findKept(portAsked(request)))
  {
    sono::askNothing(input[LABELS_OR_SCENE]->GetInformationObject(0));
    return 1;
  }
  if (vtkMultiBlockDataSet::GetData(input[LABELS_OR_SCENE]))
  {
    sono::pickNoArrays(this->GetInputAlgorithm(LABELS_OR_SCENE, 0));
  }
  for (int port : { LABELS_OR_SCENE, PULSE_ECHO_FIELD })
  {
    if (vtkImageData::GetData(input[port]))
    {
      sono::requestWholeImage(input, port);
    }
  }
  return 1;
}

int vtkSonoUltrasound::ProcessRequest(vtkInformation* request, vtkInformationVector** input,
                                      vtkInformationVector* output)
{
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_NOT_GENERATED()))
  {
    for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
    {
      if (!isMadeFor(portAsked(request), port))
      {
        output->GetInformationObject(port)->Set(vtkDemandDrivenPipeline::DATA_NOT_GENERATED(), 1);
      }
    }
  }
  return this->Superclass::ProcessRequest(request, input, output);
}

int vtkSonoUltrasound::RequestData(vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] { this->Inside->make(portAsked(request), input, output); });
}
