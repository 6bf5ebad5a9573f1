#pragma once

#include "Core/Simd.h"
#include "Kernel/Vec.h"

#include <cstdint>
#include <vector>

namespace sono {

/// Bricks of one level side by side, row after row. One row has ten bricks and holds few scatterers: what is done with
/// them is done with many rows at once.
class NestedBricks
{
public:
  int count() const { return count_; }
  Vec3i brick(int n) const { return { x()[n], y()[n], z()[n] }; }
  /// Of each brick, and more behind the last up to whole vectors.
  const std::int32_t* x() const { return x_.data(); }
  const std::int32_t* y() const { return y_.data(); }
  const std::int32_t* z() const { return z_.data(); }

  void clear() { count_ = 0; }
  /// Appends a row of `count` from `first` on along an axis.
  void append(const Vec3i& first, int axis, int count)
  {
    const Vec3i step(axis == 0, axis == 1, axis == 2);
    const int from = count_;
    count_ += count;
    for (std::vector<std::int32_t>* values : { &x_, &y_, &z_ })
    {
      values->resize(std::size_t(count_ + vectorWidth));
    }
    for (int n = 0; n < count + vectorWidth; ++n)
    {
      x_[std::size_t(from + n)] = first.x + n * step.x;
      y_[std::size_t(from + n)] = first.y + n * step.y;
      z_[std::size_t(from + n)] = first.z + n * step.z;
    }
  }

private:
  std::vector<std::int32_t> x_, y_, z_;
  int count_ = 0;
};

} // namespace sono
