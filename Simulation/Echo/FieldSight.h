#pragma once

#include "Kernel/BeamSight.h"
#include "Probe/PulseEchoField.h"

#include <cstdint>
#include <vector>

namespace sono {

/// Culling map of a pulse-echo field: tells a brick that a beam must visit from one whose scatterers do not count. Left
/// out are the faintest parts of each depth, which together hold 2.5e-7 of its sum of squares: in a uniform tissue they
/// make 0.05 % of the RF.
class FieldSight
{
public:
  /// For cubic bricks of this edge, however they are turned.
  FieldSight(const PulseEchoField& field, float brickEdgeMm);

  /// Whether a brick with this centre may hold scatterers that count.
  bool sees(float lateralMm, float elevationalMm, float depthMm) const
  {
    return view().sees(lateralMm, elevationalMm, depthMm);
  }
  /// For lookups while this lives.
  BeamSightView view() const { return { lateral_, elevational_, depth_, seen_.data() }; }
  /// Furthest distance from the axis of the centre of a brick that is seen.
  float lateralMm() const { return lateralMm_; }
  float elevationalMm() const { return elevationalMm_; }

private:
  /// What a block sees of the table: values [first, last].
  struct Window
  {
    int first;
    int last;
  };

  SightBlocks makeBlocks(const FieldAxis& axis, bool isDepth) const;
  std::vector<Window> windows(const FieldAxis& axis, const SightBlocks& blocks) const;
  void measure();

  float brickMm_;
  float marginMm_; // from a brick's centre to its corners
  float lateralMm_ = 0.0f;
  float elevationalMm_ = 0.0f;
  SightBlocks lateral_{};
  SightBlocks elevational_{};
  SightBlocks depth_{};
  std::vector<std::uint8_t> seen_; // lateral fastest, then elevational, then depth
};

} // namespace sono
