#include "Trace/Deposit.h"

#include "Core/Simd.h"
#include "Kernel/BeamDeposit.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

/// Adds the segment's mean over the whole bins [first, last) to them, and as much times the attenuation at their
/// middle, `startAbsorbed` at the segment's start, to the others.
SONO_SIMD_CLONES void depositWholeBins(const BeamSegment& g, float startAbsorbed, float binMm, int first, int last,
                                       float* __restrict__ bins, float* __restrict__ absorbed)
{
  const float inverseMu = 1.0f / g.mu;
  const float step = binMm * std::fabs(inverseMu);
  const float scale = 0.5f * g.intensity * meanDecay(g.decay * step);
  // Where a bin begins as seen by the path: its near end for either sense of travel.
  const float nearEdge = g.mu > 0.0f ? 0.0f : binMm;
  const BeamSegment local = g;
  for (int b = first; b < last; ++b)
  {
    const float near = (float(b) * binMm + nearEdge - local.r0) * inverseMu;
    const float onAxis = scale * expNegative(-local.decay * near);
    const float weights = gaussWeights(local, near, step);
    bins[b] += onAxis * weights;
    absorbed[b] += onAxis * (startAbsorbed + local.decay * (near + 0.5f * step)) * weights;
  }
}

} // namespace

LineTally::LineTally(int binCount, double binMm, int echoCount, double echoSampleMm, double wavesPerMm)
  : bins_(std::size_t(binCount), 0.0f)
  , absorbed_(std::size_t(binCount), 0.0f)
  , binSums_(std::size_t(binCount), 0.0)
  , absorbedSums_(std::size_t(binCount), 0.0)
  , echoes_(std::size_t(echoCount))
  , firstEcho_(echoCount)
  , binMm_(float(binMm))
  , echoSampleMm_(float(echoSampleMm))
  , radPerMm_(float(4.0 * 3.14159265358979323846 * wavesPerMm))
{
}

void LineTally::start(const TraceLine& line, float coherenceMm)
{
  line_ = line;
  coherenceMm_ = coherenceMm;
}

void LineTally::fold()
{
  for (std::size_t b = 0; b < bins_.size(); ++b)
  {
    binSums_[b] += double(bins_[b]);
    bins_[b] = 0.0f;
    absorbedSums_[b] += double(absorbed_[b]);
    absorbed_[b] = 0.0f;
  }
}

std::vector<float> LineTally::takeBins(int paths)
{
  fold();
  std::vector<float> means(bins_.size());
  for (std::size_t b = 0; b < means.size(); ++b)
  {
    means[b] = float(binSums_[b] / paths);
    binSums_[b] = 0.0;
  }
  return means;
}

std::vector<double> LineTally::takeAbsorbed(int paths)
{
  fold();
  std::vector<double> means(absorbedSums_.size());
  for (std::size_t b = 0; b < means.size(); ++b)
  {
    means[b] = absorbedSums_[b] / paths;
    absorbedSums_[b] = 0.0;
  }
  return means;
}

void LineTally::takeEchoes(std::complex<float>* samples)
{
  for (int s = firstEcho_; s <= lastEcho_; ++s)
  {
    samples[s] += std::complex<float>(echoes_[std::size_t(s)]);
    echoes_[std::size_t(s)] = 0.0;
  }
  firstEcho_ = int(echoes_.size());
  lastEcho_ = -1;
}

SONO_SIMD_CLONES void LineTally::segment(const PathSegment& s)
{
  ++segments_;
  const BeamSegment g = beamSegment(line_, s, coherenceMm_);
  const auto [low, high] = depthSpan(g, s.length, binMm_ * float(bins_.size()));
  if (!(high > low))
  {
    return;
  }
  const int last = int(bins_.size()) - 1;
  const int binLow = std::min(int(low / binMm_), last);
  const int binHigh = std::min(int(high / binMm_), last);
  const float inverseMu = 1.0f / g.mu;
  const auto part = [&](int bin, float from, float to) {
    const float value = meanOver(g, from, to, inverseMu) * (to - from) / binMm_;
    bins_[std::size_t(bin)] += value;
    absorbed_[std::size_t(bin)] += value * (s.absorbed + g.decay * (0.5f * (from + to) - g.r0) * inverseMu);
  };
  if (binLow == binHigh)
  {
    part(binLow, low, high);
    return;
  }
  part(binLow, low, float(binLow + 1) * binMm_);
  depositWholeBins(g, s.absorbed, binMm_, binLow + 1, binHigh, bins_.data(), absorbed_.data());
  part(binHigh, float(binHigh) * binMm_, high);
}

void LineTally::echo(const Vec3f& point, float amplitude)
{
  if (echoes_.empty())
  {
    return;
  }
  const EchoSplit split =
    splitEcho(line_, point, amplitude * echoWeight_, coherenceMm_, echoSampleMm_, int(echoes_.size()), radPerMm_);
  if (split.sample >= 0)
  {
    echoes_[std::size_t(split.sample)] += std::complex<double>(split.amplitude[0], split.amplitude[1]);
    echoes_[std::size_t(split.sample) + 1] += std::complex<double>(split.amplitude[2], split.amplitude[3]);
    firstEcho_ = std::min(firstEcho_, split.sample);
    lastEcho_ = std::max(lastEcho_, split.sample + 1);
  }
}

} // namespace sono
