#include "Probe/AcousticWindow.h"

#include "Core/ParallelFor.h"
#include "Core/Progress.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace sono {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int directionCount = 4000;
constexpr double behind = 0.5;               // sine of 30 degrees
constexpr double steepest = 0.7071067811865; // cosine of 45 degrees
constexpr int aroundCount = 8;
constexpr double ringTangents[] = { 0.2679491924311, 0.5773502691896 }; // of 15 and 30 degrees
constexpr double normalRadiusMm = 8.0;

/// The i-th of directions that spread evenly over the sphere (a Fibonacci lattice).
Vec3d direction(int i)
{
  const double z = 1.0 - (2.0 * i + 1.0) / directionCount;
  const double turn = i * pi * (3.0 - std::sqrt(5.0));
  const double r = std::sqrt(1.0 - z * z);
  return { r * std::cos(turn), r * std::sin(turn), z };
}

class WindowSearch
{
public:
  WindowSearch(const Scene& scene, const Vec3d& targetMm, double frequencyMHz)
    : scene_(scene)
    , target_(targetMm)
    , frequencyMHz_(frequencyMHz)
    , stepMm_(0.5 *
              std::min({ scene.placement().spacingMm.x, scene.placement().spacingMm.y, scene.placement().spacingMm.z }))
  {
  }

  /// Nothing where no probe can stand in this direction of the target.
  std::optional<Vec3d> skinPoint(const Vec3d& away) const
  {
    if (away.y > behind) // y points to the back
    {
      return std::nullopt;
    }
    double skinMm = -1.0;
    double r = 0.0;
    for (int tissue = tissueAt(target_); tissue != nowhere; r += stepMm_, tissue = tissueAt(target_ + r * away))
    {
      skinMm = tissue == scene_.outsideIndex() ? skinMm : r;
    }
    // The body goes on where the label map ends, so that no skin is there.
    if (skinMm < 0.0 || r - skinMm < 4.0 * stepMm_)
    {
      return std::nullopt;
    }
    const Vec3d point = target_ + skinMm * away;
    const Vec3d normal = outwardNormal(point);
    return glm::dot(normal, away) < steepest ? std::nullopt : std::optional<Vec3d>(point);
  }

  /// Sum of the amplitudes that arrive at the target and around it.
  double visibility(const Vec3d& skin) const
  {
    const Vec3d way = target_ - skin;
    const double distance = glm::length(way);
    const Vec3d helper = std::abs(way.x) < 0.9 * distance ? Vec3d(1.0, 0.0, 0.0) : Vec3d(0.0, 1.0, 0.0);
    const Vec3d across = glm::normalize(glm::cross(way, helper));
    const Vec3d up = glm::normalize(glm::cross(across, way));
    double sum = amplitude(skin, target_);
    for (const double tangent : ringTangents)
    {
      for (int i = 0; i < aroundCount; ++i)
      {
        const double turn = 2.0 * pi * i / aroundCount;
        sum += amplitude(skin, target_ + distance * tangent * (std::cos(turn) * across + std::sin(turn) * up));
      }
    }
    return sum;
  }

private:
  static constexpr int nowhere = -2; // outside the label map

  int tissueAt(const Vec3d& world) const
  {
    const Vec3d index = scene_.placement().indexFromWorld(world);
    const Vec3i size = scene_.placement().size;
    const Vec3i voxel(std::lround(index.x), std::lround(index.y), std::lround(index.z));
    if (glm::any(glm::lessThan(voxel, Vec3i(0))) || glm::any(glm::greaterThanEqual(voxel, size)))
    {
      return nowhere;
    }
    return scene_.tissueVoxels()[(std::size_t(voxel.z) * size.y + voxel.y) * size.x + voxel.x];
  }

  /// Away from where the body is, within a ball; zero where it is all around.
  Vec3d outwardNormal(const Vec3d& point) const
  {
    Vec3d sum(0.0);
    for (int i = 0; i < 400; ++i)
    {
      const Vec3d offset = direction(i * (directionCount / 400)) * normalRadiusMm;
      const int tissue = tissueAt(point + offset);
      sum += tissue == nowhere || tissue == scene_.outsideIndex() ? offset : -offset;
    }
    const double length = glm::length(sum);
    return length > 0.0 ? sum / length : sum;
  }

  /// What is left of 1 on the straight way.
  double amplitude(const Vec3d& from, const Vec3d& to) const
  {
    const double distance = glm::distance(from, to);
    const Vec3d step = (to - from) * (stepMm_ / distance);
    double lossDb = 0.0;
    int last = nowhere;
    Vec3d at = from;
    for (double r = 0.0; r < distance; r += stepMm_, at += step)
    {
      const int tissue = tissueAt(at);
      if (tissue < 0)
      {
        continue;
      }
      const Tissue& here = scene_.tissues()[std::size_t(tissue)];
      lossDb += here.attenuationDbPerCmMHz * frequencyMHz_ * stepMm_ / 10.0;
      if (last >= 0 && tissue != last)
      {
        const double z1 = scene_.tissues()[std::size_t(last)].impedanceMRayl;
        const double z2 = here.impedanceMRayl;
        lossDb -= 10.0 * std::log10(4.0 * z1 * z2 / ((z1 + z2) * (z1 + z2)));
      }
      last = tissue;
    }
    return std::pow(10.0, -lossDb / 20.0);
  }

  const Scene& scene_;
  Vec3d target_;
  double frequencyMHz_;
  double stepMm_;
};

/// The middle of the voxels that are asked for; nothing where there are none.
template<class Wanted>
std::optional<Vec3d> middleOf(const Scene& scene, const Wanted& wanted)
{
  const Vec3i size = scene.placement().size;
  Vec3d sum(0.0);
  std::size_t count = 0;
  std::size_t at = 0;
  for (int k = 0; k < size.z; ++k)
  {
    for (int j = 0; j < size.y; ++j)
    {
      for (int i = 0; i < size.x; ++i, ++at)
      {
        if (wanted(scene.tissueVoxels()[at]))
        {
          sum += Vec3d(i, j, k);
          ++count;
        }
      }
    }
  }
  return count == 0 ? std::nullopt : std::optional<Vec3d>(scene.placement().worldFromIndex(sum / double(count)));
}

} // namespace

Vec3d defaultTarget(const Scene& scene)
{
  for (const char* name : { "myocardium", "liver" })
  {
    const auto middle = middleOf(scene, [&](int tissue) { return scene.tissues()[std::size_t(tissue)].name == name; });
    if (middle)
    {
      return *middle;
    }
  }
  const auto middle = middleOf(scene, [&](int tissue) { return tissue != scene.outsideIndex(); });
  if (!middle)
  {
    throw Error("The label map holds nothing but what is outside the body; choose one with labelled anatomy.");
  }
  return *middle;
}

ProbePose findAcousticWindow(const Scene& scene, const Vec3d& targetMm, double frequencyMHz)
{
  const WindowSearch search(scene, targetMm, frequencyMHz);
  std::vector<double> visibility(directionCount, -1.0);
  parallelFor(directionCount, {}, [&](int i) {
    if (const auto skin = search.skinPoint(direction(i)))
    {
      visibility[std::size_t(i)] = search.visibility(*skin);
    }
  });
  const auto best = std::max_element(visibility.begin(), visibility.end());
  if (*best < 0.0)
  {
    throw Error("No place on the skin was found from which (" + std::to_string(targetMm.x) + ", " +
                std::to_string(targetMm.y) + ", " + std::to_string(targetMm.z) +
                ") mm can be seen; place the probe by hand.");
  }
  const Vec3d away = direction(static_cast<int>(best - visibility.begin()));
  const bool fromTheSide = std::abs(away.x) > 0.8;
  const Vec3d lateral = fromTheSide ? Vec3d(0.0, 0.0, -1.0) : Vec3d(1.0, 0.0, 0.0);
  return ProbePose{ *search.skinPoint(away), -away, lateral }.orthonormalized();
}

} // namespace sono
