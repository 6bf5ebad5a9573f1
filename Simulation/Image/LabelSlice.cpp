#include "Image/LabelSlice.h"

#include "Core/ParallelFor.h"

#include <cmath>

namespace sono {

namespace {

/// A row of pixels that starts at `start` and goes on by `step`, both as voxel indices.
void sliceRow(const LabelVolume& labels, const Vec3d& start, const Vec3d& step, int count, const std::uint8_t* mask,
              std::uint16_t* out)
{
  const Vec3i size = labels.placement.size;
  for (int n = 0; n < count; ++n)
  {
    const Vec3d voxel = glm::floor(start + double(n) * step + 0.5);
    const bool inside =
      voxel.x >= 0.0 && voxel.x < size.x && voxel.y >= 0.0 && voxel.y < size.y && voxel.z >= 0.0 && voxel.z < size.z;
    if (mask[n] && inside)
    {
      const std::size_t plane = std::size_t(voxel.z) * std::size_t(size.y) + std::size_t(voxel.y);
      out[n] = labels.voxels[plane * std::size_t(size.x) + std::size_t(voxel.x)];
    }
  }
}

/// Rows along the lateral axis, numbered over elevation and depth; minMm is (lateral, elevational, axial).
std::vector<std::uint16_t> slice(const LabelVolume& labels, const ProbePose& pose, const Vec3i& size,
                                 const Vec3d& minMm, double stepMm, const std::vector<std::uint8_t>& mask)
{
  const Vec3d elevation = glm::cross(pose.axial, pose.lateral);
  const auto indexAt = [&](const Vec3d& p) {
    return labels.placement.indexFromWorld(pose.positionMm + p.x * pose.lateral + p.y * elevation + p.z * pose.axial);
  };
  std::vector<std::uint16_t> out(mask.size(), 0);
  parallelFor(size.y * size.z, {}, [&](int row) {
    const Vec3d first = minMm + stepMm * Vec3d(0.0, row % size.y, row / size.y);
    const Vec3d start = indexAt(first);
    const Vec3d step = indexAt(first + Vec3d(stepMm, 0.0, 0.0)) - start;
    const std::size_t at = std::size_t(row) * std::size_t(size.x);
    sliceRow(labels, start, step, size.x, mask.data() + at, out.data() + at);
  });
  return out;
}

} // namespace

std::vector<std::uint16_t> sliceLabels(const LabelVolume& labels, const ProbePose& pose, const PlaneImage& image)
{
  return slice(labels, pose, { image.width, 1, image.height }, { image.lateralMinMm, 0.0, image.axialMinMm },
               image.pixelMm, image.mask);
}

std::vector<std::uint16_t> sliceLabels(const LabelVolume& labels, const ProbePose& pose, const VolumeImage& image)
{
  return slice(labels, pose, image.size, image.minMm, image.voxelMm, image.mask);
}

} // namespace sono
