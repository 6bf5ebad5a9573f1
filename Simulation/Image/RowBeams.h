#pragma once

#include "Kernel/PlaneScan.h"

namespace sono {

/// PlaneBeams::beamAt of a row of places, `x` as axialFromCentre: for loops in vectors, into which it is to be inlined.
inline void beamsOfRow(const PlaneBeams& beams, const float* __restrict lateralMm, float x, int count,
                       float* __restrict line, float* __restrict depthMm)
{
  const float forward = PlaneBeams::notZero(x);
  for (int i = 0; beams.parallel && i < count; ++i)
  {
    line[i] = beams.lineOfParallel(lateralMm[i]);
    depthMm[i] = x - beams.faceRadiusMm;
  }
  for (int i = 0; !beams.parallel && i < count; ++i)
  {
    line[i] = beams.lineOfFan(lateralMm[i], forward);
    depthMm[i] = beams.depthInFan(lateralMm[i], x);
  }
}

} // namespace sono
