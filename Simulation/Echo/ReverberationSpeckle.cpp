#include "Echo/ReverberationSpeckle.h"

#include "Core/ParallelFor.h"
#include "Core/Simd.h"
#include "Core/SoundSpeed.h"
#include "Echo/Pulse.h"
#include "Kernel/Reverberation.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

/// Nodes of the noise are sqrt(3) deviations of a beam apart, as far as lines are closer than that.
float nodesPerLine(const BeamModel& beams, const std::vector<ScanLine>& lines, int linesPerImage)
{
  if (linesPerImage < 2)
  {
    return 1.0f;
  }
  const auto focusOf = [&](const ScanLine& line) { return line.originMm + line.axis * beams.focusMm(); };
  const std::size_t middle = std::size_t(linesPerImage) / 2;
  const double pitchMm = glm::distance(focusOf(lines[middle]), focusOf(lines[middle - 1]));
  return float(std::clamp(pitchMm / (std::sqrt(3.0) * beams.focusWidth().lateralSigmaMm), 1e-3, 1.0));
}

SONO_SIMD_CLONES __attribute__((flatten)) void drawNodes(const ReverberationNoise& of, int node,
                                                         const std::vector<float>& rms, SamplePair out)
{
  const ReverberationNoise noise = of;
  const int samples = int(rms.size());
  const float* level = rms.data();
  for (int s = 0; s < samples; ++s)
  {
    const Vec2f drawn = noise.node(node, s);
    out.re[s] = level[s] * drawn.x;
    out.im[s] = level[s] * drawn.y;
  }
}

} // namespace

ReverberationSpeckle reverberationSpeckle(const EchoSettings& settings, const BeamModel& beams,
                                          const std::vector<ScanLine>& lines, int linesPerImage, int samples)
{
  constexpr double pi = 3.14159265358979323846;
  ReverberationSpeckle speckle;
  speckle.noise.seed = settings.seed;
  speckle.noise.nodesPerLine = nodesPerLine(beams, lines, linesPerImage);
  const double sampleMm = settings.sampleMm();
  const double wavelengthMm = assumedSoundSpeedMmPerUs / settings.centreFrequencyMHz;
  // A beam's width is asked for once a millimetre. A white noise of so much a sample has E_r / sample of that behind
  // the pulse, and (11.2) is for E_r.
  std::vector<double> nodes;
  for (int mm = 0; double(mm - 1) <= samples * sampleMm; ++mm)
  {
    const BeamWidth width = beams.widthAt(double(mm));
    const double power = pi * width.lateralSigmaMm * width.elevationalSigmaMm * width.amplitude * width.amplitude;
    nodes.push_back(std::sqrt(reverberationPerMmSr * power * sampleMm) * wavelengthMm / beams.focusAreaMm2());
  }
  for (int s = 0; s < samples; ++s)
  {
    const double position = s * sampleMm;
    const std::size_t node = std::size_t(position);
    speckle.rms.push_back(float(nodes[node] + (nodes[node + 1] - nodes[node]) * (position - double(node))));
  }
  return speckle;
}

ReverberationNodes::ReverberationNodes(const ReverberationSpeckle& speckle, const PulseKernel& pulse, int lines,
                                       int samples)
  : noise_(speckle.noise)
  , rows_(std::size_t(noise_.firstNode(lines - 1)) + 4)
{
  const std::size_t half = std::size_t(pulse.half()); // nothing lies above the first sample
  parallelFor(int(rows_.size()), {}, [&](int node) {
    std::vector<float> re = sampleRoom(half + speckle.rms.size());
    std::vector<float> im = re;
    drawNodes(noise_, node, speckle.rms, { re.data() + half, im.data() + half });
    std::vector<float> heardRe = sampleRoom(std::size_t(samples));
    std::vector<float> heardIm = heardRe;
    pulse.convolve(re.data(), im.data(), samples, { heardRe.data(), heardIm.data() });
    std::vector<std::complex<float>>& row = rows_[std::size_t(node)];
    row.resize(std::size_t(samples));
    interleave(heardRe.data(), heardIm.data(), samples, row.data());
  });
}

void ReverberationNodes::add(int line, const float* level, int count, std::complex<float>* iq) const
{
  const std::vector<std::complex<float>>* rows = rows_.data() + noise_.firstNode(line);
  const SplineWeights weights = noise_.weights(line);
  const std::complex<float>* const nodes[4] = { rows[0].data(), rows[1].data(), rows[2].data(), rows[3].data() };
  addSpeckle(nodes, weights.w, level, count, iq);
}

} // namespace sono
