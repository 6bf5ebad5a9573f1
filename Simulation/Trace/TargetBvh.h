#pragma once

#include "Kernel/TargetBvh.h"

#include <vector>

namespace sono {

/// Owns what a BvhTargets view points to.
struct TargetBvh
{
  std::vector<BvhNode> nodes;
  std::vector<BvhTriangle> triangles; ///< in the order of the leaves

  BvhTargets view() const { return { nodes.data(), triangles.data(), std::int32_t(nodes.size()) }; }
};

/// Splits at the median of the longest axis of the centroids, down to four triangles: depth is log2 of their number.
TargetBvh buildTargetBvh(std::vector<BvhTriangle> triangles);

} // namespace sono
