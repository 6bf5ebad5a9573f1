#include "vtkSonoUltrasound.h"

#include "Simulator.h"
#include "SonoAnatomy.h"
#include "SonoChestDefaults.h"
#include "SonoContent.h"
#include "SonoFieldImage.h"
#include "SonoImagePlacement.h"
#include "SonoImageSettings.h"
#include "SonoLineImage.h"
#include "SonoOutputs.h"
#include "SonoPaths.h"
#include "SonoProbeField.h"
#include "SonoScatterers.h"
#include "SonoStage.h"
#include "SonoTargets.h"
#include "Trace/ProbeContact.h"
#include "Trace/TraceDevice.h"
#include "vtkSonoBMode.h"
#include "vtkSonoImageFormation.h"
#include "vtkSonoProbeSource.h"
#include "vtkSonoRayTracer.h"
#include "vtkSonoScanConverter.h"
#include "vtkSonoSceneBuilder.h"
#include "vtkSonoSceneHandle.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkSonoUltrasound);

namespace {

// Where the stages' progress ends in that of the whole; Simulator shares out what is after the tracing.
constexpr double anatomyEnd = 0.3;
constexpr double tracingEnd = 0.75;
constexpr double bmodeEnd = 0.95;

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

/// What was made of an input, kept while its content stays.
template<class Made>
struct OfInput
{
  std::optional<std::vector<double>> content; ///< none: it is to be made
  Made made;

  template<class Make>
  const Made& get(vtkDataObject* input, const Make& make)
  {
    std::vector<double> now = input ? sono::contentOf(input) : std::vector<double>();
    if (content != now)
    {
      content.reset(); // stays so when it fails
      made = input ? make() : Made();
      content = std::move(now);
    }
    return made;
  }
};

} // namespace

/// The stages, for their settings, and the simulator that does what they say.
class vtkSonoUltrasound::Stages
{
public:
  explicit Stages(vtkSonoUltrasound* owner);

  /// To the scene builder, which was replaced.
  void listenToBuilder();
  std::vector<vtkAlgorithm*> withSettings() const;

  void announce(vtkInformationVector* output);
  /// Makes an output, and what is made with it.
  void make(int port, vtkInformationVector** input, vtkInformationVector* output);

  vtkSmartPointer<vtkSonoSceneBuilder> scene = vtkSmartPointer<vtkSonoSceneBuilder>::New();
  vtkSmartPointer<vtkSonoProbeSource> probe = vtkSmartPointer<vtkSonoProbeSource>::New();
  vtkSmartPointer<vtkSonoRayTracer> tracer = vtkSmartPointer<vtkSonoRayTracer>::New();
  vtkSmartPointer<vtkSonoImageFormation> formation = vtkSmartPointer<vtkSonoImageFormation>::New();
  vtkSmartPointer<vtkSonoBMode> bmode = vtkSmartPointer<vtkSonoBMode>::New();
  vtkSmartPointer<vtkSonoScanConverter> converter = vtkSmartPointer<vtkSonoScanConverter>::New();

private:
  using Inputs = std::array<vtkSmartPointer<vtkDataObject>, 4>;

  sono::ImageSettings settings(const sono::ProbeField& field) const;
  /// The part of the whole's progress that a stage reports, with its text.
  sono::Progress progress(vtkAlgorithm* stage, double from, double to);
  const std::vector<sono::TargetSurface>& targets(vtkDataObject* input, vtkMultiBlockDataSet* blocks);
  sono::TracedResult trace(const sono::ProbeField& field, const sono::ImageInput& image);
  void readEchoInputs(const Inputs& inputs, sono::ImageInput& image);
  template<class Result, class Fill>
  void makeLines(const Result& result, Result (*resultOf)(vtkImageData*), const Fill& fill,
                 vtkSmartPointer<vtkImageData>& kept, vtkImageData* lines);
  void makePaths(int port, const sono::ImageInput& image, vtkPolyData* output);
  void makeImage(const sono::ImageInput& image, vtkDataArray* errors, vtkImageData* world, vtkImageData* flat);
  void makeErrorMap(const sono::ProbeField& field, const sono::ImageInput& image, const sono::TracedResult& traced);

  vtkSonoUltrasound* owner_;
  std::unique_ptr<sono::Anatomy> anatomy_;
  sono::Simulator simulator_;
  vtkSmartPointer<vtkFieldData> acquisition_; ///< as announced
  // What is made of the inputs.
  OfInput<std::vector<sono::TargetSurface>> targets_;
  std::string targetTissue_;                         ///< and
  std::shared_ptr<const sono::TissueTable> tissues_; ///< which the targets are made with
  OfInput<std::shared_ptr<const sono::PointScatterers>> scatterers_;
  OfInput<std::shared_ptr<const sono::PulseEchoField>> pulseEchoField_;
  std::shared_ptr<const sono::SampledPulse> pulse_;
  vtkMTimeType pulseTime_ = 0; ///< of the stage when it was read; 0: it is to be read
  // The last results, and the arrays that stay as long as they do.
  sono::TracedResult traced_;
  sono::ScanPicture picture_;
  vtkSmartPointer<vtkPointData> pictureArrays_;
  sono::ImageResult errorMap_;
  vtkSmartPointer<vtkPointData> errorArrays_;
  vtkSmartPointer<vtkImageData> tracedLines_;
  vtkSmartPointer<vtkImageData> rfLines_;
  vtkSmartPointer<vtkImageData> bmodeLines_;
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
  listenToBuilder();
}

void vtkSonoUltrasound::Stages::listenToBuilder()
{
  anatomy_ = std::make_unique<sono::Anatomy>(owner_, scene, anatomyEnd);
}

std::vector<vtkAlgorithm*> vtkSonoUltrasound::Stages::withSettings() const
{
  return { scene, probe, tracer, formation, bmode, converter };
}

sono::ImageSettings vtkSonoUltrasound::Stages::settings(const sono::ProbeField& field) const
{
  return sono::imageSettings(field, *tracer, *formation, *bmode, sono::pixelMmOf(field, converter->GetPixelMm()));
}

sono::Progress vtkSonoUltrasound::Stages::progress(vtkAlgorithm* stage, double from, double to)
{
  owner_->SetProgressText(stage->GetProgressText());
  return sono::partOf(sono::progressOf(owner_), from, to);
}

void vtkSonoUltrasound::Stages::announce(vtkInformationVector* output)
{
  const auto on = [&](int port) { return output->GetInformationObject(port); };
  formation->SetDevice(tracer->GetDevice()); // what it says when it is asked
  const sono::ProbeField field = probe->Probe();
  const sono::ImageSettings all = settings(field);
  acquisition_ = vtkSmartPointer<vtkFieldData>::New();
  sono::writeProbe(field, acquisition_);
  sono::writeNumber("SamplingMHz", tracer->RfSamplingMHz(field), acquisition_);

  const sono::ImagePlacement placement = sono::placementOf(field, all.pixelMm);
  placement.announce(VTK_UNSIGNED_CHAR, on(IMAGE));
  placement.flat(field.pose).announce(VTK_UNSIGNED_CHAR, on(FLAT_IMAGE));
  placement.announce(VTK_FLOAT, on(ERROR_MAP));
  if (!owner_->ErrorMap)
  {
    const int empty[6] = { 0, -1, 0, -1, 0, -1 };
    on(ERROR_MAP)->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), empty, 6);
  }
  const int lineCount = all.geometry.totalLineCount();
  const double binMm = all.tracing.radialBinMm;
  for (int port : { RF_LINES, BMODE_LINES })
  {
    sono::announceLineImage({ all.echo.sampleCount(), lineCount, 0.0, all.echo.sampleMm() }, 1, on(port));
  }
  sono::announceLineImage({ all.tracing.binCount(), lineCount, binMm / 2.0, binMm }, 1, on(TRACED_LINES));
  sono::announceFields(acquisition_, on(IMAGE));
  for (int port : { BMODE_LINES, RF_LINES, TRACED_LINES, PROBE, FLAT_IMAGE, ERROR_MAP })
  {
    sono::announceSameFields(on(IMAGE), on(port));
  }
}

const std::vector<sono::TargetSurface>& vtkSonoUltrasound::Stages::targets(vtkDataObject* input,
                                                                           vtkMultiBlockDataSet* blocks)
{
  const auto tissues = vtkSonoSceneHandle::GetTissues(blocks->GetFieldData());
  if (tissues != tissues_ || targetTissue_ != tracer->GetTargetTissue())
  {
    targets_.content.reset();
    tissues_ = tissues;
    targetTissue_ = tracer->GetTargetTissue();
  }
  return targets_.get(input,
                      [&] { return sono::targetSurfaces(vtkPolyData::SafeDownCast(input), targetTissue_, *tissues_); });
}

sono::TracedResult vtkSonoUltrasound::Stages::trace(const sono::ProbeField& field, const sono::ImageInput& image)
{
  const sono::TraceSettings& tracing = image.settings.tracing;
  sono::announceDevice(sono::chooseDevice(tracing));
  const auto lines = sono::makeScanLines(field.geometry, field.pose);
  const auto warnOfContact = [&] {
    const std::string sentence = field.preview ? "" : sono::probeContactWarning(*simulator_.scene(), lines);
    if (!sentence.empty())
    {
      sono::warn(owner_, sentence);
    }
  };
  sono::TracedResult traced;
  try
  {
    traced = simulator_.traced(image, progress(tracer, anatomyEnd, tracingEnd));
  }
  catch (const sono::Error&)
  {
    warnOfContact();
    throw;
  }
  if (!(traced == traced_)) // on a GPU it is under way
  {
    traced_ = traced;
    pulseTime_ = 0;
    warnOfContact();
    if (field.prepares && !field.preview)
    {
      simulator_.prepareInteractive(lines, tracing);
    }
  }
  return traced;
}

void vtkSonoUltrasound::Stages::readEchoInputs(const Inputs& inputs, sono::ImageInput& image)
{
  sono::announceDevice(sono::chooseDevice(image.settings.echo.device));
  image.settings.echo.field = pulseEchoField_.get(inputs[PULSE_ECHO_FIELD], [&] {
    return std::make_shared<const sono::PulseEchoField>(
      sono::fieldFromImage(vtkImageData::SafeDownCast(inputs[PULSE_ECHO_FIELD])));
  });
  if (pulseTime_ != formation->GetMTime())
  {
    pulseTime_ = 0; // stays so when it fails
    pulse_ = formation->ReadPulse();
    pulseTime_ = formation->GetMTime();
  }
  image.settings.echo.pulse = pulse_;
  image.points = scatterers_.get(inputs[SCATTERERS],
                                 [&] { return sono::pointScatterers(vtkPointSet::SafeDownCast(inputs[SCATTERERS])); });
}

/// Takes the lines of before where they are of the same result.
template<class Result, class Fill>
void vtkSonoUltrasound::Stages::makeLines(const Result& result, Result (*resultOf)(vtkImageData*), const Fill& fill,
                                          vtkSmartPointer<vtkImageData>& kept, vtkImageData* lines)
{
  if (kept && resultOf(kept) == result)
  {
    vtkNew<vtkFieldData> fields;
    fields->ShallowCopy(lines->GetFieldData());
    lines->ShallowCopy(kept);
    lines->GetFieldData()->PassData(fields);
    return;
  }
  fill();
  kept = vtkSmartPointer<vtkImageData>::New();
  kept->ShallowCopy(lines);
}

void vtkSonoUltrasound::Stages::makePaths(int port, const sono::ImageInput& image, vtkPolyData* output)
{
  const auto paths =
    simulator_.paths(sono::makeScanLines(image.settings.geometry, image.pose), image.settings.tracing,
                     tracer->GetNumberOfShownPaths(), image.targets, progress(tracer, tracingEnd, 1.0));
  if (port == RAY_PATHS)
  {
    sono::fillPaths(*paths, output);
  }
  else
  {
    sono::fillHits(*paths, sono::mediaNames(*simulator_.scene(), image.targets), output);
  }
}

void vtkSonoUltrasound::Stages::makeErrorMap(const sono::ProbeField& field, const sono::ImageInput& image,
                                             const sono::TracedResult& traced)
{
  const sono::ImageResult map = simulator_.errorMap(field.geometry, traced, field.preview, image.settings.pixelMm,
                                                    progress(converter, tracingEnd, 1.0));
  if (!errorArrays_ || !(map == errorMap_))
  {
    errorArrays_ = sono::errorArrays(map);
    errorMap_ = map;
  }
}

void vtkSonoUltrasound::Stages::makeImage(const sono::ImageInput& image, vtkDataArray* errors, vtkImageData* world,
                                          vtkImageData* flat)
{
  const sono::ImageResult made = simulator_.image(image, progress(converter, 0.0, 1.0));
  // All else before the picture, which may have to be waited for.
  sono::placeImage(made, image.pose, world);
  sono::placeFlat(made, image.pose, world, flat);
  const sono::ScanPicture picture = simulator_.picture(made, image.pose, true);
  if (!pictureArrays_ || picture.grey.data != picture_.grey.data)
  {
    pictureArrays_ = sono::pictureArrays(picture);
    picture_ = picture;
  }
  for (vtkImageData* output : { world, flat })
  {
    output->GetPointData()->ShallowCopy(pictureArrays_);
    if (errors)
    {
      output->GetPointData()->AddArray(errors);
    }
  }
}

void vtkSonoUltrasound::Stages::make(int port, vtkInformationVector** input, vtkInformationVector* output)
{
  Inputs inputs; // others may be connected meanwhile
  for (int i = 0; i < int(inputs.size()); ++i)
  {
    inputs[i] = vtkDataObject::GetData(input[i]);
  }
  vtkDataObject* made = vtkDataObject::GetData(output, port);
  vtkFieldData* fields = made->GetFieldData();
  const sono::ProbeField field = probe->Probe();
  if (port == PROBE)
  {
    fields->Initialize();
    return sono::fillProbe(field, vtkPolyData::SafeDownCast(made));
  }
  const char* labels = owner_->GetInputArrayInformation(0)->Get(vtkDataObject::FIELD_NAME());
  const vtkSmartPointer<vtkMultiBlockDataSet> blocks = anatomy_->blocks(inputs[LABELS_OR_SCENE], labels);
  if (port == ANATOMY)
  {
    return made->ShallowCopy(blocks);
  }
  if (port == ERROR_MAP && !owner_->ErrorMap)
  {
    return;
  }
  simulator_.setScene(vtkSonoSceneHandle::Get(blocks));
  sono::ImageInput image{ field.pose, settings(field), targets(inputs[TARGETS], blocks), nullptr };
  const sono::TracedResult traced = trace(field, image);
  fields->PassData(blocks->GetFieldData());
  if (port == RAY_PATHS || port == BOUNDARY_HITS)
  {
    return tracer->GetNumberOfShownPaths() != 0 ? makePaths(port, image, vtkPolyData::SafeDownCast(made)) : void();
  }
  fields->PassData(acquisition_);
  auto* lines = vtkImageData::SafeDownCast(made);
  if (port == TRACED_LINES)
  {
    const double samplingMHz = tracer->RfSamplingMHz(field);
    return makeLines(
      traced, sono::tracedHandleOf, [&] { sono::fillTraced(traced, field, samplingMHz, lines); }, tracedLines_, lines);
  }
  if (owner_->ErrorMap)
  {
    makeErrorMap(field, image, traced);
  }
  if (port == ERROR_MAP)
  {
    sono::placeImage(errorMap_, field.pose, lines);
    return lines->GetPointData()->ShallowCopy(errorArrays_);
  }
  readEchoInputs(inputs, image);
  const sono::RfResult rf = simulator_.rf(image, progress(formation, 0.0, bmodeEnd));
  if (port == RF_LINES)
  {
    return makeLines(
      rf, sono::rfOf, [&] { sono::fillRf(rf, lines); }, rfLines_, lines);
  }
  if (port == BMODE_LINES)
  {
    const sono::BModeResult grey = simulator_.bmode(image, progress(bmode, 0.0, bmodeEnd));
    return makeLines(
      grey, sono::bmodeOf, [&] { sono::fillBMode(grey, lines); }, bmodeLines_, lines);
  }
  vtkImageData* world = vtkImageData::GetData(output, IMAGE);
  if (port == FLAT_IMAGE)
  {
    world->GetFieldData()->ShallowCopy(fields);
  }
  makeImage(image, owner_->ErrorMap ? errorArrays_->GetScalars() : nullptr, world,
            vtkImageData::GetData(output, FLAT_IMAGE));
}

vtkSonoUltrasound::vtkSonoUltrasound()
  : Inside(new Stages(this))
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
}

template<class Stage>
void vtkSonoUltrasound::Replace(vtkSmartPointer<Stage>& own, Stage* given)
{
  if (given && given != own)
  {
    own = given;
    this->Inside->listenToBuilder();
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

vtkMTimeType vtkSonoUltrasound::GetMTime()
{
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
    this->Inside->announce(output);
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
  return sono::runStage(this, output, [&] { this->Inside->make(portAsked(request), input, output); });
}
