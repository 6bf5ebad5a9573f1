#pragma once

#include "Core/ParallelFor.h"
#include "Core/Simd.h"
#include "Core/SoundSpeed.h"
#include "Trace/BatchMeans.h"
#include "Trace/PathBatches.h"
#include "Trace/SharedGroup.h"

#include <tbb/enumerable_thread_specific.h>

#include <atomic>

namespace sono {

/// What the lines of a run share. Owned elsewhere.
struct SharedRun
{
  const TraceView& view;
  const std::vector<TraceLine>& lines;
  int paths; ///< per line
  double frequencyMHz;
};

/// Lines that share: each adds a walk to the joint and a deposit to every path of the others, and as many samples.
constexpr int groupSize = 8;
/// At the ends of a scan fewer lines than this are added to their neighbours' group.
constexpr int leastGroup = groupSize / 2;
constexpr int largestGroup = groupSize + 2 * leastGroup;

/// Lines whose batches are held at a time.
constexpr int linesAtOnce = 512;

/// What one batch left on one line, by the branch that its paths took at the first boundary.
struct BatchTally
{
  std::array<std::vector<float>, FirstBranches> mean;
  std::array<double, FirstBranches> weight{};
};

/// Memory of one thread.
struct GroupWorker
{
  std::vector<LineTally> tallies;
  std::vector<GroupLine> lines;
  std::vector<BounceScramble> scrambles;
  GroupScratch scratch;
};

/// The lines of one batch's share of the work.
struct LineRange
{
  int first;
  int last;
};

inline bool sharesWith(const SharedRun& run, const std::vector<LineStart>& starts, int first, int a, int b)
{
  const LineStart& one = starts[std::size_t(a - first)];
  const LineStart& two = starts[std::size_t(b - first)];
  const auto fit = [&](const LineStart& s) {
    return s.meets && s.boundary.voxelFace && s.path.target < 0 && s.path.intensity > 0.0f &&
           s.path.intensity >= run.view.rouletteIntensity;
  };
  // Lobes farther apart than this have little in common.
  const float apart = std::cos(smaller(1.5f, 2.0f * run.view.lobe.sigma));
  return fit(one) && fit(two) && one.boundary.before.medium == two.boundary.before.medium &&
         one.boundary.after.medium == two.boundary.after.medium &&
         glm::dot(run.lines[std::size_t(a)].axis, run.lines[std::size_t(b)].axis) > apart;
}

/// Groups of neighbours for one batch, of the lines that meet a boundary.
inline std::vector<LineRange> makeGroups(const SharedRun& run, const std::vector<LineStart>& starts, LineRange lines,
                                         int batch, int batches)
{
  const int shift = batch * groupSize / batches;
  std::vector<LineRange> groups;
  for (int i = lines.first; i < lines.last; ++i)
  {
    if (!starts[std::size_t(i - lines.first)].meets)
    {
      continue;
    }
    const bool cut =
      (i - lines.first + shift) % groupSize == 0 && i - lines.first >= leastGroup && lines.last - i >= leastGroup;
    const bool goesOn = !cut && !groups.empty() && groups.back().last == i &&
                        sharesWith(run, starts, lines.first, groups.back().first, i);
    if (goesOn)
    {
      ++groups.back().last;
    }
    else
    {
      groups.push_back({ i, i + 1 });
    }
  }
  return groups;
}

/// One group of one batch. `starts` and `batchTallies` are by line, from `first` on.
template<class Space>
inline std::uint64_t traceGroupIn(const Space& space, const SharedRun& run, const LineRange& group, int batch,
                                  int paths, int first, const std::vector<LineStart>& starts,
                                  const YieldPoint& yieldPoint, GroupWorker& worker,
                                  std::vector<BatchTally>& batchTallies, TracedLines& out)
{
  const TraceView& view = run.view;
  worker.lines.clear();
  for (int i = group.first; i < group.last; ++i)
  {
    GroupLine line{ &run.lines[std::size_t(i)], &starts[std::size_t(i - first)], {} };
    for (int branch = 0; branch < FirstBranches; ++branch)
    {
      LineTally& tally = worker.tallies[std::size_t((i - group.first) * FirstBranches + branch)];
      tally.start(*line.line, view.coherenceMm);
      tally.setEchoWeight(1.0f / float(run.paths));
      line.tally[std::size_t(branch)] = &tally;
    }
    worker.lines.push_back(line);
  }
  const PathKey key{ std::uint32_t(group.first), std::uint32_t(batch), 0u, worker.scrambles.data() };
  for (int b = 0; b < view.maxCollisions; ++b)
  {
    worker.scrambles[std::size_t(b)] = makeBounceScramble(view.seed, key.line, key.batch, std::uint32_t(b));
  }
  const std::uint64_t segments =
    SharedGroup<Space>(view, space, worker.lines, worker.scratch).trace(key, paths, yieldPoint);
  for (int i = group.first; i < group.last; ++i)
  {
    const GroupLine& line = worker.lines[std::size_t(i - group.first)];
    BatchTally& tally = batchTallies[std::size_t(i - first)];
    for (std::size_t branch = 0; branch < FirstBranches; ++branch)
    {
      tally.mean[branch] = line.tally[branch]->takeBins(paths);
      line.tally[branch]->takeEchoes(out.boundaryEcho.data() + std::size_t(i) * std::size_t(out.echoCount));
      tally.weight[branch] = line.weight[branch] / paths;
    }
  }
  return segments;
}

template<class Space>
SONO_SIMD_CLONES __attribute__((flatten)) std::uint64_t traceGroup(const Space& space, const SharedRun& run,
                                                                   const LineRange& group, int batch, int paths,
                                                                   int first, const std::vector<LineStart>& starts,
                                                                   const YieldPoint& yieldPoint, GroupWorker& worker,
                                                                   std::vector<BatchTally>& batchTallies,
                                                                   TracedLines& out)
{
  return traceGroupIn(space, run, group, batch, paths, first, starts, yieldPoint, worker, batchTallies, out);
}

/// The batches' means of a line. The weights of a branch add up to its probability on average but not in each batch:
/// their excess is a control variate, whose factor, the mean per weight, comes from the other batches, so that the mean
/// stays what it is.
inline std::vector<std::vector<float>> controlledMeans(const std::vector<BatchTally>& batches, const GroupLine& line)
{
  std::vector<std::vector<float>> means;
  const std::size_t bins = batches.front().mean[0].size();
  for (const BatchTally& batch : batches)
  {
    std::vector<float> mean(bins, 0.0f);
    for (std::size_t branch = 0; branch < FirstBranches; ++branch)
    {
      double others = 0.0;
      std::vector<double> sum(bins, 0.0);
      for (const BatchTally& other : batches)
      {
        if (&other == &batch)
        {
          continue;
        }
        others += other.weight[branch];
        for (std::size_t b = 0; b < bins; ++b)
        {
          sum[b] += other.mean[branch][b];
        }
      }
      const double excess = batch.weight[branch] - double(line.firstShare(int(branch)));
      const double factor = others > 0.0 ? excess / others : 0.0;
      for (std::size_t b = 0; b < bins; ++b)
      {
        mean[b] += float(batch.mean[branch][b] - factor * sum[b]);
      }
    }
    means.push_back(std::move(mean));
  }
  return means;
}

/// See traceShared.
template<class Space>
void traceSharedLines(const Space& space, const SharedRun& run, TracedLines& out, const Progress& progress)
{
  const TraceView& view = run.view;
  const double wavesPerMm = run.frequencyMHz / assumedSoundSpeedMmPerUs;
  const LineTally empty(out.binCount, out.binMm, out.echoCount, out.echoSampleMm, wavesPerMm);
  tbb::enumerable_thread_specific<GroupWorker> workers([&] {
    GroupWorker worker;
    worker.tallies.assign(std::size_t(largestGroup * FirstBranches), empty);
    worker.scrambles.resize(std::size_t(view.maxCollisions));
    return worker;
  });
  std::atomic<std::uint64_t> segments{ 0 };
  const int batches = std::min(batchCount, run.paths);
  for (int first = 0; first < out.lineCount; first += linesAtOnce)
  {
    const LineRange lines{ first, std::min(out.lineCount, first + linesAtOnce) };
    std::vector<LineStart> starts(std::size_t(lines.last - lines.first));
    parallelFor(lines.last - lines.first, {}, [&](int i) {
      LineTally& tally = workers.local().tallies.front();
      const std::size_t row = std::size_t(first + i);
      tally.start(run.lines[row], view.coherenceMm);
      tally.setEchoWeight(1.0f);
      starts[std::size_t(i)] = startLine(view, space, run.lines[row], tally);
      const std::vector<float> bins = tally.takeBins(1);
      std::copy(bins.begin(), bins.end(), out.intensity.begin() + std::ptrdiff_t(row * std::size_t(out.binCount)));
      tally.takeEchoes(out.boundaryEcho.data() + row * std::size_t(out.echoCount));
    });
    std::vector<std::vector<BatchTally>> tallies(std::size_t(batches), std::vector<BatchTally>(starts.size()));
    for (int batch = 0; batch < batches; ++batch)
    {
      const PathRange range = batchRange(run.paths, batches, batch);
      const std::vector<LineRange> groups = makeGroups(run, starts, lines, batch, batches);
      const double share = double(lines.last - lines.first) / out.lineCount;
      const double before = double(lines.first) / out.lineCount;
      const Progress part = partOf(progress, before + share * batch / batches, before + share * (batch + 1) / batches);
      parallelFor(int(groups.size()), part, [&](int g, const YieldPoint& yieldPoint) {
        segments += traceGroup(space, run, groups[std::size_t(g)], batch, range.last - range.first, first, starts,
                               yieldPoint, workers.local(), tallies[std::size_t(batch)], out);
      });
    }
    parallelFor(lines.last - lines.first, {}, [&](int i) {
      if (!starts[std::size_t(i)].meets)
      {
        return;
      }
      std::vector<BatchTally> own;
      for (auto& batch : tallies)
      {
        own.push_back(std::move(batch[std::size_t(i)]));
      }
      const GroupLine line{ &run.lines[std::size_t(first + i)], &starts[std::size_t(i)], {} };
      addBatchMeans(controlledMeans(own, line), first + i, out);
    });
  }
  out.segments = segments;
}

} // namespace sono
