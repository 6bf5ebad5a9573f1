#pragma once

#include "Echo/FaintPieces.h"
#include "Echo/SurfaceLists.h"
#include "Kernel/SurfacePiece.h"

#include <cstdint>
#include <vector>

namespace sono {

/// How fitted pieces are bent: arrays by number, as in PieceList, with room up to whole vectors.
struct PieceShapes
{
  std::vector<float> slopeU, slopeV, bendUU, bendUV, bendVV, share;
  std::vector<std::int32_t> axis;
  std::vector<std::int32_t> isCoarsest; ///< whether a piece is cut into the coarsest blobs, 1 or 0
  int count = 0;

  void clear() { count = 0; }
  void push(const SurfacePiece& piece);
};

/// What lines hear pieces by, of all at once: pieceBounds, how each is cut for coherent echoes, and within what its
/// points lie, which are at most `longestStepMm` apart. The list has their places and rows (PieceList::place).
void layOutPieces(PieceShapes& shapes, const PieceNets& nets, float longestStepMm, const SurfaceTable& table,
                  PieceList& pieces, PieceExtents& extents);

} // namespace sono
