// From one pose to another and back to the movements that were made.
#include "SonoGuidance.h"

#include "Core/Error.h"
#include "Kernel/Vec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using sono::Mat3d;
using sono::Vec3d;

/// A probe's frame as a matrix whose columns are lateral, elevation and axial.
struct Probe
{
  Vec3d positionMm;
  Mat3d frame;

  sono::PoseNumbers numbers() const
  {
    const Vec3d& l = frame[0];
    const Vec3d& a = frame[2];
    return { positionMm.x, positionMm.y, positionMm.z, a.x, a.y, a.z, l.x, l.y, l.z };
  }
};

/// Turns the column `from` towards the column `to` of a frame.
Mat3d turned(int from, int to, double deg)
{
  const double angle = deg * M_PI / 180.0;
  Mat3d turn(1.0);
  turn[from][from] = turn[to][to] = std::cos(angle);
  turn[from][to] = std::sin(angle);
  turn[to][from] = -std::sin(angle);
  return turn;
}

/// Columns that are orthonormal and right-handed, with axial x lateral = elevation.
Mat3d anyFrame(std::mt19937& random)
{
  std::uniform_real_distribution<double> angle(-180.0, 180.0);
  return turned(0, 1, angle(random)) * turned(1, 2, angle(random)) * turned(2, 0, angle(random));
}

Probe moved(const Probe& probe, const sono::Guidance& by)
{
  const Vec3d way(by.slideLateralMm, by.slideElevationMm, by.pressMm);
  return { probe.positionMm + probe.frame * way,
           probe.frame * turned(2, 1, by.tiltDeg) * turned(2, 0, by.rockDeg) * turned(0, 1, by.rotateDeg) };
}

void expectNear(const sono::Guidance& found, const sono::Guidance& wanted, double tolerance)
{
  EXPECT_NEAR(found.slideLateralMm, wanted.slideLateralMm, tolerance);
  EXPECT_NEAR(found.slideElevationMm, wanted.slideElevationMm, tolerance);
  EXPECT_NEAR(found.pressMm, wanted.pressMm, tolerance);
  EXPECT_NEAR(found.tiltDeg, wanted.tiltDeg, tolerance);
  EXPECT_NEAR(found.rockDeg, wanted.rockDeg, tolerance);
  EXPECT_NEAR(found.rotateDeg, wanted.rotateDeg, tolerance);
}

const Probe upright{ { 10.0, 20.0, 30.0 }, Mat3d(1.0) };

} // namespace

TEST(Guidance, SinglesOutEachMovement)
{
  for (double sono::Guidance::*movement :
       { &sono::Guidance::slideLateralMm, &sono::Guidance::slideElevationMm, &sono::Guidance::pressMm,
         &sono::Guidance::tiltDeg, &sono::Guidance::rockDeg, &sono::Guidance::rotateDeg })
  {
    for (const double amount : { 12.5, -40.0 })
    {
      sono::Guidance one;
      one.*movement = amount;
      expectNear(sono::guidance(upright.numbers(), moved(upright, one).numbers()), one, 1e-9);
    }
  }
}

TEST(Guidance, IsWhatTheAxesSay)
{
  // Lateral to the left (x), axial to the back (y): the elevation, y x x, points to the feet (-z).
  const sono::PoseNumbers front{ 0, 0, 0, 0, 1, 0, 1, 0, 0 };
  const sono::Guidance found = sono::guidance(front, { 3, 5, 7, 0, 1, 0, 1, 0, 0 });
  expectNear(found, { 3.0, -7.0, 5.0, 0.0, 0.0, 0.0 }, 1e-12);
  // The beam to the feet and the back, half of each; to the left and the back; the array from left to feet.
  EXPECT_NEAR(sono::guidance(front, { 0, 0, 0, 0, 1, -1, 1, 0, 0 }).tiltDeg, 45.0, 1e-9);
  EXPECT_NEAR(sono::guidance(front, { 0, 0, 0, 1, 1, 0, 1, -1, 0 }).rockDeg, 45.0, 1e-9);
  EXPECT_NEAR(sono::guidance(front, { 0, 0, 0, 0, 1, 0, 0, 0, -1 }).rotateDeg, 90.0, 1e-9);
}

TEST(Guidance, GivesBackWhatWasComposed)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> mm(-80.0, 80.0);
  std::uniform_real_distribution<double> wide(-179.0, 179.0);
  std::uniform_real_distribution<double> narrow(-89.0, 89.0);
  for (int i = 0; i < 1000; ++i)
  {
    const Probe probe{ { mm(random), mm(random), mm(random) }, anyFrame(random) };
    const sono::Guidance by{ mm(random), mm(random), mm(random), wide(random), narrow(random), wide(random) };
    expectNear(sono::guidance(probe.numbers(), moved(probe, by).numbers()), by, 1e-6);
  }
}

TEST(Guidance, IsReachedWithinWhatIsAllowed)
{
  EXPECT_TRUE(sono::Guidance{}.isReached(0.0, 0.0));
  EXPECT_TRUE((sono::Guidance{ 3.0, -4.0, 0.0, 5.0, -5.0, 5.0 }).isReached(5.0, 5.0));
  EXPECT_FALSE((sono::Guidance{ 3.0, -4.0, 0.1 }).isReached(5.0, 5.0));
  EXPECT_FALSE((sono::Guidance{ 0.0, 0.0, 0.0, 0.0, -5.1, 0.0 }).isReached(5.0, 5.0));
}

TEST(Guidance, RefusesWhatIsNoPose)
{
  EXPECT_THROW(sono::guidance({}, upright.numbers()), sono::Error);
}
