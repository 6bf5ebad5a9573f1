#pragma once

#include "Kernel/ArrayBeam.h"
#include "Kernel/ArraySightView.h"
#include "Kernel/Vec.h"
#include "Probe/BeamReachTable.h"

#include <vector>

namespace sono {

/// Culling map of an array's beam: tells a brick that a line must visit from one where the beam is more than 46 dB
/// below its strongest value at that range.
class ArraySight
{
public:
  /// Of a table of weights down to a depth.
  ArraySight(const ArrayBeamView& view, double depthMm);

  /// For lookups while this lives, and the same for copies of its values that lie elsewhere.
  ArraySightView view() const { return view(lateral_.values.data(), elevational_.values.data()); }
  ArraySightView view(const float* lateral, const float* elevational) const;
  const std::vector<float>& lateral() const { return lateral_.values; }
  const std::vector<float>& elevational() const { return elevational_.values; }
  const BeamReachTable& reach() const { return reach_; }
  /// No place that is seen in `view` between two ranges is further from the axis, along the array and across it, mm.
  Vec2f furthest(float fromMm, float toMm) const;
  /// Bounds over all ranges: of the weight's modulus, and of its integral over places at one range.
  float largestWeight() const { return largestWeight_; }
  float largestAreaMm2() const { return largestAreaMm2_; }

private:
  struct Envelope
  {
    int count;
    float perUnit;
    float nearMm;
    std::vector<float> values;   // see ArrayEnvelope
    std::vector<float> largest;  // modulus of each range of the table
    std::vector<float> integral; // of it over the places, mm
  };
  Envelope envelopeOf(const ArrayBeamAxis& axis, const ArrayBeamView& view) const;

  int steps_;
  Envelope lateral_;
  Envelope elevational_;
  BeamReachTable reach_{ ArraySightView::stepMm };
  float largestWeight_ = 0.0f;
  float largestAreaMm2_ = 0.0f;
};

} // namespace sono
