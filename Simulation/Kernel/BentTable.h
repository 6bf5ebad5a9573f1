#pragma once

#include "Kernel/FastMath.h"

// Tables of what rises straight but for bends at boundaries, far more of it straight than bent (Data/docs/physics.md
// 13.1): a bend between two entries is found where the lines through the entries on its two sides meet.

namespace sono {

/// How steeply a line rises on the way from one place to another, and on those before and behind.
struct Slopes
{
  float before;
  float here;
  float behind;
};

/// Between a and b, `from` behind a and `rest` before b: straight on from both, as in front of a and behind b, to where
/// they meet, if one boundary has bent a straight line there; otherwise straight.
SONO_HD inline float bentBetween(float a, float b, float from, float rest, const Slopes& slopes)
{
  const float before = a + slopes.before * from;
  const float behind = b - slopes.behind * rest;
  if (slopes.before < slopes.here && slopes.here < slopes.behind)
  {
    return larger(before, behind);
  }
  const bool isBent = slopes.before > slopes.here && slopes.here > slopes.behind;
  return isBent ? smaller(before, behind) : a + slopes.here * from;
}

/// The same between values at multiples of a step, [0, last], at a share of the step that begins with one of them.
SONO_HD inline float bentAt(const float* values, int last, int step, float share)
{
  const float a = values[step];
  const float b = values[step + 1];
  const float before = step > 0 ? a - values[step - 1] : b - a;
  const float behind = step + 1 < last ? values[step + 2] - b : b - a;
  return bentBetween(a, b, share, 1.0f - share, { before, b - a, behind });
}

} // namespace sono
