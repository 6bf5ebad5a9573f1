#pragma once

#include "Kernel/HostDevice.h"
#include "Kernel/Vec.h"

#include <cstddef>
#include <cstdint>

namespace sono {

/// A view of a FibreField. Trivially copyable.
struct FibreView
{
  const std::uint32_t* packed = nullptr; ///< of each voxel of a box, i fastest; null: no fibres anywhere
  Vec3i first{ 0 };                      ///< voxel of the box
  Vec3i size{ 0 };

  /// Unit vector along the grid's axes, of either sense; 0 where there are no fibres, and outside of the box.
  SONO_HD Vec3f at(const Vec3i& voxel) const
  {
    const Vec3i p = voxel - first;
    if (!packed || unsigned(p.x) >= unsigned(size.x) || unsigned(p.y) >= unsigned(size.y) ||
        unsigned(p.z) >= unsigned(size.z))
    {
      return Vec3f(0.0f);
    }
    const std::uint32_t w =
      packed[std::size_t(p.x) + std::size_t(size.x) * (std::size_t(p.y) + std::size_t(size.y) * std::size_t(p.z))];
    return w == 0u ? Vec3f(0.0f)
                   : (Vec3f(float(w & 255u), float((w >> 8) & 255u), float((w >> 16) & 255u)) - Vec3f(128.0f)) *
                       Vec3f(1.0f / 127.0f);
  }
};

} // namespace sono
