#pragma once

#include "Kernel/SurfaceEcho.h"
#include "Kernel/SurfacePiece.h"

#include <cstddef>
#include <cstdint>
#include <vector>

// A brick's faces, pieces and points, as HeardSurfaces.h and SurfaceLoops.h take them: arrays by number, with room up
// to whole vectors.

namespace sono {

/// Faces, of which only a rough normal is known.
struct FaceList
{
  std::vector<float> x, y, z; ///< their middles, mm
  std::vector<float> normalX, normalY, normalZ;
  std::vector<float> cosineBelow, cosineAbove; ///< below it nothing counts, as met along the normal and against it
  int count = 0;

  void clear() { count = 0; }
  /// Room for so many more.
  void reserve(int more);
  /// Of a boundary met from either side; there must be room for it. Inline: each brick that a line passes has some.
  void push(const Vec3f& middle, const Vec3f& roughNormal, const SurfaceRow& below, const SurfaceRow& above)
  {
    const std::size_t n = std::size_t(count++);
    x[n] = middle.x;
    y[n] = middle.y;
    z[n] = middle.z;
    normalX[n] = roughNormal.x;
    normalY[n] = roughNormal.y;
    normalZ[n] = roughNormal.z;
    cosineBelow[n] = below.roughCosine;
    cosineAbove[n] = above.roughCosine;
  }
};

/// Pieces, or points of targets as such.
struct PieceList
{
  std::vector<float> x, y, z; ///< mm
  std::vector<float> normalX, normalY, normalZ;
  std::vector<float> radiusMm; ///< points lie no further away
  std::vector<std::int32_t> row;
  /// Of SurfaceRow, as met from a and from b; the coherent reach is that of the blobs the piece has.
  std::vector<float> reachA, reachB, coherentReachA, coherentReachB, decayPerMmA, decayPerMmB;
  int count = 0;

  void clear() { count = 0; }
  /// One of which no more is known yet.
  void place(const Vec3f& position, int rowFromA);
  /// What one counts of its row. `coarse`: its blobs are the coarsest.
  void setReach(int piece, bool coarse, const SurfaceTable& table);
  /// Both, of one that is known.
  void push(const Vec3f& position, const Vec3f& normal, float radius, bool coarse, int rowFromA,
            const SurfaceTable& table);
};

/// Points of pieces, ascending by piece.
struct PointList
{
  std::vector<float> x, y, z; ///< mm
  std::vector<float> normalX, normalY, normalZ;
  std::vector<float> uX, uY, uZ, vX, vY, vZ; ///< tangents, of coherent echoes
  std::vector<float> areaMm2;
  std::vector<float> phaseRe, phaseIm; ///< of diffuse echoes
  std::vector<std::int32_t> row, piece;
  int count = 0;

  void clear() { count = 0; }
  /// Room for so many more.
  void reserve(int more);
  void push(const SurfacePoint& point, int ofPiece);
  /// Fills up to whole vectors with what echoes nothing; before it is listened to.
  void pad();
};

/// Component of the n-th of some vectors along a direction.
inline float across(const float* x, const float* y, const float* z, int n, const Vec3f& direction)
{
  return x[n] * direction.x + y[n] * direction.y + z[n] * direction.z;
}

/// All points of a piece's net, without phases.
void addNet(const SurfacePiece& piece, const PieceNet& net, int row, int ofPiece, PointList& points);

} // namespace sono
