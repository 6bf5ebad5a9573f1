#pragma once

#include "Kernel/FastMath.h"
#include "Kernel/TraceView.h"

#include <cmath>
#include <cstdint>

// How far sound that was reflected has spread (Data/docs/physics.md 13.4): a beam that mirrors fold stays in one
// resolution cell; behind rough or curved walls its paths lie in many, whose tissues echo with signs of their own.

namespace sono {

/// How well a line hears what comes back beside its axis where the probe does not name its aperture: a standard
/// deviation in mm, of the two-way amplitude. Chosen: about a beam's width.
constexpr float heardAsideMm = 1.5f;

/// Along one side of the aperture: how wide the line's cell is at a range, and the paths that nothing has spread, mm.
struct CellSide
{
  float mm2;     ///< squared width of the cell
  float pathsMm; ///< from the first to the last
};

/// The integral of a beam's two-way amplitude, squared, over that of its square: 3/2 lambda r / D of an aperture of
/// even weight at its focus, and as wide as its paths are apart elsewhere; sqrt(4 pi) deviations of a Gaussian.
SONO_HD inline CellSide cellSide(float perMm, float halfMm, float perFocus, float rangeMm)
{
  constexpr float rootOfFourPi = 3.5449077f;
  const float pathsMm = 2.0f * halfMm * fabsf(1.0f - rangeMm * perFocus);
  const float waveMm = perMm > 0.0f ? perMm * rangeMm : rootOfFourPi * heardAsideMm;
  return { waveMm * waveMm + pathsMm * pathsMm, pathsMm };
}

/// How likely two places of a row so long lie in one cell of a grid across it that begins anywhere.
SONO_HD inline float sameCell(float lengthMm, float cellMm)
{
  const float x = lengthMm / cellMm;
  return x < 1.0f ? 1.0f - x * (1.0f / 3.0f) : (1.0f - 1.0f / (3.0f * x)) / x;
}

/// The resolution cell of a line at a range, taken for a cube, and how likely two of the paths that nothing has spread
/// lie in one.
struct ResolutionCell
{
  float sideMm;
  float unspread;
};

/// Along the way of the sound a cell is shorter, about as a wavefront is bent in it and a pulse long; and sound that
/// comes from another direction, by about as much as an aperture is wide as seen from the tissue, meets another
/// speckle.
constexpr float cellLengthMm = 1.5f;
constexpr float cellAngle = 0.5f;

SONO_HD inline ResolutionCell resolutionCell(const TraceView& view, const TraceLine& line, float rangeMm)
{
  const float halfLateral = glm::length(line.lateral);
  const float halfElevational = glm::length(line.elevation);
  const CellSide lateral = cellSide(view.cellLateralPerMm, halfLateral, view.perTransmitFocus, rangeMm);
  const CellSide elevational = cellSide(view.cellElevationPerMm, halfElevational, view.perElevationFocus, rangeMm);
  const float sideMm = larger(sqrtf(sqrtf(lateral.mm2 * elevational.mm2)), 0.05f);
  const float sameSide = sameCell(lateral.pathsMm, sideMm) * sameCell(elevational.pathsMm, sideMm);
  const float sameAngle = sameCell(2.0f * halfLateral * view.perTransmitFocus, cellAngle) *
                          sameCell(2.0f * halfElevational * view.perElevationFocus, cellAngle);
  return { sideMm, sameSide * sameAngle };
}

SONO_HD inline std::uint32_t mixedBits(std::uint32_t x)
{
  // The finaliser of MurmurHash3 (Appleby, public domain).
  x = (x ^ (x >> 16)) * 0x85ebca6bu;
  x = (x ^ (x >> 13)) * 0xc2b2ae35u;
  return x ^ (x >> 16);
}

/// Which signs are drawn for a line's bin of range.
SONO_HD inline std::uint32_t signDraw(std::uint32_t line, int bin)
{
  return mixedBits(std::uint32_t(bin) * 0x9e3779b9u + line * 0x85ebca77u + 1u);
}

/// The sign of the speckle that a path meets at a place on its way: +1 or -1, drawn for each cell. Each `draw` has
/// grids that begin elsewhere.
SONO_HD inline float cellSign(const Vec3f& place, const Vec3f& direction, float sideMm, std::uint32_t draw)
{
  const std::uint32_t more = mixedBits(draw);
  const auto begin = [](std::uint32_t bits) { return float(bits & 1023u) * (1.0f / 1024.0f); };
  const float perSide = 1.0f / sideMm;
  std::uint32_t key = draw;
  float along = 0.0f;
  for (int axis = 0; axis < 3; ++axis)
  {
    const float position = place[axis] * perSide + begin(draw >> (10 * axis));
    const float cell = floorf(position);
    const float turn = floorf(direction[axis] * (1.0f / cellAngle) + begin(more >> (10 * axis)));
    along += direction[axis] * (position - cell - 0.5f);
    // Odd factors of the kind that Weyl sequences take; what follows mixes them.
    key = (key + std::uint32_t(int(cell))) * 0x9e3779b1u;
    key = (key + std::uint32_t(int(turn))) * 0x85ebca6bu;
  }
  const float step = floorf(along * sideMm * (1.0f / cellLengthMm) + begin((draw * more) >> 22));
  return (mixedBits(key + std::uint32_t(int(step))) & 1u) != 0u ? 1.0f : -1.0f;
}

} // namespace sono
