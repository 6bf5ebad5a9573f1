#pragma once

#include "Kernel/BoundaryRecord.h"
#include "Kernel/NormalDeviate.h"
#include "Scene/BoundaryFits.h"
#include "Scene/FaceColumns.h"
#include "Scene/SmoothedMask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace sono {

/// Bakes the records of one block of a box.
class RecordBaker
{
public:
  RecordBaker(const std::uint8_t* tissues, const Vec3i& size, const Vec3d& spacingMm)
    : tissues_(tissues)
    , size_(size)
    , smoother_(tissues, size)
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
    for (std::size_t n = 0; n < inBlock.size(); ++n)
    {
      const Vec3i& v = inBlock[n];
      if (n == 0 || v.y != inBlock[n - 1].y || v.z != inBlock[n - 1].z)
      {
        row_ = inBlock.data() + n;
        rowEnd_ = std::find_if(row_, inBlock.data() + inBlock.size(),
                               [&](const Vec3i& other) { return other.y != v.y || other.z != v.z; });
        rowColumns_.clear();
      }
      store(v, encodeRecord(recordAt(v)));
    }
  }

private:
  BoundaryRecord recordAt(const Vec3i& v)
  {
    const Vec3i at = v - low_;
    const auto coarse = [&](int x, int y, int z) {
      return coarse_[std::size_t(at.x + 1 + x + (count_.x + 2) * (at.y + 1 + y + (count_.y + 2) * (at.z + 1 + z)))];
    };
    const Vec3d gradient((coarse(1, 0, 0) - coarse(-1, 0, 0)) / (2.0 * spacing_.x),
                         (coarse(0, 1, 0) - coarse(0, -1, 0)) / (2.0 * spacing_.y),
                         (coarse(0, 0, 1) - coarse(0, 0, -1)) / (2.0 * spacing_.z));
    const double slope = glm::length(gradient);
    // A plane's smoothed occupancy has the slope 1 / (sigma sqrt(2 pi)).
    const double perPlane = normalSigma_ * 2.5066282746;
    BoundaryRecord record;
    record.confidence = float(slope * perPlane);
    bool isKnown = fits_.normalAt(first_ + v, record.normal);
    // Both sides of a thin wall are in that slope: the less there is of it, the less its direction says, and a wedge
    // beside the wall would lead. Long voxels leave no room to tell sides apart.
    const bool isThick = normalSigma_ > 2.0 * sigma_;
    if (isKnown && !isThick)
    {
      record.confidence = 1.0f;
    }
    else if (!isThick && record.confidence < thinnestWhole)
    {
      const Vec3d side = sideGradient(first_ + v);
      const double sideSlope = glm::length(side);
      if (sideSlope * perPlane > flattest)
      {
        record.normal = Vec3f(side / sideSlope);
        record.confidence = float(sideSlope * perPlane);
        isKnown = true;
      }
    }
    if (!isKnown)
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
    const float share = fine_[std::size_t(at.x + count_.x * (at.y + count_.y * at.z))];
    // For a plane at distance d inside, occupancy = Phi(d / sigma).
    record.offset = -normalFromUpperTail(std::clamp(share, 1e-4f, 1.0f - 1e-4f));
    return record;
  }

  /// The gradient of the smoothed occupancy is the sum of Gaussian times outward normal over the tissue's faces, so
  /// that the two sides of a thin wall cancel. This is that of the one side that a voxel is on, outward: of the faces
  /// that look the way of the voxel's own. 0 where these look to opposite sides, and where the other side is not a
  /// wall's.
  Vec3d sideGradient(const Vec3i& voxel)
  {
    const std::ptrdiff_t pitch[3] = { 1, size_.x, std::ptrdiff_t(size_.x) * size_.y };
    const std::uint8_t* middle = tissues_ + voxel.x + pitch[1] * voxel.y + pitch[2] * voxel.z;
    const std::uint8_t tissue = *middle;
    Vec3d own(0.0);
    for (int a = 0; a < 3; ++a)
    {
      const bool isLast = voxel[a] + 1 < size_[a] && middle[pitch[a]] != tissue;
      const bool isFirst = voxel[a] > 0 && middle[-pitch[a]] != tissue;
      if (isLast && isFirst)
      {
        return Vec3d(0.0);
      }
      own[a] = (double(isLast) - double(isFirst)) / spacing_[a];
    }
    if (own == Vec3d(0.0))
    {
      return own;
    }
    const Vec3i low = glm::max(voxel - normal_.radius, Vec3i(1));
    const Vec3i high = glm::min(voxel + normal_.radius, size_ - 2);
    if (rowColumns_.empty())
    {
      sumRowColumns(tissue, low, high);
    }
    // Sums of faces by axis and way.
    double toward[3] = { 0.0, 0.0, 0.0 };
    double away[3] = { 0.0, 0.0, 0.0 };
    for (int x = low.x; x <= high.x; ++x)
    {
      const auto column = std::size_t(x - rowFirst_);
      const FaceColumns& columns = rowColumns_[column / FaceColumns::most];
      const std::size_t n = column % FaceColumns::most;
      const double w = normal_.weight[0][std::size_t(x - voxel.x + normal_.radius.x)];
      for (int a = 0; a < 3; ++a)
      {
        toward[a] += w * columns.toward[a][n];
        away[a] += w * columns.away[a][n];
      }
    }
    Vec3d sum(0.0);
    Vec3d other(0.0); // of the opposite side
    for (int round = 0; round < 2; ++round)
    {
      const Vec3d way = round == 0 ? own : sum;
      for (int a = 0; a < 3; ++a)
      {
        const bool isToward = way[a] > 0.0 || (way[a] == 0.0 && toward[a] > away[a]);
        sum[a] = (isToward ? toward[a] : -away[a]) / spacing_[a];
        other[a] = (isToward ? -away[a] : toward[a]) / spacing_[a];
      }
    }
    const bool isWall = glm::dot(sum, other) <= -parallel * glm::length(sum) * glm::length(other);
    return isWall ? sum : Vec3d(0.0);
  }

  /// The columns around the row's voxels, which they share: of a thin wall several in a row ask for them. `low` and
  /// `high` say how far those of one of them go along the other axes.
  void sumRowColumns(std::uint8_t tissue, const Vec3i& low, const Vec3i& high)
  {
    const std::ptrdiff_t pitch[3] = { 1, size_.x, std::ptrdiff_t(size_.x) * size_.y };
    const Vec3i corner = low - (first_ + *row_) + normal_.radius; // of the weights
    rowFirst_ = std::max(first_.x + row_->x - normal_.radius.x, 1);
    const int last = std::min(first_.x + (rowEnd_ - 1)->x + normal_.radius.x, size_.x - 2);
    for (int x = rowFirst_; x <= last; x += FaceColumns::most)
    {
      const Vec3i count(std::min(FaceColumns::most, last - x + 1), high.y - low.y + 1, high.z - low.z + 1);
      sumFaces(tissues_ + x + pitch[1] * low.y + pitch[2] * low.z, size_, tissue, count,
               &normal_.weight[1][std::size_t(corner.y)], &normal_.weight[2][std::size_t(corner.z)],
               rowColumns_.emplace_back());
    }
  }

  static constexpr float thinnestWhole = 0.4f; ///< confidence of a wall too thin for smoothing, two to three voxels
  static constexpr double flattest = 0.85;     ///< of one side's slope against a plane's: not of a wire, nor at a rim
  static constexpr double parallel = 0.9;      ///< cosine between the sides of a wall; those of a wire are round

  const std::uint8_t* tissues_;
  Vec3i size_;
  MaskSmoother<std::uint8_t> smoother_;
  Vec3d spacing_;
  double sigma_;
  GaussianAxes position_;
  double normalSigma_;
  GaussianAxes normal_;
  BoundaryFits fits_;
  const Vec3i* row_ = nullptr; ///< the block's voxels of a row, as they are listed
  const Vec3i* rowEnd_ = nullptr;
  std::vector<FaceColumns> rowColumns_; ///< empty: not made for this row
  int rowFirst_ = 0;                    ///< x of the first of them
  Vec3i first_{ 0, 0, 0 };
  Vec3i low_{ 0, 0, 0 }; ///< what is smoothed of the block
  Vec3i count_{ 0, 0, 0 };
  std::array<float, std::size_t(recordBlock) * recordBlock * recordBlock> fine_{};
  std::array<float, std::size_t(recordBlock + 2) * (recordBlock + 2) * (recordBlock + 2)> coarse_{};
};

} // namespace sono
