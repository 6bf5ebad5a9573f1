#include "Phantoms/PhantomVolume.h"

#include "Core/ParallelFor.h"
#include "Core/Require.h"

#include <glm/common.hpp>

namespace sono {

LabelVolume makePhantomVolume(const Vec3d& extentMm, double spacingMm, const std::vector<std::string>& tissues,
                              const std::function<int(const Vec3d&)>& labelAt)
{
  requireInRange(spacingMm >= 0.1 && spacingMm <= 5.0, "voxel size of the phantom (mm)", spacingMm, "0.1 to 5");
  LabelVolume volume;
  GridPlacement& grid = volume.placement;
  grid.size = Vec3i(glm::max(glm::round(extentMm / spacingMm), Vec3d(1.0)));
  grid.spacingMm = Vec3d(spacingMm);
  grid.originMm = Vec3d(-0.5 * (grid.size.x - 1), -0.5 * (grid.size.y - 1), 0.5) * spacingMm;
  if (double(grid.size.x) * grid.size.y * grid.size.z > 4e8)
  {
    throw Error("the phantom would have more than 400 million voxels: choose larger voxels or a thinner block");
  }
  volume.voxels.resize(grid.voxelCount());
  const std::size_t slice = std::size_t(grid.size.x) * std::size_t(grid.size.y);
  parallelFor(grid.size.z, {}, [&](int k) {
    std::uint16_t* voxel = volume.voxels.data() + slice * std::size_t(k);
    for (int j = 0; j < grid.size.y; ++j)
    {
      for (int i = 0; i < grid.size.x; ++i)
      {
        *voxel++ = std::uint16_t(labelAt(grid.worldFromIndex(Vec3d(i, j, k))) + 1);
      }
    }
  });
  for (std::size_t i = 0; i < tissues.size(); ++i)
  {
    LabelInfo label;
    label.id = int(i) + 1;
    label.name = tissues[i];
    volume.labels.push_back(label);
  }
  volume.collectLabels();
  return volume;
}

} // namespace sono
