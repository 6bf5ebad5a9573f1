#pragma once

#include "Core/Progress.h"

#include <vector>

namespace sono {

/// An element's height, its lens, and what the field along it is needed for.
struct ElevationSetup
{
  double heightMm;
  double focusMm;            ///< infinity: no lens
  double waveNumberPerMm;    ///< k = 2 pi f / c
  double attenuationNpPerMm; ///< of the amplitude, at f
  double minRangeMm;         ///< > 0
  double maxRangeMm;
  std::vector<double> elevationMm; ///< where it is needed
};

/// The field of a line source along an element's height, seen from in-plane range r and elevation y, without the
/// range's own factor:
///   E(r, y) = r exp((a - i k) r) integral over y' of sinc(k h sin theta_y) exp((i k - a) s - i k d(y')) / s dy',
///   s = sqrt(r^2 + (y - y')^2),  d(y') = sqrt(F^2 + y'^2) - F,  taken over strips of at most half a wavelength.
/// Tabulated over u = Y / (r + Y), in which its phase turns at an even pace, and interpolated with cubics.
class ElevationProfile
{
public:
  /// Throws Error when the table would be too large, Aborted.
  ElevationProfile(const ElevationSetup& setup, const Progress& progress);

  /// Four rows of the table, as (re of every elevation, im of every elevation), and their weights at a range.
  struct Stencil
  {
    const float* firstRow;
    float weight[4];
  };
  Stencil at(double rangeMm) const;
  int rowLength() const { return 2 * count_; }

private:
  double rangeAt(int row) const;

  int count_; // elevations
  double scaleMm_;
  double firstU_;
  double stepU_;
  int rows_;
  std::vector<float> table_;
};

} // namespace sono
