#include "Trace/AxisWay.h"

#include "Core/Simd.h"

#include <cmath>
#include <cstddef>

namespace sono {

namespace {

SONO_SIMD_CLONES void fill(const FlightStep& each, const AxisSums& before, int count, float* rangeMm, float* amplitude,
                           float* absorbedNp)
{
  const FlightStep step = each;
  const AxisSums sums = before;
#pragma GCC ivdep
  for (int s = 0; s < count; ++s)
  {
    rangeMm[s] = float(sums.rangeMm + double(s) * double(step.rangeMm));
    amplitude[s] = float(sums.amplitude) * expNegative(-0.5f * step.lostNp * float(s));
    absorbedNp[s] = float(sums.absorbedNp + double(s) * double(step.absorbedNp));
  }
}

} // namespace

void goOn(const FlightStep& each, int first, int count, AxisSums& sums, AxisWay& way)
{
  const std::size_t at = std::size_t(first);
  fill(each, sums, count, way.rangeMm.data() + at, way.amplitude.data() + at, way.absorbedNp.data() + at);
  sums.rangeMm += double(count) * double(each.rangeMm);
  sums.amplitude *= std::exp(-0.5 * double(count) * double(each.lostNp));
  sums.absorbedNp += double(count) * double(each.absorbedNp);
}

void AxisWay::writeOffsets(int bins, double binMm, float* offsetMm) const
{
  const float* const ranges = rangeMm.data();
  const int last = steps();
  int before = 0;
  for (int b = 0; b < bins; ++b)
  {
    const float wanted = float(b) * float(binMm);
    while (before + 1 < last && ranges[before + 1] <= wanted)
    {
      ++before; // depthOfRange would look for it anew
    }
    offsetMm[b] = (wanted < ranges[last] ? depthAfterStep(ranges, last, stepMm, before, wanted)
                                         : depthOfRange(ranges, last, stepMm, wanted)) -
                  wanted;
  }
}

} // namespace sono
