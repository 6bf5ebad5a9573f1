#pragma once

#include "Echo/BeamModel.h"
#include "Echo/SampleLoops.h"
#include "Kernel/ReverberationNoise.h"

#include <complex>
#include <vector>

namespace sono {

class PulseKernel;

/// How the speckle of what reverberates (TracedLines::reverberation) is added to the samples of a line.
struct ReverberationSpeckle
{
  ReverberationNoise noise;
  std::vector<float> rms; ///< of each sample of range before the pulse, at level 1: (11.2) of 5e-4 /(cm sr)
};

/// For `samples` samples of the settings. Lines are alike where their beams overlap at the focus, which those of the
/// first image tell.
ReverberationSpeckle reverberationSpeckle(const EchoSettings& settings, const BeamModel& beams,
                                          const std::vector<ScanLine>& lines, int linesPerImage, int samples);

/// The nodes of its noise behind the pulse at each sample, at level 1, which lines side by side share. A level changes
/// little over a pulse, so that it may as well be applied behind it. What is convolved here knows nothing of what a
/// line attenuates: turned with the direct sound (Kernel/Downshift.h) and back, speckle would add to the direct one in
/// a phase that sums up B over all that lies above, with its noise.
class ReverberationNodes
{
public:
  ReverberationNodes() = default;
  /// The speckle's rms has as many values as the pulse reaches beyond `samples`.
  ReverberationNodes(const ReverberationSpeckle& speckle, const PulseKernel& pulse, int lines, int samples);

  /// Adds the noise of a line, times the level, to `count` samples where the level is worth it.
  void add(int line, const float* level, int count, std::complex<float>* iq) const;

private:
  ReverberationNoise noise_;
  std::vector<std::vector<std::complex<float>>> rows_;
};

} // namespace sono
