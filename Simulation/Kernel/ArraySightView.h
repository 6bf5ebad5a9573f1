#pragma once

#include "Kernel/FastMath.h"
#include "Kernel/HostDevice.h"

#include <cstddef>

namespace sono {

/// One axis of an array's culling map: at each step of range and each place the largest modulus there or further out,
/// over the axis' largest at that range. Places as in ArrayBeamAxis.
struct ArrayEnvelope
{
  const float* values; ///< places fastest
  int count;           ///< of places
  float perUnit;
  float nearMm;

  SONO_HD int placeAt(float mm, float rangeMm) const { return int(mm * perUnit / larger(rangeMm, nearMm)); }
  SONO_HD float at(int step, int place) const
  {
    return place < count ? values[std::size_t(step) * std::size_t(count) + std::size_t(place)] : 0.0f;
  }
};

/// A view of an ArraySight. Trivially copyable.
struct ArraySightView
{
  static constexpr float stepMm = 1.0f;
  static constexpr float faintest = 0.005f; // -46 dB

  ArrayEnvelope lateral;
  ArrayEnvelope elevational;
  int steps;

  SONO_HD int stepAt(float mm) const
  {
    const int step = int(mm / stepMm);
    return step < 0 ? 0 : (step < steps ? step : steps - 1);
  }
  /// The largest share of its strongest value that the beam may have at distances from the axis of at least these,
  /// straight ahead, between two ranges.
  SONO_HD float most(float lateralMm, float elevationalMm, float fromMm, float toMm) const
  {
    float share = 0.0f;
    const int last = stepAt(toMm);
    const int l = lateral.placeAt(lateralMm, toMm);
    const int e = elevational.placeAt(elevationalMm, toMm);
    for (int step = stepAt(fromMm); step <= last; ++step)
    {
      share = larger(share, lateral.at(step, l) * elevational.at(step, e));
    }
    return share;
  }
  /// Whether the beam may count there.
  SONO_HD bool sees(float lateralMm, float elevationalMm, float fromMm, float toMm) const
  {
    return most(lateralMm, elevationalMm, fromMm, toMm) > faintest;
  }
};

} // namespace sono
