#pragma once

#include "Kernel/FastMath.h"
#include "Kernel/Rng.h"
#include "Kernel/SurfaceEcho.h"
#include "Kernel/Vec.h"

#include <cmath>
#include <cstdint>

// Pieces of the boundaries between labels, and the points (Gaussian blobs) that a piece is cut into for a wavelength.

namespace sono {

/// The surface between two face-adjacent voxels of different tissues, as a function over the voxels' column: at (u, v)
/// mm from the column's middle it lies at position[axis] + slopeU u + slopeV v + (bendUU u^2 + bendVV v^2) / 2 +
/// bendUV u v. u and v run along the axes (axis + 1) % 3 and (axis + 2) % 3.
struct SurfacePiece
{
  Vec3f positionMm; ///< local to the scene
  float slopeU;
  float slopeV;
  float bendUU; ///< 1/mm
  float bendUV;
  float bendVV;
  float share;        ///< of the surface in this column that this piece stands for: columns of other axes stand for the
                      ///< rest
  std::uint8_t axis;  ///< 0 to 2
  std::uint8_t below; ///< tissue index of the voxel and of the next one along the axis
  std::uint8_t above;
  Vec3i voxel;       ///< the one below
  Vec3f roughNormal; ///< its face's
};

/// A component of v along the axis `axis` plus 0, 1 or 2; the other way round, the vector of three such components.
/// By choice, since a GPU keeps what is indexed in memory.
template<class T>
SONO_HD inline T along(const glm::vec<3, T>& v, int axis, int plus)
{
  const int a = axis + plus < 3 ? axis + plus : axis + plus - 3;
  return a == 0 ? v.x : (a == 1 ? v.y : v.z);
}
SONO_HD inline Vec3f fromAlong(int axis, float first, float second, float third)
{
  return { axis == 0 ? first : (axis == 1 ? third : second), axis == 0 ? second : (axis == 1 ? first : third),
           axis == 0 ? third : (axis == 1 ? second : first) };
}

/// How one piece is cut: points along its u and v, their distances.
struct PieceNet
{
  int cutsU;
  int cutsV;
  float stepU; ///< mm
  float stepV;

  SONO_HD int points() const { return cutsU * cutsV; }
};

/// How pieces are cut: points of a voxel along each axis.
struct PieceCuts
{
  Vec3i cuts;

  SONO_HD PieceNet of(int axis, const Vec3f& spacingMm) const
  {
    const int cutsU = along(cuts, axis, 1);
    const int cutsV = along(cuts, axis, 2);
    return { cutsU, cutsV, quickDivide(along(spacingMm, axis, 1), float(cutsU)),
             quickDivide(along(spacingMm, axis, 2), float(cutsV)) };
  }
};

/// How many points a piece is cut into. A blob's own place and tilt count exactly, its curvature does not: the points
/// of coherent echoes lie as close together as the piece is bent. Diffuse echoes have random phases; a few points do.
struct PieceNets
{
  PieceCuts diffuse;
  Vec3f spacingMm; ///< between voxels
  Vec3i fewest;
  Vec3i most;
  float cutsPerMm; ///< per root of the curvature, 1/mm^1/2

  SONO_HD PieceCuts coherentCuts(const SurfacePiece& piece) const
  {
    const float bend = larger(fabsf(piece.bendUU), fabsf(piece.bendVV)) + fabsf(piece.bendUV);
    const float perMm = cutsPerMm * sqrtf(bend);
    const auto cutsOf = [perMm](float mm, int least, int most) {
      const int wanted = int(ceilf(smaller(mm * perMm, float(most))));
      return wanted > least ? wanted : least;
    };
    return { { cutsOf(spacingMm.x, fewest.x, most.x), cutsOf(spacingMm.y, fewest.y, most.y),
               cutsOf(spacingMm.z, fewest.z, most.z) } };
  }
  SONO_HD bool isCoarsest(const PieceCuts& net) const { return net.cuts == fewest; }
  SONO_HD PieceNet coherentNet(const SurfacePiece& piece) const
  {
    return coherentCuts(piece).of(piece.axis, spacingMm);
  }
  SONO_HD PieceNet diffuseNet(const SurfacePiece& piece) const { return diffuse.of(piece.axis, spacingMm); }
};

/// Deviation of a blob on a square net of step 1: the net shows through by exp(-2 pi^2 0.76^2) = 1e-5. Where a plane's
/// slope turns the phase by a cycle in a step (28 degrees for 0.5 mm and 2.5 MHz), that is in phase with an echo of
/// 3e-4.
constexpr double blobPerStep = 0.76;

/// The random phases of sixteen points' diffuse echoes, from number 16 `block` on: a function of the seed and of the
/// place in the world, as scatterers' amplitudes are. `kind` is the axis of a label's columns, or 3 for targets.
SONO_HD inline RandomWords surfacePhases(std::uint64_t seed, const Vec3i& cell, std::uint32_t kind, std::uint32_t block)
{
  return philox(seed, std::uint32_t(cell.x), std::uint32_t(cell.y), std::uint32_t(cell.z),
                0x5f0ce000u | (kind << 10) | block);
}

/// Which of 256 directions of the unit circle is the phase of a point, from those of its block.
SONO_HD inline std::uint32_t phaseAmong(const RandomWords& phases, std::uint32_t number)
{
  return (phases.v[(number >> 2) & 3u] >> (8u * (number & 3u))) & 255u;
}

SONO_HD inline std::uint32_t surfacePhase(std::uint64_t seed, const Vec3i& cell, std::uint32_t kind,
                                          std::uint32_t number)
{
  return phaseAmong(surfacePhases(seed, cell, kind, number >> 4), number);
}

/// Unit normal of a piece in its middle, and how far its points may lie from there.
struct PieceBounds
{
  Vec3f normal;
  float radiusMm;
};

SONO_HD inline PieceBounds pieceBounds(const SurfacePiece& piece, float longestStepMm)
{
  const float stretch = sqrtf(1.0f + piece.slopeU * piece.slopeU + piece.slopeV * piece.slopeV);
  const float perStretch = 1.0f / stretch;
  return { fromAlong(piece.axis, perStretch, -piece.slopeU * perStretch, -piece.slopeV * perStretch),
           0.70710678f * longestStepMm * stretch };
}

/// Point `number` of a piece, all but its row and its phase.
SONO_HD inline SurfacePoint piecePoint(const SurfacePiece& piece, const PieceNet& net, int number)
{
  const int j = int(quickDivide(float(number) + 0.5f, float(net.cutsU)));
  const int i = number - j * net.cutsU;
  const float du = (float(i) + 0.5f - 0.5f * float(net.cutsU)) * net.stepU;
  const float dv = (float(j) + 0.5f - 0.5f * float(net.cutsV)) * net.stepV;
  const float slopeU = piece.slopeU + piece.bendUU * du + piece.bendUV * dv;
  const float slopeV = piece.slopeV + piece.bendUV * du + piece.bendVV * dv;
  const float stretch = sqrtf(1.0f + slopeU * slopeU + slopeV * slopeV);
  const float perStretch = 1.0f / stretch;
  const float rise = 0.5f * ((piece.slopeU + slopeU) * du + (piece.slopeV + slopeV) * dv);
  const float blobU = float(blobPerStep) * net.stepU;
  const float blobV = float(blobPerStep) * net.stepV;
  const int axis = piece.axis;
  SurfacePoint point{};
  point.position = piece.positionMm + fromAlong(axis, rise, du, dv);
  point.normal = fromAlong(axis, perStretch, -slopeU * perStretch, -slopeV * perStretch);
  point.tangentU = fromAlong(axis, blobU * slopeU, blobU, 0.0f);
  point.tangentV = fromAlong(axis, blobV * slopeV, 0.0f, blobV);
  point.areaMm2 = piece.share * stretch * net.stepU * net.stepV;
  return point;
}

} // namespace sono
