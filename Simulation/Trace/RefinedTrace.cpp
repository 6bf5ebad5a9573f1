#include "Trace/RefinedTrace.h"

#include <algorithm>
#include <numeric>

namespace sono {

namespace {

constexpr double prepared = 0.3; // of the progress

} // namespace

RefinedTrace::RefinedTrace(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                           const std::vector<TargetSurface>& targets, const Progress& progress)
  : rounds_(scene, lines, settings, targets, partOf(progress, 0.0, prepared))
  , targetDb_(settings.targetErrorDb)
{
  const bool doubles = targetDb_ > 0.0 && rounds_.mostPaths() >= 2 * firstPaths;
  const int first = doubles ? firstPaths : rounds_.mostPaths();
  mostPaths_ = first;
  while (doubles && mostPaths_ <= rounds_.mostPaths() / 2)
  {
    mostPaths_ *= 2;
    ++roundCount_;
  }
  paths_.assign(lines.size(), first);
  std::vector<int> all(lines.size());
  std::iota(all.begin(), all.end(), 0);
  rounds_.trace(all, paths_, mayDouble(), partOfRound(progress));
  errors_ = lineErrors(rounds_.cells(), paths_);
}

bool RefinedTrace::refine(const Progress& progress)
{
  const std::vector<int> lines =
    mayDouble() ? linesToDouble(errors_, paths_, mostPaths_, targetDb_) : std::vector<int>();
  if (lines.empty())
  {
    return false;
  }
  for (const int line : lines)
  {
    paths_[std::size_t(line)] *= 2;
  }
  round_ = std::min(round_ + 1, roundCount_ - 1);
  rounds_.trace(lines, paths_, mayDouble(), partOfRound(progress));
  errors_ = lineErrors(rounds_.cells(), paths_);
  return true;
}

/// Whether any line may get more.
bool RefinedTrace::mayDouble() const
{
  return std::any_of(paths_.begin(), paths_.end(), [&](int paths) { return paths < mostPaths_; });
}

/// Rounds that not all lines take part in may be more than those of the most paths; they share the last part.
Progress RefinedTrace::partOfRound(const Progress& progress) const
{
  const auto from = [&](int round) { return prepared + (1.0 - prepared) * round / roundCount_; };
  return partOf(progress, from(round_), from(round_ + 1));
}

TracedLines RefinedTrace::lines() const
{
  TracedLines now = rounds_.traced();
  now.paths = paths_;
  now.errorDb = errors_.rmsDb();
  return now;
}

TracedLines RefinedTrace::take()
{
  TracedLines last = rounds_.take();
  last.paths = paths_;
  last.errorDb = errors_.rmsDb();
  return last;
}

TracedLines trace(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                  const Progress& progress, const std::vector<TargetSurface>& targets)
{
  RefinedTrace refined(scene, lines, settings, targets, progress);
  while (refined.refine(progress))
  {
  }
  return refined.take();
}

} // namespace sono
