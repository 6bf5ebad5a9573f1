#pragma once

#include "Kernel/HostDevice.h"

#include <cmath>
#include <cstdint>
#include <cstring>

/// Short polynomials that a compiler can vectorise, in place of libm's calls. The coefficients are minimax fits
/// (Lawson's iteration) with the end points pinned, so that neighbouring intervals join without a step.
namespace sono {

/// 20 log10(x) of a finite normal x > 0: to 3e-5 dB within +-120 dB, to 1e-4 dB at the ends of the float range.
SONO_HD inline float fastDecibels(float x)
{
  std::uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  const auto exponent = static_cast<float>(static_cast<std::int32_t>(bits >> 23) - 127);
  const std::uint32_t mantissaBits = (bits & 0x007fffffu) | 0x3f800000u;
  float mantissa;
  memcpy(&mantissa, &mantissaBits, sizeof mantissa);

  // log2(1 + t) on [0, 1), error 2.2e-6
  const float t = mantissa - 1.0f;
  const float p =
    1.4425449f + t * (-0.71814525f + t * (0.45754918f + t * (-0.27790534f + t * (0.12179791f - 0.02584145f * t))));
  constexpr float decibelsPerOctave = 6.02059991f;
  return decibelsPerOctave * (exponent + t * p);
}

/// atan2(y, x) for x >= 0 and not both zero, to 2e-7 rad.
SONO_HD inline float fastAtan2RightHalf(float y, float x)
{
  const float a = fabsf(y);
  const float larger = a > x ? a : x;
  const float smaller = a > x ? x : a;
  const float t = smaller / larger;
  const float s = t * t;
  // atan(t) on [0, 1], error 4e-8
  float p = 0.021862952f - 0.0040545654f * s;
  p = -0.05591232f + p * s;
  p = 0.096421964f + p * s;
  p = -0.13908629f + p * s;
  p = 0.19946566f + p * s;
  p = -0.3332986f + p * s;
  p = 0.99999934f + p * s;
  const float octant = t * p;
  constexpr float halfPi = 1.57079633f;
  const float angle = a > x ? halfPi - octant : octant;
  return y < 0.0f ? -angle : angle;
}

/// atan2(y, x) in [-pi, pi] for x and y not both zero, to 4e-7 rad.
SONO_HD inline float fastAtan2(float y, float x)
{
  constexpr float pi = 3.14159265f;
  const float right = fastAtan2RightHalf(y, fabsf(x));
  const float left = (y < 0.0f ? -pi : pi) - right;
  return x < 0.0f ? left : right;
}

} // namespace sono
