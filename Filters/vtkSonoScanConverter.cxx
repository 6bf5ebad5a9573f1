#include "vtkSonoScanConverter.h"

#include "Image/LabelSlice.h"
#include "Scene/Scene.h"
#include "Simulator.h"
#include "SonoDisplay.h"
#include "SonoImagePlacement.h"
#include "SonoLabelImage.h"
#include "SonoLineImage.h"
#include "SonoOutputs.h"
#include "SonoProbeField.h"
#include "SonoSettings.h"
#include "SonoStage.h"
#include "vtkSonoSceneHandle.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"

#include <utility>

vtkStandardNewMacro(vtkSonoScanConverter);

namespace {

/// That was traced; null where the data lost it, as in files.
std::shared_ptr<const sono::Scene> sceneOf(vtkFieldData* field)
{
  for (int i = 0; i < field->GetNumberOfArrays(); ++i)
  {
    if (vtkSonoSceneHandle::SafeDownCast(field->GetAbstractArray(i)))
    {
      return vtkSonoSceneHandle::Get(field);
    }
  }
  return nullptr;
}

} // namespace

vtkSonoScanConverter::vtkSonoScanConverter()
  : Parameters(new sono::SettingsOf<sono::DisplaySettings>)
  , Simulator(new sono::Simulator)
  , Display(new sono::Display)
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
  this->SetProgressText("Placing the image");
}

vtkSonoScanConverter::~vtkSonoScanConverter() = default;

void vtkSonoScanConverter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "PixelMm: " << this->PixelMm << endl;
  this->Parameters->print(os, indent);
}

const sono::DisplaySettings& vtkSonoScanConverter::DisplaySettings() const
{
  return sono::settingsIn<sono::DisplaySettings>(std::as_const(*this->Parameters));
}

int vtkSonoScanConverter::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

std::shared_ptr<const sono::LabelVolume> vtkSonoScanConverter::ConnectedLabels(vtkImageData* image)
{
  if (!image)
  {
    this->Labels.reset();
  }
  else if (!this->Labels || this->LabelsTime != image->GetMTime())
  {
    this->Labels =
      std::make_shared<const sono::LabelVolume>(sono::labelVolumeFromImage(image, image->GetPointData()->GetScalars()));
    this->LabelsTime = image->GetMTime();
  }
  return this->Labels;
}

int vtkSonoScanConverter::RequestInformation(vtkInformation*, vtkInformationVector** input,
                                             vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    vtkFieldData* acquisition = sono::announcedFields(input[0]->GetInformationObject(0));
    const sono::ProbeField probe = sono::readProbe(acquisition);
    const sono::ImagePlacement placement = sono::placementOf(probe, sono::pixelMmOf(probe, this->PixelMm));
    placement.announce(VTK_UNSIGNED_CHAR, output->GetInformationObject(0));
    placement.flat(probe.pose).announce(VTK_UNSIGNED_CHAR, output->GetInformationObject(1));
    for (int port : { 0, 1 })
    {
      sono::announceSameFields(input[0]->GetInformationObject(0), output->GetInformationObject(port));
    }
  });
}

int vtkSonoScanConverter::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  sono::requestWholeImage(input, 1);
  return sono::requestWholeImage(input);
}

int vtkSonoScanConverter::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    vtkImageData* lines = vtkImageData::GetData(input[0]);
    const sono::ProbeField probe = sono::readProbe(lines->GetFieldData());
    const sono::LineImageLayout layout = sono::lineImageLayout(lines, probe.geometry.totalLineCount());
    sono::BModeResult bmode = sono::bmodeOf(lines);
    if (!bmode)
    {
      bmode = sono::BModeResult(
        { layout.lineCount, layout.sampleCount, sono::rangeSampleMm(probe.geometry, layout), 0.0,
          sono::lineValues("BMode", lines->GetPointData(), std::size_t(layout.lineCount) * layout.sampleCount) });
    }
    const auto connected = this->ConnectedLabels(vtkImageData::GetData(input[1]));
    const auto scene = sceneOf(lines->GetFieldData());
    this->Simulator->setScene(scene);
    const double pixelMm = sono::pixelMmOf(probe, this->PixelMm);
    const sono::ImageResult image =
      this->Display->show(this->Simulator->scanConvert(probe.geometry, bmode, pixelMm, sono::progressOf(this)), probe,
                          sono::timeOf(lines), this->DisplaySettings());
    // All else before the picture, which may have to be waited for.
    vtkImageData* world = vtkImageData::GetData(output, 0);
    vtkImageData* flat = vtkImageData::GetData(output, 1);
    if (connected || scene)
    {
      sono::writeLabelTable(connected ? connected->labels : scene->volume().labels, world->GetFieldData());
    }
    sono::placeImage(image, probe.pose, world);
    sono::placeFlat(image, probe.pose, world, flat);
    sono::ScanPicture picture = this->Simulator->picture(image);
    if (const auto labels = connected ? connected
                            : scene   ? std::shared_ptr<const sono::LabelVolume>(scene, &scene->volume())
                                      : nullptr)
    {
      const sono::TracedLines traced = sono::rangeArraysOf(lines, layout.lineCount);
      const sono::DepthOffsets offsets{ &traced.depthOffsetMm, traced.binCount, traced.binMm };
      picture.labels = sono::SharedSpan<std::uint16_t>(
        image.isVolume() ? sono::sliceLabels(*labels, probe.geometry, probe.pose, image.volume(), offsets)
                         : sono::sliceLabels(*labels, probe.geometry, probe.pose, image.plane().host(), offsets));
    }
    const auto arrays = sono::pictureArrays(picture);
    world->GetPointData()->ShallowCopy(arrays);
    sono::fillFlat(world, flat);
  });
}
