#include "vtkSonoScanConverter.h"

#include "Image/LabelSlice.h"
#include "Image/ScanConvert.h"
#include "Image/ScanConvertVolume.h"
#include "Scene/Scene.h"
#include "SonoImagePlacement.h"
#include "SonoLabelImage.h"
#include "SonoLineImage.h"
#include "SonoProbeField.h"
#include "SonoStage.h"
#include "vtkSonoSceneHandle.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedShortArray.h"

#include <algorithm>
#include <cmath>

vtkStandardNewMacro(vtkSonoScanConverter);

namespace {

template<class Array, class Values, class Change>
void addArray(const char* name, const Values& values, vtkPointData* arrays, const Change& change)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
  std::transform(values.begin(), values.end(), array->GetPointer(0), change);
  arrays->AddArray(array);
}

/// Of the scene that was traced; null where the data lost it, as in files.
std::shared_ptr<const sono::LabelVolume> sceneLabels(vtkFieldData* field)
{
  for (int i = 0; i < field->GetNumberOfArrays(); ++i)
  {
    if (vtkSonoSceneHandle::SafeDownCast(field->GetAbstractArray(i)))
    {
      const auto scene = vtkSonoSceneHandle::Get(field);
      return { scene, &scene->volume() };
    }
  }
  return nullptr;
}

/// A plane or a volume, and the labels there.
template<class Converted>
void fillImage(const Converted& converted, const sono::ProbePose& pose, const sono::LabelVolume* labels,
               vtkImageData* image, vtkImageData* flat)
{
  const sono::ImagePlacement placement(converted, pose);
  placement.place(image);
  vtkPointData* arrays = image->GetPointData();
  // From 1 on, so that a colour map can leave out what was not scanned and still show black.
  addArray<vtkUnsignedCharArray>("BMode", converted.value, arrays, [](float value) {
    return static_cast<unsigned char>(std::max(1L, std::lround(255.0f * std::clamp(value, 0.0f, 1.0f))));
  });
  auto* grey = vtkUnsignedCharArray::SafeDownCast(arrays->GetArray("BMode"));
  for (std::size_t i = 0; i < converted.mask.size(); ++i)
  {
    if (!converted.mask[i])
    {
      grey->SetValue(static_cast<vtkIdType>(i), 0);
    }
  }
  arrays->SetActiveScalars("BMode");
  addArray<vtkUnsignedCharArray>("Mask", converted.mask, arrays, [](std::uint8_t inside) { return inside; });
  if (labels)
  {
    addArray<vtkUnsignedShortArray>("Labels", sono::sliceLabels(*labels, pose, converted), arrays,
                                    [](std::uint16_t label) { return label; });
    sono::writeLabelTable(labels->labels, image->GetFieldData());
  }
  flat->ShallowCopy(image);
  placement.flat(pose).place(flat);
}

} // namespace

vtkSonoScanConverter::vtkSonoScanConverter()
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
      sono::announceFields(acquisition, output->GetInformationObject(port));
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
    const std::vector<float> grey =
      sono::lineValues("BMode", lines->GetPointData(), std::size_t(layout.lineCount) * layout.sampleCount);
    auto labels = this->ConnectedLabels(vtkImageData::GetData(input[1]));
    if (!labels)
    {
      labels = sceneLabels(lines->GetFieldData());
    }
    const double pixelMm = sono::pixelMmOf(probe, this->PixelMm);
    const auto fill = [&](const auto& converted) {
      fillImage(converted, probe.pose, labels.get(), vtkImageData::GetData(output, 0),
                vtkImageData::GetData(output, 1));
    };
    if (probe.geometry.isVolume())
    {
      fill(sono::scanConvertVolume(probe.geometry, grey, layout.sampleCount, layout.sampleMm, pixelMm,
                                   sono::progressOf(this)));
    }
    else
    {
      fill(sono::scanConvert(probe.geometry, grey, layout.sampleCount, layout.sampleMm, pixelMm));
    }
  });
}
