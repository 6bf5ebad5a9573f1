#include "Probe/ElevationProfile.h"

#include "Core/ParallelFor.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double maxTable = 134217728.0; // 2^27
constexpr double radPerRow = 0.4;        // a cubic then errs by 3/128 of the fourth power, 6e-4, at the worst edge

double sinc(double x)
{
  return std::abs(x) < 1e-4 ? 1.0 - x * x / 6.0 : std::sin(x) / x;
}

} // namespace

ElevationProfile::ElevationProfile(const ElevationSetup& setup, const Progress& progress)
  : count_(int(setup.elevationMm.size()))
{
  const double k = setup.waveNumberPerMm;
  double furthest = 0.0;
  for (const double y : setup.elevationMm)
  {
    furthest = std::max(furthest, std::abs(y));
  }
  scaleMm_ = furthest + 0.5 * setup.heightMm + 2.0 * pi / k;
  const double nearU = scaleMm_ / (setup.minRangeMm + scaleMm_);
  const double farU = scaleMm_ / (setup.maxRangeMm + scaleMm_);
  // The phase k (s - r) turns by at most 1.18 k Y per unit of u.
  const double cells = std::max(64.0, std::ceil(1.18 * k * scaleMm_ * (nearU - farU) / radPerRow));
  stepU_ = -(nearU - farU) / cells;
  firstU_ = nearU;
  if (cells * rowLength() > maxTable)
  {
    throw Error("the field: the elevational axis holds too many positions or reaches too far; shorten it or choose "
                "longer steps.");
  }
  rows_ = int(cells) + 1;
  table_.resize(std::size_t(rows_) * rowLength());

  const int strips = std::max(1, int(std::ceil(setup.heightMm * k / pi - 1e-9)));
  const double stripMm = setup.heightMm / strips;
  parallelFor(rows_, progress, [&](int row) {
    const double r = rangeAt(row);
    float* out = table_.data() + std::size_t(row) * rowLength();
    for (int j = 0; j < count_; ++j)
    {
      double re = 0.0;
      double im = 0.0;
      for (int m = 0; m < strips; ++m)
      {
        const double from = -0.5 * setup.heightMm + (m + 0.5) * stripMm;
        const double dy = setup.elevationMm[std::size_t(j)] - from;
        const double s = std::sqrt(r * r + dy * dy);
        const double further = dy * dy / (s + r); // s - r without cancellation
        const double focus = setup.focusMm;
        const double lens = std::isinf(focus) ? 0.0 : from * from / (std::sqrt(focus * focus + from * from) + focus);
        const double size =
          stripMm * r / s * sinc(0.5 * k * stripMm * dy / s) * std::exp(-setup.attenuationNpPerMm * further);
        const double phase = k * (further - lens);
        re += size * std::cos(phase);
        im += size * std::sin(phase);
      }
      out[j] = float(re);
      out[count_ + j] = float(im);
    }
  });
}

double ElevationProfile::rangeAt(int row) const
{
  const double u = firstU_ + row * stepU_;
  return scaleMm_ * (1.0 - u) / u;
}

ElevationProfile::Stencil ElevationProfile::at(double rangeMm) const
{
  const double place = (scaleMm_ / (rangeMm + scaleMm_) - firstU_) / stepU_;
  const int first = std::clamp(int(std::floor(place)) - 1, 0, rows_ - 4);
  const double t = std::clamp(place, 0.0, rows_ - 1.0) - first; // nodes at 0, 1, 2, 3
  Stencil stencil;
  stencil.firstRow = table_.data() + std::size_t(first) * rowLength();
  stencil.weight[0] = float(-(t - 1.0) * (t - 2.0) * (t - 3.0) / 6.0);
  stencil.weight[1] = float(t * (t - 2.0) * (t - 3.0) / 2.0);
  stencil.weight[2] = float(-t * (t - 1.0) * (t - 3.0) / 2.0);
  stencil.weight[3] = float(t * (t - 1.0) * (t - 2.0) / 6.0);
  return stencil;
}

} // namespace sono
