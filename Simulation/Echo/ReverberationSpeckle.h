#pragma once

#include "Echo/BeamModel.h"
#include "Kernel/ReverberationNoise.h"

#include <vector>

namespace sono {

/// How the speckle of what reverberates (TracedLines::reverberation) is added to the samples of a line.
struct ReverberationSpeckle
{
  ReverberationNoise noise;
  std::vector<float> rms; ///< of each sample of range before the pulse, at level 1: (11.2) of 5e-4 /(cm sr)
};

/// For `samples` samples of the settings. Lines are alike where their beams overlap at the focus.
ReverberationSpeckle reverberationSpeckle(const EchoSettings& settings, const BeamModel& beams,
                                          const std::vector<ScanLine>& lines, int samples);

/// The nodes of its noise at each sample, which lines side by side share.
class ReverberationNodes
{
public:
  ReverberationNodes() = default;
  ReverberationNodes(const ReverberationNoise& noise, int lines, int samples);

  /// As ReverberationNoise::at.
  Vec2f at(int line, int sample) const
  {
    const std::vector<Vec2f>* rows = rows_.data() + noise_.firstNode(line);
    return noise_.blend(line, [&](int k) { return rows[k][std::size_t(sample)]; });
  }

private:
  ReverberationNoise noise_;
  std::vector<std::vector<Vec2f>> rows_;
};

} // namespace sono
