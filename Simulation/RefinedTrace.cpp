#include "RefinedTrace.h"

#include "Core/SoundSpeed.h"
#include "Echo/FormRf.h"
#include "Trace/PathBatches.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr int firstPaths = 64;
constexpr std::size_t linesLookedAt = 32;
constexpr double leastGrowth = 1.5; ///< of the paths, for their picture's change to tell anything
constexpr double preparing = 0.1;   // of the progress

constexpr double floorDb = -60.0;
constexpr double peakShare = 0.005;

EchoSettings usualEcho(const TraceSettings& tracing)
{
  EchoSettings echo;
  echo.device = Device::Cpu;
  echo.imagingMode = tracing.imagingMode;
  echo.centreFrequencyMHz = receivedMHz(tracing.imagingMode, tracing.frequencyMHz);
  echo.fractionalBandwidth = tracing.fractionalBandwidth;
  echo.aperture = tracing.aperture;
  echo.depthMm = tracing.depthMm;
  echo.samplingMHz = 0.5 * assumedSoundSpeedMmPerUs / tracing.echoSampleMm; // few samples a period hide dark gaps
  return echo;
}

/// Some of the lines.
TracedLines linesOf(const TracedLines& traced, const std::vector<std::size_t>& indices)
{
  TracedLines some;
  some.model = traced.model;
  some.lineCount = int(indices.size());
  some.binCount = traced.binCount;
  some.binMm = traced.binMm;
  some.echoCount = traced.echoCount;
  some.echoSampleMm = traced.echoSampleMm;
  some.targets = traced.targets;
  std::vector<const void*> from;
  TracedLines::visitArrays(traced, [&](const auto& values, const char*, TracedAxis) { from.push_back(&values); });
  auto next = from.begin();
  TracedLines::visitArrays(some, [&](auto& values, const char*, TracedAxis axis) {
    const auto& all = *static_cast<const std::decay_t<decltype(values)>*>(*next++);
    const auto each = std::size_t(axis == TracedAxis::EchoSamples ? traced.echoCount : traced.binCount);
    for (const std::size_t index : indices)
    {
      if (!all.empty())
      {
        values.insert(values.end(), all.begin() + std::ptrdiff_t(index * each),
                      all.begin() + std::ptrdiff_t((index + 1) * each));
      }
    }
  });
  return some;
}

} // namespace

double changeDb(const std::vector<float>& before, const std::vector<float>& now)
{
  if (now.empty())
  {
    return 0.0;
  }
  std::vector<float> sorted = now;
  const auto bright = sorted.end() - 1 - std::ptrdiff_t(peakShare * double(sorted.size()));
  std::nth_element(sorted.begin(), bright, sorted.end());
  const double peak = *bright;
  const auto level = [&](float value) { return std::max(floorDb, 20.0 * std::log10(double(value) / peak)); };
  double squares = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < now.size() && peak > 0.0; ++i)
  {
    const double a = level(before[i]);
    const double b = level(now[i]);
    if (std::max(a, b) > floorDb)
    {
      squares += (a - b) * (a - b);
      ++count;
    }
  }
  return count > 0 ? std::sqrt(squares / double(count)) : 0.0;
}

RefinedTrace::RefinedTrace(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                           const std::vector<TargetSurface>& targets, const Progress& progress)
  : scene_(scene)
  , settings_(settings)
  , start_(Clock::now())
  , rounds_(roundsByMode(scene, lines, settings, targets, partOf(progress, 0.0, preparing)))
  , shown_(usualEcho(settings))
  , done_(preparing)
{
  const std::size_t apart = std::max<std::size_t>(1, lines.size() / linesLookedAt);
  for (std::size_t l = apart / 2; l < lines.size(); l += apart)
  {
    indices_.push_back(l);
    lines_.push_back(lines[l]);
  }
  // Half of all, so that a second round tells how exact it is.
  const int half = std::max(settings.pathsPerLine / 2, std::min(2 * batchCount, settings.pathsPerLine));
  traceTo(std::min(firstPaths, half), progress);
}

/// As many as now: no more.
int RefinedTrace::nextPaths() const
{
  const bool isExact = settings_.targetErrorDb > 0.0 && errorDb_ > 0.0 && errorDb_ <= settings_.targetErrorDb;
  int next = isExact ? paths_ : std::min(2 * paths_, settings_.pathsPerLine);
  if (settings_.timeBudgetS > 0.0)
  {
    const double leftS = settings_.timeBudgetS - std::chrono::duration<double>(Clock::now() - start_).count();
    const double affordable = std::max(0.0, leftS / secondsPerPath_);
    if (double(next - paths_) > affordable)
    {
      next = paths_ + int(affordable) / batchCount * batchCount;
      next = next < leastGrowth * paths_ ? paths_ : next;
    }
  }
  return next;
}

bool RefinedTrace::refine(const Progress& progress)
{
  const int next = nextPaths();
  if (next == paths_)
  {
    return false;
  }
  traceTo(next, progress);
  return true;
}

void RefinedTrace::traceTo(int paths, const Progress& progress)
{
  const auto before = Clock::now();
  const double wanted = errorDb_ > 0.0 && settings_.targetErrorDb > 0.0
                          ? paths_ * std::pow(errorDb_ / settings_.targetErrorDb, 2.0)
                          : double(settings_.pathsPerLine);
  const double end = std::clamp(paths / std::max(wanted, 1.0), done_, 1.0);
  result_ = rounds_(
    paths, paths < settings_.pathsPerLine, [&](const TracedLines& traced) { return errorOf(traced, paths); },
    partOf(progress, done_, end));
  done_ = end;
  secondsPerPath_ = std::chrono::duration<double>(Clock::now() - before).count() / (paths - paths_);
  paths_ = paths;
}

double RefinedTrace::errorOf(const TracedLines& traced, int paths)
{
  std::vector<float> envelope = formRf(scene_, lines_, linesOf(traced, indices_), shown_).envelope();
  if (paths_ > 0 && paths >= leastGrowth * paths_)
  {
    const double seen = changeDb(envelope_, envelope) * std::sqrt(double(paths_) / (paths - paths_));
    const double expected = errorDb_ * std::sqrt(double(paths_) / paths);
    errorDb_ = errorDb_ > 0.0 ? std::sqrt(0.5 * (seen * seen + expected * expected)) : seen;
  }
  else if (paths_ > 0)
  {
    errorDb_ *= std::sqrt(double(paths_) / paths); // too few are new
  }
  envelope_ = std::move(envelope);
  return errorDb_;
}

} // namespace sono
