#pragma once

#include "Kernel/HostDevice.h"

#include <cmath>
#include <cstdint>

namespace sono {

/// A grey level from 0 to 1 as a byte from 1 to 255; 0 is left to what was not scanned.
SONO_HD inline std::uint8_t greyByte(float grey)
{
  const float clamped = grey < 0.0f ? 0.0f : (grey > 1.0f ? 1.0f : grey);
  const long level = lroundf(255.0f * clamped);
  return std::uint8_t(level < 1 ? 1 : level);
}

} // namespace sono
