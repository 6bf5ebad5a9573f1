#include "Trace/Trace.h"

#include "Kernel/TracePath.h"
#include "ParallelFor.h"
#include "Simd.h"
#include "Trace/Deposit.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace sono
{

namespace
{

constexpr int batchCount = 8; // of paths, for the standard error

void require(bool ok, const char* parameter, double value, const char* range)
{
  if (!ok)
  {
    throw Error(std::string(parameter) + " is " + std::to_string(value) + ": it must be " + range);
  }
}

/// What the fan can reach: the half balls of radius `depthMm` in front of each line's origin, in voxels.
VoxelBox reach(const Scene& scene, const std::vector<ScanLine>& lines, double depthMm)
{
  const Mat3d toLocal = scene.rotationToLocal();
  Vec3d low(1e30);
  Vec3d high(-1e30);
  for (const ScanLine& line : lines)
  {
    const Vec3d origin = scene.localFromWorld(line.originMm);
    const Vec3d axis = toLocal * line.axis;
    for (int a = 0; a < 3; ++a)
    {
      const double across = std::sqrt(std::max(0.0, 1.0 - axis[a] * axis[a]));
      high[a] = std::max(high[a], origin[a] + depthMm * (axis[a] >= 0.0 ? 1.0 : across));
      low[a] = std::min(low[a], origin[a] - depthMm * (axis[a] <= 0.0 ? 1.0 : across));
    }
  }
  const Vec3d spacing = scene.placement().spacingMm;
  const Vec3d size(scene.placement().size);
  return { Vec3i(glm::clamp(glm::floor(low / spacing), Vec3d(0.0), size)),
           Vec3i(glm::clamp(glm::ceil(high / spacing) + 1.0, Vec3d(0.0), size)) };
}

std::vector<TraceMedium> makeMedia(const Scene& scene, double frequencyMHz)
{
  std::vector<TraceMedium> media;
  for (const Tissue& tissue : scene.tissues())
  {
    TraceMedium m;
    m.impedance = float(tissue.impedanceMRayl);
    m.speed = float(tissue.soundSpeedMPerS);
    // Intensity falls by 10^(-a f l / 10), l in cm.
    m.decayPerMm = float(tissue.attenuationDbPerCmMHz * frequencyMHz * std::log(10.0) / 100.0);
    m.tau = float(tissue.tau);
    m.gamma = float(tissue.gamma);
    media.push_back(m);
  }
  return media;
}

TraceView makeView(const Scene& scene,
                   const TraceRegion& region,
                   const std::vector<TraceMedium>& media,
                   const TraceSettings& settings)
{
  TraceView view;
  view.cells = region.view();
  view.media = media.data();
  view.outsideTissue = scene.outsideIndex();
  view.model = settings.model;
  view.lobe = makeLobe(settings.lobeMeanRad, settings.lobeSigmaRad, settings.lobeMinRad, settings.lobeMaxRad);
  view.lowDiscrepancy = settings.sampling == Sampling::LowDiscrepancy;
  view.deterministic = settings.deterministic;
  view.maxCollisions = settings.maxCollisions;
  view.coherenceMm = float(settings.coherenceMm);
  view.depthMm = float(settings.depthMm);
  view.seed = settings.seed;
  return view;
}

/// Traces one line into its rows of the result. Sums run in the order of the batches and paths.
SONO_SIMD_CLONES __attribute__((flatten)) bool traceLine(const TraceView& view,
                                                         const TraceLine& line,
                                                         int index,
                                                         int paths,
                                                         LineTally& tally,
                                                         TracedLines& out)
{
  const std::size_t row = std::size_t(index) * std::size_t(out.binCount);
  tally.start(line, view.coherenceMm, out.boundaryEcho.data() + std::size_t(index) * std::size_t(out.echoCount));
  tally.clearBins();
  tally.setEchoWeight(1.0f);
  const LineStart start = startLine(view, line, tally);
  const std::vector<float> shared = tally.bins();
  std::copy(shared.begin(), shared.end(), out.intensity.begin() + std::ptrdiff_t(row));
  if (!start.meets)
  {
    return start.enters;
  }

  tally.setEchoWeight(1.0f / float(paths));
  const int batches = std::min(batchCount, paths);
  std::vector<std::vector<float>> means;
  for (int batch = 0; batch < batches; ++batch)
  {
    const int first = int(std::int64_t(paths) * batch / batches);
    const int last = int(std::int64_t(paths) * (batch + 1) / batches);
    tally.clearBins();
    for (int path = first; path < last; ++path)
    {
      tracePath(
        view, line, start, PathKey{ std::uint32_t(index), std::uint32_t(batch), std::uint32_t(path - first) }, tally);
    }
    std::vector<float> mean = tally.bins();
    for (float& v : mean)
    {
      v /= float(last - first);
    }
    means.push_back(std::move(mean));
  }
  for (int b = 0; b < out.binCount; ++b)
  {
    double mean = 0.0;
    double spread = 0.0;
    for (const auto& m : means)
    {
      mean += m[std::size_t(b)];
    }
    mean /= batches;
    for (const auto& m : means)
    {
      spread += (m[std::size_t(b)] - mean) * (m[std::size_t(b)] - mean);
    }
    out.intensity[row + std::size_t(b)] += float(mean);
    out.standardError[row + std::size_t(b)] =
      batches > 1 ? float(std::sqrt(spread / (double(batches) * (batches - 1)))) : 0.0f;
  }
  return true;
}

} // namespace

void TraceSettings::validate() const
{
  require(pathsPerLine >= 1 && pathsPerLine <= 10000000, "paths per line", pathsPerLine, "1 to 10,000,000");
  require(maxCollisions >= 0 && maxCollisions <= 1000, "maximum collisions", maxCollisions, "0 to 1000");
  require(coherenceMm >= 0.0 && std::isfinite(coherenceMm), "beam coherence C0 (mm)", coherenceMm, "0 or more");
  require(std::isfinite(lobeMeanRad), "lobe mean (rad)", lobeMeanRad, "a finite angle");
  require(lobeSigmaRad >= 0.0 && std::isfinite(lobeSigmaRad), "lobe sigma (rad)", lobeSigmaRad, "0 or more");
  require(
    lobeMinRad >= 0.0 && lobeMinRad < lobeMaxRad, "lobe minimum (rad)", lobeMinRad, "0 or more and below the maximum");
  require(lobeMaxRad <= 1.5708, "lobe maximum (rad)", lobeMaxRad, "at most pi/2");
  require(frequencyMHz > 0.0 && std::isfinite(frequencyMHz), "frequency (MHz)", frequencyMHz, "more than 0");
  require(depthMm > 0.0 && depthMm <= 1000.0, "depth (mm)", depthMm, "more than 0 and at most 1000");
  require(
    radialBinMm > 0.0 && radialBinMm <= depthMm, "radial bin (mm)", radialBinMm, "more than 0 and at most the depth");
  require(depthMm / radialBinMm <= 1e5, "radial bin (mm)", radialBinMm, "at least 1/100,000 of the depth");
  require(echoSampleMm > 0.0 && depthMm / echoSampleMm <= 1e6,
          "echo sample (mm)",
          echoSampleMm,
          "more than 0 and at least a millionth of the depth");
}

TracedLines trace(const Scene& scene,
                  const std::vector<ScanLine>& lines,
                  const TraceSettings& settings,
                  const Progress& progress)
{
  settings.validate();
  if (lines.empty())
  {
    throw Error("the probe has no scan lines: set the number of lines to 1 or more");
  }
  TracedLines out;
  out.lineCount = int(lines.size());
  out.binMm = settings.radialBinMm;
  out.binCount = int(std::ceil(settings.depthMm / settings.radialBinMm - 1e-9));
  out.echoSampleMm = settings.echoSampleMm;
  out.echoCount = int(std::floor(settings.depthMm / settings.echoSampleMm)) + 1;
  if (double(out.lineCount) * out.echoCount > 5e8)
  {
    throw Error("the number of scan lines is " + std::to_string(out.lineCount) +
                ": at this depth and sampling their samples do not fit; use fewer lines or a lower sampling frequency");
  }
  out.intensity.assign(std::size_t(out.lineCount) * out.binCount, 0.0f);
  out.standardError.assign(out.intensity.size(), 0.0f);
  out.boundaryEcho.assign(std::size_t(out.lineCount) * out.echoCount, {});

  const auto region = scene.traceRegion(reach(scene, lines, settings.depthMm));
  report(progress, 0.05);
  const std::vector<TraceMedium> media = makeMedia(scene, settings.frequencyMHz);
  const TraceView view = makeView(scene, *region, media, settings);
  const Vec3d corner = Vec3d(region->box.first) * scene.placement().spacingMm;
  const Mat3d toLocal = scene.rotationToLocal();
  const int paths = settings.deterministic ? 1 : settings.pathsPerLine;

  tbb::enumerable_thread_specific<LineTally> tallies(
    [&]
    {
      return LineTally(
        out.binCount, out.binMm, out.echoCount, out.echoSampleMm, settings.frequencyMHz / assumedSoundSpeedMmPerUs);
    });
  std::atomic<bool> anyEnters{ false };
  const Progress tracing = progress ? Progress([&](double f) { return progress(0.05 + 0.95 * f); }) : Progress{};
  parallelFor(
    out.lineCount,
    tracing,
    [&](int i)
    {
      const ScanLine& world = lines[std::size_t(i)];
      const TraceLine line{ Vec3f(scene.localFromWorld(world.originMm) - corner), Vec3f(toLocal * world.axis) };
      if (traceLine(view, line, i, paths, tallies.local(), out))
      {
        anyEnters = true;
      }
    });
  if (!anyEnters)
  {
    throw Error("no scan line meets the label map: move the probe onto the skin or increase the depth");
  }
  for (const LineTally& tally : tallies)
  {
    out.segments += tally.segments();
  }
  return out;
}

} // namespace sono
