#pragma once

#include "Kernel/BoundaryRecord.h"
#include "Kernel/NormalDeviate.h"
#include "Scene/BoundaryFits.h"
#include "Scene/SmoothedMask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace sono {

/// Bakes the records of one block of a box.
class RecordBaker
{
public:
  RecordBaker(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm)
    : smoother_(tissues, size)
    , spacing_(spacingMm)
    , sigma_(std::cbrt(spacingMm.x * spacingMm.y * spacingMm.z))
    , position_(makeGaussian(spacingMm, sigma_))
    , normalSigma_(std::clamp(1.35 * std::max({ spacingMm.x, spacingMm.y, spacingMm.z }), 2.0 * sigma_, 3.0 * sigma_))
    , normal_(makeGaussian(spacingMm, normalSigma_))
    , fits_(tissues, size, spacingMm, normalSigma_)
  {
  }

  /// Goes to the block from `first` on, a multiple of its edge.
  void begin(const Vec3i& first)
  {
    first_ = first;
    fits_.find(first);
  }

  /// `inBlock` lists the block's boundary voxels of one tissue, relative to `first`.
  template<class Store>
  void bake(std::uint8_t tissue, const std::vector<Vec3i>& inBlock, const Store& store)
  {
    // A boundary takes a part of its block, which is all that need be smoothed.
    low_ = Vec3i(recordBlock);
    Vec3i high(0);
    for (const Vec3i& v : inBlock)
    {
      low_ = glm::min(low_, v);
      high = glm::max(high, v + 1);
    }
    count_ = high - low_;
    smoother_.smooth(tissue, first_ + low_, count_, position_, fine_.data());
    smoother_.smooth(tissue, first_ + low_ - 1, count_ + 2, normal_, coarse_.data());
    for (const Vec3i& v : inBlock)
    {
      store(v, encodeRecord(recordAt(v)));
    }
  }

private:
  BoundaryRecord recordAt(const Vec3i& v) const
  {
    const Vec3i at = v - low_;
    const auto coarse = [&](int x, int y, int z) {
      return coarse_[std::size_t(at.x + 1 + x + (count_.x + 2) * (at.y + 1 + y + (count_.y + 2) * (at.z + 1 + z)))];
    };
    const Vec3d gradient((coarse(1, 0, 0) - coarse(-1, 0, 0)) / (2.0 * spacing_.x),
                         (coarse(0, 1, 0) - coarse(0, -1, 0)) / (2.0 * spacing_.y),
                         (coarse(0, 0, 1) - coarse(0, 0, -1)) / (2.0 * spacing_.z));
    const double slope = glm::length(gradient);
    BoundaryRecord record;
    if (!fits_.normalAt(first_ + v, record.normal))
    {
      // Of the occupancy for the confidence; of its probit for the direction, since that is linear across a plane and
      // a difference over a thick voxel therefore exact.
      const auto depth = [&](int x, int y, int z) {
        return normalFromUpperTail(std::clamp(coarse(x, y, z), 1e-6f, 1.0f - 1e-6f));
      };
      const Vec3d outward((depth(1, 0, 0) - depth(-1, 0, 0)) / spacing_.x,
                          (depth(0, 1, 0) - depth(0, -1, 0)) / spacing_.y,
                          (depth(0, 0, 1) - depth(0, 0, -1)) / spacing_.z);
      const double steepness = glm::length(outward);
      record.normal = steepness > 1e-9 ? Vec3f(outward / steepness) : Vec3f(0.0f, 0.0f, 1.0f);
    }
    // A plane's smoothed occupancy has the slope 1 / (sigma sqrt(2 pi)).
    record.confidence = float(slope * normalSigma_ * 2.5066282746);
    const float share = fine_[std::size_t(at.x + count_.x * (at.y + count_.y * at.z))];
    // For a plane at distance d inside, occupancy = Phi(d / sigma).
    record.offset = -normalFromUpperTail(std::clamp(share, 1e-4f, 1.0f - 1e-4f));
    return record;
  }

  MaskSmoother<std::uint8_t> smoother_;
  Vec3d spacing_;
  double sigma_;
  GaussianAxes position_;
  double normalSigma_;
  GaussianAxes normal_;
  BoundaryFits fits_;
  Vec3i first_{ 0, 0, 0 };
  Vec3i low_{ 0, 0, 0 }; ///< what is smoothed of the block
  Vec3i count_{ 0, 0, 0 };
  std::array<float, std::size_t(recordBlock) * recordBlock * recordBlock> fine_{};
  std::array<float, std::size_t(recordBlock + 2) * (recordBlock + 2) * (recordBlock + 2)> coarse_{};
};

} // namespace sono
