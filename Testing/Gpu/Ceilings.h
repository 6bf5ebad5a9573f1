#pragma once

namespace sono {

/// What the device can do at most, measured: bytes read plus written by a large copy, and single-precision operations
/// (two for each fused multiply and add).
struct Ceilings
{
  double gigabytesPerSecond;
  double teraflops;
};

Ceilings measureCeilings();

} // namespace sono
