#include "vtkSonoScanConverter.h"

#include "Image/LabelSlice.h"
#include "Image/ScanConvert.h"
#include "Image/ScanConvertVolume.h"
#include "Scene/Scene.h"
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
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedShortArray.h"

#include <algorithm>
#include <array>
#include <cmath>

vtkStandardNewMacro(vtkSonoScanConverter);

namespace {

/// Where an image lies in the world.
struct Placement
{
  Placement(const sono::PlaneImage& plane, const sono::ProbePose& pose)
    : size(plane.width, plane.height, 1)
    , pixelMm(plane.pixelMm)
    , originMm(pose.positionMm + plane.lateralMinMm * pose.lateral + plane.axialMinMm * pose.axial)
  {
    setColumns(pose.lateral, pose.axial, glm::cross(pose.axial, pose.lateral));
  }

  Placement(const sono::VolumeImage& volume, const sono::ProbePose& pose)
    : size(volume.size)
    , pixelMm(volume.voxelMm)
  {
    const sono::Vec3d elevation = glm::cross(pose.axial, pose.lateral);
    originMm =
      pose.positionMm + volume.minMm.x * pose.lateral + volume.minMm.y * elevation + volume.minMm.z * pose.axial;
    setColumns(pose.lateral, elevation, pose.axial);
  }

  void announce(vtkInformation* outInfo) const
  {
    const int extent[6] = { 0, size.x - 1, 0, size.y - 1, 0, size.z - 1 };
    const double spacing[3] = { pixelMm, pixelMm, pixelMm };
    outInfo->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
    outInfo->Set(vtkDataObject::ORIGIN(), &originMm.x, 3);
    outInfo->Set(vtkDataObject::SPACING(), spacing, 3);
    outInfo->Set(vtkDataObject::DIRECTION(), direction.data(), 9);
    vtkDataObject::SetPointDataActiveScalarInfo(outInfo, VTK_UNSIGNED_CHAR, 1);
  }

  void place(vtkImageData* image) const
  {
    image->SetDimensions(size.x, size.y, size.z);
    image->SetOrigin(&originMm.x);
    image->SetSpacing(pixelMm, pixelMm, pixelMm);
    image->SetDirectionMatrix(direction.data());
  }

private:
  void setColumns(const sono::Vec3d& x, const sono::Vec3d& y, const sono::Vec3d& z)
  {
    for (int row = 0; row < 3; ++row)
    {
      direction[3 * row] = x[row];
      direction[3 * row + 1] = y[row];
      direction[3 * row + 2] = z[row];
    }
  }

  sono::Vec3i size;
  double pixelMm;
  sono::Vec3d originMm;
  std::array<double, 9> direction{}; // row-major
};

Placement placementOf(const sono::ProbeField& probe, double pixelMm)
{
  if (probe.geometry.kind == sono::ScanKind::Matrix)
  {
    return { sono::volumeImageLayout(probe.geometry, pixelMm), probe.pose };
  }
  return { sono::planeImageLayout(probe.geometry, pixelMm), probe.pose };
}

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
               vtkImageData* image)
{
  Placement(converted, pose).place(image);
  vtkPointData* arrays = image->GetPointData();
  addArray<vtkUnsignedCharArray>("BMode", converted.value, arrays, [](float value) {
    return static_cast<unsigned char>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
  });
  arrays->SetActiveScalars("BMode");
  addArray<vtkUnsignedCharArray>("Mask", converted.mask, arrays, [](std::uint8_t inside) { return inside; });
  if (labels)
  {
    addArray<vtkUnsignedShortArray>("Labels", sono::sliceLabels(*labels, pose, converted), arrays,
                                    [](std::uint16_t label) { return label; });
    sono::writeLabelTable(labels->labels, image->GetFieldData());
  }
}

} // namespace

vtkSonoScanConverter::vtkSonoScanConverter()
{
  this->SetNumberOfInputPorts(2);
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
    vtkInformation* outInfo = output->GetInformationObject(0);
    placementOf(sono::readProbe(acquisition), this->PixelMm).announce(outInfo);
    sono::announceFields(acquisition, outInfo);
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
    const auto fill = [&](const auto& converted) {
      fillImage(converted, probe.pose, labels.get(), vtkImageData::GetData(output));
    };
    if (probe.geometry.kind == sono::ScanKind::Matrix)
    {
      fill(sono::scanConvertVolume(probe.geometry, grey, layout.sampleCount, layout.sampleMm, this->PixelMm,
                                   sono::progressOf(this)));
    }
    else
    {
      fill(sono::scanConvert(probe.geometry, grey, layout.sampleCount, layout.sampleMm, this->PixelMm));
    }
  });
}
