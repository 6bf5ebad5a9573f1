#pragma once

#include "Kernel/EchoSplat.h"
#include "Kernel/FastMath.h"
#include "Kernel/Vec.h"

#include <cmath>
#include <cstdint>

// Scatterers whose density follows the resolution cell (Data/docs/physics.md section 4.7). A cell of level a has the
// edge 2^a / 32 mm and holds one candidate: that of one of its eight children, chosen by a hash. So the candidates of a
// coarser level are an eighth of the finer one's, the same wherever the probe stands and whatever it is; and since the
// eight children have an order, their rank, any number of them can be had.
//
// Candidates are made by bricks of 4^3 cells. Number n of a brick lies in the parent (a cell of the next level) of rank
// n % 8, in the cell there of rank n / 8: the first eight are those of the next level, the first is that of the one
// behind it.

namespace sono {

constexpr float nestedFinestMm = 1.0f / 32.0f; ///< edge of a cell of level 0
constexpr int nestedLevels = 8;                ///< up to cells of 4 mm
constexpr float nestedFullWeight = 12.0f;      ///< 1 / the weight from which on all candidates count (2.2 sigma)
constexpr float nestedInward = 0.5f;           ///< taken halfway from a brick's centre to its place nearest to the axis
constexpr float nestedLeastWeight = 0.003f;    ///< bricks of less are left out: 3.4 sigma, 1e-5 of the power
constexpr float nestedReach = 0.87f;           ///< a little more, as a share of a Gaussian beam's reach, beamCutSigma
constexpr int nestedBrickCells = 4;            ///< cells along an edge of a brick, on every level

SONO_HD inline float nestedCellMm(int level)
{
  return nestedFinestMm * float(1u << level);
}

/// Level from which hashes come down to the cells.
constexpr int nestedRootLevel = nestedLevels + 2;

/// A hash of a cell of the root's level: PCG3D (Jarzynski and Olano 2020, "Hash functions for GPU rendering").
SONO_HD inline std::uint32_t nestedRoot(std::uint64_t seed, const Vec3i& cell)
{
  std::uint32_t x = (std::uint32_t(cell.x) + std::uint32_t(seed)) * 1664525u + 1013904223u;
  std::uint32_t y = (std::uint32_t(cell.y) + std::uint32_t(seed >> 32)) * 1664525u + 1013904223u;
  std::uint32_t z = std::uint32_t(cell.z) * 1664525u + 1013904223u;
  x += y * z;
  y += z * x;
  z += x * y;
  x ^= x >> 16;
  y ^= y >> 16;
  z ^= z >> 16;
  x += y * z;
  y += z * x;
  z += x * y;
  return z;
}

/// The hash of a child of a cell, from the cell's: the mixer of MurmurHash3.
SONO_HD inline std::uint32_t nestedDescend(std::uint32_t hash, std::uint32_t child)
{
  hash ^= (child + 1u) * 0x9e3779b9u;
  hash ^= hash >> 16;
  hash *= 0x85ebca6bu;
  hash ^= hash >> 13;
  hash *= 0xc2b2ae35u;
  hash ^= hash >> 16;
  return hash;
}

/// Child 0 to 7 of a cell, bit 0 along x.
SONO_HD inline Vec3i nestedChild(const Vec3i& cell, std::uint32_t child)
{
  return { 2 * cell.x + int(child & 1u), 2 * cell.y + int((child >> 1) & 1u), 2 * cell.z + int((child >> 2) & 1u) };
}

/// The child whose candidate is the cell's own.
SONO_HD inline std::uint32_t chosenChild(std::uint32_t hash)
{
  return hash >> 29;
}

/// The child of a given rank, 0 to 7; rank 0 is the chosen one. An odd factor permutes the numbers modulo 8 and is its
/// own inverse.
SONO_HD inline std::uint32_t childOfRank(std::uint32_t hash, std::uint32_t rank)
{
  const std::uint32_t odd = ((hash >> 26) & 6u) | 1u;
  return ((rank * odd) & 7u) ^ chosenChild(hash);
}

/// The hash of a brick of a level, which is a cell two levels above.
SONO_HD inline std::uint32_t nestedBrickHash(std::uint64_t seed, const Vec3i& brick, int level)
{
  const int up = nestedRootLevel - (level + 2);
  std::uint32_t hash = nestedRoot(seed, { brick.x >> up, brick.y >> up, brick.z >> up });
  for (int l = up - 1; l >= 0; --l)
  {
    hash = nestedDescend(
      hash, std::uint32_t(((brick.x >> l) & 1) | (((brick.y >> l) & 1) << 1) | (((brick.z >> l) & 1) << 2)));
  }
  return hash;
}

/// A cell with its hash.
struct NestedCell
{
  Vec3i cell;
  std::uint32_t hash;

  SONO_HD NestedCell child(std::uint32_t number) const
  {
    return { nestedChild(cell, number), nestedDescend(hash, number) };
  }
};

/// The cell of level 0 that holds candidate `number` of a brick, 0 to 63.
SONO_HD inline NestedCell nestedFinestCell(const NestedCell& brick, int level, int number)
{
  static_assert(nestedLevels + 2 <= 10, "the way down takes a bit of each coordinate, and ten of them a word's third");
  std::uint32_t hash = brick.hash;
  std::uint32_t way = 0u; // x from bit 0 on, y from bit 10, z from bit 20
  const auto descend = [&](std::uint32_t child) {
    way = 2u * way + ((child * 0x40201u) & 0x100401u);
    hash = nestedDescend(hash, child);
  };
  descend(childOfRank(hash, std::uint32_t(number & 7)));
  descend(childOfRank(hash, std::uint32_t(number >> 3)));
  for (int l = level; l > 0; --l)
  {
    descend(chosenChild(hash));
  }
  const int scale = 4 << level;
  return { { brick.cell.x * scale + int(way & 1023u), brick.cell.y * scale + int((way >> 10) & 1023u),
             brick.cell.z * scale + int(way >> 20) },
           hash };
}

/// What the scatterers of a tissue are: all of one strength, there with `probability`.
struct NestedMedium
{
  float amplitude = 0.0f;
  float probability = 0.0f;
};

/// A candidate, before the tissue at its position decides on presence and amplitude.
struct NestedCandidate
{
  Vec3f positionMm;
  float presence; ///< uniform [0, 1): there when below the tissue's probability
  float sign;     ///< 1 or -1 by chance, so that powers add however regular the cells are

  SONO_HD float amplitude(const NestedMedium& medium) const
  {
    return presence < medium.probability ? sign * medium.amplitude : 0.0f;
  }
};

/// Of a cell of level 0; local mm.
SONO_HD inline NestedCandidate nestedCandidate(const NestedCell& c)
{
  const std::uint32_t other = nestedDescend(c.hash, 8u);
  const auto at = [](int cell, std::uint32_t bits) {
    return (float(cell) + (float(std::int32_t(bits & 255u)) + 0.5f) * (1.0f / 256.0f)) * nestedFinestMm;
  };
  return { { at(c.cell.x, c.hash), at(c.cell.y, c.hash >> 8), at(c.cell.z, c.hash >> 16) },
           float(std::int32_t(other >> 8)) * (1.0f / 16777216.0f),
           (other & 1u) ? 1.0f : -1.0f };
}

/// A part of a brick's candidates, by number: those below `count`, of which the last ones have their amplitudes times
/// `last`, so that nothing pops up where the part grows.
struct NestedShare
{
  int count;   ///< 1 to 8, or eighths of all: 8 to 64; 0: none
  int whole;   ///< that do not fade
  float last;  ///< above 0, up to 1
  float scale; ///< of all amplitudes, as 1 / sqrt(density), mm^(3/2)

  SONO_HD float scaleOf(int number) const { return number < whole ? scale : scale * last; }
};

/// Of cells of this edge so many eighths, 1/8, which is one candidate of a brick, to 8.
SONO_HD inline NestedShare nestedShareOf(float eighths, float edgeMm)
{
  const float steps = eighths * (eighths > 1.0f ? 1.0f : 8.0f);
  const int together = eighths > 1.0f ? 8 : 1; // that fade in
  const int last = int(ceilf(steps));
  return { together * last, together * (last - 1), sqrtf(steps - float(last - 1)),
           sqrtf(edgeMm * edgeMm * edgeMm * 8.0f / eighths) };
}

/// The eighths of cells of this edge where so many candidates are needed, at a weight of the beam.
SONO_HD inline float nestedEighths(float perMm3, float edgeMm, float weight)
{
  const float full = weight * nestedFullWeight;
  const float needed = 8.0f * perMm3 * (full < 1.0f ? full : 1.0f) * edgeMm * edgeMm * edgeMm;
  return larger(0.125f, smaller(8.0f, needed));
}

/// Which bricks a line takes its scatterers from, and which part of them. Trivially copyable; see
/// ScattererDensity, which owns the tables. A brick of level a is a cube of 4^3 cells. A line takes the coarsest bricks
/// whose whole depth does with their density: each point of space lies in exactly one of them.
struct DensityView
{
  const float* perMm3 = nullptr;              ///< candidates that are needed, at each depth
  const std::uint8_t* coarseEnough = nullptr; ///< bit a: bricks of level a around that depth have enough
  int count = 0;
  float depthsPerMm = 1.0f;
  int finest = 0; ///< first and last level in use
  int coarsest = 0;

  SONO_HD int at(float depthMm) const
  {
    const float place = roundedProduct(depthMm, depthsPerMm) + 0.5f;
    const int i = place > 0.0f ? int(place) : 0;
    return i < count ? i : count - 1;
  }
  /// Whether a line takes the brick of this level, with the depth of its centre and that of the centre of the brick of
  /// the next level in which it lies.
  SONO_HD bool takes(int level, float depthMm, float parentDepthMm) const
  {
    return takesAt(level, at(depthMm), at(parentDepthMm));
  }
  /// The same with the depths' places in the tables.
  SONO_HD bool takesAt(int level, int depth, int parentDepth) const
  {
    const bool enough = level == finest || ((coarseEnough[depth] >> level) & 1u);
    const bool parentHas = level < coarsest && ((coarseEnough[parentDepth] >> (level + 1)) & 1u);
    return enough && !parentHas;
  }
  /// Eighths of the candidates of this level that do at this depth and at this weight of the beam, which is 1 on its
  /// axis. Far from the axis fewer and stronger ones do: what they add to the envelope's moments goes with the fourth
  /// power of the weight.
  SONO_HD NestedShare share(int level, float depthMm, float weight) const
  {
    const float edge = nestedCellMm(level);
    return nestedShareOf(nestedEighths(perMm3[at(depthMm)], edge, weight), edge);
  }
};

/// Half the extent of a brick of this level along a beam's lateral and elevational direction, mm.
SONO_HD inline Vec2f nestedHalfExtent(const Beam& b, int level)
{
  const auto along = [](const Vec3f& d) { return fabsf(d.x) + fabsf(d.y) + fabsf(d.z); };
  return Vec2f(along(b.lateral), along(b.elevation)) * (0.5f * nestedCellMm(level) * float(nestedBrickCells));
}

/// Centre of a brick of this level, mm.
SONO_HD inline Vec3f nestedBrickCentre(const Vec3i& brick, int level)
{
  return (Vec3f(brick) + 0.5f) * (nestedCellMm(level) * float(nestedBrickCells));
}

/// Depth of a brick's centre along a beam. Which level gives a place is asked of a brick by itself and of it as a
/// parent of others, and on either device: products are rounded by themselves everywhere.
SONO_HD inline float nestedBrickDepth(const Vec3i& brick, int level, const Vec3f& origin, const Vec3f& axis)
{
  const Vec3f q = nestedBrickCentre(brick, level) - origin; // a centre is exact
  return roundedProduct(q.x, axis.x) + roundedProduct(q.y, axis.y) + roundedProduct(q.z, axis.z);
}

} // namespace sono
