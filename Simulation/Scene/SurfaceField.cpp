#include "Scene/SurfaceField.h"

#include "Core/ParallelFor.h"
#include "Kernel/NormalDeviate.h"
#include "Scene/GridTransform.h"
#include "Scene/NanoConvert.h"
#include "Scene/NanoGridStorage.h"
#include "Scene/OpenGrids.h"
#include "Scene/SmoothedMask.h"

#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace sono {

namespace {

template<class Build>
auto valueAt(const NanoGrid& grid, const Vec3i& ijk)
{
  const auto* typed = grid.storage->handle.grid<Build>();
  return typed->tree().getValue(nanovdb::Coord(ijk.x, ijk.y, ijk.z));
}

/// Whether the voxels of the box [first, last), clipped to the volume, are partly `labelId` and partly not.
bool mixed(const LabelVolume& volume, int labelId, Vec3i first, Vec3i last)
{
  const Vec3i n = volume.placement.size;
  first = glm::clamp(first, Vec3i(0), n - 1);
  last = glm::clamp(last, first + 1, n);
  bool in = false;
  bool out = false;
  for (int z = first.z; z < last.z; ++z)
  {
    for (int y = first.y; y < last.y; ++y)
    {
      const std::uint16_t* row = volume.voxels.data() + std::size_t(n.x) * (std::size_t(y) + std::size_t(n.y) * z);
      for (int x = first.x; x < last.x; ++x)
      {
        (row[x] == labelId ? in : out) = true;
      }
      if (in && out)
      {
        return true;
      }
    }
  }
  return false;
}

struct Leaf
{
  Vec3i origin;
  std::array<float, leafEdge * leafEdge * leafEdge> value; // i fastest
};

} // namespace

int LabelGrid::at(const Vec3i& ijk) const
{
  return valueAt<std::int32_t>(grid, ijk);
}

float SurfaceField::at(const Vec3i& ijk) const
{
  return valueAt<nanovdb::Fp8>(sdf, ijk);
}

LabelGrid buildLabelGrid(const LabelVolume& volume, const Progress& progress)
{
  openvdb::initialize(); // does nothing after the first time
  auto grid = openvdb::Int32Grid::create(0);
  grid->setName("labels");
  grid->setTransform(worldTransform(volume.placement));
  auto accessor = grid->getAccessor();
  const Vec3i n = volume.placement.size;
  const std::uint16_t* voxel = volume.voxels.data();
  for (int k = 0; k < n.z; ++k)
  {
    report(progress, 0.7 * k / n.z);
    for (int j = 0; j < n.y; ++j)
    {
      for (int i = 0; i < n.x; ++i, ++voxel)
      {
        if (*voxel != 0)
        {
          accessor.setValue(openvdb::Coord(i, j, k), *voxel);
        }
      }
    }
  }
  grid->tree().prune();
  LabelGrid result;
  result.grid = nanoFromOpen(*grid);
  report(progress, 1.0);
  return result;
}

std::vector<VoxelBox> labelBoxes(const LabelVolume& volume)
{
  const Vec3i n = volume.placement.size;
  using BoxOfId = std::vector<VoxelBox>;
  tbb::enumerable_thread_specific<BoxOfId> workers([&] { return BoxOfId(65536, VoxelBox{ n, Vec3i(0) }); });
  parallelFor(n.z, {}, [&](int k) {
    BoxOfId& boxes = workers.local();
    for (int j = 0; j < n.y; ++j)
    {
      const std::uint16_t* row = volume.voxels.data() + std::size_t(n.x) * (std::size_t(j) + std::size_t(n.y) * k);
      for (int i = 0; i < n.x;)
      {
        const int start = i;
        while (i < n.x && row[i] == row[start])
        {
          ++i;
        }
        VoxelBox& box = boxes[row[start]];
        box.first = glm::min(box.first, Vec3i(start, j, k));
        box.last = glm::max(box.last, Vec3i(i, j + 1, k + 1));
      }
    }
  });
  std::vector<VoxelBox> result;
  for (const LabelInfo& label : volume.labels)
  {
    VoxelBox all{ n, Vec3i(0) };
    for (const BoxOfId& boxes : workers)
    {
      all.first = glm::min(all.first, boxes[std::size_t(label.id)].first);
      all.last = glm::max(all.last, boxes[std::size_t(label.id)].last);
    }
    result.push_back(all);
  }
  return result;
}

SurfaceField buildSurface(const LabelVolume& volume, int labelId, const VoxelBox& box, const Progress& progress)
{
  openvdb::initialize(); // does nothing after the first time
  const GridPlacement& placement = volume.placement;
  SurfaceField field;
  field.labelId = labelId;
  field.smoothingMm = std::cbrt(placement.spacingMm.x * placement.spacingMm.y * placement.spacingMm.z);
  const GaussianAxes gaussian = makeGaussian(placement.spacingMm, field.smoothingMm);
  // Beyond 2.6 sigma the smoothed occupancy of a plane is 0 or 1.
  field.bandMm = 2.5 * field.smoothingMm;
  field.box = box;
  if (box.empty())
  {
    throw Error("label " + std::to_string(labelId) + " has no voxels: choose one of the labels that occur");
  }

  // Leaves are aligned to OpenVDB's; negative coordinates round down.
  const Vec3i low = glm::max(box.first - gaussian.radius, Vec3i(0)) / leafEdge;
  const Vec3i high = (glm::min(box.last + gaussian.radius, placement.size) + (leafEdge - 1)) / leafEdge;
  const Vec3i leaves = high - low;
  tbb::enumerable_thread_specific<MaskSmoother<std::uint16_t>> smoothers(
    [&] { return MaskSmoother<std::uint16_t>(volume.voxels.data(), placement.size); });
  std::vector<std::vector<Leaf>> rows(std::size_t(leaves.y) * leaves.z);
  parallelFor(leaves.y * leaves.z, progress, [&](int row) {
    for (int x = 0; x < leaves.x; ++x)
    {
      const Vec3i origin = (low + Vec3i(x, row % leaves.y, row / leaves.y)) * leafEdge;
      if (!mixed(volume, labelId, origin - gaussian.radius, origin + leafEdge + gaussian.radius))
      {
        continue;
      }
      Leaf leaf;
      leaf.origin = origin;
      smoothers.local().smooth(std::uint16_t(labelId), origin, Vec3i(leafEdge), gaussian, leaf.value.data());
      for (float& v : leaf.value)
      {
        const float d = float(field.smoothingMm) * normalFromUpperTail(std::clamp(v, 1e-4f, 1.0f - 1e-4f));
        v = std::clamp(d, -float(field.bandMm), float(field.bandMm));
      }
      rows[std::size_t(row)].push_back(leaf);
    }
  });

  auto grid = openvdb::FloatGrid::create(float(field.bandMm));
  grid->setName("sdf_" + std::to_string(labelId));
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  grid->setTransform(worldTransform(placement));
  for (const auto& row : rows)
  {
    for (const Leaf& leaf : row)
    {
      auto* node = grid->tree().touchLeaf(openvdb::Coord(leaf.origin.x, leaf.origin.y, leaf.origin.z));
      for (int i = 0; i < leafEdge * leafEdge * leafEdge; ++i)
      {
        // OpenVDB stores k fastest.
        const int x = i % leafEdge;
        const int y = (i / leafEdge) % leafEdge;
        const int z = i / (leafEdge * leafEdge);
        const float v = leaf.value[std::size_t(i)];
        const auto at = openvdb::Index((x * leafEdge + y) * leafEdge + z);
        if (std::abs(v) < float(field.bandMm))
        {
          node->setValueOn(at, v);
        }
        else
        {
          node->setValueOff(at, v);
        }
      }
    }
  }
  openvdb::tools::signedFloodFill(grid->tree());
  field.sdf = compactNanoFromOpen(*grid);
  return field;
}

TriangleSurface meshSurface(const LabelVolume& volume, const SurfaceField& field)
{
  openvdb::initialize(); // does nothing after the first time
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(openFromNano(field.sdf));
  // In index space: OpenVDB's mesher would apply the grid's transform, of which NanoVDB keeps single precision.
  grid->setTransform(openvdb::math::Transform::createLinearTransform());
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*grid, points, triangles, quads, 0.0, 0.0, false);

  TriangleSurface surface;
  surface.points.reserve(points.size());
  for (const auto& p : points)
  {
    const Vec3d w = volume.placement.worldFromIndex(Vec3d(p.x(), p.y(), p.z()));
    surface.points.push_back({ float(w.x), float(w.y), float(w.z) });
  }
  surface.triangles.reserve(triangles.size() + 2 * quads.size());
  for (const auto& t : triangles)
  {
    surface.triangles.push_back({ int(t[0]), int(t[1]), int(t[2]) });
  }
  for (const auto& q : quads)
  {
    surface.triangles.push_back({ int(q[0]), int(q[1]), int(q[2]) });
    surface.triangles.push_back({ int(q[0]), int(q[2]), int(q[3]) });
  }
  return surface;
}

} // namespace sono
