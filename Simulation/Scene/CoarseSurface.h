#pragma once

#include "Scene/SurfaceField.h"

namespace sono {

/// With a unit normal at each point, to the side that the triangles face, so that these look as round as what they
/// stand for.
struct DrawnSurface : TriangleSurface
{
  std::vector<std::array<float, 3>> normals;
};

/// The surface by fewer triangles, to be drawn: of points in a cube of an edge of `cubeMm` that edges join along which
/// the normal hardly turns, one is left in their middle. So the two sides of a thin wall stay apart, and what was
/// closed stays closed.
DrawnSurface coarseSurface(const TriangleSurface& surface, double cubeMm);

} // namespace sono
