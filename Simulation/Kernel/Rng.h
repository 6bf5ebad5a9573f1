#pragma once

#include "Kernel/HostDevice.h"
#include "Kernel/Vec.h"

#include <cstdint>

namespace sono {

/// Four random words.
struct RandomWords
{
  std::uint32_t v[4];
};

/// Philox4x32-10, a counter-based generator (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3",
/// SC 2011): the same key and counter give the same words on every device.
SONO_HD inline RandomWords philox(std::uint64_t key, std::uint32_t c0, std::uint32_t c1, std::uint32_t c2,
                                  std::uint32_t c3)
{
  std::uint32_t k0 = std::uint32_t(key);
  std::uint32_t k1 = std::uint32_t(key >> 32);
  for (int round = 0; round < 10; ++round)
  {
    const std::uint64_t p0 = std::uint64_t(0xD2511F53u) * c0;
    const std::uint64_t p1 = std::uint64_t(0xCD9E8D57u) * c2;
    c0 = std::uint32_t(p1 >> 32) ^ c1 ^ k0;
    c2 = std::uint32_t(p0 >> 32) ^ c3 ^ k1;
    c1 = std::uint32_t(p1);
    c3 = std::uint32_t(p0);
    k0 += 0x9E3779B9u;
    k1 += 0xBB67AE85u;
  }
  return { { c0, c1, c2, c3 } };
}

/// Uniform in the open interval (0, 1): 23 bits and a half fill the 24 of single precision, so that nothing is rounded
/// and neither end occurs.
SONO_HD inline float uniformFrom(std::uint32_t word)
{
  return (float(word >> 9) + 0.5f) * (1.0f / 8388608.0f);
}

/// What one boundary consumes.
struct BounceSample
{
  float choice;  ///< reflect or transmit
  float polar;   ///< phi of the lobe
  float azimuth; ///< theta of the lobe
};

SONO_HD inline std::uint32_t reverseBits(std::uint32_t x)
{
  x = (x << 16) | (x >> 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
  x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
  x = ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
  return x;
}

/// A hash in which lower bits steer higher ones (Laine and Karras 2011, with Burley's 2020 constants).
SONO_HD inline std::uint32_t hashUpward(std::uint32_t x, std::uint32_t seed)
{
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// Nested uniform (Owen) scrambling of a base-2 fraction, in which higher bits steer lower ones.
SONO_HD inline std::uint32_t owenScramble(std::uint32_t fraction, std::uint32_t seed)
{
  return reverseBits(hashUpward(reverseBits(fraction), seed));
}

/// The second dimension of Sobol's sequence, bits reversed: bit j is the sum modulo 2 of the index bits k with C(k, j)
/// odd, that is (Lucas) of the k that contain j, five steps of a superset sum.
SONO_HD inline std::uint32_t sobolSecondReversed(std::uint32_t index)
{
  index ^= (index >> 1) & 0x55555555u;
  index ^= (index >> 2) & 0x33333333u;
  index ^= (index >> 4) & 0x0f0f0f0fu;
  index ^= (index >> 8) & 0x00ff00ffu;
  index ^= (index >> 16) & 0x0000ffffu;
  return index;
}

/// Stream keys: (seed; line, path, bounce, batch). A path's numbers depend on nothing else.
SONO_HD inline BounceSample independentSample(std::uint64_t seed, std::uint32_t line, std::uint32_t batch,
                                              std::uint32_t path, std::uint32_t bounce)
{
  const RandomWords w = philox(seed, line, path, bounce, batch);
  return { uniformFrom(w.v[0]), uniformFrom(w.v[1]), uniformFrom(w.v[2]) };
}

/// The scrambles that one bounce of one batch shares: every batch is a randomised low-discrepancy set of its own,
/// so that batch means are independent.
struct BounceScramble
{
  std::uint32_t shuffle;
  std::uint32_t choice;
  std::uint32_t polar;
  std::uint32_t azimuth;
};

SONO_HD inline BounceScramble makeBounceScramble(std::uint64_t seed, std::uint32_t line, std::uint32_t batch,
                                                 std::uint32_t bounce)
{
  const RandomWords w = philox(seed, line, 0xfffffff0u, bounce, batch);
  return { w.v[0], w.v[1], w.v[2], w.v[3] };
}

/// Padded Sobol pairs: (polar, azimuth) is a scrambled (0,2)-sequence over the paths of a batch, `choice` a scrambled
/// van der Corput sequence; each bounce visits the points in another order so that bounces stay uncorrelated.
/// Scrambling the index itself (Burley 2020) maps aligned blocks of 2^k paths onto aligned blocks of the sequence,
/// which keeps their stratification.
SONO_HD inline BounceSample lowDiscrepancySample(const BounceScramble& s, std::uint32_t path)
{
  const std::uint32_t choiceIndex = owenScramble(path, s.shuffle ^ 0x9e3779b9u);
  const std::uint32_t index = owenScramble(path, s.shuffle);
  // owenScramble of the sequences' elements, whose bits are at hand in reverse.
  return { uniformFrom(reverseBits(hashUpward(choiceIndex, s.choice))),
           uniformFrom(reverseBits(hashUpward(index, s.polar))),
           uniformFrom(reverseBits(hashUpward(sobolSecondReversed(index), s.azimuth))) };
}

} // namespace sono
