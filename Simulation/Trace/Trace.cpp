#include "Trace/Trace.h"

#include "Core/ParallelFor.h"
#include "Core/Simd.h"
#include "Core/SoundSpeed.h"
#include "Kernel/NanoSpace.h"
#include "Kernel/TracePath.h"
#include "Trace/AxisWay.h"
#include "Trace/BatchMeans.h"
#include "Trace/Deposit.h"
#include "Trace/ReverberationWindows.h"
#include "Trace/SharedWay.h"
#include "Trace/TraceSetup.h"
#include "Trace/TracedBin.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace sono {

namespace {

/// Writes the arrays of a line, of what its paths share and of the means of their batches.
void writeBins(const std::vector<BinSums<double>>& shared, const std::vector<std::vector<BinSums<double>>>& batches,
               double frequencyMHz, int line, TracedLines& out)
{
  const std::size_t first = std::size_t(line) * std::size_t(out.binCount);
  finishBins(
    shared, batches, binSumsOf(out.model), frequencyMHz,
    { out.intensity.data() + first, out.standardError.data() + first, out.attenuationNpPerMHz.data() + first });
}

/// What lines leave of reverberation, by TissueBins, until all are traced.
struct TracedReverberation
{
  TissueBins tissueBins;
  std::vector<float> ownLevel; ///< ReverberationMeans, lines x bins
  ReverberationRows along;     ///< over the bins around, of the same line
  ReverberationRows around;    ///< and of the lines around
  std::vector<char> isHeard;   ///< whether the line has any

  explicit TracedReverberation(const TracedLines& out)
    : tissueBins(out.binCount, float(out.binMm))
  {
    const int lines = out.reverberation.empty() ? 0 : out.lineCount;
    ownLevel.resize(std::size_t(lines) * std::size_t(tissueBins.count));
    along = around = ReverberationRows(lines, tissueBins.count);
    isHeard.resize(std::size_t(out.lineCount));
  }
  std::size_t at(int line, int bin) const
  {
    return std::size_t(line) * std::size_t(tissueBins.count) + std::size_t(bin);
  }
};

/// Of the means of a line's batches, and of what the media have taken.
void keepReverberation(const std::vector<std::vector<ReverberationSums>>& batches, const std::vector<float>& takenNp,
                       double frequencyMHz, int line, TracedReverberation& kept, TracedLines& out)
{
  const TissueBins& tissueBins = kept.tissueBins;
  kept.isHeard[std::size_t(line)] = 1;
  const ReverberationLine means = reverberationOf(batches, tissueBins.count);
  std::copy(means.ownLevel.begin(), means.ownLevel.end(), kept.ownLevel.begin() + std::ptrdiff_t(kept.at(line, 0)));
  const std::size_t first = std::size_t(line) * std::size_t(out.binCount);
  for (int b = 0; b < out.binCount; ++b)
  {
    out.reverberationError[first + std::size_t(b)] = means.error[std::size_t(b / tissueBins.each)];
    out.reverberationNpPerMHz[first + std::size_t(b)] = float(double(takenNp[std::size_t(b)]) / frequencyMHz);
  }
  sumAlongLine(means.around, 0, tissueBins.mm, kept.along, line);
}

/// Of a line without any, which counts in the means around it.
void keepSilence(int line, TracedReverberation& kept)
{
  ReverberationRows bins(1, kept.tissueBins.count);
  for (int t = 0; t < kept.tissueBins.count; ++t)
  {
    bins.set(0, t, aroundOf(ReverberationMeans{}));
  }
  sumAlongLine(bins, 0, kept.tissueBins.mm, kept.along, line);
}

/// Whether a line or one around it has any.
bool isHeardAround(const TracedReverberation& kept, int line)
{
  const auto heard = kept.isHeard.begin();
  return std::any_of(heard + std::max(0, line - linesAround),
                     heard + std::min(int(kept.isHeard.size()), line + linesAround + 1),
                     [](char is) { return is != 0; });
}

/// The levels of a line's reverberation, of what it and the lines beside it have left.
void writeReverberation(const TraceSetup& setup, const TracedReverberation& kept, int line, TracedLines& out)
{
  const TissueBins& tissueBins = kept.tissueBins;
  ReverberationRows further(1, tissueBins.count);
  sumFurther(kept.around, line, tissueBins.mm, further);
  std::vector<float> levels(std::size_t(tissueBins.count));
  reverberationLevels(setup.view, setup.lines[std::size_t(line)], tissueBins.mm, kept.around, line, further,
                      kept.ownLevel.data() + kept.at(line, 0), levels.data());
  float* const ofLine = out.reverberation.data() + std::size_t(line) * std::size_t(out.binCount);
  for (int b = 0; b < out.binCount; ++b)
  {
    ofLine[b] = levels[std::size_t(b / tissueBins.each)];
  }
}

} // namespace

/// What the paths of a line have left, while more may follow: means of its batches.
struct LineMeans
{
  std::vector<std::vector<BinSums<double>>> bins;
  std::vector<std::vector<ReverberationSums>> reverberation; ///< of a batch without any: empty
  AbsorbedByBin absorbed;
  bool isHeard = false; ///< whether anything has reverberated
};

namespace {

/// The paths of a line from `before` to `paths`.
struct Round
{
  int before;
  int paths;
};

/// The mean of both, where `share` of all is what was added. Empty: zeros.
template<class Sums>
void addMeans(std::vector<Sums>& means, std::vector<Sums> added, double share)
{
  const bool isFirst = means.empty();
  if (isFirst)
  {
    means = std::move(added);
  }
  for (std::size_t i = 0; i < means.size() && !(isFirst && share == 1.0); ++i)
  {
    for (std::size_t sum = 0; sum < std::size(means[i].of); ++sum)
    {
      const double before = isFirst ? 0.0 : means[i].of[sum];
      const double now = isFirst ? means[i].of[sum] : added.empty() ? 0.0 : added[i].of[sum];
      means[i].of[sum] = before + (now - before) * share;
    }
  }
}

/// Traces one line into its rows of the result. Sums run in the order of the batches and paths. `earlier` is what the
/// paths of earlier rounds have left, to which this one's are added; null: there is this round alone.
template<class Space>
inline void traceLineIn(const Space& space, const TraceSetup& setup, int index, const Round& round,
                        const YieldPoint& yieldPoint, LineTally& tally, LineMeans* earlier, TracedReverberation& kept,
                        TracedLines& out)
{
  const TraceView& view = setup.view;
  const TraceLine& line = setup.lines[std::size_t(index)];
  AxisWay way;
  if (!out.depthOffsetMm.empty())
  {
    way = followAxis(view, space, line, out.binCount, out.binMm);
    way.writeOffsets(out.binCount, out.binMm,
                     out.depthOffsetMm.data() + std::size_t(index) * std::size_t(out.binCount));
  }
  tally.begin(view, line, std::uint32_t(index), way.view());
  std::complex<float>* echoes = out.boundaryEcho.data() + std::size_t(index) * std::size_t(out.echoCount);
  const float shareBefore = float(round.before) / float(round.paths);
  if (round.before > 0)
  {
    std::transform(echoes, echoes + out.echoCount, echoes,
                   [&](const std::complex<float>& echo) { return echo * shareBefore; });
  }
  tally.setEchoWeight(1.0f - shareBefore);
  std::vector<SharedStretch> sharedStretches;
  std::vector<BinSums<double>> shared(std::size_t(out.binCount), BinSums<double>{});
  LineMeans own;
  LineMeans& means = earlier ? *earlier : own;
  if (!view.startsApart)
  {
    const LineStart start = startLine(view, space, line, tally);
    shared = tally.takeBins(1);
    if (!start.meets)
    {
      writeBins(shared, means.bins, setup.frequencyMHz, index, out);
      tally.takeEchoes(echoes);
      return;
    }
    sharedStretches = sharedWay(view, space, line, start);
  }

  tally.setEchoWeight(1.0f / float(round.paths));
  const int batches = round.before > 0 ? int(means.bins.size()) : std::min(batchCount, round.paths);
  means.bins.resize(std::size_t(batches));
  means.reverberation.resize(std::size_t(batches));
  std::vector<BounceScramble> scrambles(std::size_t(scrambleCount(view)));
  for (int batch = 0; batch < batches; ++batch)
  {
    const int first = batchRange(round.before, batches, batch).count();
    const int last = batchRange(round.paths, batches, batch).count();
    for (std::size_t b = 0; b < scrambles.size(); ++b)
    {
      scrambles[b] = makeScramble(view, setup.seed, std::uint32_t(index), std::uint32_t(batch), int(b));
    }
    for (int path = first; path < last;)
    {
      const int pause = std::min(last, path + pathsPerFold); // a few milliseconds' worth
      for (; path < pause; ++path)
      {
        const PathKey key{ std::uint32_t(index), std::uint32_t(batch), std::uint32_t(path), setup.seed,
                           scrambles.data() };
        if (view.startsApart)
        {
          const TraceLine own = pathLine(view, line, key);
          tally.start(own, view.coherenceMm);
          tracePath(view, space, own, key, tally);
        }
        else
        {
          traceApart(view, space, line, sharedStretches, key, tally);
        }
      }
      if (path < last)
      {
        tally.fold();
        yieldPoint();
      }
    }
    if (last == first)
    {
      continue;
    }
    for (SharedStretch& stretch : sharedStretches)
    {
      tally.sharedSegments(stretch.segments, stretch.paths);
      stretch.paths = 0;
    }
    const double share = double(last - first) / double(last);
    addMeans(means.bins[std::size_t(batch)], tally.takeBins(last - first), share);
    if (!out.reverberation.empty())
    {
      addMeans(means.reverberation[std::size_t(batch)], tally.takeReverberation(last - first), share);
    }
  }
  means.isHeard = means.isHeard || tally.hasReverberated();
  if (!out.reverberation.empty() && means.isHeard)
  {
    keepReverberation(means.reverberation, tally.takeReverberatedNp(earlier ? &earlier->absorbed : nullptr),
                      setup.frequencyMHz, index, kept, out);
  }
  tally.takeEchoes(echoes);
  writeBins(shared, means.bins, setup.frequencyMHz, index, out);
}

SONO_SIMD_CLONES __attribute__((flatten)) void traceLine(const TraceSetup& setup, int index, const Round& round,
                                                         const YieldPoint& yieldPoint, LineTally& tally,
                                                         LineMeans* earlier, TracedReverberation& kept,
                                                         TracedLines& out)
{
  traceLineIn(setup.space(), setup, index, round, yieldPoint, tally, earlier, kept, out);
}

void traceLineByNanoVDB(const TraceSetup& setup, int index, const Round& round, const YieldPoint& yieldPoint,
                        LineTally& tally, LineMeans* earlier, TracedReverberation& kept, TracedLines& out)
{
  traceLineIn(setup.nanoSpace(), setup, index, round, yieldPoint, tally, earlier, kept, out);
}

} // namespace

TracedLines tracedLayout(int lineCount, const TraceSettings& settings, const std::vector<TargetSurface>& targets)
{
  TracedLines out;
  out.model = settings.model;
  out.targets = targets.empty() ? nullptr : std::make_shared<const std::vector<TargetSurface>>(targets);
  out.lineCount = lineCount;
  out.binMm = settings.radialBinMm;
  out.binCount = settings.binCount();
  out.echoSampleMm = settings.echoSampleMm;
  out.echoCount = settings.echoCount();
  out.paths = settings.pathsAtMost();
  if (double(out.lineCount) * out.echoCount > 5e8)
  {
    throw Error("the number of scan lines is " + std::to_string(out.lineCount) +
                ": at this depth and sampling their samples do not fit; use fewer lines or a lower sampling frequency");
  }
  return out;
}

TraceRounds::TraceRounds(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                         const std::vector<TargetSurface>& targets, const Progress& progress)
  : setup_(std::make_unique<TraceSetup>(scene, lines, settings, targets, progress, Records::OnDemand))
  , march_(settings.march)
  , out_(tracedLayout(int(lines.size()), settings, targets))
{
  out_.paths = 0;
  TracedLines::visitArrays(out_, [this](auto& values, const char*, TracedAxis axis) {
    values.resize(std::size_t(out_.lineCount) * (axis == TracedAxis::EchoSamples ? out_.echoCount : out_.binCount));
  });
  if (!settings.rangeIsTime() || settings.intensityAlone)
  {
    out_.depthOffsetMm.clear();
  }
  if (!settings.reverberates())
  {
    out_.reverberation.clear();
    out_.reverberationError.clear();
    out_.reverberationNpPerMHz.clear();
  }
}

TraceRounds::~TraceRounds() = default;

LineTally TraceRounds::makeTally() const
{
  return LineTally(out_.binCount, out_.binMm, binSumsOf(out_.model), out_.echoCount, out_.echoSampleMm,
                   setup_->frequencyMHz / assumedSoundSpeedMmPerUs);
}

void TraceRounds::traceTo(int paths, bool more, const Progress& progress)
{
  TracedReverberation kept(out_);
  tbb::enumerable_thread_specific<LineTally> tallies([&] { return makeTally(); });
  const Round round{ out_.paths, paths };
  if (more)
  {
    earlier_.resize(std::size_t(out_.lineCount));
  }
  parallelFor(out_.lineCount, progress, [&](int i, const YieldPoint& yieldPoint) {
    LineMeans* earlier = earlier_.empty() ? nullptr : &earlier_[std::size_t(i)];
    const auto traceOne = march_ == March::NanoVDB ? traceLineByNanoVDB : traceLine;
    traceOne(*setup_, i, round, yieldPoint, tallies.local(), earlier, kept, out_);
  });
  out_.paths = paths;
  if (!out_.reverberation.empty())
  {
    const auto forHeard = [&](const auto& work) {
      parallelFor(out_.lineCount, {}, [&](int i) {
        if (isHeardAround(kept, i))
        {
          work(i);
        }
      });
    };
    forHeard([&](int i) {
      if (!kept.isHeard[std::size_t(i)])
      {
        keepSilence(i, kept);
      }
    });
    forHeard([&](int i) { sumOverLines(kept.along, i, kept.around); });
    forHeard([&](int i) { writeReverberation(*setup_, kept, i, out_); });
  }
  for (const LineTally& tally : tallies)
  {
    out_.segments += tally.segments();
  }
}

void TraceRounds::traceLines(const std::vector<int>& lines, int paths, const Progress& progress)
{
  TracedReverberation kept(out_);
  tbb::enumerable_thread_specific<LineTally> tallies([&] { return makeTally(); });
  parallelFor(int(lines.size()), progress, [&](int n, const YieldPoint& yieldPoint) {
    const auto traceOne = march_ == March::NanoVDB ? traceLineByNanoVDB : traceLine;
    traceOne(*setup_, lines[std::size_t(n)], { 0, paths }, yieldPoint, tallies.local(), nullptr, kept, out_);
  });
  out_.paths = paths;
}

TracedLines trace(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                  const Progress& progress, const std::vector<TargetSurface>& targets)
{
  TraceRounds round(scene, lines, settings, targets, partOf(progress, 0.0, 0.3));
  round.traceTo(settings.pathsAtMost(), false, partOf(progress, 0.3, 1.0));
  return round.take();
}

} // namespace sono
