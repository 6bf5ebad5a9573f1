#pragma once

#include "Echo/SurfaceLists.h"

#include <cstdint>
#include <vector>

// Which of a brick's faces and pieces a line hears, in vectors: Kernel/SurfaceEcho.h for many at once.

namespace sono {

/// What a line hears of each piece.
struct HeardList
{
  std::vector<float> diffuse, coherent; ///< the intensity there if it hears such an echo, otherwise 0
  std::vector<float> most;
  bool anyDiffuse = false;
  bool anyCoherent = false;
};

/// mayHearSurface of each face: `heard`, with room for whole vectors, is 1 where it is so, otherwise 0.
void markHeard(const FaceList& faces, float radiusMm, const Beam& beam, const LineGrid& grid, std::int32_t* heard);

/// hearSurface of each piece whose face the beam may hear, with room for whole vectors; null: of all.
void hearPieces(const PieceList& pieces, const std::int32_t* mayHear, const Beam& beam, const LineGrid& grid,
                const SurfaceTable& table, const SurfaceIntensity& intensity, HeardList& heard);

} // namespace sono
