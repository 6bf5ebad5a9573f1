#include "SonoImagePlacement.h"

#include "Core/Policy.h"

#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

namespace sono {

Vec3d flatFromWorld(const Vec3d& worldMm, const ProbePose& pose)
{
  const Vec3d from = worldMm - pose.positionMm;
  return { glm::dot(from, pose.lateral), glm::dot(from, pose.axial),
           glm::dot(from, glm::cross(pose.axial, pose.lateral)) };
}

ImagePlacement::ImagePlacement(const PlaneImage& plane, const ProbePose& pose)
  : size_(plane.width, plane.height, 1)
  , pixelMm_(plane.pixelMm)
  , originMm_(pose.positionMm + plane.lateralMinMm * pose.lateral + plane.axialMinMm * pose.axial)
{
  setColumns(pose.lateral, pose.axial, glm::cross(pose.axial, pose.lateral));
}

ImagePlacement::ImagePlacement(const VolumeImage& volume, const ProbePose& pose)
  : size_(volume.size)
  , pixelMm_(volume.voxelMm)
{
  const Vec3d elevation = glm::cross(pose.axial, pose.lateral);
  originMm_ =
    pose.positionMm + volume.minMm.x * pose.lateral + volume.minMm.y * elevation + volume.minMm.z * pose.axial;
  setColumns(pose.lateral, elevation, pose.axial);
}

ImagePlacement ImagePlacement::flat(const ProbePose& pose) const
{
  ImagePlacement result = *this;
  result.originMm_ = flatFromWorld(originMm_, pose);
  if (size_.z > 1)
  {
    result.originMm_.z = 0.0;
    result.size_ = { size_.x, size_.z, 1 };
  }
  result.setColumns({ 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }, { 0.0, 0.0, 1.0 });
  return result;
}

void ImagePlacement::announce(int scalarType, vtkInformation* outInfo) const
{
  const int extent[6] = { 0, size_.x - 1, 0, size_.y - 1, 0, size_.z - 1 };
  const double spacing[3] = { pixelMm_, pixelMm_, pixelMm_ };
  outInfo->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  outInfo->Set(vtkDataObject::ORIGIN(), &originMm_.x, 3);
  outInfo->Set(vtkDataObject::SPACING(), spacing, 3);
  outInfo->Set(vtkDataObject::DIRECTION(), direction_.data(), 9);
  vtkDataObject::SetPointDataActiveScalarInfo(outInfo, scalarType, 1);
}

void ImagePlacement::place(vtkImageData* image) const
{
  image->SetDimensions(size_.x, size_.y, size_.z);
  image->SetOrigin(&originMm_.x);
  image->SetSpacing(pixelMm_, pixelMm_, pixelMm_);
  image->SetDirectionMatrix(direction_.data());
}

void ImagePlacement::setColumns(const Vec3d& x, const Vec3d& y, const Vec3d& z)
{
  for (int row = 0; row < 3; ++row)
  {
    direction_[3 * row] = x[row];
    direction_[3 * row + 1] = y[row];
    direction_[3 * row + 2] = z[row];
  }
}

void fillFlat(vtkImageData* world, vtkImageData* flat)
{
  const Vec3i size(world->GetDimensions()[0], world->GetDimensions()[1], world->GetDimensions()[2]);
  vtkPointData* from = world->GetPointData();
  vtkPointData* to = flat->GetPointData();
  if (size.z == 1)
  {
    to->ShallowCopy(from);
    return;
  }
  const vtkIdType middle = size.y / 2;
  to->Initialize();
  to->CopyAllOn();
  to->CopyAllocate(from, vtkIdType(size.x) * size.z);
  for (vtkIdType k = 0; k < size.z; ++k)
  {
    to->CopyData(from, k * size.x, size.x, size.x * (middle + size.y * k));
  }
}

double pixelMmOf(const ProbeField& probe, double settingMm)
{
  const double pixelMm = probe.geometry.isVolume() ? voxelMmThatFits(probe.geometry, settingMm) : settingMm;
  return probe.coarse ? interactivePixelMm(pixelMm) : pixelMm;
}

ImagePlacement placementOf(const ProbeField& probe, double pixelMm)
{
  if (probe.geometry.isVolume())
  {
    return { volumeImageLayout(probe.geometry, pixelMm), probe.pose };
  }
  return { planeImageLayout(probe.geometry, pixelMm), probe.pose };
}

} // namespace sono
