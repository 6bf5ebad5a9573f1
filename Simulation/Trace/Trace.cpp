#include "Trace/Trace.h"

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

/// What lines leave of reverberation, lines x bins, until all are traced.
struct TracedReverberation
{
  std::vector<float> ownLevel; ///< ReverberationMeans, as the next
  std::vector<float> straightPower;
  std::vector<SpreadSums> around; ///< over the bins around, of the same line

  explicit TracedReverberation(std::size_t size)
    : ownLevel(size)
    , straightPower(size)
    , around(size)
  {
  }
};

/// Of the means of a line's batches, and of what the media have taken.
void keepReverberation(const std::vector<std::vector<ReverberationSums>>& batches, const std::vector<float>& takenNp,
                       double frequencyMHz, int line, TracedReverberation& kept, TracedLines& out)
{
  const std::size_t first = std::size_t(line) * std::size_t(out.binCount);
  std::vector<SpreadSums> bins(takenNp.size());
  const auto each = std::size_t(TissueBins(out.binCount, float(out.binMm)).each);
  ReverberationMeans means{};
  for (std::size_t b = 0; b < bins.size(); ++b)
  {
    if (b % each == 0)
    {
      means = reverberationMeans(int(batches.size()), [&](int batch) { return batches[std::size_t(batch)][b / each]; });
    }
    bins[b] = { means.cellPower, means.ownLevel * means.ownLevel };
    kept.ownLevel[first + b] = means.ownLevel;
    kept.straightPower[first + b] = means.straightPower;
    out.reverberationError[first + b] = means.error;
    out.reverberationNpPerMHz[first + b] = float(double(takenNp[b]) / frequencyMHz);
  }
  const int reach = spreadBins(float(out.binMm));
  for (int b = 0; b < out.binCount; ++b)
  {
    SpreadSums& around = kept.around[first + std::size_t(b)];
    for (int n = std::max(0, b - reach); n <= std::min(out.binCount - 1, b + reach); ++n)
    {
      around.cellPower += bins[std::size_t(n)].cellPower;
      around.power += bins[std::size_t(n)].power;
    }
  }
}

/// The levels of a line's reverberation, of what it and the lines beside it have left.
void writeReverberation(const TraceSetup& setup, const TracedReverberation& kept, int line, TracedLines& out)
{
  const auto at = [&](int l, int b) { return std::size_t(l) * std::size_t(out.binCount) + std::size_t(b); };
  const int first = std::max(0, line - spreadLines);
  const int last = std::min(out.lineCount - 1, line + spreadLines);
  for (int b = 0; b < out.binCount; ++b)
  {
    SpreadSums around;
    float straight = 0.0f;
    for (int l = first; l <= last; ++l)
    {
      around.cellPower += kept.around[at(l, b)].cellPower;
      around.power += kept.around[at(l, b)].power;
      straight += kept.straightPower[at(l, b)] / float(last - first + 1);
    }
    const float rangeMm = (float(b) + 0.5f) * float(out.binMm);
    const float unspread = resolutionCell(setup.view, setup.lines[std::size_t(line)], rangeMm).unspread;
    out.reverberation[at(line, b)] = reverberationLevel(around, unspread, kept.ownLevel[at(line, b)], straight);
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

/// Traces one line into its rows of the result. Sums run in the order of the batches and paths.
template<class Space>
inline void traceLineIn(const Space& space, const TraceSetup& setup, int index, const YieldPoint& yieldPoint,
                        LineTally& tally, TracedReverberation& kept, TracedLines& out)
{
  const TraceView& view = setup.view;
  const TraceLine& line = setup.lines[std::size_t(index)];
  const AxisWay way = followAxis(space, setup, index, out);
  tally.begin(view, line, std::uint32_t(index), way.view());
  std::complex<float>* echoes = out.boundaryEcho.data() + std::size_t(index) * std::size_t(out.echoCount);
  tally.setEchoWeight(1.0f);
  LineStart start;
  std::vector<BinSums<double>> shared(std::size_t(out.binCount), BinSums<double>{});
  std::vector<std::vector<BinSums<double>>> means;           // of batches
  std::vector<std::vector<ReverberationSums>> reverberation; // the same
  if (!view.startsApart)
  {
    start = startLine(view, space, line, tally);
    shared = tally.takeBins(1);
    if (!start.meets)
    {
      writeBins(shared, means, setup.frequencyMHz, index, out);
      tally.takeEchoes(echoes);
      return;
    }
  }

  tally.setEchoWeight(1.0f / float(setup.paths));
  const int batches = std::min(batchCount, setup.paths);
  std::vector<BounceScramble> scrambles(std::size_t(scrambleCount(view)));
  for (int batch = 0; batch < batches; ++batch)
  {
    const auto [first, last] = batchRange(setup.paths, batches, batch);
    for (std::size_t b = 0; b < scrambles.size(); ++b)
    {
      scrambles[b] = makeScramble(view, std::uint32_t(index), std::uint32_t(batch), int(b));
    }
    for (int path = first; path < last;)
    {
      const int pause = std::min(last, path + pathsPerFold); // a few milliseconds' worth
      for (; path < pause; ++path)
      {
        const PathKey key{ std::uint32_t(index), std::uint32_t(batch), std::uint32_t(path - first), scrambles.data() };
        if (view.startsApart)
        {
          const TraceLine own = pathLine(view, line, key);
          tally.start(own, view.coherenceMm);
          tracePath(view, space, own, key, tally);
        }
        else
        {
          tracePath(view, space, line, start, key, tally);
        }
      }
      if (path < last)
      {
        tally.fold();
        yieldPoint();
      }
    }
    means.push_back(tally.takeBins(last - first));
    if (!out.reverberation.empty())
    {
      reverberation.push_back(tally.takeReverberation(last - first));
    }
  }
  if (!out.reverberation.empty())
  {
    keepReverberation(reverberation, tally.takeReverberatedNp(), setup.frequencyMHz, index, kept, out);
  }
  tally.takeEchoes(echoes);
  writeBins(shared, means, setup.frequencyMHz, index, out);
}

SONO_SIMD_CLONES __attribute__((flatten)) void traceLine(const TraceSetup& setup, int index,
                                                         const YieldPoint& yieldPoint, LineTally& tally,
                                                         TracedReverberation& kept, TracedLines& out)
{
  traceLineIn(setup.space(), setup, index, yieldPoint, tally, kept, out);
}

void traceLineByNanoVDB(const TraceSetup& setup, int index, const YieldPoint& yieldPoint, LineTally& tally,
                        TracedReverberation& kept, TracedLines& out)
{
  traceLineIn(setup.nanoSpace(), setup, index, yieldPoint, tally, kept, out);
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

TracedLines trace(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                  const Progress& progress, const std::vector<TargetSurface>& targets)
{
  const Progress preparing = partOf(progress, 0.0, 0.3);
  const TraceSetup setup(scene, lines, settings, targets, preparing, Records::OnDemand);
  const Progress tracing = partOf(progress, 0.3, 1.0);
  TracedLines out = tracedLayout(int(lines.size()), settings, targets);
  TracedLines::visitArrays(out, [&out](auto& values, const char*, TracedAxis axis) {
    values.assign(std::size_t(out.lineCount) * (axis == TracedAxis::EchoSamples ? out.echoCount : out.binCount), {});
  });
  if (!settings.rangeIsTime())
  {
    out.depthOffsetMm.clear();
  }
  if (!settings.reverberates())
  {
    out.reverberation.clear();
    out.reverberationError.clear();
    out.reverberationNpPerMHz.clear();
  }

  TracedReverberation kept(out.reverberation.size());
  tbb::enumerable_thread_specific<LineTally> tallies([&] {
    return LineTally(out.binCount, out.binMm, binSumsOf(settings.model), out.echoCount, out.echoSampleMm,
                     settings.frequencyMHz / assumedSoundSpeedMmPerUs);
  });
  parallelFor(out.lineCount, tracing, [&](int i, const YieldPoint& yieldPoint) {
    if (settings.march == March::NanoVDB)
    {
      traceLineByNanoVDB(setup, i, yieldPoint, tallies.local(), kept, out);
    }
    else
    {
      traceLine(setup, i, yieldPoint, tallies.local(), kept, out);
    }
  });
  if (!out.reverberation.empty())
  {
    parallelFor(out.lineCount, {}, [&](int i) { writeReverberation(setup, kept, i, out); });
  }
  for (const LineTally& tally : tallies)
  {
    out.segments += tally.segments();
  }
  return out;
}

} // namespace sono
