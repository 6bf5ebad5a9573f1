#include "KernelScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace sono;
using namespace sono::test;

/// How a path ended, from its last piece.
struct LastPiece : PathSink
{
  Vec3f end{ 0.0f };
  float intensity = 0.0f;
  double length = 0.0;
  int boundaries = 0;

  void segment(const PathSegment& s)
  {
    end = s.start + s.direction * s.length;
    intensity = s.intensity * std::exp(-s.decayPerMm * s.length);
    length += s.length;
  }
  void echo(const Vec3f&, float) { ++boundaries; }
};

/// What left the scene, and by which way, as shares of the paths.
struct Balance
{
  double total = 0.0;
  double error = 0.0;   ///< of the total: paths stand for more or less than one
  double back = 0.0;    ///< through the plane of the transducer
  double border = 0.0;  ///< through the rest of the border
  double late = 0.0;    ///< still on the way when the recording ends
  double limit = 0.0;   ///< stopped by the number of collisions
  double nowhere = 0.0; ///< none of these: lost
};

Balance run(const KernelScene& scene, const TraceLine& line, int paths)
{
  Balance balance;
  LastPiece shared;
  const LineStart start = startLine(scene.view, scene.space(), line, shared);
  EXPECT_TRUE(start.meets);
  const Vec3f extent(scene.extent());
  for (int p = 0; p < paths; ++p)
  {
    LastPiece piece;
    piece.length = start.path.length;
    piece.boundaries = 1;
    tracePath(scene.view, scene.space(), line, start, PathKey{ 0, 0, std::uint32_t(p) }, piece);
    const double share = double(piece.intensity) / paths;
    balance.total += share;
    balance.error += share * share;
    const Vec3f q = piece.end - line.origin;
    const float r = glm::dot(q, line.axis);
    const Vec3f toBorder = glm::min(piece.end, extent - piece.end);
    const double wayBack = glm::length(q);
    if (std::min(toBorder.x, std::min(toBorder.y, toBorder.z)) < 2e-3f)
    {
      (r < 2e-3f ? balance.back : balance.border) += share;
    }
    else if (std::abs(r) < 2e-3f)
    {
      balance.back += share;
    }
    else if (piece.length + wayBack > 2.0 * scene.view.depthMm - 2e-2)
    {
      balance.late += share;
    }
    else
    {
      (piece.boundaries >= scene.view.maxCollisions ? balance.limit : balance.nowhere) += share;
    }
  }
  balance.error = std::sqrt(std::max(0.0, balance.error - balance.total * balance.total / paths));
  return balance;
}

/// Bone-like and gas-like bodies in soft tissue, without attenuation.
KernelScene makeLosslessScene()
{
  return KernelScene(Vec3i(48), Vec3d(1.0, 1.0, 1.5),
                     { makeMedium(1.5f, 1500.0f), makeMedium(1.7f, 1600.0f), makeMedium(7.8f, 4080.0f),
                       makeMedium(0.0004f, 330.0f), makeMedium(1.38f, 1450.0f) },
                     [](const Vec3d& p) {
                       if (glm::length(p - Vec3d(20.0, 26.0, 30.0)) < 8.0)
                       {
                         return 2;
                       }
                       if (glm::length(p - Vec3d(33.0, 20.0, 45.0)) < 9.0)
                       {
                         return 3;
                       }
                       return p.z < 12.0 ? 0 : (p.z < 55.0 ? 1 : 4);
                     });
}

TEST(Furnace, AcousticLosesAndGainsNothingForAnyRoughness)
{
  KernelScene scene = makeLosslessScene();
  scene.view.maxCollisions = 1000;
  scene.view.depthMm = 200.0f;
  scene.view.waveNumberAtOne = float(2000.0 * M_PI * 2.5);
  const double surfaces[][2] = {
    { 0.0, 1.0 }, { 0.02, 1.0 }, { 0.1, 1.0 }, { 0.5, 1.0 }, { 1.0, 1.0 }, { 10.0, 0.01 }
  };
  for (const auto& [height, correlation] : surfaces)
  {
    for (TraceMedium& m : scene.media)
    {
      m.roughnessMm = float(height);
      m.correlationMm = float(correlation);
    }
    for (const bool lowDiscrepancy : { false, true })
    {
      scene.view.lowDiscrepancy = lowDiscrepancy;
      const Vec3f axis = glm::normalize(Vec3f(0.02f, -0.05f, 1.0f));
      const Balance b = run(scene, { { 23.3f, 25.4f, 0.0f }, axis }, 4000);
      EXPECT_NEAR(b.total, 1.0, 1e-5 + 4.0 * b.error) << "height " << height;
      EXPECT_EQ(b.nowhere, 0.0) << "height " << height;
      EXPECT_EQ(b.limit, 0.0) << "height " << height;
      EXPECT_NEAR(b.back + b.border + b.late, b.total, 1e-5) << "height " << height;
      EXPECT_LT(b.error, 0.02);
    }
  }
}

TEST(Furnace, APlateReflectsTheSumOfItsIncoherentReverberations)
{
  // Normal incidence onto a plate between equal media: R_total = 2 R / (1 + R), from the geometric series.
  for (const float z : { 3.0f, 7.8f, 40.0f })
  {
    KernelScene scene(Vec3i(20, 20, 60), Vec3d(1.0), { makeMedium(1.5f, 1500.0f), makeMedium(z, 1500.0f) },
                      [](const Vec3d& p) { return p.z > 20.0 && p.z < 25.0 ? 1 : 0; });
    scene.view.maxCollisions = 1000;
    const double r = (z - 1.5) / (z + 1.5);
    const double reflectance = r * r;
    const double expected = 2.0 * reflectance / (1.0 + reflectance);
    constexpr int paths = 40000;
    const double error = std::sqrt(expected * (1.0 - expected) / paths);
    for (const bool lowDiscrepancy : { false, true })
    {
      scene.view.lowDiscrepancy = lowDiscrepancy;
      const Balance b = run(scene, { { 10.3f, 10.4f, 0.0f }, { 0.0f, 0.0f, 1.0f } }, paths);
      EXPECT_NEAR(b.back, expected, 4.0 * error) << z;
      EXPECT_NEAR(b.border, 1.0 - expected, 4.0 * error) << z;
      EXPECT_NEAR(b.total, 1.0, 1e-5 + 4.0 * b.error);
    }
  }
}

/// What a path deposits along its way: the integral of its intensity.
struct Dose : PathSink
{
  double sum = 0.0;

  void segment(const PathSegment& s) { sum += s.intensity * -std::expm1(-s.decayPerMm * s.length) / s.decayPerMm; }
};

TEST(Furnace, RussianRouletteKeepsTheMean)
{
  KernelScene scene = makeLosslessScene();
  for (TraceMedium& m : scene.media)
  {
    m.decayPerMm = 0.05f;
    m.roughnessMm = 0.5f;
  }
  scene.view.waveNumberAtOne = float(2000.0 * M_PI * 2.5);
  scene.view.maxCollisions = 50;
  scene.view.lowDiscrepancy = false;
  const TraceLine line{ { 23.3f, 25.4f, 0.0f }, { 0.0f, 0.0f, 1.0f } };
  constexpr int paths = 100000;
  double mean[2];
  double variance[2];
  for (int i = 0; i < 2; ++i)
  {
    scene.view.rouletteIntensity = i == 0 ? 0.0f : 0.3f;
    Dose shared;
    const LineStart start = startLine(scene.view, scene.space(), line, shared);
    double squares = 0.0;
    double sum = 0.0;
    for (int p = 0; p < paths; ++p)
    {
      Dose dose;
      tracePath(scene.view, scene.space(), line, start, PathKey{ 0, 0, std::uint32_t(p), std::uint64_t(i) }, dose);
      sum += dose.sum;
      squares += dose.sum * dose.sum;
    }
    mean[i] = sum / paths;
    variance[i] = (squares / paths - mean[i] * mean[i]) / paths;
  }
  EXPECT_NEAR(mean[1], mean[0], 4.0 * std::sqrt(variance[0] + variance[1]));
  EXPECT_GT(variance[1], variance[0]); // it does something here
}

TEST(Furnace, AmadouMirrorKeepsRSquaredPlusTSquared)
{
  for (const double degrees : { 0.0, 30.0 })
  {
    KernelScene scene(Vec3i(120, 20, 60), Vec3d(1.0), { makeMedium(1.65f, 1550.0f), makeMedium(7.8f, 4080.0f) },
                      [](const Vec3d& p) { return p.z > 20.0 ? 1 : 0; });
    scene.view.model = InterfaceModel::Amadou2024;
    constexpr int paths = 65536;
    const double t1 = degrees * M_PI / 180.0;
    const Vec3f axis(float(std::sin(t1)), 0.0f, float(std::cos(t1)));
    const Balance b = run(scene, { { 30.3f, 10.4f, 0.0f }, axis }, paths);
    const double cos1 = std::cos(t1);
    const double cos2 = std::sqrt(1.0 - std::pow(1.65 / 7.8 * std::sin(t1), 2.0));
    const double root = (7.8 * cos2 - 1.65 * cos1) / (7.8 * cos2 + 1.65 * cos1);
    const double r = root * root;
    // Chosen with probability R, weighted with R again, and with the cosine of the way out. Of 1, 0.512 is left at
    // normal incidence on bone.
    const double expected = r * r * cos1 + (1.0 - r) * (1.0 - r) * cos2;
    EXPECT_NEAR(b.total, expected, 1e-3) << degrees;
    if (degrees == 0.0)
    {
      EXPECT_NEAR(expected, 0.512, 0.0005);
    }
  }
}

TEST(Furnace, AmadouLobeAroundTheNormalGainsPi)
{
  // The mean of cos/p over a lobe that covers the hemisphere is the hemisphere's projected solid angle, whatever sigma.
  for (const double sigma : { M_PI / 4.0, 1.0, 3.0 })
  {
    KernelScene scene(Vec3i(20, 20, 60), Vec3d(1.0), { makeMedium(1.5f, 1540.0f), makeMedium(4.5f, 1540.0f) },
                      [](const Vec3d& p) { return p.z > 20.0 ? 1 : 0; });
    scene.view.model = InterfaceModel::Amadou2024;
    scene.view.lobe = makeLobe(0.0, sigma, 0.0, M_PI / 2.0);
    const Balance b = run(scene, { { 10.3f, 10.4f, 0.0f }, { 0.0f, 0.0f, 1.0f } }, 65536);
    // R = 0.25: pi (R^2 + T^2) = 1.963 comes out of 1.
    EXPECT_NEAR(b.total, M_PI * 0.625, 0.01) << sigma;
  }
}

} // namespace
