#include "Trace/Trace.h"

#include "Core/ParallelFor.h"
#include "Core/Simd.h"
#include "Core/SoundSpeed.h"
#include "Kernel/NanoSpace.h"
#include "Kernel/TracePath.h"
#include "Trace/BatchMeans.h"
#include "Trace/Deposit.h"
#include "Trace/TraceSetup.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

/// Writes B of a line from its intensity and the means of A I. A path's intensity falls as the round trip's amplitude
/// does, so A is B f.
void writeAttenuation(const std::vector<double>& absorbed, double frequencyMHz, int line, TracedLines& out)
{
  const std::size_t row = std::size_t(line) * std::size_t(out.binCount);
  for (std::size_t b = 0; b < absorbed.size(); ++b)
  {
    const double intensity = double(out.intensity[row + b]);
    out.attenuationNpPerMHz[row + b] = intensity > 0.0 ? float(absorbed[b] / (intensity * frequencyMHz)) : 0.0f;
  }
}

/// Traces one line into its rows of the result. Sums run in the order of the batches and paths.
template<class Space>
inline void traceLineIn(const Space& space, const TraceSetup& setup, int index, const YieldPoint& yieldPoint,
                        LineTally& tally, TracedLines& out)
{
  const std::size_t row = std::size_t(index) * std::size_t(out.binCount);
  const TraceView& view = setup.view;
  const TraceLine& line = setup.lines[std::size_t(index)];
  std::complex<float>* echoes = out.boundaryEcho.data() + std::size_t(index) * std::size_t(out.echoCount);
  tally.start(line, view.coherenceMm);
  tally.setEchoWeight(1.0f);
  LineStart start;
  std::vector<double> absorbed(std::size_t(out.binCount), 0.0);
  if (!view.startsApart)
  {
    start = startLine(view, space, line, tally);
    const std::vector<float> shared = tally.takeBins(1);
    std::copy(shared.begin(), shared.end(), out.intensity.begin() + std::ptrdiff_t(row));
    absorbed = tally.takeAbsorbed(1);
    if (!start.meets)
    {
      writeAttenuation(absorbed, setup.frequencyMHz, index, out);
      tally.takeEchoes(echoes);
      return;
    }
  }

  tally.setEchoWeight(1.0f / float(setup.paths));
  const int batches = std::min(batchCount, setup.paths);
  std::vector<std::vector<float>> means;
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
    const std::vector<double> ofBatch = tally.takeAbsorbed(last - first);
    for (std::size_t b = 0; b < absorbed.size(); ++b)
    {
      absorbed[b] += ofBatch[b] / batches;
    }
  }
  tally.takeEchoes(echoes);
  addBatchMeans(means, index, out);
  writeAttenuation(absorbed, setup.frequencyMHz, index, out);
}

SONO_SIMD_CLONES __attribute__((flatten)) void traceLine(const TraceSetup& setup, int index,
                                                         const YieldPoint& yieldPoint, LineTally& tally,
                                                         TracedLines& out)
{
  traceLineIn(setup.space(), setup, index, yieldPoint, tally, out);
}

void traceLineByNanoVDB(const TraceSetup& setup, int index, const YieldPoint& yieldPoint, LineTally& tally,
                        TracedLines& out)
{
  traceLineIn(setup.nanoSpace(), setup, index, yieldPoint, tally, out);
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
    values.assign(std::size_t(out.lineCount) * (axis == TracedAxis::Bins ? out.binCount : out.echoCount), {});
  });

  tbb::enumerable_thread_specific<LineTally> tallies([&] {
    return LineTally(out.binCount, out.binMm, out.echoCount, out.echoSampleMm,
                     settings.frequencyMHz / assumedSoundSpeedMmPerUs);
  });
  parallelFor(out.lineCount, tracing, [&](int i, const YieldPoint& yieldPoint) {
    if (settings.march == March::NanoVDB)
    {
      traceLineByNanoVDB(setup, i, yieldPoint, tallies.local(), out);
    }
    else
    {
      traceLine(setup, i, yieldPoint, tallies.local(), out);
    }
  });
  for (const LineTally& tally : tallies)
  {
    out.segments += tally.segments();
  }
  return out;
}

} // namespace sono
