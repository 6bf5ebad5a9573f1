#include "vtkSonoSweep.h"

#include "ChestDefaults.h"
#include "Core/ParallelFor.h"
#include "Simulator.h"
#include "SonoAnatomy.h"
#include "SonoImageSettings.h"
#include "SonoLabelImage.h"
#include "SonoPoses.h"
#include "SonoProbeField.h"
#include "SonoStage.h"
#include "Trace/TraceDevice.h"
#include "vtkSonoBMode.h"
#include "vtkSonoImageFormation.h"
#include "vtkSonoRayTracer.h"
#include "vtkSonoSceneBuilder.h"
#include "vtkSonoSceneHandle.h"

#include "vtkAlgorithmOutput.h"
#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedShortArray.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

vtkStandardNewMacro(vtkSonoSweep);

namespace {

enum InputPorts
{
  LABELS_OR_SCENE = 0,
  PROBE = 1,
  POSES = 2
};

/// The array of the run before, where nobody else holds it any more: to give its pages back and take fresh ones costs
/// as much as several images.
template<class Array>
void renew(const char* name, std::size_t count, vtkSmartPointer<Array>& array)
{
  if (!array || array->GetReferenceCount() > 1)
  {
    array = vtkSmartPointer<Array>::New();
    array->SetName(name);
  }
  array->SetNumberOfValues(static_cast<vtkIdType>(count));
  array->Modified();
}

// The progress's end of the anatomy, where it is built here.
constexpr double anatomyEnd = 0.3;

/// The probe stands wherever a pose says, and never moves.
sono::ProbeField resting(sono::ProbeField probe)
{
  probe.preview = probe.coarse = false;
  probe.prepares = false;
  return probe;
}

std::unique_ptr<sono::Anatomy> anatomyOf(vtkSonoSweep* sweep, vtkSonoSceneBuilder* builder)
{
  return std::make_unique<sono::Anatomy>(sweep, builder, anatomyEnd,
                                         [sweep](const std::string& sentence) { sono::warn(sweep, sentence); });
}

} // namespace

vtkSonoSweep::vtkSonoSweep()
  : SceneBuilder(vtkSmartPointer<vtkSonoSceneBuilder>::New())
  , RayTracer(vtkSmartPointer<vtkSonoRayTracer>::New())
  , ImageFormation(vtkSmartPointer<vtkSonoImageFormation>::New())
  , BMode(vtkSmartPointer<vtkSonoBMode>::New())
  , Anatomy(anatomyOf(this, this->SceneBuilder))
  , Simulator(new sono::Simulator)
{
  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(2);
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS,
                               vtkDataSetAttributes::AttributeTypes::SCALARS);
  this->SetProgressText("Sweeping");
  sono::TraceSettings tracing;
  sono::BModeSettings grey;
  sono::setChestDefaults(tracing);
  sono::setChestDefaults(grey);
  this->RayTracer->SetMaxCollisions(tracing.maxCollisions);
  this->RayTracer->SetCoherenceMm(tracing.coherenceMm);
  this->RayTracer->SetLobeSigmaDeg(tracing.lobeSigmaDeg);
  this->BMode->SetTgcDbPerCm(grey.tgcDbPerCm);
  this->HideSurfaces();
}

vtkSonoSweep::~vtkSonoSweep() = default;

void vtkSonoSweep::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  for (vtkAlgorithm* stage :
       std::initializer_list<vtkAlgorithm*>{ this->SceneBuilder, this->RayTracer, this->ImageFormation, this->BMode })
  {
    os << indent << stage->GetClassName() << ":" << endl;
    stage->PrintSelf(os, indent.GetNextIndent());
  }
  os << indent << "PixelMm: " << this->PixelMm << endl;
  os << indent << "WithLabels: " << this->WithLabels << endl;
}

#define sonoStage(type, name)                                                                                          \
  void vtkSonoSweep::Set##name(type* stage)                                                                            \
  {                                                                                                                    \
    if (stage && stage != this->name)                                                                                  \
    {                                                                                                                  \
      this->name = stage;                                                                                              \
      this->Modified();                                                                                                \
    }                                                                                                                  \
  }                                                                                                                    \
  type* vtkSonoSweep::Get##name()                                                                                      \
  {                                                                                                                    \
    return this->name;                                                                                                 \
  }
sonoStage(vtkSonoRayTracer, RayTracer);
sonoStage(vtkSonoImageFormation, ImageFormation);
sonoStage(vtkSonoBMode, BMode);
#undef sonoStage

void vtkSonoSweep::SetSceneBuilder(vtkSonoSceneBuilder* stage)
{
  if (stage && stage != this->SceneBuilder)
  {
    this->SceneBuilder = stage;
    this->HideSurfaces();
    this->Anatomy = anatomyOf(this, stage);
    this->Modified();
  }
}

void vtkSonoSweep::HideSurfaces()
{
  this->SceneBuilder->SetBuildSurfaces(false); // nobody sees them
}

vtkSonoSceneBuilder* vtkSonoSweep::GetSceneBuilder()
{
  return this->SceneBuilder;
}

vtkMTimeType vtkSonoSweep::GetMTime()
{
  vtkMTimeType time = this->Superclass::GetMTime();
  for (vtkAlgorithm* stage :
       std::initializer_list<vtkAlgorithm*>{ this->SceneBuilder, this->RayTracer, this->ImageFormation, this->BMode })
  {
    time = std::max(time, stage->GetMTime());
  }
  return time;
}

int vtkSonoSweep::FillInputPortInformation(int port, vtkInformation* info)
{
  const auto type = vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE();
  switch (port)
  {
    case LABELS_OR_SCENE:
      // The composite one first: the pipeline would otherwise hand a scene over block by block.
      info->Set(type, "vtkMultiBlockDataSet");
      info->Append(type, "vtkImageData");
      break;
    case PROBE:
      info->Set(type, "vtkPolyData");
      break;
    default:
      info->Set(type, "vtkPointSet");
      info->Append(type, "vtkTable");
  }
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1); // so that one clear sentence says what is missing
  return 1;
}

int vtkSonoSweep::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : "vtkTable");
  return 1;
}

int vtkSonoSweep::RequestInformation(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    sono::requireConnected(input[LABELS_OR_SCENE], "No label map is connected; set the filter's Input.");
    sono::requireConnected(input[PROBE], "No probe is connected; give an Ultrasound Probe.");
    const sono::ProbeField probe = sono::readProbe(sono::announcedFields(input[PROBE]->GetInformationObject(0)));
    const sono::PlaneImage layout = sono::planeImageLayout(probe.geometry, this->PixelMm);
    // How many images there are is known from the poses alone.
    if (vtkAlgorithmOutput* poses = this->GetInputConnection(POSES, 0))
    {
      poses->GetProducer()->Update(poses->GetIndex());
    }
    const int count = static_cast<int>(sono::posesOf(vtkDataObject::GetData(input[POSES])).size());
    vtkInformation* outInfo = output->GetInformationObject(0);
    const int extent[6] = { 0, layout.width - 1, 0, layout.height - 1, 0, count - 1 };
    const double origin[3] = { layout.lateralMinMm, layout.axialMinMm, 0.0 };
    const double spacing[3] = { layout.pixelMm, layout.pixelMm, 1.0 };
    outInfo->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
    outInfo->Set(vtkDataObject::ORIGIN(), origin, 3);
    outInfo->Set(vtkDataObject::SPACING(), spacing, 3);
    vtkDataObject::SetPointDataActiveScalarInfo(outInfo, VTK_UNSIGNED_CHAR, 1);
  });
}

int vtkSonoSweep::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  const bool isImage = vtkImageData::GetData(input[LABELS_OR_SCENE]) != nullptr;
  return isImage ? sono::requestWholeImage(input) : 1;
}

int vtkSonoSweep::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    const sono::ProbeField probe = resting(sono::readProbe(vtkPolyData::GetData(input[PROBE])->GetFieldData()));
    const std::vector<sono::ProbePose> poses = sono::posesOf(vtkDataObject::GetData(input[POSES]));
    sono::ImageSettings settings =
      sono::imageSettings(probe, *this->RayTracer, *this->ImageFormation, *this->BMode, this->PixelMm);
    settings.echo.pulse = this->ImageFormation->ReadPulse();
    sono::announceDevice(sono::chooseDevice(settings.tracing));
    vtkDataObject* anatomy = vtkDataObject::GetData(input[LABELS_OR_SCENE]);
    const double begin = vtkImageData::SafeDownCast(anatomy) ? anatomyEnd : 0.0;
    const auto scene = vtkSonoSceneHandle::Get(this->Anatomy->blocks(anatomy));
    this->Simulator->setScene(scene);

    const sono::PlaneImage layout = sono::planeImageLayout(settings.geometry, settings.pixelMm);
    const std::size_t pixels = std::size_t(layout.width) * layout.height;
    vtkImageData* images = vtkImageData::GetData(output, 0);
    images->GetPointData()->Initialize(); // VTK keeps the scalars of the run before
    renew("BMode", pixels * poses.size(), this->Grey);
    renew("Mask", pixels * poses.size(), this->Mask);
    if (this->WithLabels)
    {
      renew("Labels", pixels * poses.size(), this->Labels);
    }
    const auto take = [&](const sono::SweptPictures& pictures) {
      // In parallel: fresh memory costs more than what is copied into it.
      sono::parallelFor(pictures.count, {}, [&](int n) {
        const std::size_t from = std::size_t(n) * pixels;
        const auto to = static_cast<vtkIdType>((std::size_t(pictures.firstPose) + n) * pixels);
        std::copy_n(pictures.grey + from, pixels, this->Grey->GetPointer(to));
        if (this->WithLabels)
        {
          std::copy_n(pictures.labels + from, pixels, this->Labels->GetPointer(to));
        }
      });
      if (pictures.firstPose == 0) // all at once, while a GPU is at work on the others
      {
        sono::fillPoses(poses, vtkTable::GetData(output, 1));
        sono::parallelFor(static_cast<int>(poses.size()), {}, [&](int n) {
          std::copy_n(pictures.mask, pixels, this->Mask->GetPointer(static_cast<vtkIdType>(n * pixels)));
        });
      }
    };
    this->Simulator->sweep(poses, settings, this->WithLabels, take, sono::partOf(sono::progressOf(this), begin, 1.0));

    images->SetDimensions(layout.width, layout.height, static_cast<int>(poses.size()));
    images->SetOrigin(layout.lateralMinMm, layout.axialMinMm, 0.0);
    images->SetSpacing(layout.pixelMm, layout.pixelMm, 1.0);
    sono::writeProbe(probe, images->GetFieldData());
    sono::writePoses(poses, images->GetFieldData());
    images->GetPointData()->SetScalars(this->Grey);
    images->GetPointData()->AddArray(this->Mask);
    if (this->WithLabels)
    {
      images->GetPointData()->AddArray(this->Labels);
      sono::writeLabelTable(scene->volume().labels, images->GetFieldData());
    }
  });
}
