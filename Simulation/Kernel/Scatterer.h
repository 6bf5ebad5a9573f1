#pragma once

#include "Kernel/FastMath.h"
#include "Kernel/Rng.h"
#include "Kernel/Vec.h"

#include <cstdint>

namespace sono {

/// How a tissue scatters (Burger et al. 2013): a cell holds a scatterer with probability `probability`, of amplitude
/// normal(mean, sigma).
struct ScatteringMedium
{
  float mean = 0.0f;
  float sigma = 0.0f;
  float probability = 0.0f;
};

/// The candidate of one cell, before the tissue at its position decides on presence and amplitude.
struct ScattererSeed
{
  Vec3f fraction; ///< position inside the cell, in [0, 1)
  float presence; ///< uniform (0, 1): there when below the tissue's probability
  float deviate;  ///< uniform (0, 1): mapped to a standard normal deviate
};

/// A pure function of (seed, cell): the same anatomy shows the same speckle wherever the probe stands
/// (Data/docs/physics.md section 4). 21 bits a coordinate, 24 for presence, 32 - 8 for the deviate, out of one Philox
/// block.
SONO_HD inline ScattererSeed scattererSeed(std::uint64_t seed, const Vec3i& cell)
{
  const RandomWords w = philox(seed, std::uint32_t(cell.x), std::uint32_t(cell.y), std::uint32_t(cell.z), 0x5ca77e4u);
  const float unit = 1.0f / 2097152.0f;
  const std::uint32_t z = ((w.v[0] & 0x7ffu) << 10) | (w.v[1] & 0x3ffu);
  return { Vec3f(float(w.v[0] >> 11) * unit, float(w.v[1] >> 11) * unit, float(z) * unit), uniformFrom(w.v[2]),
           uniformFrom(w.v[3]) };
}

/// Standard normal deviate whose upper tail probability is u, a uniform of (0, 1) of 24 bits: Giles 2010
/// ("Approximating the erfinv function"), absolute error below 2e-6. Branch-free, so that host loops vectorise.
SONO_HD inline float normalDeviate(float u)
{
  const float p = u < 0.5f ? u : 1.0f - u; // the smaller tail keeps its digits
  const float w = -logPositive(4.0f * p * (1.0f - p));
  const float c = w - 2.5f;
  float central = 2.81022636e-08f;
  central = 3.43273939e-07f + central * c;
  central = -3.5233877e-06f + central * c;
  central = -4.39150654e-06f + central * c;
  central = 0.00021858087f + central * c;
  central = -0.00125372503f + central * c;
  central = -0.00417768164f + central * c;
  central = 0.246640727f + central * c;
  central = 1.50140941f + central * c;
  const float t = sqrtf(w > 0.0f ? w : 0.0f) - 3.0f;
  float tail = -0.000200214257f;
  tail = 0.000100950558f + tail * t;
  tail = 0.00134934322f + tail * t;
  tail = -0.00367342844f + tail * t;
  tail = 0.00573950773f + tail * t;
  tail = -0.0076224613f + tail * t;
  tail = 0.00943887047f + tail * t;
  tail = 1.00167406f + tail * t;
  tail = 2.83297682f + tail * t;
  const float x = 1.41421356f * (w < 5.0f ? central : tail) * (1.0f - 2.0f * p);
  return u < 0.5f ? x : -x;
}

/// Amplitude of a candidate in this medium; 0 when it is not there.
SONO_HD inline float scattererAmplitude(const ScatteringMedium& medium, float presence, float deviate)
{
  const float amplitude = medium.mean + medium.sigma * normalDeviate(deviate);
  return presence < medium.probability ? amplitude : 0.0f;
}

} // namespace sono
