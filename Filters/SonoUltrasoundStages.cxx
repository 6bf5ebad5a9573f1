#include "SonoUltrasoundStages.h"

#include "ChestDefaults.h"
#include "SonoContentKey.h"
#include "SonoFieldImage.h"
#include "SonoImagePlacement.h"
#include "SonoImageSettings.h"
#include "SonoLineImage.h"
#include "SonoOutputs.h"
#include "SonoPaths.h"
#include "SonoPlayed.h"
#include "SonoScatterers.h"
#include "SonoStage.h"
#include "SonoTargets.h"
#include "Trace/CollisionLimit.h"
#include "Trace/ProbeContact.h"
#include "Trace/TraceDevice.h"
#include "vtkSonoBMode.h"
#include "vtkSonoImageFormation.h"
#include "vtkSonoProbeSource.h"
#include "vtkSonoRayTracer.h"
#include "vtkSonoScanConverter.h"
#include "vtkSonoSceneBuilder.h"
#include "vtkSonoSceneHandle.h"
#include "vtkSonoUltrasound.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <exception>
#include <initializer_list>
#include <iterator>
#include <utility>

namespace sono {
namespace {

using Filter = vtkSonoUltrasound; // of the ports

// Where the stages' progress ends in that of the whole; Simulator shares out what is after the tracing.
constexpr double anatomyEnd = 0.3;
constexpr double tracingEnd = 0.75;
constexpr double bmodeEnd = 0.95;

// ParaView draws its window's lower edge for each word of progress, which can take as long as a moving probe's picture.
constexpr double quietPreviewS = 1.0;

} // namespace

UltrasoundStages::UltrasoundStages(vtkSonoUltrasound* owner)
  : scene(vtkSmartPointer<vtkSonoSceneBuilder>::New())
  , probe(vtkSmartPointer<vtkSonoProbeSource>::New())
  , tracer(vtkSmartPointer<vtkSonoRayTracer>::New())
  , formation(vtkSmartPointer<vtkSonoImageFormation>::New())
  , bmode(vtkSmartPointer<vtkSonoBMode>::New())
  , converter(vtkSmartPointer<vtkSonoScanConverter>::New())
  , owner_(owner)
  , simulator_(std::make_unique<Simulator>())
  , spare_(std::make_unique<Simulator>())
{
  TraceSettings tracing;
  BModeSettings grey;
  setChestDefaults(tracing);
  setChestDefaults(grey);
  tracer->SetMaxCollisions(tracing.maxCollisions);
  tracer->SetCoherenceMm(tracing.coherenceMm);
  tracer->SetLobeSigmaDeg(tracing.lobeSigmaDeg);
  bmode->SetTgcDbPerCm(grey.tgcDbPerCm);
  listenToBuilder();
}

UltrasoundStages::~UltrasoundStages()
{
  dropPlayed(owner_);
}

void UltrasoundStages::listenToBuilder()
{
  anatomy_ =
    std::make_unique<Anatomy>(owner_, scene, anatomyEnd, [this](const std::string& sentence) { say(sentence); });
}

std::vector<vtkAlgorithm*> UltrasoundStages::withSettings() const
{
  return { scene, probe, tracer, formation, bmode, converter };
}

Progress UltrasoundStages::progress(vtkAlgorithm* stage, double from, double to)
{
  owner_->SetProgressText(stage->GetProgressText());
  return partOf(progressOf(owner_, field_.preview ? quietPreviewS : 0.0), from, to);
}

UltrasoundStages::Inputs UltrasoundStages::inputsOf(vtkInformationVector** input)
{
  Inputs inputs;
  for (int i = 0; i < int(inputs.size()); ++i)
  {
    inputs[i] = vtkDataObject::GetData(input[i]);
  }
  return inputs;
}

/// While VTK prepares the request for data. Once between two such requests, for it may be that none follows.
void UltrasoundStages::begin(vtkInformationVector** input)
{
  const auto areUpToDate = [&](std::initializer_list<int> ports) {
    return std::all_of(ports.begin(), ports.end(), [&](int port) { return isInputUpToDate(owner_, port); });
  };
  const bool wholeImage = std::exchange(isImageAsked_, false);
  if (!std::exchange(isAsked_, false) || !areUpToDate({ Filter::LABELS_OR_SCENE, Filter::TARGETS }))
  {
    return;
  }
  vtkMultiBlockDataSet* blocks = anatomy_->builtBlocks(vtkDataObject::GetData(input[Filter::LABELS_OR_SCENE]));
  try
  {
    if (blocks && vtkSonoSceneHandle::Get(blocks) == simulator_->scene())
    {
      vtkDataObject* surfaces = vtkDataObject::GetData(input[Filter::TARGETS]);
      ImageInput image{ field_.pose, settings_, targets(surfaces, blocks), nullptr };
      // A file's pulse is read again when the image is made.
      const bool whole = wholeImage && std::string(formation->GetPulseFileName()).empty() &&
                         areUpToDate({ Filter::PULSE_ECHO_FIELD, Filter::SCATTERERS });
      if (whole)
      {
        readEchoInputs(inputsOf(input), image);
      }
      simulator_->begin(image, whole);
    }
  }
  catch (const std::exception&) // make() meets it again, and lets it be said
  {
  }
}

void UltrasoundStages::announce(vtkInformationVector** input, vtkInformationVector* output)
{
  const auto on = [&](int port) { return output->GetInformationObject(port); };
  formation->SetDevice(tracer->GetDevice()); // what it says when it is asked
  probe->UseDevice(tracer->GetDevice());
  field_ = probe->Probe();
  settings_ = imageSettings(field_, *tracer, *formation, *bmode, pixelMmOf(field_, converter->GetPixelMm()));
  begin(input);
  const vtkSmartPointer<vtkFieldData> before = acquisition_;
  acquisition_ = vtkSmartPointer<vtkFieldData>::New();
  writeProbe(field_, acquisition_, before);
  writeNumber("SamplingMHz", settings_.echo.samplingInMHz(), acquisition_, before);

  const ImagePlacement placement = placementOf(field_, settings_.pixelMm);
  placement.announce(VTK_UNSIGNED_CHAR, on(Filter::IMAGE));
  placement.flat(field_.pose).announce(VTK_UNSIGNED_CHAR, on(Filter::FLAT_IMAGE));
  placement.announce(VTK_FLOAT, on(Filter::ERROR_MAP));
  if (!owner_->GetErrorMap())
  {
    const int empty[6] = { 0, -1, 0, -1, 0, -1 };
    on(Filter::ERROR_MAP)->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), empty, 6);
  }
  const int lineCount = settings_.geometry.totalLineCount();
  const double binMm = settings_.tracing.radialBinMm;
  for (int port : { Filter::RF_LINES, Filter::BMODE_LINES })
  {
    announceLineImage(shownLayout(settings_.geometry, settings_.echo.sampleCount(), settings_.echo.sampleMm()), 1,
                      on(port));
  }
  announceLineImage({ settings_.tracing.binCount(), lineCount, binMm / 2.0, binMm }, 1, on(Filter::TRACED_LINES));
  announceFields(acquisition_, on(Filter::IMAGE));
  for (int port : { Filter::BMODE_LINES, Filter::RF_LINES, Filter::TRACED_LINES, Filter::PROBE, Filter::FLAT_IMAGE,
                    Filter::ERROR_MAP })
  {
    announceSameFields(on(Filter::IMAGE), on(port));
  }
}

const std::vector<TargetSurface>& UltrasoundStages::targets(vtkDataObject* input, vtkMultiBlockDataSet* blocks)
{
  const auto tissues = vtkSonoSceneHandle::GetTissues(blocks->GetFieldData());
  if (tissues != tissues_ || targetTissue_ != tracer->GetTargetTissue())
  {
    targets_.content.reset();
    tissues_ = tissues;
    targetTissue_ = tracer->GetTargetTissue();
  }
  return targets_.get(input,
                      [&] { return targetSurfaces(vtkPolyData::SafeDownCast(input), targetTissue_, *tissues_); });
}

TracedResult UltrasoundStages::trace(const ImageInput& image)
{
  const TraceSettings& tracing = image.settings.tracing;
  announceDevice(chooseDevice(tracing));
  const auto lines = [&] { return makeScanLines(image.settings.geometry, image.pose); };
  const auto contactWarning = [&]() -> std::string {
    if (field_.preview)
    {
      return {};
    }
    const std::string sentence = probeContactWarning(*simulator_->scene(), lines());
    return sentence.empty() ? probePlaceWarning(*simulator_->scene(), image.settings.geometry, image.pose) : sentence;
  };
  const auto sayAny = [&](const std::vector<std::string>& sentences) {
    for (const std::string& sentence : sentences)
    {
      if (!sentence.empty())
      {
        say(sentence);
      }
    }
  };
  TracedResult traced;
  isAsked_ = true;
  try
  {
    traced = simulator_->traced(image, progress(tracer, anatomyEnd, tracingEnd));
  }
  catch (const Error&)
  {
    sayAny({ contactWarning() });
    throw;
  }
  if (!(traced == traced_)) // on a GPU it is under way
  {
    traced_ = traced;
    if (isImproved_)
    {
      return traced; // of the same lines, of which all is said
    }
    pulseTime_ = 0;
    traceWarnings_ = { contactWarning() };
    const std::tuple asksFor(simulator_->scene().get(), tracing.maxCollisions, tracing.faceReflection, tracing.depthMm);
    if (!field_.preview && tracing.reverberates() && limitAskedFor_ != asksFor)
    {
      limitAskedFor_ = asksFor;
      limitWarning_ = collisionLimitWarning(*simulator_->scene(), lines(), tracing, image.targets);
    }
    traceWarnings_.push_back(tracing.reverberates() ? limitWarning_ : std::string());
    sayAny(traceWarnings_);
    if (field_.prepares && !field_.preview)
    {
      simulator_->prepareInteractive(lines(), tracing);
    }
  }
  return traced;
}

bool UltrasoundStages::offerBetter()
{
  isBetterOffered_ = hasBetter();
  return isBetterOffered_;
}

void UltrasoundStages::readEchoInputs(const Inputs& inputs, ImageInput& image)
{
  announceDevice(chooseDevice(image.settings.echo.device));
  image.settings.echo.field = pulseEchoField_.get(inputs[Filter::PULSE_ECHO_FIELD], [&] {
    return std::make_shared<const PulseEchoField>(
      fieldFromImage(vtkImageData::SafeDownCast(inputs[Filter::PULSE_ECHO_FIELD])));
  });
  if (pulseTime_ != formation->GetMTime())
  {
    pulseTime_ = 0; // stays so when it fails
    pulse_ = formation->ReadPulse();
    pulseTime_ = formation->GetMTime();
  }
  image.settings.echo.pulse = pulse_;
  image.points = scatterers_.get(
    inputs[Filter::SCATTERERS], [&] { return pointScatterers(vtkPointSet::SafeDownCast(inputs[Filter::SCATTERERS])); });
}

/// Takes the lines of before where they are of the same result.
template<class Result, class Fill>
void UltrasoundStages::makeLines(const Result& result, Result (*resultOf)(vtkImageData*), const Fill& fill,
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

/// Some of the `paths` of each line.
void UltrasoundStages::makePaths(int port, ImageInput image, int paths, vtkPolyData* output)
{
  image.settings.tracing.pathsPerLine = paths;
  const auto recorded =
    simulator_->paths(makeScanLines(image.settings.geometry, image.pose), image.settings.tracing,
                      tracer->GetNumberOfShownPaths(), image.targets, progress(tracer, tracingEnd, 1.0));
  if (port == Filter::RAY_PATHS)
  {
    fillPaths(*recorded, output);
  }
  else
  {
    fillHits(*recorded, mediaNames(*simulator_->scene(), image.targets), output);
  }
}

void UltrasoundStages::makeErrorMap(const ImageInput& image, const TracedResult& traced)
{
  const ImageResult map = simulator_->errorMap(image.settings.geometry, traced, field_.preview, image.settings.pixelMm,
                                               progress(converter, tracingEnd, 1.0));
  if (!errorArrays_ || !(map == errorMap_))
  {
    errorArrays_ = errorArrays(map);
    errorMap_ = map;
  }
}

void UltrasoundStages::makeImage(const ImageInput& image, std::optional<double> time, vtkDataArray* errors,
                                 vtkImageData* world, vtkImageData* flat)
{
  isImageAsked_ = true;
  const ImageResult made =
    display_.show(simulator_->image(image, progress(converter, 0.0, 1.0)), field_, time, converter->DisplaySettings());
  // All else before the picture, which may have to be waited for.
  placeImage(made, image.pose, world);
  placeFlat(made, image.pose, world, flat);
  const ScanPicture picture =
    simulator_->picture(made, image.settings.geometry, image.pose, simulator_->traced(image, {}));
  if (!pictureArrays_ || picture.grey.data != picture_.grey.data)
  {
    pictureArrays_ = pictureArrays(picture);
    picture_ = picture;
  }
  world->GetPointData()->ShallowCopy(pictureArrays_);
  if (errors)
  {
    world->GetPointData()->AddArray(errors);
  }
  fillFlat(world, flat);
}

void UltrasoundStages::make(int port, vtkInformationVector** input, vtkInformationVector* output)
{
  const Inputs inputs = inputsOf(input); // others may be connected meanwhile
  vtkDataObject* made = vtkDataObject::GetData(output, port);
  vtkFieldData* fields = made->GetFieldData();
  if (port == Filter::PROBE)
  {
    fields->Initialize();
    return fillProbe(field_, vtkPolyData::SafeDownCast(made));
  }
  const bool isImage = port == Filter::IMAGE || port == Filter::FLAT_IMAGE;
  if (left_.count(port) != 0 || (isImage && !kept_.empty() && takeKept(output)))
  {
    return;
  }
  const vtkSmartPointer<vtkMultiBlockDataSet> blocks = anatomy_->blocks(inputs[Filter::LABELS_OR_SCENE]);
  if (port == Filter::ANATOMY)
  {
    return vtkMultiBlockDataSet::SafeDownCast(made)->CompositeShallowCopy(blocks); // a hundred, which nothing changes
  }
  if (port == Filter::ERROR_MAP && !owner_->GetErrorMap())
  {
    return;
  }
  simulator_->setScene(vtkSonoSceneHandle::Get(blocks));
  const std::string played = playedKey(inputs);
  if (isImage ? takePlayed(played, output) : leavesPlayed(played, port))
  {
    return;
  }
  ImageInput image{ field_.pose, settings_, targets(inputs[Filter::TARGETS], blocks), nullptr };
  if (isImage)
  {
    takeAhead(image, progress(tracer, anatomyEnd, bmodeEnd));
  }
  simulator_->setProgressive(owner_->GetProgressive());
  // One output would otherwise be of a round that ended after another had been made, and nobody would know which.
  const bool takesBetter = std::exchange(isBetterOffered_, false) || !owner_->GetProgressive();
  isImproved_ = takesBetter && simulator_->improve();
  const TracedResult traced = trace(image);
  fields->PassData(blocks->GetFieldData());
  if (port == Filter::RAY_PATHS || port == Filter::BOUNDARY_HITS)
  {
    return tracer->GetNumberOfShownPaths() != 0
             ? makePaths(port, image, traced.layout().paths, vtkPolyData::SafeDownCast(made))
             : void();
  }
  fields->PassData(acquisition_);
  writeReached(traced.layout(), fields);
  auto* lines = vtkImageData::SafeDownCast(made);
  if (port == Filter::TRACED_LINES)
  {
    return makeLines(
      traced, tracedHandleOf, [&] { fillTraced(traced, field_, settings_.echo.samplingInMHz(), lines); }, tracedLines_,
      lines);
  }
  if (owner_->GetErrorMap())
  {
    makeErrorMap(image, traced);
  }
  if (port == Filter::ERROR_MAP)
  {
    placeImage(errorMap_, field_.pose, lines);
    return lines->GetPointData()->ShallowCopy(errorArrays_);
  }
  readEchoInputs(inputs, image);
  const RfResult rf = simulator_->rf(image, progress(formation, 0.0, bmodeEnd));
  if (port == Filter::RF_LINES)
  {
    if (rfLines_ && rfLines_->GetSpacing()[0] != shownLayout(field_.geometry, 1, rf.layout().sampleMm).sampleMm)
    {
      rfLines_ = nullptr; // the same samples, shown to another scale
    }
    return makeLines(
      rf, rfOf, [&] { fillRf(rf, field_, lines); }, rfLines_, lines);
  }
  writeGreySettings(settings_.bmode, fields);
  if (port == Filter::BMODE_LINES)
  {
    const BModeResult grey = simulator_->bmode(image, progress(bmode, 0.0, bmodeEnd));
    return makeLines(
      grey, bmodeOf, [&] { fillBMode(grey, field_, lines); }, bmodeLines_, lines);
  }
  vtkImageData* world = vtkImageData::GetData(output, Filter::IMAGE);
  if (port == Filter::FLAT_IMAGE)
  {
    world->GetFieldData()->ShallowCopy(fields);
  }
  makeImage(image, timeOf(inputs[Filter::LABELS_OR_SCENE]),
            owner_->GetErrorMap() ? errorArrays_->GetScalars() : nullptr, world,
            vtkImageData::GetData(output, Filter::FLAT_IMAGE));
  latest_ = std::move(image);
  beginNext();
  vtkNew<vtkFieldData> kept;
  kept->ShallowCopy(blocks->GetFieldData());
  writeReached(traced.layout(), kept);
  keep(kept);
  keepPlayed(played, kept);
}

} // namespace sono
