#include "Core/Simd.h"
#include "Phantoms/ThoraxChest.h"

namespace sono {

SONO_SIMD_CLONES void wallRow(double px, double stepMm, double py, double halfWidthMm, double halfDepthMm, int count,
                              double* __restrict depthMm, double* __restrict side, double* __restrict back)
{
  for (int i = 0; i < count; ++i)
  {
    const WallPoint point = wallPoint(px + stepMm * i, py, halfWidthMm, halfDepthMm);
    depthMm[i] = point.depthMm;
    side[i] = point.side;
    back[i] = point.back;
  }
}

} // namespace sono
