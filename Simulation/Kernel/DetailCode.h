#pragma once

#include "Kernel/HostDevice.h"

#include <cmath>
#include <cstdint>

namespace sono {

/// A voxel's backscatter against its tissue's: `(code - detailNone) detailStepDb`; silence for `detailSilent`.
constexpr float detailStepDb = 0.125f;
constexpr int detailNone = 128;
constexpr int detailSilent = 0;

/// Of amplitudes.
SONO_HD inline float detailFactor(std::uint8_t code)
{
  const float factor = exp2f(float(int(code) - detailNone) * (detailStepDb * 0.16609640474436813f)); // log2(10) / 20
  return int(code) == detailSilent ? 0.0f : factor;
}

/// The largest one.
constexpr float largestDetailFactor = 6.25f;

} // namespace sono
