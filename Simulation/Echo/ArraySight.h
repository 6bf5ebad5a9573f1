#pragma once

#include "Kernel/Vec.h"
#include "Probe/ArrayField.h"

#include <vector>

namespace sono {

/// How far from its axis a beam that widens in depth is seen: the largest distances along the array and across it, mm,
/// in steps of depth, of a line straight ahead.
struct BeamReachTable
{
  float stepMm = 1.0f;
  std::vector<float> lateralMm; ///< of depths [n, n + 1) stepMm
  std::vector<float> elevationalMm;

  /// The largest ones between two depths; those of the first and the last step hold beyond them.
  Vec2f widest(float fromMm, float toMm) const;
};

/// Culling map of an array's beam: tells a brick that a line must visit from one where the beam is more than 46 dB
/// below its strongest value at that range.
class ArraySight
{
public:
  explicit ArraySight(const ArrayField& field);

  /// Whether the beam may count at distances from the axis of at least these, straight ahead, between two ranges.
  bool sees(float lateralMm, float elevationalMm, float fromMm, float toMm) const;
  const BeamReachTable& reach() const { return reach_; }

private:
  /// Of one axis, at each step of range and place: the largest modulus there or further out, over the axis' largest.
  struct Envelope
  {
    int count;
    float perUnit;
    float nearMm;
    std::vector<float> values;

    float at(int step, float mm, float rangeMm) const;
  };
  Envelope envelopeOf(const ArrayBeamAxis& axis, const ArrayBeamView& view) const;

  int steps_;
  Envelope lateral_;
  Envelope elevational_;
  BeamReachTable reach_;
};

} // namespace sono
