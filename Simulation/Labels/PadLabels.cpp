#include "Labels/PadLabels.h"

#include "Core/ParallelFor.h"

#include <glm/common.hpp>

#include <cmath>

namespace sono {

namespace {

std::size_t indexOf(const Vec3i& size, const Vec3i& v)
{
  return (std::size_t(v.z) * size.y + v.y) * size.x + v.x;
}

bool isOfOneLabel(const LabelVolume& volume, int axis, bool last)
{
  const Vec3i& size = volume.placement.size;
  Vec3i v(0);
  v[axis] = last ? size[axis] - 1 : 0;
  const std::uint16_t label = volume.voxels[indexOf(size, v)];
  const int b = (axis + 1) % 3;
  const int c = (axis + 2) % 3;
  for (v[c] = 0; v[c] < size[c]; ++v[c])
  {
    for (v[b] = 0; v[b] < size[b]; ++v[b])
    {
      if (volume.voxels[indexOf(size, v)] != label)
      {
        return false;
      }
    }
  }
  return true;
}

} // namespace

Padding padding(const LabelVolume& volume, double mm)
{
  Padding pad;
  pad.placement = volume.placement;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int voxels = int(std::ceil(mm / volume.placement.spacingMm[axis]));
    pad.before[axis] = isOfOneLabel(volume, axis, false) ? voxels : 0;
    pad.placement.size[axis] += pad.before[axis] + (isOfOneLabel(volume, axis, true) ? voxels : 0);
  }
  pad.placement.originMm = volume.placement.worldFromIndex(-Vec3d(pad.before));
  return pad;
}

LabelVolume padded(const LabelVolume& volume, double mm)
{
  const Padding pad = padding(volume, mm);
  const Vec3i from = volume.placement.size;
  const Vec3i size = pad.placement.size;
  LabelVolume out;
  out.placement = pad.placement;
  out.labels = volume.labels;
  out.notice = volume.notice;
  out.voxels.resize(out.placement.voxelCount());
  parallelFor(size.z, {}, [&](int k) {
    std::uint16_t* voxel = out.voxels.data() + std::size_t(k) * size.x * size.y;
    for (int j = 0; j < size.y; ++j)
    {
      for (int i = 0; i < size.x; ++i)
      {
        *voxel++ = volume.voxels[indexOf(from, glm::clamp(Vec3i(i, j, k) - pad.before, Vec3i(0), from - 1))];
      }
    }
  });
  return out;
}

} // namespace sono
