#include "Echo/MovingScatterers.h"

#include "Core/ParallelFor.h"
#include "Core/Policy.h"
#include "Core/SoundSpeed.h"
#include "Echo/BeamModel.h"
#include "Echo/BrickWalk.h"
#include "Echo/EchoSetup.h"
#include "Echo/FieldSight.h"
#include "Echo/NestedScatterers.h"
#include "Echo/Pulse.h"
#include "Echo/TissueScatterers.h"
#include "Kernel/DetailCode.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double closeMm = 1e-5; // to where a scatterer belongs
constexpr double mostSortingBricks = 5e8;
constexpr float strongestSigmas = 6.5f; // no deviate is larger
constexpr double leastVolume = 0.1;     // of what stood there before, over that of a voxel: below it, the field folds

/// Of the power along fibres that echo exp(-2 (scale cos)^2) of it: its mean over all directions.
double meanOverDirections(double scale)
{
  const double s = std::sqrt(2.0) * scale;
  return s > 1e-3 ? std::sqrt(pi) * std::erf(s) / (2.0 * s) : 1.0;
}

/// Finds the scatterers that lie in a voxel.
class InVoxel
{
public:
  InVoxel(const Scene& scene, const MovingStatistics& statistics)
    : scene_(scene)
    , motion_(*scene.motion())
    , statistics_(statistics)
  {
  }

  void add(const Vec3i& voxel, int tissue, float factor, std::vector<PointScatterer>& points) const
  {
    // Before, at the voxel's centre, corners and the middles between: there the trilinear field's pieces end, and each
    // stays between its corners.
    const GridPlacement& grid = scene_.placement();
    Vec3d before[3][3][3];
    Vec3d low(1e300);
    Vec3d high(-1e300);
    for (int c = 0; c < 27; ++c)
    {
      const Vec3i at(c % 3, (c / 3) % 3, c / 9);
      const Vec3d x = grid.worldFromIndex(Vec3d(voxel) + 0.5 * Vec3d(at - 1));
      const Vec3d stood = x - motion_.displacementMm(x);
      before[at.x][at.y][at.z] = stood;
      low = glm::min(low, stood);
      high = glm::max(high, stood);
    }
    // By index along the grid's axes.
    const Mat3d slope(before[2][1][1] - before[0][1][1], before[1][2][1] - before[1][0][1],
                      before[1][1][2] - before[1][1][0]);
    const double volume = std::abs(grid.spacingMm.x * grid.spacingMm.y * grid.spacingMm.z);
    if (std::abs(glm::determinant(slope)) < leastVolume * volume)
    {
      return;
    }
    const Mat3d back = glm::inverse(slope);
    // A field on another grid has its pieces end elsewhere, too.
    const double marginMm = 0.1 * std::max({ grid.spacingMm.x, grid.spacingMm.y, grid.spacingMm.z });
    const Vec3i first(glm::floor((low - marginMm) / statistics_.cellMm));
    const Vec3i last(glm::floor((high + marginMm) / statistics_.cellMm));
    for (int k = first.z; k <= last.z; ++k)
    {
      for (int j = first.y; j <= last.y; ++j)
      {
        for (int i = first.x; i <= last.x; ++i)
        {
          const ScattererSeed seed = scattererSeed(statistics_.seed, { i, j, k });
          if (seed.presence >= statistics_.probability[std::size_t(tissue)])
          {
            continue;
          }
          const Vec3d stood = (Vec3d(i, j, k) + Vec3d(seed.fraction)) * statistics_.cellMm;
          Vec3d offset = back * (stood - before[1][1][1]);
          if (glm::any(glm::greaterThan(glm::abs(offset), Vec3d(1.0))) || !solve(voxel, stood, back, offset))
          {
            continue;
          }
          const auto isHere = [](double o) { return o >= -0.5 && o < 0.5; };
          if (isHere(offset.x) && isHere(offset.y) && isHere(offset.z))
          {
            points.push_back({ grid.worldFromIndex(Vec3d(voxel) + offset), factor * amplitude(seed, tissue) });
          }
        }
      }
    }
  }

private:
  /// x = X + u(x) by Newton steps with the voxel's own slope, from a first guess.
  bool solve(const Vec3i& voxel, const Vec3d& stood, const Mat3d& back, Vec3d& offset) const
  {
    for (int step = 0; step < 25; ++step)
    {
      const Vec3d x = scene_.placement().worldFromIndex(Vec3d(voxel) + offset);
      const Vec3d missing = stood - (x - motion_.displacementMm(x));
      offset += back * missing;
      if (glm::length(missing) < closeMm)
      {
        return true;
      }
      if (glm::any(glm::greaterThan(glm::abs(offset), Vec3d(2.0))))
      {
        return false;
      }
    }
    return false;
  }

  float amplitude(const ScattererSeed& seed, int tissue) const
  {
    const std::size_t t = std::size_t(tissue);
    if (statistics_.signs)
    {
      return seed.deviate < 0.5f ? -statistics_.mean[t] : statistics_.mean[t];
    }
    return statistics_.mean[t] + statistics_.sigma[t] * normalDeviate(seed.deviate);
  }

  const Scene& scene_;
  const TissueMotion& motion_;
  const MovingStatistics& statistics_;
};

/// Whether a voxel's centre lies in a cube of a part.
class CubesWanted
{
public:
  CubesWanted(const Scene& scene, const MovingPart& part)
    : isAll_(part.isAll)
  {
    const GridPlacement& grid = scene.placement();
    perVoxel_ = grid.spacingMm / movingCubeMm;
    count_ = Vec3i(Vec3d(grid.size) * perVoxel_) + 1;
    wanted_.assign(std::size_t(count_.x) * std::size_t(count_.y) * std::size_t(count_.z), 0);
    for (const Vec3i& cube : part.cubes)
    {
      if (glm::all(glm::lessThan(cube, count_)))
      {
        wanted_[indexOf(cube)] = 1;
      }
    }
  }
  bool hold(const Vec3i& voxel) const
  {
    return isAll_ || wanted_[indexOf(Vec3i((Vec3d(voxel) + 0.5) * perVoxel_))] != 0;
  }

private:
  std::size_t indexOf(const Vec3i& cube) const
  {
    return std::size_t(cube.x) +
           std::size_t(count_.x) * (std::size_t(cube.y) + std::size_t(count_.y) * std::size_t(cube.z));
  }

  bool isAll_;
  Vec3i count_{ 0 };
  Vec3d perVoxel_{ 0.0 };
  std::vector<std::uint8_t> wanted_;
};

Vec3d middleOf(const Scene& scene)
{
  return 0.5 * Vec3d(scene.placement().size) * scene.placement().spacingMm;
}

/// Of the bricks into which a part's scatterers are sorted: some hundred in one.
double sortingEdgeMm(const MovingStatistics& statistics)
{
  return std::max(1.0, 4.0 * statistics.cellMm);
}

} // namespace

MovingPart movingPart(const Scene& scene, const MovingStatistics& statistics, const std::vector<ScanLine>& lines,
                      const EchoSettings& settings, InterfaceModel model)
{
  MovingPart part;
  part.isAll = statistics.cellMm >= smallMovingCellMm;
  if (part.isAll)
  {
    return part;
  }
  const BeamModel beams(settings, model);
  const BrickGrid grid{ float(movingCubeMm), Vec3f(0.0f),
                        Vec3f(Vec3d(scene.placement().size) * scene.placement().spacingMm) };
  // Half a voxel beyond the cube lie its scatterers, and so far reaches a brick in which they are sorted.
  const double marginMm = 0.5 * glm::length(scene.placement().spacingMm) + std::sqrt(3.0) * sortingEdgeMm(statistics);
  std::optional<FieldSight> sight;
  if (settings.field)
  {
    sight.emplace(*settings.field, float(movingCubeMm + 2.0 * marginMm));
  }
  const double depthMm =
    (settings.sampleCount() + PulseKernel(settings).half()) * settings.sampleMm() * deepestPerRange;
  std::vector<BeamReach> reaches;
  for (const ScanLine& line : lines)
  {
    BeamReach reach = beams.reachOf(beams.beamOf(line, scene.localFromWorld(line.originMm), scene.rotationToLocal()),
                                    float(depthMm), sight ? &*sight : nullptr);
    reach.marginMm = float(marginMm);
    reaches.push_back(reach);
  }
  forBrickRows(grid, reaches, [&](const BrickRow& row) {
    for (int n = 0; n < row.count(); ++n)
    {
      bool isSeen = false;
      for (std::size_t line = 0; line < reaches.size() && !isSeen; ++line)
      {
        isSeen = row.sees(line, n);
      }
      if (isSeen)
      {
        part.cubes.push_back(row.brick(n));
      }
    }
  });
  std::sort(part.cubes.begin(), part.cubes.end(), MovingPart::isBefore); // the walk's order depends on the lines
  return part;
}

MovingStatistics movingStatistics(const Scene& scene, const EchoSettings& settings, InterfaceModel model)
{
  settings.validate();
  const BeamModel beams(settings, model);
  MovingStatistics statistics;
  statistics.seed = settings.seed;
  if (model != InterfaceModel::Acoustic)
  {
    const TissueScatterers still(scene, settings.scattererCellMm,
                                 tissueScattererScale(settings, beams.focusPowerAreaMm2()), settings.seed);
    statistics.cellMm = settings.scattererCellMm;
    for (std::size_t t = 0; t < still.media().size(); ++t)
    {
      statistics.mean[t] = still.media()[t].mean;
      statistics.sigma[t] = still.media()[t].sigma;
      statistics.probability[t] = still.media()[t].probability;
    }
    return statistics;
  }
  const double wavelengthMm = assumedSoundSpeedMmPerUs / settings.centreFrequencyMHz;
  const NestedScatterers still(scene, settings.centreFrequencyMHz, wavelengthMm / beams.focusAreaMm2(), settings.seed);
  statistics.cellMm = std::clamp(0.72 * wavelengthMm, 0.15, 0.5);
  if (settings.interactive) // fewer, each of which is stronger
  {
    statistics.cellMm *= std::cbrt(1.0 / interactiveMovingShare);
  }
  statistics.signs = true;
  const double perCell = std::sqrt(statistics.cellMm * statistics.cellMm * statistics.cellMm);
  for (std::size_t t = 0; t < still.media().size(); ++t)
  {
    const double power = meanOverDirections(double(still.fibreScale()[t]));
    statistics.mean[t] = float(double(still.media()[t].amplitude) * perCell * std::sqrt(power));
    statistics.probability[t] = still.media()[t].probability;
  }
  return statistics;
}

std::vector<PointScatterer> movingScatterers(const Scene& scene, const MovingStatistics& statistics,
                                             const MovingPart& part, const Progress& progress)
{
  const InVoxel inVoxel(scene, statistics);
  const TissueMotion& motion = *scene.motion();
  const Vec3i size = scene.placement().size;
  const CubesWanted wanted(scene, part);
  std::vector<std::vector<PointScatterer>> ofSlices(std::size_t(size.z));
  parallelFor(size.z, partOf(progress, 0.0, 0.9), [&](int k) {
    std::size_t at = std::size_t(k) * std::size_t(size.x) * std::size_t(size.y);
    for (int j = 0; j < size.y; ++j)
    {
      for (int i = 0; i < size.x; ++i, ++at)
      {
        const int tissue = scene.tissueVoxels()[at];
        if (statistics.probability[std::size_t(tissue)] > 0.0f && motion.moves(scene.volume().voxels[at]) &&
            wanted.hold({ i, j, k }))
        {
          const float factor = scene.detail().empty() ? 1.0f : detailFactor(scene.detail()[at]);
          inVoxel.add({ i, j, k }, tissue, factor, ofSlices[std::size_t(k)]);
        }
      }
    }
  });
  std::vector<PointScatterer> points;
  std::size_t count = 0;
  for (const auto& slice : ofSlices)
  {
    count += slice.size();
  }
  points.reserve(count);
  for (auto& slice : ofSlices)
  {
    points.insert(points.end(), slice.begin(), slice.end());
    slice = {};
    report(progress, 0.9 + 0.1 * double(points.size()) / double(std::max<std::size_t>(count, 1)));
  }
  return points;
}

PointScatterers sortedMoving(const Scene& scene, const MovingStatistics& statistics, const MovingPart& part,
                             const std::vector<PointScatterer>& points, const Progress& progress)
{
  if (part.isAll)
  {
    return PointScatterers(points, progress);
  }
  const Vec3d middle = scene.worldFromLocal(middleOf(scene));
  const double edgeMm = sortingEdgeMm(statistics);
  // As far and as strong as the user's, and any of the scene's may be.
  double farthestMm = 0.0;
  float loudest = 0.0f;
  for (const PointScatterer& point : points)
  {
    farthestMm = std::max(farthestMm, glm::length(point.positionMm - middle));
    loudest = std::max(loudest, std::fabs(point.amplitude));
  }
  const float detail = scene.detail().empty() ? 1.0f : largestDetailFactor;
  for (std::size_t t = 0; t < statistics.mean.size(); ++t)
  {
    loudest = std::max(loudest, detail * (std::fabs(statistics.mean[t]) + strongestSigmas * statistics.sigma[t]));
  }
  const bool fit = std::pow(2.0 * farthestMm / edgeMm + 1.0, 3.0) < mostSortingBricks;
  return fit ? PointScatterers(points, middle, edgeMm, loudest, progress) : PointScatterers(points, progress);
}

} // namespace sono
