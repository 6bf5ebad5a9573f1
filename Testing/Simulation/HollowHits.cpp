#include "HollowHits.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace sono::test {

/// Hears everything: paths end where they leave the volume.
struct EveryBeam
{
};
inline float remainingLength(const TraceView&, const EveryBeam&, const PathState&)
{
  return 1e4f;
}

namespace {

constexpr double rounding = 1e-3; // voxels: a hit may be moved by one voxel, in single precision

std::vector<TraceMedium> media(const Turning& turning)
{
  std::vector<TraceMedium> all = { makeMedium(1.5f, 1500.0f), makeMedium(4.5f, 1700.0f), makeMedium(2.5f, 1600.0f) };
  for (TraceMedium& m : all)
  {
    m.roughnessMm = float(turning.roughness); // of a correlation length of 1 mm
  }
  return all;
}

Vec3d randomUnit(std::mt19937& random)
{
  std::normal_distribution<double> gauss;
  return glm::normalize(Vec3d(gauss(random), gauss(random), gauss(random)));
}

class RoundScene
{
public:
  RoundScene(const RoundBody& body, const Turning& turning)
    : body_(body)
    , voxel_(std::cbrt(body.spacing.x * body.spacing.y * body.spacing.z))
    , radius_(body.radius * voxel_)
    , inner_(body.inner * voxel_)
    , size_(glm::ceil(Vec3d(2.0 * (radius_ + 8.0 * voxel_)) / body.spacing))
    , centre_(Vec3d(size_) * body.spacing * 0.5 + Vec3d(0.13, -0.21, 0.34) * body.spacing)
    , scene_(size_, body.spacing, media(turning), [this](const Vec3d& p) { return labelOf(p); })
  {
    scene_.view.model = turning.model;
    scene_.view.waveNumberAtOne = float(2000.0 * M_PI * 2.5);
    scene_.view.lobe = makeLobe(0.0, turning.lobeDegrees * M_PI / 180.0, 0.0, 0.5 * M_PI);
  }

  RoundHits meet(int hits) const
  {
    RoundHits found;
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform;
    NullSink sink;
    const auto space = scene_.space();
    while (found.hits < hits)
    {
      PathState path = start(random);
      PathBoundary boundary;
      bool away = false;
      for (int i = 0; i < 8 && advanceToBoundary(scene_.view, space, EveryBeam(), path, boundary, sink); ++i)
      {
        ++found.hits;
        const double off = distance(pointOf(path, boundary), boundary.before.medium, boundary.after.medium);
        found.worst = std::max(found.worst, off);
        found.off += off > 1.0 + rounding ? 1 : 0;
        found.through += leadsThroughAnother(path, boundary.surface.t) ? 1 : 0;
        found.again += away ? 1 : 0;
        const Vec3d point = pointOf(path, boundary);
        leaveBoundary(scene_.view, boundary, { uniform(random), uniform(random), uniform(random) }, path);
        away = goesAway(point, path);
        found.away += away ? 1 : 0;
      }
    }
    return found;
  }

private:
  bool isOneVoxelWall() const { return body_.inner < 0.0; }
  double level(const Vec3d& p) const { return glm::length(p - centre_); }
  /// Length of a voxel's edge along the radius.
  double edge(const Vec3d& p) const
  {
    const Vec3d n = (p - centre_) / level(p);
    return glm::length(n * body_.spacing);
  }
  int labelOf(const Vec3d& p) const
  {
    if (level(p) >= radius_)
    {
      return 0;
    }
    if (!isOneVoxelWall())
    {
      return level(p) < inner_ ? body_.core : 1;
    }
    for (int a = 0; a < 3; ++a)
    {
      Vec3d step(0.0);
      step[a] = body_.spacing[a];
      if (level(p + step) >= radius_ || level(p - step) >= radius_)
      {
        return 1;
      }
    }
    return body_.core;
  }
  int labelAt(const Vec3i& c) const
  {
    const auto space = scene_.space();
    return space.contains(c) ? int(scene_.voxels[(std::size_t(c.z) * size_.y + c.y) * size_.x + c.x]) : 0;
  }
  /// Onto the disc of the ball.
  PathState start(std::mt19937& random) const
  {
    std::uniform_real_distribution<double> uniform;
    const Vec3d d = randomUnit(random);
    const Vec3d s = glm::normalize(glm::cross(d, randomUnit(random)));
    const double aside = 0.98 * radius_ * std::sqrt(uniform(random));
    const double back = std::sqrt(std::pow(radius_ + 4.0 * voxel_, 2) - aside * aside);
    PathState path;
    path.ray.position = Vec3f(centre_ + s * aside - d * back);
    path.ray.direction = Vec3f(d);
    path.ray.cell = scene_.space().cellAt(path.ray.position);
    return path;
  }
  static Vec3d pointOf(const PathState& path, const PathBoundary& boundary)
  {
    return Vec3d(path.ray.position) + Vec3d(path.ray.direction) * double(boundary.surface.t);
  }
  /// Voxels from the nearest face between voxels of two labels.
  double fromFaces(const Vec3d& p, int a, int b) const
  {
    const Vec3d at = p / body_.spacing;
    double best = 1e9;
    const Vec3i low = Vec3i(glm::floor(at)) - 3;
    for (int n = 0; n < 7 * 7 * 7; ++n)
    {
      const Vec3i cell = low + Vec3i(n % 7, n / 7 % 7, n / 49);
      const int mine = labelAt(cell);
      for (int axis = 0; axis < 3; ++axis)
      {
        Vec3i next = cell;
        ++next[axis];
        const int other = labelAt(next);
        if (std::minmax(mine, other) == std::minmax(a, b))
        {
          Vec3d corner(cell);
          const Vec3d end = corner + 1.0;
          corner[axis] = end[axis];
          best = std::min(best, glm::length(at - glm::clamp(at, corner, end)));
        }
      }
    }
    return best;
  }
  /// Voxels from the surface between two labels.
  double distance(const Vec3d& p, int from, int to) const
  {
    if (isOneVoxelWall())
    {
      return fromFaces(p, from, to);
    }
    const double outer = std::abs(level(p) - radius_) / edge(p);
    const double inner = inner_ > 0.0 ? std::abs(level(p) - inner_) / edge(p) : 1e9;
    if (std::max(from, to) == 2)
    {
      return inner;
    }
    return body_.core == 0 ? std::min(outer, inner) : outer;
  }
  /// How deep a point lies in other tissues than the one, voxels.
  double depthInOthers(const Vec3d& p, int medium) const
  {
    const double r = level(p);
    const double inner = isOneVoxelWall() ? radius_ - voxel_ : inner_;
    if (medium == 1)
    {
      return std::max(r - radius_, inner - r) / edge(p);
    }
    if (medium == 2)
    {
      return (r - inner) / edge(p);
    }
    return (body_.core == 0 && inner > 0.0 ? std::min(radius_ - r, r - inner) : radius_ - r) / edge(p);
  }
  bool leadsThroughAnother(const PathState& path, float length) const
  {
    const Vec3d h = body_.spacing;
    const double stairs = 1.5 * std::max({ h.x, h.y, h.z }); // of a wall of one voxel, whose inside has no formula
    int side = 0;
    for (double t = 0.0; t < double(length); t += 0.2 * voxel_)
    {
      const Vec3d p = Vec3d(path.ray.position) + Vec3d(path.ray.direction) * t;
      if (depthInOthers(p, path.tissue) > (isOneVoxelWall() ? stairs / voxel_ : 1.0 + rounding))
      {
        return true;
      }
      if (isOneVoxelWall() && path.tissue == 0)
      {
        const double fromWall = level(p) - (radius_ - 0.5 * voxel_);
        const int now = std::abs(fromWall) < stairs ? 0 : (fromWall < 0.0 ? -1 : 1);
        if (now * side < 0)
        {
          return true;
        }
        side = now != 0 ? now : side;
      }
    }
    return false;
  }
  bool goesAway(const Vec3d& point, const PathState& path) const
  {
    const Vec3d out = (point - centre_) / level(point);
    const bool isOutside = path.tissue == 0 && level(point) > radius_ - 1.5 * voxel_;
    return isOutside && !(isOneVoxelWall() && body_.core == 0) && glm::dot(out, Vec3d(path.ray.direction)) > 0.05;
  }

  RoundBody body_;
  double voxel_; ///< mm, the cube root of its volume
  double radius_;
  double inner_;
  Vec3i size_;
  Vec3d centre_;
  KernelScene scene_;
};

} // namespace

std::vector<RoundBody> roundBodies()
{
  std::vector<RoundBody> all;
  for (const Vec3d& spacing : { Vec3d(1.0), Vec3d(0.7, 0.7, 2.1) })
  {
    const std::string voxels = spacing.x == spacing.z ? "" : " 3:1";
    all.push_back({ "solid" + voxels, 15.0, 0.0, 0, spacing });
    all.push_back({ "hollow" + voxels, 18.0, 13.0, 0, spacing });
    all.push_back({ "walled" + voxels, 18.0, 14.0, 2, spacing });
    all.push_back({ "shell" + voxels, 16.0, -1.0, 0, spacing });
    all.push_back({ "skin" + voxels, 16.0, -1.0, 2, spacing });
  }
  return all;
}

std::vector<Turning> allTurnings()
{
  std::vector<Turning> all;
  for (const double degrees : { 0.0, 10.0, 45.0 })
  {
    all.push_back({ InterfaceModel::Amadou2024, degrees, 0.0 });
  }
  for (const double roughness : { 0.02, 0.3, 1.0 })
  {
    all.push_back({ InterfaceModel::Acoustic, 0.0, roughness });
  }
  return all;
}

RoundHits meetRoundBody(const RoundBody& body, const Turning& turning, int hits)
{
  return RoundScene(body, turning).meet(hits);
}

} // namespace sono::test
