#pragma once

#include "Kernel/NormalDeviate.h"
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

/// Amplitude of a candidate in this medium; 0 when it is not there.
SONO_HD inline float scattererAmplitude(const ScatteringMedium& medium, float presence, float deviate)
{
  const float amplitude = medium.mean + medium.sigma * normalDeviate(deviate);
  return presence < medium.probability ? amplitude : 0.0f;
}

} // namespace sono
