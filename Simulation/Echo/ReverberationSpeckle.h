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

} // namespace sono
