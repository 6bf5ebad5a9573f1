#pragma once

#include "Labels/LabelVolume.h"

#include <cstdint>
#include <functional>
#include <unordered_set>
#include <vector>

namespace sono {

/// Which labels of a map touch, by voxels' faces.
class LabelContacts
{
public:
  explicit LabelContacts(const LabelVolume& volume);

  /// Whether two ids do; each touches itself.
  bool touch(int a, int b) const { return a == b || pairs_.count(keyOf(a, b)) > 0; }

private:
  static std::uint32_t keyOf(int a, int b)
  {
    return a < b ? std::uint32_t(a) << 16 | std::uint32_t(b) : std::uint32_t(b) << 16 | std::uint32_t(a);
  }

  std::unordered_set<std::uint32_t> pairs_;
};

/// Changes voxels of a resampled map so that labels that do not touch in its original do not touch there, as a cavity
/// and what lies behind its thin wall: a voxel at such a face gets the first of the labels that `candidates` names for
/// its index which may touch all its six neighbours. Returns how many faces are left, for which there is none.
std::size_t keepApart(LabelVolume& resampled, const LabelContacts& original,
                      const std::function<std::vector<std::uint16_t>(const Vec3i&)>& candidates);

} // namespace sono
