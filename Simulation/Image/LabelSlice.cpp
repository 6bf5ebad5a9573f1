#include "Image/LabelSlice.h"

#include "Core/ParallelFor.h"

namespace sono {

namespace {

/// Rows along the lateral axis, numbered over elevation and depth; minMm is (lateral, elevational, axial).
std::vector<LabelRow> rowsOf(const LabelVolume& labels, const ProbePose& pose, const Vec3i& size, const Vec3d& minMm,
                             double stepMm)
{
  const Vec3d elevation = glm::cross(pose.axial, pose.lateral);
  const auto indexAt = [&](const Vec3d& p) {
    return labels.placement.indexFromWorld(pose.positionMm + p.x * pose.lateral + p.y * elevation + p.z * pose.axial);
  };
  std::vector<LabelRow> rows(std::size_t(size.y) * std::size_t(size.z));
  for (int row = 0; row < size.y * size.z; ++row)
  {
    const Vec3d first = minMm + stepMm * Vec3d(0.0, row % size.y, row / size.y);
    const Vec3d start = indexAt(first);
    rows[std::size_t(row)] = { start, indexAt(first + Vec3d(stepMm, 0.0, 0.0)) - start };
  }
  return rows;
}

std::vector<std::uint16_t> slice(const LabelVolume& labels, const std::vector<LabelRow>& rows, int width,
                                 const std::vector<std::uint8_t>& mask)
{
  std::vector<std::uint16_t> out(mask.size(), 0);
  parallelFor(int(rows.size()), {}, [&](int row) {
    const std::size_t at = std::size_t(row) * std::size_t(width);
    for (int n = 0; n < width; ++n)
    {
      if (mask[at + std::size_t(n)])
      {
        out[at + std::size_t(n)] = labelAt(rows[std::size_t(row)], n, labels.voxels.data(), labels.placement.size);
      }
    }
  });
  return out;
}

} // namespace

std::vector<LabelRow> labelRows(const LabelVolume& labels, const ProbePose& pose, const PlaneImage& layout)
{
  return rowsOf(labels, pose, { layout.width, 1, layout.height }, { layout.lateralMinMm, 0.0, layout.axialMinMm },
                layout.pixelMm);
}

std::vector<std::uint16_t> sliceLabels(const LabelVolume& labels, const ProbePose& pose, const PlaneImage& image)
{
  return slice(labels, labelRows(labels, pose, image), image.width, image.mask);
}

std::vector<std::uint16_t> sliceLabels(const LabelVolume& labels, const ProbePose& pose, const VolumeImage& image)
{
  return slice(labels, rowsOf(labels, pose, image.size, image.minMm, image.voxelMm), image.size.x, image.mask);
}

} // namespace sono
