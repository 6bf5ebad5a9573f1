#include "vtkSonoUltrasound.h"

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
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkInformationInformationVectorKey.h"
#include "vtkInformationIntegerVectorKey.h"
#include "vtkInformationVector.h"
#include "vtkMatrix3x3.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <initializer_list>
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
  sono::announceFields(sono::announcedFields(from), to);
}

void appendTimes(vtkFieldData* arrays, std::vector<double>& content)
{
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
  {
    content.push_back(static_cast<double>(arrays->GetAbstractArray(i)->GetMTime()));
  }
}

/// What tells one input from another. The time of a data object itself does not: ParaView makes a new shallow copy of
/// the same data for each run. Times are unique, so that equal ones of the arrays mean the same arrays.
std::vector<double> contentOf(vtkDataObject* input)
{
  std::vector<double> content;
  appendTimes(input->GetFieldData(), content);
  if (auto* image = vtkImageData::SafeDownCast(input))
  {
    appendTimes(image->GetPointData(), content);
    content.insert(content.end(), image->GetExtent(), image->GetExtent() + 6);
    content.insert(content.end(), image->GetOrigin(), image->GetOrigin() + 3);
    content.insert(content.end(), image->GetSpacing(), image->GetSpacing() + 3);
    const double* direction = image->GetDirectionMatrix()->GetData();
    content.insert(content.end(), direction, direction + 9);
  }
  return content;
}

} // namespace

class vtkSonoUltrasound::Stages
{
public:
  explicit Stages(vtkSonoUltrasound* owner);

  /// Connects a label image, or a scene.
  void connect(vtkDataObject* input);
  /// The point array that holds the labels; null: the scalars.
  void chooseLabels(const char* name);
  /// Whether the error map runs with the others.
  void chooseErrorMap(bool wanted);
  /// The stage and its port that make an output.
  vtkAlgorithmOutput* port(int outputPort) const;
  /// Whether that stage runs.
  bool isMade(int outputPort) const;

  vtkNew<vtkSonoSceneBuilder> scene;
  vtkNew<vtkSonoProbeSource> probe;
  vtkNew<vtkSonoRayTracer> tracer;
  vtkNew<vtkSonoImageFormation> formation;
  vtkNew<vtkSonoBMode> bmode;
  vtkNew<vtkSonoErrorMap> errors;
  vtkNew<vtkSonoScanConverter> converter;
  sono::StageChain chain;

private:
  std::vector<double> connected_; // content of the input
  std::string labels_;
};

vtkSonoUltrasound::Stages::Stages(vtkSonoUltrasound* owner)
  : chain(owner, { { probe, 0.0 },
                   { scene, 0.3 },
                   { tracer, 0.75 },
                   { formation, 0.95 },
                   { bmode, 0.97 },
                   { errors, 0.98 },
                   { converter, 1.0 } })
{
  tracer->SetInputConnection(1, probe->GetOutputPort());
  formation->SetInputConnection(tracer->GetOutputPort());
  bmode->SetInputConnection(formation->GetOutputPort());
  converter->SetInputConnection(bmode->GetOutputPort());
  // A chest's walls spread a beam by a few degrees, and sixteen centimetres of it cross more than seven boundaries.
  tracer->SetMaxCollisions(20);
  tracer->SetCoherenceMm(20.0);
  tracer->SetLobeSigmaDeg(6.0);
  bmode->SetTgcDbPerCm(3.0);
}

void vtkSonoUltrasound::Stages::connect(vtkDataObject* input)
{
  if (!input)
  {
    throw sono::Error("No label map is connected; select one before you make the filter, or set its Input.");
  }
  std::vector<double> content = contentOf(input);
  if (content == connected_ && tracer->GetNumberOfInputConnections(0) > 0)
  {
    return;
  }
  connected_ = std::move(content);
  // A copy, because a data object belongs to one pipeline.
  const vtkSmartPointer<vtkDataObject> copy = vtk::TakeSmartPointer(input->NewInstance());
  copy->ShallowCopy(input);
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

void vtkSonoUltrasound::Stages::chooseErrorMap(bool wanted)
{
  errors->SetInputConnection(wanted ? tracer->GetOutputPort(0) : nullptr);
}

bool vtkSonoUltrasound::Stages::isMade(int outputPort) const
{
  return outputPort != ERROR_MAP || errors->GetNumberOfInputConnections(0) > 0;
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
  this->SetNumberOfOutputPorts(10);
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS,
                               vtkDataSetAttributes::AttributeTypes::SCALARS);
}

vtkSonoUltrasound::~vtkSonoUltrasound() = default;

void vtkSonoUltrasound::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const Stages& stages = *this->Chain;
  for (vtkAlgorithm* stage : std::initializer_list<vtkAlgorithm*>{
         stages.scene, stages.probe, stages.tracer, stages.formation, stages.bmode, stages.converter, stages.errors })
  {
    os << indent << stage->GetClassName() << ":" << endl;
    stage->PrintSelf(os, indent.GetNextIndent());
  }
  os << indent << "ErrorMap: " << this->ErrorMap << endl;
}

template<class Stage, class Change>
void vtkSonoUltrasound::ChangeStage(Stage* stage, const Change& change)
{
  const vtkMTimeType before = stage->GetMTime();
  change(stage);
  if (stage->GetMTime() != before)
  {
    this->Modified();
  }
}

#define sonoForward(stage, type, name)                                                                                 \
  void vtkSonoUltrasound::Set##name(type value)                                                                        \
  {                                                                                                                    \
    this->ChangeStage(this->Chain->stage.Get(), [=](auto* changed) { changed->Set##name(value); });                    \
  }                                                                                                                    \
  type vtkSonoUltrasound::Get##name()                                                                                  \
  {                                                                                                                    \
    return this->Chain->stage->Get##name();                                                                            \
  }

#define sonoForwardVector(stage, name)                                                                                 \
  void vtkSonoUltrasound::Set##name(double x, double y, double z)                                                      \
  {                                                                                                                    \
    this->ChangeStage(this->Chain->stage.Get(), [=](auto* changed) { changed->Set##name(x, y, z); });                  \
  }                                                                                                                    \
  double* vtkSonoUltrasound::Get##name()                                                                               \
  {                                                                                                                    \
    return this->Chain->stage->Get##name();                                                                            \
  }

// clang-format off
sonoForward(scene, const char*, TissueTableFile)
sonoForward(scene, const char*, LabelTissueFile)
sonoForward(scene, const char*, LabelTableFile)
sonoForward(scene, const char*, FallbackTissue)
sonoForward(scene, const char*, OutsideTissue)
sonoForward(scene, bool, FillBody)
sonoForward(scene, double, ClosingMm)
sonoForward(scene, double, WallMm)
sonoForward(scene, double, SkinMm)
sonoForward(scene, const char*, CacheFolder)
sonoForward(scene, bool, BuildSurfaces)

sonoForward(probe, const char*, PresetFile)
sonoForward(probe, int, ScanKind)
sonoForward(probe, int, LineCount)
sonoForward(probe, double, DepthMm)
sonoForward(probe, double, SectorDeg)
sonoForward(probe, double, RadiusMm)
sonoForward(probe, double, WidthMm)
sonoForward(probe, int, ElevationLineCount)
sonoForward(probe, double, ElevationSectorDeg)
sonoForwardVector(probe, PositionMm)
sonoForwardVector(probe, Axial)
sonoForwardVector(probe, Lateral)
sonoForward(probe, double, CentreFrequencyMHz)
sonoForward(probe, double, FractionalBandwidth)
sonoForward(probe, bool, Preview)

sonoForward(tracer, int, InterfaceModel)
sonoForward(tracer, int, Sampling)
sonoForward(tracer, int, PathsPerLine)
sonoForward(tracer, int, MaxCollisions)
sonoForward(tracer, double, CoherenceMm)
sonoForward(tracer, bool, Deterministic)
sonoForward(tracer, double, LobeMeanDeg)
sonoForward(tracer, double, LobeSigmaDeg)
sonoForward(tracer, double, LobeMinDeg)
sonoForward(tracer, double, LobeMaxDeg)
sonoForward(tracer, double, RadialBinMm)
sonoForward(tracer, double, SamplingMHz)
sonoForward(tracer, double, RouletteDb)
sonoForward(tracer, int, NumberOfShownPaths)

sonoForward(formation, double, LateralSigmaMm)
sonoForward(formation, double, ElevationalSigmaMm)
sonoForward(formation, double, ScattererCellMm)
sonoForward(formation, double, ScattererLevelDb)
sonoForward(formation, const char*, PulseFileName)

sonoForward(bmode, double, TgcDbPerCm)
sonoForward(bmode, double, GainDb)
sonoForward(bmode, bool, AutomaticReference)
sonoForward(bmode, double, ReferenceAmplitude)
sonoForward(bmode, double, DynamicRangeDb)
sonoForward(bmode, double, RejectDb)
sonoForward(bmode, int, GreyMap)
sonoForward(bmode, bool, AddNoise)
sonoForward(bmode, double, NoiseDb)
sonoForward(bmode, int, NoiseSeed)

  // clang-format on

  void vtkSonoUltrasound::SetPixelMm(double value)
{
  this->ChangeStage(this->Chain->converter.Get(), [=](auto* converter) { converter->SetPixelMm(value); });
  this->ChangeStage(this->Chain->errors.Get(), [=](auto* errors) { errors->SetPixelMm(value); });
}

double vtkSonoUltrasound::GetPixelMm()
{
  return this->Chain->converter->GetPixelMm();
}

void vtkSonoUltrasound::SetSeed(int value)
{
  this->ChangeStage(this->Chain->tracer.Get(), [=](auto* tracer) { tracer->SetSeed(value); });
  this->ChangeStage(this->Chain->formation.Get(), [=](auto* formation) { formation->SetSeed(value); });
}

void vtkSonoUltrasound::SetDevice(int value)
{
  this->ChangeStage(this->Chain->tracer.Get(), [=](auto* tracer) { tracer->SetDevice(value); });
  this->ChangeStage(this->Chain->formation.Get(), [=](auto* formation) { formation->SetDevice(value); });
}

int vtkSonoUltrasound::GetDevice()
{
  return this->Chain->tracer->GetDevice();
}

int vtkSonoUltrasound::GetSeed()
{
  return this->Chain->tracer->GetSeed();
}

void vtkSonoUltrasound::AddTgcPoint(double depthMm, double gainDb)
{
  this->ChangeStage(this->Chain->bmode.Get(), [=](auto* bmode) { bmode->AddTgcPoint(depthMm, gainDb); });
}

void vtkSonoUltrasound::RemoveAllTgcPoints()
{
  this->ChangeStage(this->Chain->bmode.Get(), [](auto* bmode) { bmode->RemoveAllTgcPoints(); });
}

int vtkSonoUltrasound::GetNumberOfTgcPoints()
{
  return this->Chain->bmode->GetNumberOfTgcPoints();
}

int vtkSonoUltrasound::FillInputPortInformation(int, vtkInformation* info)
{
  // The composite one first: the pipeline would otherwise hand a scene over block by block.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkMultiBlockDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1); // so that one clear sentence says what is missing
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
    this->Chain->connect(vtkDataObject::GetData(input[0]));
    this->Chain->chain.updateInformation();
    for (int port : { IMAGE, BMODE_LINES, RF_LINES, TRACED_LINES, PROBE, FLAT_IMAGE })
    {
      vtkAlgorithmOutput* made = this->Chain->port(port);
      announceSame(made->GetProducer()->GetOutputInformation(made->GetIndex()), output->GetInformationObject(port));
    }
    this->Chain->chooseErrorMap(this->ErrorMap);
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
  const bool isImage = vtkImageData::GetData(input[0]) != nullptr;
  return isImage ? sono::requestWholeImage(input) : 1;
}

int vtkSonoUltrasound::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    this->Chain->connect(vtkDataObject::GetData(input[0]));
    this->Chain->chooseLabels(this->GetInputArrayInformation(0)->Get(vtkDataObject::FIELD_NAME()));
    this->Chain->chain.update();
    for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
    {
      if (this->Chain->isMade(port))
      {
        vtkAlgorithmOutput* made = this->Chain->port(port);
        vtkDataObject::GetData(output, port)->ShallowCopy(made->GetProducer()->GetOutputDataObject(made->GetIndex()));
      }
    }
    if (this->Chain->isMade(ERROR_MAP))
    {
      vtkDataArray* percent = vtkImageData::GetData(output, ERROR_MAP)->GetPointData()->GetScalars();
      for (int port : { IMAGE, FLAT_IMAGE })
      {
        vtkImageData::GetData(output, port)->GetPointData()->AddArray(percent);
      }
    }
  });
}
