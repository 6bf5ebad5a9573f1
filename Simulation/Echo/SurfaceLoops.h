#pragma once

#include "Kernel/SurfacePiece.h"

#include <cstdint>
#include <initializer_list>
#include <vector>

// The loops over a brick's faces, pieces and points that SurfaceEchoes is made of, in vectors: Kernel/SurfaceEcho.h for
// many at once. Lists are arrays by number, with room up to whole vectors.

namespace sono {

/// Faces, of which only a rough normal is known.
struct FaceList
{
  std::vector<float> x, y, z; ///< their middles, mm
  std::vector<float> normalX, normalY, normalZ;
  std::vector<float> cosineBelow, cosineAbove; ///< below it nothing counts, as met along the normal and against it
  std::vector<float> seen;                     ///< room
  int count = 0;

  void clear() { count = 0; }
  /// Of a boundary met from either side.
  void push(const Vec3f& middle, const Vec3f& roughNormal, const SurfaceRow& below, const SurfaceRow& above);
};

/// Pieces, or points of targets as such.
struct PieceList
{
  std::vector<float> x, y, z; ///< mm
  std::vector<float> normalX, normalY, normalZ;
  std::vector<float> radiusMm; ///< points lie no further away
  std::vector<float> isCoarse; ///< 1 or 0
  std::vector<std::int32_t> row;
  int count = 0;

  void clear() { count = 0; }
  void push(const Vec3f& position, const Vec3f& normal, float radius, bool coarse, int rowFromA);
};

/// What a line hears of each piece.
struct HeardList
{
  std::vector<float> diffuse, coherent; ///< the intensity there if it hears such an echo, otherwise 0
  std::vector<float> most;
  bool anyDiffuse = false;
  bool anyCoherent = false;
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

/// All points of a piece's net, without phases.
void addNet(const SurfacePiece& piece, const PieceNet& net, int row, int ofPiece, PointList& points);

/// mayHearSurface of each face: sets `heard`, as long as the list, to 1 where it is so.
void markHeard(FaceList& faces, float radiusMm, const Beam& beam, const LineGrid& grid, std::int32_t* heard);

/// hearSurface of each piece.
void hearPieces(const PieceList& pieces, const Beam& beam, const LineGrid& grid, const SurfaceTable& table,
                const SurfaceIntensity& intensity, HeardList& heard);

/// addDiffuse and addCoherent of each point, to a line's sum.
void addDiffusePoints(const PointList& points, const HeardList& heard, const Beam& beam, const LineGrid& grid,
                      const SurfaceTable& table, float* iq);
void addCoherentPoints(const PointList& points, const HeardList& heard, const Beam& beam, const LineGrid& grid,
                       const SurfaceTable& table, float* iq);

} // namespace sono
