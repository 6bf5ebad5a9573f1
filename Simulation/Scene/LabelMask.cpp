#include "Scene/LabelMask.h"

#include "Core/ParallelFor.h"
#include "Scene/GridTransform.h"
#include "Scene/NanoConvert.h"
#include "Scene/NanoGridStorage.h"
#include "Scene/OpenGrids.h"

#include <openvdb/tools/Prune.h>

#include <algorithm>

namespace sono {

namespace {

/// Calls visit(voxels, position) for every voxel of a block that carries the label; returns how many.
template<class Visit>
int forLabelInBlock(const LabelVolume& volume, int labelId, const Vec3i& origin, const Visit& visit)
{
  const Vec3i n = volume.placement.size;
  const Vec3i extent = glm::min(Vec3i(leafEdge), n - origin);
  int found = 0;
  for (int z = 0; z < extent.z; ++z)
  {
    for (int y = 0; y < extent.y; ++y)
    {
      const std::size_t row = std::size_t(n.y) * (origin.z + z) + std::size_t(origin.y + y);
      const std::uint16_t* at = volume.voxels.data() + std::size_t(n.x) * row + origin.x;
      for (int x = 0; x < extent.x; ++x)
      {
        if (at[x] == labelId)
        {
          ++found;
          visit(Vec3i(x, y, z));
        }
      }
    }
  }
  return found;
}

} // namespace

NanoGrid buildLabelMask(const LabelVolume& volume, int labelId, const VoxelBox& box)
{
  openvdb::initialize(); // does nothing after the first time
  auto grid = openvdb::MaskGrid::create();
  grid->setName("voxels_" + std::to_string(labelId));
  grid->setTransform(worldTransform(volume.placement));
  const Vec3i low = box.first / leafEdge;
  const Vec3i high = (box.last + (leafEdge - 1)) / leafEdge;
  openvdb::MaskTree::LeafNodeType::NodeMaskType mask;
  for (int bz = low.z; bz < high.z; ++bz)
  {
    for (int by = low.y; by < high.y; ++by)
    {
      for (int bx = low.x; bx < high.x; ++bx)
      {
        const Vec3i origin = Vec3i(bx, by, bz) * leafEdge;
        mask.setOff();
        const int found = forLabelInBlock(volume, labelId, origin, [&](const Vec3i& v) {
          mask.setOn(openvdb::Index((v.x * leafEdge + v.y) * leafEdge + v.z)); // OpenVDB stores k fastest
        });
        const openvdb::Coord at(origin.x, origin.y, origin.z);
        if (found == leafEdge * leafEdge * leafEdge)
        {
          grid->tree().addTile(1, at, true, true);
        }
        else if (found > 0)
        {
          grid->tree().touchLeaf(at)->setValueMask(mask);
        }
      }
    }
  }
  openvdb::tools::prune(grid->tree());
  return nanoFromOpen(*grid);
}

std::vector<std::uint16_t> voxelsOf(const LabelGrid& labels, const Vec3i& size)
{
  std::vector<std::uint16_t> voxels(std::size_t(size.x) * size.y * size.z);
  const auto* grid = labels.grid.storage->handle.grid<std::int32_t>();
  const Vec3i blocks = (size + (leafEdge - 1)) / leafEdge;
  parallelFor(blocks.y * blocks.z, {}, [&](int slab) {
    auto accessor = grid->getAccessor();
    for (int bx = 0; bx < blocks.x; ++bx)
    {
      const Vec3i origin = Vec3i(bx, slab % blocks.y, slab / blocks.y) * leafEdge;
      const Vec3i extent = glm::min(Vec3i(leafEdge), size - origin);
      const auto* leaf = accessor.probeLeaf(nanovdb::Coord(origin.x, origin.y, origin.z));
      const int tile = leaf ? 0 : accessor.getValue(nanovdb::Coord(origin.x, origin.y, origin.z));
      for (int z = 0; z < extent.z; ++z)
      {
        for (int y = 0; y < extent.y; ++y)
        {
          const std::size_t row = std::size_t(size.y) * (origin.z + z) + std::size_t(origin.y + y);
          std::uint16_t* to = voxels.data() + std::size_t(size.x) * row + origin.x;
          for (int x = 0; x < extent.x; ++x)
          {
            to[x] = std::uint16_t(leaf ? leaf->getValue(std::uint32_t((x * leafEdge + y) * leafEdge + z)) : tile);
          }
        }
      }
    }
  });
  return voxels;
}

} // namespace sono
