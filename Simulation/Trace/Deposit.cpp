#include "Trace/Deposit.h"

#include "Core/Simd.h"
#include "Kernel/BeamDeposit.h"
#include "Trace/ReverberationBins.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

/// Adds the segment's mean over the whole bins [first, last) to the sums, whose factors count at a bin's middle.
template<int Sums>
__attribute__((always_inline)) inline void depositWholeBins(const BeamSegment& g, float binMm, int first, int last,
                                                            std::array<std::vector<float>, binSumCount>& bins)
{
  const float inverseMu = 1.0f / g.mu;
  const float step = binMm * std::fabs(inverseMu);
  const float scale = 0.5f * g.intensity * meanDecay(g.decay * step);
  // Where a bin begins as seen by the path: its near end for either sense of travel.
  const float nearEdge = g.mu > 0.0f ? 0.0f : binMm;
  const BeamSegment local = g;
  float* sums[Sums];
  for (int sum = 0; sum < Sums; ++sum)
  {
    sums[sum] = bins[std::size_t(sum)].data();
  }
#pragma GCC ivdep
  for (int b = first; b < last; ++b)
  {
    const float near = (float(b) * binMm + nearEdge - local.r0) * inverseMu;
    const float onAxis = scale * expNegative(-local.decay * near);
    const float weights = gaussWeights(local, near, step);
    for (int sum = 0; sum < Sums; ++sum)
    {
      sums[sum][b] += onAxis * binFactor(sum, local, near + 0.5f * step, 1.0f) * weights;
    }
  }
}

/// What was left in bins, of each of `paths` paths, both sums side by side: alone, the compiler makes no vectors of
/// them.
SONO_SIMD_CLONES void takeMeans(std::array<std::vector<float>, binSumCount>& bins,
                                std::array<std::vector<double>, binSumCount>& earlier, double paths,
                                std::vector<BinSums<double>>& means)
{
  static_assert(binSumCount == 2);
  const double share = 1.0 / paths;
  float *ofIntensity = bins[intensitySum].data(), *ofAbsorbed = bins[absorbedSum].data();
  double *intensity = earlier[intensitySum].data(), *absorbed = earlier[absorbedSum].data();
  BinSums<double>* mean = means.data();
  const std::size_t count = means.size();
#pragma GCC ivdep
  for (std::size_t b = 0; b < count; ++b)
  {
    mean[b].of[intensitySum] = (intensity[b] + double(ofIntensity[b])) * share;
    mean[b].of[absorbedSum] = (absorbed[b] + double(ofAbsorbed[b])) * share;
  }
}

void addTo(std::vector<AbsorbedSums>& sums, const std::vector<AbsorbedSums>& more)
{
  for (std::size_t b = 0; b < sums.size(); ++b)
  {
    sums[b].weight += more[b].weight;
    sums[b].weightedNp += more[b].weightedNp;
  }
}

} // namespace

LineTally::LineTally(int binCount, double binMm, int sums, int echoCount, double echoSampleMm, double wavesPerMm)
  : binCount_(binCount)
  , sums_(sums)
  , tissueBins_(binCount, float(binMm))
  , reverberation_(std::size_t(tissueBins_.count))
  , absorbed_{ std::vector<AbsorbedSums>(std::size_t(tissueBins_.count)),
               std::vector<AbsorbedSums>(std::size_t(binCount)) }
  , cellMm_(std::size_t(tissueBins_.count + binsTogether), 1.0f)
  , tissueLevels_(cellMm_.size())
  , tissuePowers_(cellMm_.size())
  , echoes_(std::size_t(echoCount))
  , firstEcho_(echoCount)
  , binMm_(float(binMm))
  , echoSampleMm_(float(echoSampleMm))
  , radPerMm_(float(4.0 * 3.14159265358979323846 * wavesPerMm))
{
  for (std::size_t sum = 0; sum < binSumCount; ++sum)
  {
    bins_[sum].assign(std::size_t(binCount), 0.0f);
    binSums_[sum].assign(std::size_t(binCount), 0.0);
  }
}

void LineTally::begin(const TraceView& view, const TraceLine& axis, std::uint32_t lineKey, const StraightWay& way)
{
  view_ = &view;
  axis_ = &axis;
  way_ = way;
  lineKey_ = lineKey;
  reverberated_ = false;
  start(axis, view.coherenceMm);
}

void LineTally::start(const TraceLine& line, float coherenceMm)
{
  line_ = line;
  coherenceMm_ = coherenceMm;
}

void LineTally::fold()
{
  for (std::size_t sum = 0; sum < std::size_t(sums_); ++sum)
  {
    for (std::size_t b = 0; b < bins_[sum].size(); ++b)
    {
      binSums_[sum][b] += double(bins_[sum][b]);
      bins_[sum][b] = 0.0f;
    }
  }
}

std::vector<BinSums<double>> LineTally::takeBins(int paths)
{
  std::vector<BinSums<double>> means(bins_.front().size());
  takeMeans(bins_, binSums_, double(paths), means);
  for (std::size_t sum = 0; sum < std::size_t(sums_); ++sum)
  {
    std::fill(bins_[sum].begin(), bins_[sum].end(), 0.0f);
    std::fill(binSums_[sum].begin(), binSums_[sum].end(), 0.0);
  }
  return means;
}

std::vector<ReverberationSums> LineTally::takeReverberation(int paths)
{
  if (!reverberated_)
  {
    return {};
  }
  std::vector<ReverberationSums> means(reverberation_.size());
  means.swap(reverberation_);
  const double share = 1.0 / double(paths);
  for (ReverberationSums& mean : means)
  {
    for (double& sum : mean.of)
    {
      sum *= share;
    }
  }
  return means;
}

std::vector<float> LineTally::takeReverberatedNp(AbsorbedByBin* earlier)
{
  if (earlier && !earlier->tissue.empty())
  {
    addTo(absorbed_.tissue, earlier->tissue);
    addTo(absorbed_.boundaries, earlier->boundaries);
  }
  std::vector<float> means;
  for (int b = 0; b < binCount_; ++b)
  {
    means.push_back(absorbedNp(absorbed_.tissue[std::size_t(tissueBins_.absorptionBin(b / tissueBins_.each))],
                               absorbed_.boundaries[std::size_t(b)]));
  }
  if (earlier)
  {
    *earlier = absorbed_;
  }
  std::fill(absorbed_.tissue.begin(), absorbed_.tissue.end(), AbsorbedSums());
  std::fill(absorbed_.boundaries.begin(), absorbed_.boundaries.end(), AbsorbedSums());
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

template<int Sums>
__attribute__((always_inline)) inline void LineTally::deposit(const BeamSegment& g, const DepthSpan& span)
{
  const auto [low, high] = span;
  const BinSpan covered = binSpan(span, binMm_);
  const float inverseMu = 1.0f / g.mu;
  const auto part = [&](int bin, float from, float to) {
    const float value = meanOver(g, from, to, inverseMu) * (to - from) / binMm_;
    for (int sum = 0; sum < Sums; ++sum)
    {
      bins_[std::size_t(sum)][std::size_t(bin)] += value * binFactor(sum, g, 0.5f * (from + to) - g.r0, inverseMu);
    }
  };
  if (covered.first == covered.last)
  {
    part(covered.first, low, high);
    return;
  }
  part(covered.first, low, float(covered.first + 1) * binMm_);
  depositWholeBins<Sums>(g, binMm_, covered.first + 1, covered.last, bins_);
  part(covered.last, float(covered.last) * binMm_, high);
}

SONO_SIMD_CLONES void LineTally::segment(const PathSegment& s)
{
  ++segments_;
  if (s.reflections > 0 && view_->model == InterfaceModel::Acoustic)
  {
    addReverberation(s);
    return;
  }
  const BeamSegment g = beamSegment(line_, s, coherenceMm_);
  const DepthSpan span = depthSpan(g.r0, g.mu, s.length, binMm_ * float(binCount_));
  if (!(span.high > span.low))
  {
    return;
  }
  if (sums_ == binSumCount)
  {
    deposit<binSumCount>(g, span);
  }
  else
  {
    deposit<1>(g, span);
  }
}

void LineTally::sharedSegments(const std::vector<PathSegment>& segments, int paths)
{
  if (paths == 0)
  {
    return;
  }
  for (PathSegment s : segments)
  {
    s.intensity *= float(paths);
    segment(s);
  }
  segments_ += std::uint64_t(paths - 1) * segments.size();
}

void LineTally::findCells()
{
  reverberated_ = true;
  for (int b = 0; b < tissueBins_.count; ++b)
  {
    cellMm_[std::size_t(b)] = resolutionCell(*view_, *axis_, (float(b) + 0.5f) * tissueBins_.mm).sideMm;
  }
}

void LineTally::absorb(const TissueEcho& echo, const DepthSpan& span, const BinSpan& bins)
{
  for (int group = bins.first; group <= bins.last; group = tissueBins_.nextGroup(group))
  {
    const int b = tissueBins_.absorptionBin(group);
    if (b >= bins.first && b <= bins.last)
    {
      const double level = double(std::fabs(tissueLevels_[std::size_t(b - bins.first)]));
      absorbed_.tissue[std::size_t(b)].weight += level;
      absorbed_.tissue[std::size_t(b)].weightedNp +=
        level * double(echoInBin(echo, span, b, tissueBins_.mm).absorbedNp);
    }
  }
}

void LineTally::addReverberation(const PathSegment& s)
{
  const float endMm = tissueBins_.endMm();
  const auto isHeard = [&](const TissueEcho& echo, const DepthSpan& span) {
    if (!(span.high > span.low) || echo.level == 0.0f)
    {
      return false;
    }
    if (!reverberated_)
    {
      findCells();
    }
    return true;
  };
  const TissueEcho own = ownWayEcho(*view_, s);
  const DepthSpan ownSpan = depthSpan(own.r0, own.mu, s.length, endMm);
  if (isHeard(own, ownSpan))
  {
    const BinSpan bins = binSpan(ownSpan, tissueBins_.mm);
    ownWayLevels(own, ownSpan, tissueBins_.mm, bins, lineKey_, cellMm_.data(), tissueLevels_.data());
    for (int b = bins.first; b <= bins.last; ++b)
    {
      const float level = tissueLevels_[std::size_t(b - bins.first)];
      reverberation_[std::size_t(b)].of[level > 0.0f ? plusSum : minusSum] += double(std::fabs(level));
    }
    absorb(own, ownSpan, bins);
  }
  if (!isStraightBack(*axis_, s))
  {
    return;
  }
  const TissueEcho straight = straightBackEcho(way_, *axis_, line_, s);
  const DepthSpan straightSpan = heardSpan(straight, s.length, endMm);
  if (isHeard(straight, straightSpan))
  {
    const BinSpan bins = binSpan(straightSpan, tissueBins_.mm);
    straightBackLevels(straight, straightSpan, tissueBins_.mm, bins, tissueLevels_.data(), tissuePowers_.data());
    for (int b = bins.first; b <= bins.last; ++b)
    {
      reverberation_[std::size_t(b)].of[straightPowerSum] += double(tissuePowers_[std::size_t(b - bins.first)]);
    }
    absorb(straight, straightSpan, bins);
  }
}

void LineTally::echo(const Vec3f& point, float amplitude)
{
  // In Acoustic surfaces echo by themselves.
  if (!echoes_.empty() && view_->model != InterfaceModel::Acoustic)
  {
    const EchoPlace place = echoPlace(line_, point, coherenceMm_);
    addEcho(place.depthMm, amplitude * place.weight);
  }
}

void LineTally::arrives(const PathState& path, const PathBoundary& boundary)
{
  if (!echoes_.empty())
  {
    const Arrival arrival = boundaryArrival(*view_, way_, *axis_, line_, path, boundary);
    addEcho(arrival.rangeMm, arrival.amplitude);
    // An echo may end a bin and begin the next.
    for (const float beside : { -0.5f, 0.5f })
    {
      const auto bin = std::size_t(larger(0.0f, arrival.rangeMm / binMm_ + beside));
      if (bin < absorbed_.boundaries.size())
      {
        const double weight = double(std::fabs(arrival.amplitude) / boundaryPerSpeckle);
        absorbed_.boundaries[bin].weight += weight;
        absorbed_.boundaries[bin].weightedNp += weight * double(arrival.absorbedNp);
      }
    }
  }
}

void LineTally::addEcho(float rangeMm, float amplitude)
{
  const EchoSplit split = splitEcho(rangeMm, amplitude * echoWeight_, echoSampleMm_, int(echoes_.size()), radPerMm_);
  if (split.sample >= 0 && amplitude != 0.0f)
  {
    echoes_[std::size_t(split.sample)] += std::complex<double>(split.amplitude[0], split.amplitude[1]);
    echoes_[std::size_t(split.sample) + 1] += std::complex<double>(split.amplitude[2], split.amplitude[3]);
    firstEcho_ = std::min(firstEcho_, split.sample);
    lastEcho_ = std::max(lastEcho_, split.sample + 1);
  }
}

} // namespace sono
