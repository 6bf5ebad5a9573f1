#include "Echo/ScattererDensity.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr double wantedStepMm = 0.25;

/// From the centre of a brick of this level to its corners, with room for the rounding of depths to the table's steps:
/// the reach of a brick holds those of its eight children.
double reachMm(int level, double stepMm)
{
  return 0.5 * std::sqrt(3.0) * nestedBrickCells * double(nestedCellMm(level)) + 1.01 * stepMm * level;
}

} // namespace

ScattererDensity::ScattererDensity(double depthMm, const std::function<double(double)>& cellMm3, double perCell)
{
  const int count = std::max(2, int(std::ceil(depthMm / wantedStepMm)) + 1);
  stepMm_ = depthMm / (count - 1);
  const double most = std::pow(double(nestedFinestMm), -3.0);
  for (int i = 0; i < count; ++i)
  {
    const double volume = cellMm3(i * stepMm_);
    const double needed = volume > 0.0 ? std::min(perCell / volume, most) : 0.0;
    perMm3_.push_back(float(needed));
    int level = 0;
    while (level + 1 < nestedLevels && std::pow(double(nestedCellMm(level + 1)), -3.0) >= needed)
    {
      ++level;
    }
    level_.push_back(std::uint8_t(level));
  }
  finest_ = *std::min_element(level_.begin(), level_.end());
  coarsest_ = *std::max_element(level_.begin(), level_.end());
  coarseEnough_.assign(level_.size(), 0);
  for (int level = finest_; level <= coarsest_; ++level)
  {
    const int reach = int(std::ceil(reachMm(level, stepMm_) / stepMm_));
    for (int i = 0; i < count; ++i)
    {
      const auto first = level_.begin() + std::max(0, i - reach);
      const auto last = level_.begin() + std::min(count, i + reach + 1);
      if (level == finest_ || *std::min_element(first, last) >= level)
      {
        coarseEnough_[std::size_t(i)] |= std::uint8_t(1u << level);
      }
    }
  }
}

DensityView ScattererDensity::view() const
{
  return { perMm3_.data(), coarseEnough_.data(), int(level_.size()), float(1.0 / stepMm_), finest_, coarsest_ };
}

ScattererDensity::Range ScattererDensity::range(int level) const
{
  // Where a brick of this level may be taken, its parent is not, for some depth of the parent's within its reach.
  const int reach = level < coarsest_ ? int(std::ceil(reachMm(level + 1, stepMm_) / stepMm_)) : 0;
  int first = int(level_.size());
  int last = -1;
  for (int i = 0; i < int(level_.size()); ++i)
  {
    const bool enough = (coarseEnough_[std::size_t(i)] >> level) & 1u;
    bool parentLacks = level == coarsest_;
    for (int j = std::max(0, i - reach); !parentLacks && j <= std::min(int(level_.size()) - 1, i + reach); ++j)
    {
      parentLacks = !((coarseEnough_[std::size_t(j)] >> (level + 1)) & 1u);
    }
    if (enough && parentLacks)
    {
      first = std::min(first, i);
      last = i;
    }
  }
  if (last < 0)
  {
    return { 0.0f, 0.0f };
  }
  // The bricks' centres; their scatterers lie within their reach. The table's ends stand for all beyond.
  const double reachedMm = reachMm(level, stepMm_) + stepMm_;
  return { first == 0 ? 0.0f : float(std::max(0.0, first * stepMm_ - reachedMm)),
           last == int(level_.size()) - 1 ? 1e30f : float(last * stepMm_ + reachedMm) };
}

} // namespace sono
