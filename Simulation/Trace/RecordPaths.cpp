#include "Trace/RecordPaths.h"

#include "Kernel/TracePath.h"
#include "Trace/TraceSetup.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

/// A sink that keeps a path's corners, and the boundaries that it is told of.
class PathRecorder
{
public:
  PathRecorder(const TraceSetup& setup, int line)
    : setup_(setup)
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
  void echo(const Vec3f&, float amplitude)
  {
    ++bounces_;
    echo_ = amplitude;
  }
  /// After its echo.
  void hit(const PathState& path, const PathBoundary& boundary)
  {
    const Vec3f point = path.ray.position + path.ray.direction * boundary.surface.t;
    const TraceLine& line = setup_.lines[std::size_t(path_.line)];
    path_.hits.push_back({ setup_.worldFromRegion(point), setup_.toWorld * Vec3d(boundary.surface.normal),
                           path.intensity, echo_, boundary.cosine, glm::dot(point - line.origin, line.axis),
                           path.length + boundary.surface.t - boundary.restart, path.collisions, boundary.before.medium,
                           boundary.after.medium });
  }
  const RecordedPath& path() const { return path_; }

private:
  void add(const Vec3f& point, float intensity)
  {
    path_.pointMm.push_back(setup_.worldFromRegion(point));
    path_.intensity.push_back(intensity);
    path_.bounce.push_back(bounces_);
  }

  const TraceSetup& setup_;
  RecordedPath path_;
  int bounces_ = 0;
  float echo_ = 0.0f;
};

/// What tracePath does, with a word to the recorder at each boundary.
template<class Space>
void followPath(const TraceSetup& setup, const Space& space, const LineStart& start, const PathKey& key,
                PathRecorder& recorder)
{
  const TraceView& view = setup.view;
  PathState path = start.path;
  PathBoundary boundary = start.boundary;
  for (;;)
  {
    recorder.hit(path, boundary);
    leaveBoundary(view, space, boundary, drawBounce(view, key, std::uint32_t(path.collisions)), path);
    if (!(path.intensity > 0.0f) || !survivesRoulette(view, key, path) ||
        !advanceToBoundary(view, space, setup.lines[key.line], path, boundary, recorder) ||
        path.collisions >= view.maxCollisions)
    {
      return;
    }
    depositBoundary(view, path, boundary, recorder);
  }
}

} // namespace

std::vector<RecordedPath> recordPaths(const Scene& scene, const std::vector<ScanLine>& lines,
                                      const TraceSettings& settings, int count,
                                      const std::vector<TargetSurface>& targets)
{
  if (count < 1 || count > 100000)
  {
    throw Error("the number of recorded paths is " + std::to_string(count) + ": it must be 1 to 100,000");
  }
  const TraceSetup setup(scene, lines, settings, targets, {}, Records::OnDemand);
  const auto space = setup.space();
  const int batches = std::min(batchCount, setup.paths);
  const std::int64_t all = std::int64_t(setup.lines.size()) * setup.paths;
  std::vector<RecordedPath> recorded;
  for (std::int64_t i = 0; i < std::min<std::int64_t>(count, all); ++i)
  {
    const std::int64_t pick = (2 * i + 1) * all / (2 * std::min<std::int64_t>(count, all));
    const int line = int(pick / setup.paths);
    const int path = int(pick % setup.paths);
    int batch = batches - 1;
    while (batchRange(setup.paths, batches, batch).first > path)
    {
      --batch;
    }
    PathRecorder recorder(setup, line);
    const LineStart start = startLine(setup.view, space, setup.lines[std::size_t(line)], recorder);
    if (start.meets)
    {
      const int within = path - batchRange(setup.paths, batches, batch).first;
      followPath(setup, space, start, PathKey{ std::uint32_t(line), std::uint32_t(batch), std::uint32_t(within) },
                 recorder);
    }
    if (recorder.path().pointMm.size() > 1)
    {
      recorded.push_back(recorder.path());
    }
  }
  return recorded;
}

} // namespace sono
