#pragma once

#include "Kernel/FastMath.h"
#include "Kernel/HostDevice.h"

namespace sono {

/// A complex number of a beam's weight.
struct ComplexWeight
{
  float re;
  float im;
};

/// One axis of a computed beam: complex values over (place, range), place fastest, place n at a share of n / perUnit of
/// max(range, nearMm), on the half where it is not negative: the steps widen with the beam.
struct ArrayBeamAxis
{
  const float* values; ///< re, im
  int count;           ///< of places, at least 2
  float perUnit;
  float nearMm;
};

/// A computed two-way beam (Data/docs/physics.md section 12.2): its weight at a distance `range` from the middle of the
/// face is the product of both axes' values, its echo comes from that range. Trivially copyable.
struct ArrayBeamView
{
  ArrayBeamAxis lateral;
  ArrayBeamAxis elevational;
  float rangesPerMm;
  int rangeCount; ///< at least 2; beyond the last one the beam stays as it is there
};

/// A place in an axis' table: the value before it in both directions, and the share of the next.
struct ArrayBeamCell
{
  int index; ///< of the value's real part
  float share;
  bool inside;
};

SONO_HD inline ArrayBeamCell arrayBeamCell(const ArrayBeamAxis& axis, int rangeIndex, float mm, float rangeMm)
{
  const float distance = mm < 0.0f ? -mm : mm;
  const float place = quickDivide(distance * axis.perUnit, larger(rangeMm, axis.nearMm));
  const float last = float(axis.count - 1);
  const float held = smaller(place, last);
  const float cell = smaller(floorf(held), last - 1.0f);
  return { 2 * (rangeIndex * axis.count + int(cell)), held - cell, place <= last };
}

/// Where a range falls between two of the table's.
struct ArrayBeamRange
{
  int index;
  float share;
};

SONO_HD inline ArrayBeamRange arrayBeamRange(const ArrayBeamView& view, float rangeMm)
{
  const float last = float(view.rangeCount - 1);
  const float place = smaller(rangeMm * view.rangesPerMm, last);
  const float before = smaller(floorf(place), last - 1.0f);
  return { int(before), place - before };
}

SONO_HD inline ComplexWeight arrayBeamValue(const float* v, int row, float share, float rangeShare)
{
  const float nearRe = v[0] + share * (v[2] - v[0]);
  const float nearIm = v[1] + share * (v[3] - v[1]);
  const float farRe = v[row] + share * (v[row + 2] - v[row]);
  const float farIm = v[row + 1] + share * (v[row + 3] - v[row + 1]);
  return { nearRe + rangeShare * (farRe - nearRe), nearIm + rangeShare * (farIm - nearIm) };
}

/// Weight at distances from the axis, mm, and a range; 0 beside the table.
SONO_HD inline ComplexWeight arrayBeamWeight(const ArrayBeamView& view, float lateralMm, float elevationalMm,
                                             float rangeMm)
{
  const ArrayBeamRange range = arrayBeamRange(view, rangeMm);
  const ArrayBeamCell l = arrayBeamCell(view.lateral, range.index, lateralMm, rangeMm);
  const ArrayBeamCell e = arrayBeamCell(view.elevational, range.index, elevationalMm, rangeMm);
  const ComplexWeight a = arrayBeamValue(view.lateral.values + l.index, 2 * view.lateral.count, l.share, range.share);
  const ComplexWeight b =
    arrayBeamValue(view.elevational.values + e.index, 2 * view.elevational.count, e.share, range.share);
  const float inside = l.inside && e.inside ? 1.0f : 0.0f;
  return { inside * (a.re * b.re - a.im * b.im), inside * (a.re * b.im + a.im * b.re) };
}

} // namespace sono
