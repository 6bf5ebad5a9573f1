#pragma once

#include "Kernel/HostDevice.h"

namespace sono {

/// One axis of a beam table, as the lookup wants it.
struct BeamFieldAxis
{
  float lowMm; ///< first and last position that the table answers for
  float highMm;
  float minMm;   ///< position of the first value
  float perMm;   ///< values per mm; 0 where there is only one value
  int lastCell;  ///< index of the last interval's first value
  int stride;    ///< from a value to the next one along this axis; 0 where there is only one
  bool mirrored; ///< the table holds the half at positions >= 0 of a symmetric beam
};

/// A table of two-way beam weights over (lateral, elevational, depth), mm in a beam's frame, lateral fastest.
/// Trivially copyable; the values belong to a PulseEchoField or to a copy of its values on the device.
struct BeamFieldView
{
  const float* values;
  BeamFieldAxis lateral;
  BeamFieldAxis elevational;
  BeamFieldAxis depth;
};

/// Where a position falls on an axis: the index of the value before it, and the share of the one behind it.
struct BeamFieldCell
{
  int index;
  float share;
  bool inside;
};

SONO_HD inline BeamFieldCell beamFieldCell(const BeamFieldAxis& axis, float positionMm)
{
  const float p = axis.mirrored && positionMm < 0.0f ? -positionMm : positionMm;
  const bool inside = p >= axis.lowMm && p <= axis.highMm; // false for NaN
  const float place = inside ? (p - axis.minMm) * axis.perMm : 0.0f;
  int index = int(place);
  index = index < axis.lastCell ? index : axis.lastCell;
  const float share = place - float(index);
  return { index, share < 1.0f ? share : 1.0f, inside };
}

/// The weight at a position, trilinear; 0 outside of the table.
SONO_HD inline float beamWeight(const BeamFieldView& field, float lateralMm, float elevationalMm, float depthMm)
{
  const BeamFieldCell l = beamFieldCell(field.lateral, lateralMm);
  const BeamFieldCell e = beamFieldCell(field.elevational, elevationalMm);
  const BeamFieldCell d = beamFieldCell(field.depth, depthMm);
  if (!(l.inside && e.inside && d.inside))
  {
    return 0.0f;
  }
  const int el = field.elevational.stride;
  const int de = field.depth.stride;
  // A lateral axis of one value has a stride of 0, where the index is 0 too.
  const float* v = field.values + l.index + e.index * el + d.index * de;
  const int la = field.lateral.stride;
  const float nearLow = v[0] + l.share * (v[la] - v[0]);
  const float nearHigh = v[el] + l.share * (v[el + la] - v[el]);
  const float farLow = v[de] + l.share * (v[de + la] - v[de]);
  const float farHigh = v[de + el] + l.share * (v[de + el + la] - v[de + el]);
  const float near = nearLow + e.share * (nearHigh - nearLow);
  const float far = farLow + e.share * (farHigh - farLow);
  return near + d.share * (far - near);
}

} // namespace sono
