#include "Trace/LineRounds.h"

#include "Core/ParallelFor.h"
#include "Core/Simd.h"
#include "Core/SoundSpeed.h"
#include "Kernel/NanoSpace.h"
#include "Kernel/TimeOfFlight.h"
#include "Kernel/TracePath.h"
#include "Trace/Deposit.h"
#include "Trace/TraceSetup.h"
#include "Trace/TracedBin.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;

/// Writes the arrays of a line, of what its paths share and of the means of their batches.
void writeBins(const std::vector<BinSums<double>>& shared, const std::vector<std::vector<BinSums<double>>>& batches,
               double frequencyMHz, int line, TracedLines& out)
{
  for (std::size_t b = 0; b < shared.size(); ++b)
  {
    const auto meanOf = [&](int batch) { return batches[std::size_t(batch)][b]; };
    const BinArrays bin = finishBin(shared[b], int(batches.size()), meanOf, binSumsOf(out.model), frequencyMHz);
    const std::size_t at = std::size_t(line) * std::size_t(out.binCount) + b;
    out.intensity[at] = bin.of[intensityArray];
    out.standardError[at] = bin.of[standardErrorArray];
    out.attenuationNpPerMHz[at] = bin.of[attenuationArray];
  }
}

} // namespace

/// What lines leave of reverberation, lines x TissueBins, until all are traced.
struct TracedReverberation
{
  TissueBins tissueBins;
  std::vector<float> ownLevel;             ///< ReverberationMeans
  std::vector<ReverberationAround> along;  ///< over the bins around, of the same line
  std::vector<ReverberationAround> around; ///< and of the lines around
  std::vector<char> isHeard;               ///< whether the line has any

  explicit TracedReverberation(const TracedLines& out)
    : tissueBins(out.binCount, float(out.binMm))
  {
    const std::size_t size = out.reverberation.empty() ? 0 : std::size_t(out.lineCount) * std::size_t(tissueBins.count);
    ownLevel.resize(size);
    along.resize(size);
    around.resize(size);
    isHeard.resize(std::size_t(out.lineCount));
  }
  std::size_t at(int line, int bin) const
  {
    return std::size_t(line) * std::size_t(tissueBins.count) + std::size_t(bin);
  }
};

namespace {

/// Of the means of a line's batches, and of what the media have taken.
void keepReverberation(const std::vector<std::vector<ReverberationSums>>& batches, const std::vector<float>& takenNp,
                       double frequencyMHz, int line, TracedReverberation& kept, TracedLines& out)
{
  const TissueBins& tissueBins = kept.tissueBins;
  kept.isHeard[std::size_t(line)] = 1;
  std::vector<ReverberationAround> bins(std::size_t(tissueBins.count));
  const std::size_t first = std::size_t(line) * std::size_t(out.binCount);
  for (int t = 0; t < tissueBins.count; ++t)
  {
    const ReverberationMeans means = reverberationMeans(int(batches.size()), [&](int batch) {
      const std::vector<ReverberationSums>& sums = batches[std::size_t(batch)];
      return sums.empty() ? ReverberationSums() : sums[std::size_t(t)];
    });
    bins[std::size_t(t)] = aroundOf(means);
    kept.ownLevel[kept.at(line, t)] = means.ownLevel;
    for (int b = t * tissueBins.each; b < std::min(out.binCount, (t + 1) * tissueBins.each); ++b)
    {
      out.reverberationError[first + std::size_t(b)] = means.error;
      out.reverberationNpPerMHz[first + std::size_t(b)] = float(double(takenNp[std::size_t(b)]) / frequencyMHz);
    }
  }
  for (int t = 0; t < tissueBins.count; ++t)
  {
    kept.along[kept.at(line, t)] =
      sumAlongLine(t, tissueBins.count, tissueBins.mm, [&](int near) { return bins[std::size_t(near)]; });
  }
}

/// Whether a line or one around it has any.
bool isHeardAround(const TracedReverberation& kept, int line)
{
  const auto heard = kept.isHeard.begin();
  return std::any_of(heard + std::max(0, line - linesAround),
                     heard + std::min(int(kept.isHeard.size()), line + linesAround + 1),
                     [](char is) { return is != 0; });
}

void sumLinesAround(int line, TracedReverberation& kept)
{
  for (int t = 0; t < kept.tissueBins.count; ++t)
  {
    kept.around[kept.at(line, t)] =
      sumOverLines(line, 0, int(kept.isHeard.size()), [&](int near) { return kept.along[kept.at(near, t)]; });
  }
}

/// The levels of a line's reverberation, of what it and the lines beside it have left.
void writeReverberation(const TraceSetup& setup, const TracedReverberation& kept, int line, TracedLines& out)
{
  const TissueBins& tissueBins = kept.tissueBins;
  for (int t = 0; t < tissueBins.count; ++t)
  {
    const ReverberationAround further = sumFurther(line, 0, out.lineCount, t, tissueBins.count, tissueBins.mm,
                                                   [&](int l, int b) { return kept.around[kept.at(l, b)]; });
    const float rangeMm = (float(t) + 0.5f) * tissueBins.mm;
    const float unspread = resolutionCell(setup.view, setup.lines[std::size_t(line)], rangeMm).unspread;
    const float level =
      reverberationLevel(kept.around[kept.at(line, t)], further, unspread, kept.ownLevel[kept.at(line, t)]);
    for (int b = t * tissueBins.each; b < std::min(out.binCount, (t + 1) * tissueBins.each); ++b)
    {
      out.reverberation[std::size_t(line) * std::size_t(out.binCount) + std::size_t(b)] = level;
    }
  }
}

/// A line's way along its axis, as StraightWay wants it.
struct AxisWay
{
  std::vector<float> rangeMm;
  std::vector<float> amplitude;
  std::vector<float> absorbedNp;
  float stepMm = 1.0f;

  StraightWay view() const
  {
    return { rangeMm.data(), amplitude.data(), absorbedNp.data(), int(rangeMm.size()) - 1, stepMm };
  }
};

/// Follows the line's axis by time, and writes where ranges lie on it.
template<class Space>
AxisWay followAxis(const Space& space, const TraceSetup& setup, int line, TracedLines& out)
{
  AxisWay way;
  if (out.depthOffsetMm.empty())
  {
    return way;
  }
  const TraceView& view = setup.view;
  const TraceLine& axis = setup.lines[std::size_t(line)];
  const int steps = out.binCount * flightSteps(float(out.binMm));
  way.stepMm = float(out.binMm) / float(flightSteps(float(out.binMm)));
  const TargetSpans spans = targetSpans(view, space, axis);
  int medium = mediumOnAxis(view, space, axis, spans, 0.0f);
  double range = 0.0;
  double lost = 0.0;
  double absorbed = 0.0;
  for (int s = 0; s <= steps; ++s)
  {
    way.rangeMm.push_back(float(range));
    way.amplitude.push_back(float(std::exp(-0.5 * lost)));
    way.absorbedNp.push_back(float(absorbed));
    const FlightStep step = flightStep(view, space, axis, spans, way.stepMm, s, medium);
    range += double(step.rangeMm);
    lost += double(step.lostNp);
    absorbed += double(step.absorbedNp);
  }
  float* offset = out.depthOffsetMm.data() + std::size_t(line) * std::size_t(out.binCount);
  for (int b = 0; b < out.binCount; ++b)
  {
    const float wanted = float(b) * float(out.binMm);
    offset[b] = depthOfRange(way.rangeMm.data(), steps, way.stepMm, wanted) - wanted;
  }
  return way;
}

} // namespace

/// What the paths of a line have left so far, see LineRounds.
struct LineSums
{
  int paths = 0;
  AxisWay way;
  LineStart start{};                   // where paths do not start apart
  std::vector<BinSums<double>> shared; // what all paths leave
  LineEchoes sharedEchoes;             // the same
  std::vector<BatchSums> batches;
  LineEchoes echoes;
};

namespace {

/// Before a line's first path.
template<class Space>
void beginLine(const Space& space, const TraceSetup& setup, int index, LineTally& tally, LineSums& sums,
               TracedLines& out)
{
  const TraceLine& line = setup.lines[std::size_t(index)];
  sums.way = followAxis(space, setup, index, out);
  sums.shared.assign(std::size_t(out.binCount), BinSums<double>{});
  sums.echoes = tally.emptyEchoes();
  if (!setup.view.startsApart)
  {
    tally.begin(setup.view, line, std::uint32_t(index), sums.way.view());
    sums.start = startLine(setup.view, space, line, tally);
    sums.shared = tally.takeBins(1);
    sums.sharedEchoes = tally.emptyEchoes();
    tally.exchange(sums.sharedEchoes);
  }
}

/// Lets a line have `paths` altogether. Sums run in the order of the batches and paths.
template<class Space>
inline void traceLineIn(const Space& space, const TraceSetup& setup, int index, int paths, const YieldPoint& yieldPoint,
                        LineTally& tally, LineSums& sums, TracedLines& out)
{
  const TraceView& view = setup.view;
  const TraceLine& line = setup.lines[std::size_t(index)];
  const int before = sums.paths;
  sums.paths = paths;
  if (before == 0)
  {
    beginLine(space, setup, index, tally, sums, out);
    if (!view.startsApart && !sums.start.meets)
    {
      return;
    }
    sums.batches.resize(std::size_t(std::min(batchCount, paths)), tally.emptyBatch());
  }
  const int batches = int(sums.batches.size());
  tally.begin(view, line, std::uint32_t(index), sums.way.view());
  tally.exchange(sums.echoes);
  std::vector<BounceScramble> scrambles(std::size_t(scrambleCount(view)));
  for (int batch = 0; batch < batches; ++batch)
  {
    const PathRange done = batchRange(before, batches, batch);
    const PathRange wanted = batchRange(paths, batches, batch);
    const int last = wanted.last - wanted.first;
    tally.exchange(sums.batches[std::size_t(batch)]);
    for (std::size_t b = 0; b < scrambles.size(); ++b)
    {
      scrambles[b] = makeScramble(view, std::uint32_t(index), std::uint32_t(batch), int(b));
    }
    for (int path = done.last - done.first; path < last;)
    {
      const int pause = std::min(last, nextFold(path)); // at most a few milliseconds' worth
      for (; path < pause; ++path)
      {
        const PathKey key{ std::uint32_t(index), std::uint32_t(batch), std::uint32_t(path), scrambles.data() };
        if (view.startsApart)
        {
          const TraceLine own = pathLine(view, line, key);
          tally.start(own, view.coherenceMm);
          tracePath(view, space, own, key, tally);
        }
        else
        {
          tracePath(view, space, line, sums.start, key, tally);
        }
      }
      if (path < last)
      {
        tally.fold();
        yieldPoint();
      }
    }
    tally.exchange(sums.batches[std::size_t(batch)]);
  }
  tally.exchange(sums.echoes);
}

SONO_SIMD_CLONES __attribute__((flatten)) void traceLine(const TraceSetup& setup, int index, int paths,
                                                         const YieldPoint& yieldPoint, LineTally& tally, LineSums& sums,
                                                         TracedLines& out)
{
  traceLineIn(setup.space(), setup, index, paths, yieldPoint, tally, sums, out);
}

void traceLineByNanoVDB(const TraceSetup& setup, int index, int paths, const YieldPoint& yieldPoint, LineTally& tally,
                        LineSums& sums, TracedLines& out)
{
  traceLineIn(setup.nanoSpace(), setup, index, paths, yieldPoint, tally, sums, out);
}

/// Writes a line's rows of the result.
void writeLine(const TraceSetup& setup, const LineSums& sums, int index, TracedReverberation& kept, TracedLines& out)
{
  const int batches = int(sums.batches.size());
  std::vector<std::vector<BinSums<double>>> means;           // of batches
  std::vector<std::vector<ReverberationSums>> reverberation; // the same
  for (int batch = 0; batch < batches; ++batch)
  {
    const PathRange range = batchRange(sums.paths, batches, batch);
    means.push_back(meanBins(sums.batches[std::size_t(batch)], range.last - range.first));
    if (!out.reverberation.empty())
    {
      reverberation.push_back(meanReverberation(sums.batches[std::size_t(batch)], range.last - range.first));
    }
  }
  writeBins(sums.shared, means, setup.frequencyMHz, index, out);
  if (!out.reverberation.empty() && batches > 0)
  {
    const TissueBins tissueBins(out.binCount, float(out.binMm));
    keepReverberation(reverberation, sums.echoes.takenNp(tissueBins), setup.frequencyMHz, index, kept, out);
  }
  std::complex<float>* echoes = out.boundaryEcho.data() + std::size_t(index) * std::size_t(out.echoCount);
  std::fill_n(echoes, out.echoCount, std::complex<float>());
  sums.sharedEchoes.addTo(echoes, 1.0);
  sums.echoes.addTo(echoes, 1.0 / sums.paths);
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
  if (double(out.lineCount) * out.echoCount > 5e8)
  {
    throw Error("the number of scan lines is " + std::to_string(out.lineCount) +
                ": at this depth and sampling their samples do not fit; use fewer lines or a lower sampling frequency");
  }
  return out;
}

LineRounds::LineRounds(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                       const std::vector<TargetSurface>& targets, const Progress& progress)
  : setup_(scene, lines, settings, targets, progress, Records::OnDemand)
  , march_(settings.march)
  , out_(tracedLayout(int(lines.size()), settings, targets))
{
  TracedLines::visitArrays(out_, [this](auto& values, const char*, TracedAxis axis) {
    values.assign(std::size_t(out_.lineCount) * (axis == TracedAxis::EchoSamples ? out_.echoCount : out_.binCount), {});
  });
  if (!settings.rangeIsTime())
  {
    out_.depthOffsetMm.clear();
  }
  if (!settings.reverberates())
  {
    out_.reverberation.clear();
    out_.reverberationError.clear();
    out_.reverberationNpPerMHz.clear();
  }
  reverberation_ = std::make_unique<TracedReverberation>(out_);
  cells_ = cellLayout(out_);
  echoCells_.level.resize(out_.reverberation.empty() ? 0 : cells_.level.size());
  echoCells_.error.resize(echoCells_.level.size());
}

LineRounds::~LineRounds() = default;

void LineRounds::trace(const std::vector<int>& lines, const std::vector<int>& paths, bool more,
                       const Progress& progress)
{
  sums_.resize(more || !sums_.empty() ? std::size_t(out_.lineCount) : 0);
  const double wavesPerMm = setup_.frequencyMHz / assumedSoundSpeedMmPerUs;
  tbb::enumerable_thread_specific<LineTally> tallies([&] {
    return LineTally(out_.binCount, out_.binMm, binSumsOf(out_.model), out_.echoCount, out_.echoSampleMm, wavesPerMm);
  });
  parallelFor(int(lines.size()), progress, [&](int i, const YieldPoint& yieldPoint) {
    const int line = lines[std::size_t(i)];
    LineSums once;
    LineSums& sums = sums_.empty() ? once : sums_[std::size_t(line)];
    const auto traceOne = march_ == March::NanoVDB ? traceLineByNanoVDB : traceLine;
    traceOne(setup_, line, paths[std::size_t(line)], yieldPoint, tallies.local(), sums, out_);
    writeLine(setup_, sums, line, *reverberation_, out_);
    if (!echoCells_.level.empty())
    {
      fillEchoCells(out_, sums.echoes, line, sums.paths, 4.0 * pi * wavesPerMm, cells_, echoCells_);
    }
  });
  // What reverberates is known of a line and those beside it.
  TracedReverberation& kept = *reverberation_;
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
    forHeard([&](int i) { sumLinesAround(i, kept); });
    forHeard([&](int i) { writeReverberation(setup_, kept, i, out_); });
  }
  parallelFor(out_.lineCount, {}, [&](int line) { fillCells(out_, echoCells_, line, cells_); });
  for (const LineTally& tally : tallies)
  {
    out_.segments += tally.segments();
  }
}

} // namespace sono
