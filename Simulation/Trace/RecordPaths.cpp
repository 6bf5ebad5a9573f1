#include "Trace/RecordPaths.h"

#include "Core/ParallelFor.h"
#include "Kernel/TracePath.h"
#include "Trace/TraceSetup.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sono {

namespace {

/// Keeps a path's corners, and the boundaries that echo.
class PathRecorder : public PathSink
{
public:
  PathRecorder(const TraceSetup& setup, int line, const TraceLine& seenFrom)
    : setup_(setup)
    , line_(seenFrom)
  {
    path_.line = line;
  }

  void segment(const PathSegment& s)
  {
    if (path_.pointMm.empty())
    {
      add(s.start, s.intensity);
    }
    if (s.length > 0.0f)
    {
      add(s.start + s.direction * s.length, s.intensity * std::exp(-s.decayPerMm * s.length));
    }
  }
  void meets(const PathState& path, const PathBoundary& boundary)
  {
    const Vec3f point = path.ray.position + path.ray.direction * boundary.surface.t;
    met_ = { setup_.worldFromRegion(point),
             setup_.toWorld * Vec3d(boundary.surface.normal),
             path.intensity,
             0.0f,
             boundary.cosine,
             glm::dot(point - line_.origin, line_.axis),
             path.length + boundary.surface.t - boundary.restart,
             path.collisions,
             boundary.before.medium,
             boundary.after.medium };
    path_.cutOff = path.collisions >= setup_.view.maxCollisions ? path.intensity : 0.0f;
  }
  void echo(const Vec3f&, float amplitude)
  {
    ++bounces_;
    met_.echo = amplitude;
    path_.hits.push_back(met_);
  }
  RecordedPath take() { return std::move(path_); }

private:
  void add(const Vec3f& point, float intensity)
  {
    path_.pointMm.push_back(setup_.worldFromRegion(point));
    path_.intensity.push_back(intensity);
    path_.bounce.push_back(bounces_);
  }

  const TraceSetup& setup_;
  TraceLine line_;
  RecordedPath path_;
  BoundaryHit met_{};
  int bounces_ = 0;
};

/// Of the `number`-th path of a line, of all its batches.
PathKey keyOf(const TraceSetup& setup, int line, int number)
{
  const int batches = std::min(batchCount, setup.paths);
  int batch = batches - 1;
  while (batchRange(setup.paths, batches, batch).first > number)
  {
    --batch;
  }
  const int within = number - batchRange(setup.paths, batches, batch).first;
  return { std::uint32_t(line), std::uint32_t(batch), std::uint32_t(within), setup.seed };
}

/// The `number`-th path of a line. Less than two corners where there is nothing to follow.
RecordedPath recordPath(const TraceSetup& setup, int line, int number)
{
  const auto space = setup.space();
  const TraceLine& axis = setup.lines[std::size_t(line)];
  const PathKey key = keyOf(setup, line, number);
  if (setup.view.startsApart)
  {
    const TraceLine own = pathLine(setup.view, axis, key);
    PathRecorder recorder(setup, line, own);
    tracePath(setup.view, space, own, key, recorder);
    return recorder.take();
  }
  PathRecorder recorder(setup, line, axis);
  const LineStart start = startLine(setup.view, space, axis, recorder);
  if (start.meets)
  {
    tracePath(setup.view, space, axis, start, key, recorder);
  }
  return recorder.take();
}

} // namespace

std::vector<RecordedPath> recordPaths(const Scene& scene, const std::vector<ScanLine>& lines,
                                      const TraceSettings& settings, int count,
                                      const std::vector<TargetSurface>& targets, const Progress& progress)
{
  if (count < 1 || count > 100000)
  {
    throw Error("the number of recorded paths is " + std::to_string(count) + ": it must be 1 to 100,000");
  }
  const TraceSetup setup(scene, lines, settings, targets, partOf(progress, 0.0, 0.3), Records::OnDemand);
  const std::int64_t all = std::int64_t(setup.lines.size()) * setup.paths;
  const std::int64_t wanted = std::min<std::int64_t>(count, all);
  std::vector<RecordedPath> recorded(static_cast<std::size_t>(wanted));
  parallelFor(int(wanted), partOf(progress, 0.3, 1.0), [&](int i) {
    const std::int64_t pick = (2 * std::int64_t(i) + 1) * all / (2 * wanted);
    recorded[std::size_t(i)] = recordPath(setup, int(pick / setup.paths), int(pick % setup.paths));
  });
  const auto empty = [](const RecordedPath& path) { return path.pointMm.size() < 2; };
  recorded.erase(std::remove_if(recorded.begin(), recorded.end(), empty), recorded.end());
  return recorded;
}

} // namespace sono
