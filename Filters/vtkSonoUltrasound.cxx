#include "vtkSonoUltrasound.h"

#include "SonoChestDefaults.h"
#include "SonoContent.h"
#include "SonoOutputs.h"
#include "SonoProbeField.h"
#include "SonoStage.h"
#include "SonoStageChain.h"
#include "vtkSonoBMode.h"
#include "vtkSonoErrorMap.h"
#include "vtkSonoImageFormation.h"
#include "vtkSonoProbeSource.h"
#include "vtkSonoRayTracer.h"
#include "vtkSonoScanConverter.h"
#include "vtkSonoSceneBuilder.h"

#include "vtkAlgorithmOutput.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkExecutive.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkInformationInformationVectorKey.h"
#include "vtkInformationIntegerVectorKey.h"
#include "vtkInformationVector.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkSonoUltrasound);

namespace {

/// Announces what another filter's output announces, of an image its size and place too.
void announceSame(vtkInformation* from, vtkInformation* to)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  for (vtkInformationKey* key : std::initializer_list<vtkInformationKey*>{
         Pipeline::WHOLE_EXTENT(), vtkDataObject::ORIGIN(), vtkDataObject::SPACING(), vtkDataObject::DIRECTION(),
         vtkDataObject::POINT_DATA_VECTOR() })
  {
    to->CopyEntry(from, key);
  }
  sono::announceSameFields(from, to);
}

/// The output that somebody asks for; the image where nobody does.
int portAsked(vtkInformation* request)
{
  return std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()));
}

/// A data object belongs to one pipeline. Null of null.
vtkSmartPointer<vtkDataObject> copyOf(vtkDataObject* input)
{
  vtkSmartPointer<vtkDataObject> copy;
  if (input)
  {
    copy = vtk::TakeSmartPointer(input->NewInstance());
    copy->ShallowCopy(input);
  }
  return copy;
}

/// Whether an output is made when another is asked for. Those that are not keep their data until they are asked for.
bool isMadeFor(int asked, int port)
{
  const auto isImage = [](int p) { return p == vtkSonoUltrasound::IMAGE || p == vtkSonoUltrasound::FLAT_IMAGE; };
  return port == asked || (isImage(asked) && isImage(port));
}

} // namespace

class vtkSonoUltrasound::Stages
{
public:
  explicit Stages(vtkSonoUltrasound* owner);

  /// Connects the stages with each other, as they are now.
  void chainUp();
  /// Connects the inputs of the filter: a label image, or a scene, and what is optional.
  void connect(vtkInformationVector** input);
  /// The point array that holds the labels; null: the scalars.
  void chooseLabels(const char* name);
  /// Whether the error map runs with the others, and what the stages share.
  void share(bool wantsErrorMap);
  /// The stage and its port that make an output.
  vtkAlgorithmOutput* port(int outputPort) const;
  /// The last stage that an output needs.
  vtkAlgorithm* stageOf(int outputPort) const;
  /// Whether that stage runs.
  bool isMade(int outputPort) const;
  /// Those that have settings.
  std::vector<vtkAlgorithm*> withSettings() const;

  vtkSmartPointer<vtkSonoSceneBuilder> scene = vtkSmartPointer<vtkSonoSceneBuilder>::New();
  vtkSmartPointer<vtkSonoProbeSource> probe = vtkSmartPointer<vtkSonoProbeSource>::New();
  vtkSmartPointer<vtkSonoRayTracer> tracer = vtkSmartPointer<vtkSonoRayTracer>::New();
  vtkSmartPointer<vtkSonoImageFormation> formation = vtkSmartPointer<vtkSonoImageFormation>::New();
  vtkSmartPointer<vtkSonoBMode> bmode = vtkSmartPointer<vtkSonoBMode>::New();
  vtkSmartPointer<vtkSonoScanConverter> converter = vtkSmartPointer<vtkSonoScanConverter>::New();
  vtkNew<vtkSonoErrorMap> errors;
  std::unique_ptr<sono::StageChain> chain;

private:
  void connectMain(vtkDataObject* input);
  void connectOptional(int port, vtkDataObject* input, vtkAlgorithm* stage, int stagePort);

  vtkSonoUltrasound* owner_;
  std::array<std::vector<double>, 4> connected_; // content of the inputs
  std::string labels_;
};

vtkSonoUltrasound::Stages::Stages(vtkSonoUltrasound* owner)
  : owner_(owner)
{
  sono::TraceSettings tracing;
  sono::BModeSettings grey;
  sono::setChestDefaults(tracing);
  sono::setChestDefaults(grey);
  tracer->SetMaxCollisions(tracing.maxCollisions);
  tracer->SetCoherenceMm(tracing.coherenceMm);
  tracer->SetLobeSigmaDeg(tracing.lobeSigmaDeg);
  bmode->SetTgcDbPerCm(grey.tgcDbPerCm);
  chainUp();
}

void vtkSonoUltrasound::Stages::chainUp()
{
  chain.reset(); // before the new one listens to the same stages
  chain = std::make_unique<sono::StageChain>(owner_, std::vector<sono::StageChain::Link>{ { probe, 0.0 },
                                                                                          { scene, 0.3 },
                                                                                          { tracer, 0.75 },
                                                                                          { formation, 0.95 },
                                                                                          { bmode, 0.97 },
                                                                                          { errors, 0.98 },
                                                                                          { converter, 1.0 } });
  tracer->SetInputConnection(1, probe->GetOutputPort());
  formation->SetInputConnection(tracer->GetOutputPort());
  bmode->SetInputConnection(formation->GetOutputPort());
  converter->SetInputConnection(bmode->GetOutputPort());
  connected_ = {};
}

std::vector<vtkAlgorithm*> vtkSonoUltrasound::Stages::withSettings() const
{
  return { scene, probe, tracer, formation, bmode, converter };
}

void vtkSonoUltrasound::Stages::connect(vtkInformationVector** input)
{
  connectMain(vtkDataObject::GetData(input[LABELS_OR_SCENE]));
  connectOptional(TARGETS, vtkDataObject::GetData(input[TARGETS]), tracer, 2);
  connectOptional(SCATTERERS, vtkDataObject::GetData(input[SCATTERERS]), formation, 1);
  connectOptional(PULSE_ECHO_FIELD, vtkDataObject::GetData(input[PULSE_ECHO_FIELD]), formation, 2);
}

void vtkSonoUltrasound::Stages::connectOptional(int port, vtkDataObject* input, vtkAlgorithm* stage, int stagePort)
{
  std::vector<double> content = input ? sono::contentOf(input) : std::vector<double>();
  if (content != connected_[port])
  {
    connected_[port] = std::move(content);
    stage->SetInputDataObject(stagePort, copyOf(input));
  }
}

void vtkSonoUltrasound::Stages::connectMain(vtkDataObject* input)
{
  if (!input)
  {
    throw sono::Error("No label map is connected; select one before you make the filter, or set its Input.");
  }
  std::vector<double> content = sono::contentOf(input);
  if (content == connected_[LABELS_OR_SCENE] && tracer->GetNumberOfInputConnections(0) > 0)
  {
    return;
  }
  connected_[LABELS_OR_SCENE] = std::move(content);
  const vtkSmartPointer<vtkDataObject> copy = copyOf(input);
  if (vtkImageData::SafeDownCast(input))
  {
    scene->SetInputDataObject(copy);
    tracer->SetInputConnection(0, scene->GetOutputPort());
  }
  else
  {
    scene->SetInputDataObject(nullptr);
    tracer->SetInputDataObject(0, copy);
  }
}

void vtkSonoUltrasound::Stages::chooseLabels(const char* name)
{
  if (name && labels_ != name)
  {
    labels_ = name;
    scene->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name);
  }
}

void vtkSonoUltrasound::Stages::share(bool wantsErrorMap)
{
  errors->SetInputConnection(wantsErrorMap ? tracer->GetOutputPort(0) : nullptr);
  errors->SetPixelMm(converter->GetPixelMm());
  formation->SetDevice(tracer->GetDevice());
}

bool vtkSonoUltrasound::Stages::isMade(int outputPort) const
{
  return outputPort != ERROR_MAP || errors->GetNumberOfInputConnections(0) > 0;
}

vtkAlgorithm* vtkSonoUltrasound::Stages::stageOf(int outputPort) const
{
  return outputPort == ANATOMY ? static_cast<vtkAlgorithm*>(scene) : port(outputPort)->GetProducer();
}

vtkAlgorithmOutput* vtkSonoUltrasound::Stages::port(int outputPort) const
{
  switch (outputPort)
  {
    case IMAGE:
      return converter->GetOutputPort(0);
    case BMODE_LINES:
      return bmode->GetOutputPort();
    case RF_LINES:
      return formation->GetOutputPort();
    case TRACED_LINES:
      return tracer->GetOutputPort(0);
    case ANATOMY:
      return tracer->GetInputConnection(0, 0);
    case PROBE:
      return probe->GetOutputPort();
    case RAY_PATHS:
      return tracer->GetOutputPort(2);
    case BOUNDARY_HITS:
      return tracer->GetOutputPort(3);
    case ERROR_MAP:
      return errors->GetOutputPort(0);
    default:
      return converter->GetOutputPort(1);
  }
}

vtkSonoUltrasound::vtkSonoUltrasound()
  : Chain(new Stages(this))
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
  for (vtkAlgorithm* stage : this->Chain->withSettings())
  {
    os << indent << stage->GetClassName() << ":" << endl;
    stage->PrintSelf(os, indent.GetNextIndent());
  }
  os << indent << "ErrorMap: " << this->ErrorMap << endl;
}

template<class Stage>
void vtkSonoUltrasound::Replace(vtkSmartPointer<Stage>& own, Stage* given)
{
  if (given && given != own)
  {
    const vtkSmartPointer<Stage> before = own; // the chain still listens to it
    own = given;
    this->Chain->chainUp();
    this->Modified();
  }
}

#define sonoStage(type, name, member)                                                                                  \
  void vtkSonoUltrasound::Set##name(type* stage)                                                                       \
  {                                                                                                                    \
    this->Replace(this->Chain->member, stage);                                                                         \
  }                                                                                                                    \
  type* vtkSonoUltrasound::Get##name()                                                                                 \
  {                                                                                                                    \
    return this->Chain->member;                                                                                        \
  }
sonoStage(vtkSonoSceneBuilder, SceneBuilder, scene);
sonoStage(vtkSonoProbeSource, Probe, probe);
sonoStage(vtkSonoRayTracer, RayTracer, tracer);
sonoStage(vtkSonoImageFormation, ImageFormation, formation);
sonoStage(vtkSonoBMode, BMode, bmode);
sonoStage(vtkSonoScanConverter, ScanConverter, converter);
#undef sonoStage

vtkMTimeType vtkSonoUltrasound::GetMTime()
{
  vtkMTimeType time = this->Superclass::GetMTime();
  for (vtkAlgorithm* stage : this->Chain->withSettings())
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
    this->Chain->connect(input);
    this->Chain->share(this->ErrorMap);
    this->Chain->chain->updateInformation();
    for (int port : { IMAGE, BMODE_LINES, RF_LINES, TRACED_LINES, PROBE, FLAT_IMAGE })
    {
      vtkAlgorithmOutput* made = this->Chain->port(port);
      announceSame(made->GetProducer()->GetOutputInformation(made->GetIndex()), output->GetInformationObject(port));
    }
    vtkInformation* map = output->GetInformationObject(ERROR_MAP);
    announceSame(output->GetInformationObject(IMAGE), map);
    vtkDataObject::SetPointDataActiveScalarInfo(map, VTK_FLOAT, 1);
    if (!this->Chain->isMade(ERROR_MAP))
    {
      const int empty[6] = { 0, -1, 0, -1, 0, -1 };
      map->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), empty, 6);
    }
  });
}

int vtkSonoUltrasound::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
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
  return sono::runStage(this, output, [&] {
    this->Chain->connect(input);
    this->Chain->chooseLabels(this->GetInputArrayInformation(0)->Get(vtkDataObject::FIELD_NAME()));
    const int asked = portAsked(request);
    this->Chain->chain->update(this->Chain->stageOf(asked));
    for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
    {
      if (isMadeFor(asked, port) && this->Chain->isMade(port))
      {
        vtkAlgorithmOutput* made = this->Chain->port(port);
        vtkDataObject* data = made->GetProducer()->GetOutputDataObject(made->GetIndex());
        if (auto* lines = vtkImageData::SafeDownCast(data))
        {
          sono::addArrays(lines);
        }
        vtkDataObject::GetData(output, port)->ShallowCopy(data);
      }
    }
    if (isMadeFor(asked, IMAGE) && this->Chain->isMade(ERROR_MAP))
    {
      vtkAlgorithmOutput* map = this->Chain->port(ERROR_MAP);
      vtkDataArray* percent =
        vtkImageData::SafeDownCast(map->GetProducer()->GetOutputDataObject(0))->GetPointData()->GetScalars();
      for (int port : { IMAGE, FLAT_IMAGE })
      {
        vtkImageData::GetData(output, port)->GetPointData()->AddArray(percent);
      }
    }
  });
}
