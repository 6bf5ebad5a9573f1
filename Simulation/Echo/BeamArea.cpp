#include "Echo/BeamArea.h"

#include "Core/Error.h"
#include "Echo/EchoSettings.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;

double mirrored(const FieldAxis& axis)
{
  return axis.minMm == 0.0 && axis.count > 1 ? 2.0 : 1.0;
}

/// Of the trapezoidal rule along an axis.
double quadratureMm(const FieldAxis& axis, int i)
{
  const bool end = axis.count > 1 && (i == 0 || i == axis.count - 1);
  return mirrored(axis) * axis.stepMm * (end ? 0.5 : 1.0);
}

struct Integrals
{
  double weight = 0.0;
  double square = 0.0;
};

Integrals integrate(const FieldGrid& grid, const float* plane)
{
  Integrals sum;
  for (int e = 0; e < grid.elevational.count; ++e)
  {
    for (int l = 0; l < grid.lateral.count; ++l)
    {
      const double w = *plane++;
      const double area = quadratureMm(grid.lateral, l) * quadratureMm(grid.elevational, e);
      sum.weight += std::fabs(w) * area;
      sum.square += w * w * area;
    }
  }
  return sum;
}

} // namespace

BeamArea::BeamArea(const EchoSettings& settings)
{
  if (!settings.field)
  {
    const double productMm2 = settings.lateralSigmaMm * settings.elevationalSigmaMm;
    focusMm2_ = 2.0 * pi * productMm2;
    cellMm2_ = { pi * productMm2 };
    return;
  }
  const FieldGrid& grid = settings.field->grid();
  const BeamFieldView view = settings.field->view();
  const std::size_t plane = std::size_t(grid.lateral.count) * std::size_t(grid.elevational.count);
  depth_ = grid.depth;
  float strongest = 0.0f;
  for (int d = 0; d < depth_.count; ++d)
  {
    const Integrals sum = integrate(grid, settings.field->values().data() + std::size_t(d) * plane);
    cellMm2_.push_back(sum.square > 0.0 ? 0.25 * sum.weight * sum.weight / sum.square : 0.0);
    const float onAxis = beamWeight(view, 0.0f, 0.0f, float(depth_.at(d)));
    if (onAxis > strongest)
    {
      strongest = onAxis;
      focusMm2_ = sum.weight / onAxis;
    }
  }
  if (!(strongest > 0.0f))
  {
    throw Error("the pulse-echo field is zero on its whole axis: correct its lateral and elevational positions");
  }
}

double BeamArea::cellMm2(double depthMm) const
{
  const double place = std::clamp((depthMm - depth_.minMm) / depth_.stepMm, 0.0, double(cellMm2_.size() - 1));
  const std::size_t before = std::size_t(place);
  const std::size_t behind = std::min(before + 1, cellMm2_.size() - 1);
  return cellMm2_[before] + (place - double(before)) * (cellMm2_[behind] - cellMm2_[before]);
}

} // namespace sono
