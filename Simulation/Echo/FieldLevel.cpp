#include "Echo/FieldLevel.h"

#include "Core/Progress.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

double mirrorFactor(const FieldAxis& axis)
{
  return axis.minMm == 0.0 && axis.count > 1 ? 2.0 : 1.0;
}

/// Integral along an axis of the product of two rows, each linear between its values.
double productIntegral(const FieldAxis& axis, const float* a, const float* b)
{
  if (axis.count == 1)
  {
    return axis.stepMm * a[0] * b[0];
  }
  double sum = 0.0;
  for (int i = 0; i + 1 < axis.count; ++i)
  {
    const double a0 = a[i], a1 = a[i + 1], b0 = b[i], b1 = b[i + 1];
    sum += 2.0 * (a0 * b0 + a1 * b1) + a0 * b1 + a1 * b0;
  }
  return mirrorFactor(axis) * axis.stepMm / 6.0 * sum;
}

/// A(z) of one depth of the table, exact for its bilinear interpolation.
double areaMm2(const FieldGrid& grid, const float* plane)
{
  const FieldAxis& axis = grid.elevational;
  const auto product = [&](int e, int f) {
    return productIntegral(grid.lateral, plane + e * grid.lateral.count, plane + f * grid.lateral.count);
  };
  if (axis.count == 1)
  {
    return axis.stepMm * product(0, 0);
  }
  double sum = 0.0;
  for (int e = 0; e + 1 < axis.count; ++e)
  {
    sum += product(e, e) + product(e, e + 1) + product(e + 1, e + 1);
  }
  return mirrorFactor(axis) * axis.stepMm / 3.0 * sum;
}

} // namespace

FieldLevel::FieldLevel(const PulseEchoField& field)
  : depth_(field.grid().depth)
{
  const FieldGrid& grid = field.grid();
  const BeamFieldView view = field.view();
  const std::size_t plane = std::size_t(grid.lateral.count) * std::size_t(grid.elevational.count);
  float strongest = 0.0f;
  for (int d = 0; d < depth_.count; ++d)
  {
    level_.push_back(areaMm2(grid, field.values().data() + std::size_t(d) * plane));
    const float onAxis = beamWeight(view, 0.0f, 0.0f, float(depth_.at(d)));
    if (onAxis > strongest)
    {
      strongest = onAxis;
      focusAreaMm2_ = level_.back();
      focusMm_ = depth_.at(d);
    }
  }
  if (!(strongest > 0.0f))
  {
    throw Error("the pulse-echo field is zero on its whole axis: correct its lateral and elevational positions");
  }
  for (double& level : level_)
  {
    level = std::sqrt(level / focusAreaMm2_);
  }
}

double FieldLevel::at(double depthMm) const
{
  const double slackMm = depth_.count == 1 ? 0.5 * depth_.stepMm : 0.0;
  if (depthMm < depth_.minMm - slackMm)
  {
    return 0.0;
  }
  const double place = std::clamp((depthMm - depth_.minMm) / depth_.stepMm, 0.0, double(depth_.count - 1));
  const std::size_t before = std::size_t(place);
  const std::size_t behind = std::min(before + 1, level_.size() - 1);
  return level_[before] + (place - double(before)) * (level_[behind] - level_[before]);
}

} // namespace sono
