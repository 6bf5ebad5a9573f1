#include "SyntheticTorso.h"

#include "Core/ParallelFor.h"
#include "Folders.h"
#include "Scene/SceneFile.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace sono {

namespace {

const Vec3d extentMm(400.0, 400.0, 300.0);
const Vec3d middleMm(200.0, 200.0, 150.0);

/// An ellipsoid with half axes `radiusMm`; with an infinite one it is an elliptic cylinder.
struct Ball
{
  Vec3d centreMm;
  Vec3d radiusMm;
  int label;
};

constexpr double endless = 1e9;

/// Skin, fat, muscle, inside; lungs; liver; heart wall and blood; spine.
std::vector<Ball> trunk()
{
  const Vec3d lung(55.0, 75.0, 110.0);
  return {
    { middleMm, { 180.0, 120.0, endless }, 1 },
    { middleMm, { 178.0, 118.0, endless }, 2 },
    { middleMm, { 165.0, 105.0, endless }, 3 },
    { middleMm, { 148.0, 92.0, endless }, 4 },
    { { 125.0, 200.0, 190.0 }, lung, 5 },
    { { 275.0, 200.0, 190.0 }, lung, 6 },
    { { 140.0, 185.0, 60.0 }, { 80.0, 65.0, 50.0 }, 7 },
    { { 215.0, 170.0, 150.0 }, { 45.0, 40.0, 55.0 }, 8 },
    { { 215.0, 170.0, 150.0 }, { 34.0, 29.0, 44.0 }, 9 },
    { { 200.0, 275.0, 150.0 }, { 20.0, 18.0, endless }, 10 },
  };
}

/// Position n of a sequence that fills [0, 1)^3 evenly.
Vec3d evenly(int n)
{
  const Vec3d step(0.8191725134, 0.6710436067, 0.5497004779);
  return glm::fract(step * double(n + 1));
}

/// A curve as overlapping balls.
template<class Curve>
void addTube(std::vector<Ball>& balls, int label, double radiusMm, int steps, const Curve& curve)
{
  for (int s = 0; s <= steps; ++s)
  {
    balls.push_back({ curve(double(s) / steps), Vec3d(radiusMm), label });
  }
}

void addRib(std::vector<Ball>& balls, int label, int number)
{
  const double side = number % 2 == 0 ? 1.0 : -1.0;
  const double top = 285.0 - 22.0 * ((number / 2) % 12);
  addTube(balls, label, 5.5, 200, [=](double s) {
    const double angle = 1.5 - 2.9 * s;
    return middleMm + Vec3d(side * 157.0 * std::cos(angle), 99.0 * std::sin(angle), top - 150.0 - 35.0 * s);
  });
}

void addVessel(std::vector<Ball>& balls, int label, int number)
{
  const Vec3d from = middleMm + (evenly(3 * number) - 0.5) * Vec3d(200.0, 120.0, 260.0);
  const Vec3d to = middleMm + (evenly(3 * number + 1) - 0.5) * Vec3d(200.0, 120.0, 260.0);
  const Vec3d bend = 30.0 * (evenly(3 * number + 2) - 0.5);
  addTube(balls, label, 3.0 + 8.0 * evenly(number).x, 150,
          [=](double s) { return glm::mix(from, to, s) + bend * std::sin(3.0 * 3.14159265 * s); });
}

void addBlob(std::vector<Ball>& balls, int label, int number)
{
  const Vec3d centre = middleMm + (evenly(7 * number + 5) - 0.5) * Vec3d(220.0, 130.0, 260.0);
  balls.push_back({ centre, 8.0 + 22.0 * evenly(number + 11), label });
}

std::vector<Ball> torso(int labelCount)
{
  std::vector<Ball> balls = trunk();
  for (int label = 11; label <= labelCount; ++label)
  {
    const int number = (label - 11) / 3;
    switch (label % 3)
    {
      case 0:
        addRib(balls, label, number);
        break;
      case 1:
        addVessel(balls, label, number);
        break;
      default:
        addBlob(balls, label, number);
    }
  }
  return balls;
}

/// Paints the part of a ball that lies in slice k.
void paint(const Ball& ball, int k, LabelVolume& volume)
{
  const GridPlacement& grid = volume.placement;
  const Vec3d centre = ball.centreMm / grid.spacingMm - 0.5;
  const Vec3d radius = ball.radiusMm / grid.spacingMm;
  const double dz = (k - centre.z) / radius.z;
  const double z = 1.0 - dz * dz;
  if (z <= 0.0)
  {
    return;
  }
  const int lowY = std::max(0, int(std::ceil(centre.y - radius.y)));
  const int highY = std::min(grid.size.y - 1, int(std::floor(centre.y + radius.y)));
  for (int j = lowY; j <= highY; ++j)
  {
    const double dy = (j - centre.y) / radius.y;
    const double half = radius.x * std::sqrt(std::max(0.0, z - dy * dy));
    const int lowX = std::max(0, int(std::ceil(centre.x - half)));
    const int highX = std::min(grid.size.x - 1, int(std::floor(centre.x + half)));
    std::uint16_t* row = volume.voxels.data() + std::size_t(grid.size.x) * (j + std::size_t(grid.size.y) * k);
    std::fill(row + lowX, row + std::max(lowX, highX + 1), std::uint16_t(ball.label));
  }
}

} // namespace

LabelVolume makeSyntheticTorso(const Vec3i& size, int labelCount)
{
  LabelVolume volume;
  volume.placement.size = size;
  volume.placement.spacingMm = extentMm / Vec3d(size);
  volume.placement.originMm = volume.placement.spacingMm * 0.5;
  volume.voxels.assign(volume.placement.voxelCount(), 0);
  const std::vector<Ball> balls = torso(labelCount);
  parallelFor(size.z, {}, [&](int k) {
    for (const Ball& ball : balls)
    {
      paint(ball, k, volume);
    }
  });
  volume.collectLabels();
  return volume;
}

std::unique_ptr<Scene> makeTorsoScene(LabelVolume volume, const std::string& cacheFolder)
{
  const TissueTable table = TissueTable::read(dataFile("tissues.csv"));
  const auto& tissues = table.tissues();
  for (LabelInfo& label : volume.labels)
  {
    label.tissue = label.id == 0 ? "air" : tissues[std::size_t(label.id) % tissues.size()].name;
  }
  return cacheFolder.empty() ? std::make_unique<Scene>(std::move(volume), table, "air")
                             : makeCachedScene(std::move(volume), table, "air", cacheFolder);
}

VoxelBox torsoFanBox(const Scene& scene)
{
  const Vec3d spacing = scene.placement().spacingMm;
  const double depth = 160.0;
  const Vec3d apex = scene.localFromWorld({ 230.0, 82.0, 140.0 });
  const Vec3d low = apex - Vec3d(depth, depth * std::sqrt(0.5), depth);
  return { Vec3i(glm::floor(low / spacing)), Vec3i(glm::ceil((apex + depth) / spacing)) };
}

} // namespace sono
