#pragma once

#include "Echo/BeamModel.h"
#include "Echo/SampleLoops.h"
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

  /// Adds ReverberationNoise::at, times level and rms, to `count` samples of a line where the level is worth it.
  void add(int line, const float* level, const float* rms, int count, SamplePair out) const;

private:
  ReverberationNoise noise_;
  std::vector<std::vector<Vec2f>> rows_;
};

} // namespace sono
