#pragma once

#include "Probe/PulseEchoField.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace sono {

/// Where a field matters: tells a brick that a beam must visit from one whose scatterers do not count. Left out are the
/// faintest parts of each depth, which together hold 2.5e-7 of its sum of squares: in a uniform tissue they make
/// 0.05 % of the RF.
class FieldSight
{
public:
  /// For cubic bricks of this edge, however they are turned.
  FieldSight(const PulseEchoField& field, float brickEdgeMm);

  /// Whether a brick with this centre may hold scatterers that count.
  bool sees(float lateralMm, float elevationalMm, float depthMm) const
  {
    const int l = lateral_.blockAt(lateralMm);
    const int e = elevational_.blockAt(elevationalMm);
    const int d = depth_.blockAt(depthMm);
    return l >= 0 && e >= 0 && d >= 0 && seen_[std::size_t(l + lateral_.count * (e + elevational_.count * d))];
  }
  /// Furthest distance from the axis of the centre of a brick that is seen.
  float lateralMm() const { return lateralMm_; }
  float elevationalMm() const { return elevationalMm_; }

private:
  /// The map's blocks along an axis.
  struct Blocks
  {
    float lowMm;
    float highMm; ///< of the last block; depths beyond it belong to it
    float perMm;
    int count;
    bool mirrored;
    bool endless;

    /// Furthest position in a block.
    float furthest(int block) const
    {
      const float low = lowMm + float(block) / perMm;
      return std::max(-low, low + 1.0f / perMm);
    }
    int blockAt(float mm) const
    {
      const float p = mirrored && mm < 0.0f ? -mm : mm;
      if (!(p >= lowMm) || (p >= highMm && !endless))
      {
        return -1;
      }
      const int block = int((p < highMm ? p - lowMm : highMm - lowMm) * perMm);
      return block < count ? block : count - 1;
    }
  };
  /// What a block sees of the table: values [first, last].
  struct Window
  {
    int first;
    int last;
  };

  Blocks makeBlocks(const FieldAxis& axis, bool isDepth) const;
  std::vector<Window> windows(const FieldAxis& axis, const Blocks& blocks) const;
  void measure();

  float brickMm_;
  float marginMm_; // from a brick's centre to its corners
  float lateralMm_ = 0.0f;
  float elevationalMm_ = 0.0f;
  Blocks lateral_{};
  Blocks elevational_{};
  Blocks depth_{};
  std::vector<std::uint8_t> seen_; // lateral fastest, then elevational, then depth
};

} // namespace sono
