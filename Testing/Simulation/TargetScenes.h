#pragma once

#include "Trace/Targets.h"

#include <string>

namespace sono::test {

/// A closed box.
inline TargetSurface makeBox(const std::string& name, const Tissue& tissue, const Vec3d& low, const Vec3d& high)
{
  TargetSurface box{ name, tissue, {}, {} };
  for (int i = 0; i < 8; ++i)
  {
    box.pointsMm.push_back({ i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z });
  }
  box.triangles = { { 0, 2, 3 }, { 0, 3, 1 }, { 4, 5, 7 }, { 4, 7, 6 }, { 0, 1, 5 }, { 0, 5, 4 },
                    { 2, 6, 7 }, { 2, 7, 3 }, { 0, 4, 6 }, { 0, 6, 2 }, { 1, 3, 7 }, { 1, 7, 5 } };
  return box;
}

} // namespace sono::test
