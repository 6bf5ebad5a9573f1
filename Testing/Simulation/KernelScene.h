#pragma once

#include "Kernel/TracePath.h"
#include "Scene/TraceRegion.h"

#include <functional>
#include <utility>
#include <vector>

namespace sono::test {

/// The tracer's kernels on a volume of their own, without a Scene: medium i belongs to label i.
struct KernelScene
{
  Vec3i size;
  Vec3d spacing;
  std::vector<std::uint8_t> voxels;
  TraceRegion region;
  std::vector<TraceMedium> media;
  TraceView view;

  /// `labelAt` takes the position of a voxel's centre, mm from the volume's outer corner.
  KernelScene(const Vec3i& voxelCount, const Vec3d& spacingMm, std::vector<TraceMedium> mediaOfLabels,
              const std::function<int(const Vec3d&)>& labelAt)
    : size(voxelCount)
    , spacing(spacingMm)
    , media(std::move(mediaOfLabels))
  {
    voxels.reserve(std::size_t(size.x) * size.y * size.z);
    for (int k = 0; k < size.z; ++k)
    {
      for (int j = 0; j < size.y; ++j)
      {
        for (int i = 0; i < size.x; ++i)
        {
          voxels.push_back(std::uint8_t(labelAt((Vec3d(i, j, k) + 0.5) * spacing)));
        }
      }
    }
    region = buildTraceRegion(voxels.data(), size, spacing, VoxelBox{ Vec3i(0), size });
    view.media = media.data();
    view.firstTargetMedium = int(media.size());
    view.rouletteIntensity = 0.0f;
    view.depthMm = 1000.0f;
  }
  KernelScene(const KernelScene&) = delete;
  KernelScene& operator=(const KernelScene&) = delete;

  CellSpace<NoTargets> space() const { return { region.view(), {} }; }
  Vec3d extent() const { return Vec3d(size) * spacing; }
};

/// Takes nothing.
using NullSink = PathSink;

inline TraceMedium makeMedium(float impedance, float speed)
{
  TraceMedium m;
  m.impedance = impedance;
  m.speed = speed;
  return m;
}

} // namespace sono::test
