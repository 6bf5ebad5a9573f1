#include "Image/Calipers.h"

#include "Core/Error.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace sono;

namespace {

constexpr double pi = 3.14159265358979323846;

/// A half ellipse whose flat side is the annulus, of half axes `half` across and `length` along, turned by `angle`.
TracedVentricle halfEllipse(double half, double length, double angle, const Vec2d& base)
{
  const auto place = [&](double x, double y) {
    return base + Vec2d(std::cos(angle) * x - std::sin(angle) * y, std::sin(angle) * x + std::cos(angle) * y);
  };
  TracedVentricle ventricle;
  constexpr int steps = 400;
  for (int i = 0; i <= steps; ++i)
  {
    ventricle.contour.push_back(place(half * std::cos(pi * i / steps), length * std::sin(pi * i / steps)));
  }
  ventricle.base = place(0.0, 0.0);
  ventricle.apex = place(0.0, length);
  return ventricle;
}

} // namespace

TEST(Calipers, DistanceAndAngleOfKnownTriangles)
{
  EXPECT_DOUBLE_EQ(distanceMm({ 1, 2, 0 }, { 4, 6, 0 }), 5.0);
  EXPECT_NEAR(angleDeg({ 1, 1, 0 }, { 3, 1, 0 }, { 1, 5, 0 }), 90.0, 1e-12);
  EXPECT_NEAR(angleDeg({ 0, 0, 0 }, { 1, 0, 0 }, { 1, std::sqrt(3.0), 0 }), 60.0, 1e-12);
  EXPECT_NEAR(angleDeg({ 0, 0, 0 }, { 1, 0, 0 }, { -2, 0, 0 }), 180.0, 1e-12);
  EXPECT_EQ(angleDeg({ 0, 0, 0 }, { 0, 0, 0 }, { 1, 0, 0 }), 0.0);
}

TEST(Calipers, AnEllipsesAreaIsOfItsAxesWhereverTheSideIsSet)
{
  EXPECT_NEAR(ellipseAreaMm2({ 0, 0, 0 }, { 20, 0, 0 }, { 10, 5, 0 }), pi * 10.0 * 5.0, 1e-9);
  EXPECT_NEAR(ellipseAreaMm2({ 0, 0, 0 }, { 20, 0, 0 }, { 3, -5, 0 }), pi * 10.0 * 5.0, 1e-9);
  EXPECT_NEAR(ellipseAreaMm2({ 0, 0, 0 }, { 12, 16, 0 }, { 6 - 4, 8 + 3, 0 }), pi * 10.0 * 5.0, 1e-9);
  EXPECT_EQ(ellipseAreaMm2({ 0, 0, 0 }, { 20, 0, 0 }, { 7, 0, 0 }), 0.0);
}

TEST(Calipers, BiplaneVolumeOfHalfAnEllipsoid)
{
  const TracedVentricle four = halfEllipse(22.0, 85.0, 0.4, { 5.0, 90.0 });
  const TracedVentricle two = halfEllipse(26.0, 85.0, -2.1, { -8.0, 60.0 });
  const double exact = 2.0 / 3.0 * pi * 22.0 * 26.0 * 85.0 / 1000.0;
  EXPECT_NEAR(biplaneVolumeMl(four, two), exact, 0.002 * exact);
  EXPECT_NEAR(biplaneVolumeMl(four, two, 200), exact, 0.0002 * exact);
}

TEST(Calipers, TheLongerAxisCounts)
{
  const TracedVentricle four = halfEllipse(22.0, 85.0, 0.0, { 0.0, 0.0 });
  const TracedVentricle foreshortened = halfEllipse(22.0, 60.0, 0.0, { 0.0, 0.0 });
  EXPECT_NEAR(biplaneVolumeMl(four, foreshortened), biplaneVolumeMl(four, four), 0.002 * biplaneVolumeMl(four, four));
  EXPECT_NEAR(biplaneVolumeMl(foreshortened, four), biplaneVolumeMl(four, foreshortened), 1e-9);
}

TEST(Calipers, WhatIsNoVentricle)
{
  TracedVentricle line = halfEllipse(22.0, 85.0, 0.0, { 0.0, 0.0 });
  line.apex = line.base;
  EXPECT_THROW(discDiametersMm(line, 20), Error);
  EXPECT_THROW(discDiametersMm(halfEllipse(22.0, 85.0, 0.0, { 0.0, 0.0 }), 0), Error);
}

TEST(Calipers, SinglePlaneVolumeOfHalfAnEllipsoidOfRevolution)
{
  const double exact = 2.0 / 3.0 * pi * 24.0 * 24.0 * 80.0 / 1000.0;
  EXPECT_NEAR(singlePlaneVolumeMl(halfEllipse(24.0, 80.0, 1.1, { 3.0, 70.0 })), exact, 0.002 * exact);
}

TEST(Calipers, AContourTracedFromHingeToHingeHasItsAxisInTheMiddle)
{
  const TracedVentricle drawn = halfEllipse(22.0, 85.0, 0.7, { 5.0, 90.0 });
  const TracedVentricle traced = tracedVentricle(drawn.contour);
  EXPECT_NEAR(distanceMm({ traced.base, 0.0 }, { drawn.base, 0.0 }), 0.0, 1e-9);
  EXPECT_NEAR(distanceMm({ traced.apex, 0.0 }, { drawn.apex, 0.0 }), 0.0, 1e-9);
}

TEST(Calipers, TwelveClicksGiveATriaxialVolumeWithinAFewPercent)
{
  // A polygon with its corners on the ellipse lies inside of it, by sin(t) / t in area for steps of t.
  const auto clicks = [](double half, double length) {
    std::vector<Vec2d> points;
    for (int i = 0; i < 12; ++i)
    {
      points.emplace_back(half * std::cos(pi * i / 11), length * std::sin(pi * i / 11));
    }
    return tracedVentricle(points);
  };
  const double exact = 2.0 / 3.0 * pi * 22.0 * 26.0 * 85.0 / 1000.0;
  const double volume = biplaneVolumeMl(clicks(22.0, 85.0), clicks(26.0, 85.0));
  EXPECT_LT(volume, exact);
  EXPECT_NEAR(volume, exact, 0.04 * exact);
}

TEST(Calipers, PixelsGiveAContourThatPassesOverWhatReachesIntoThem)
{
  // Half an ellipse of pixels of 0.25 mm over an atrium, with a muscle in it and an opening between two leaflets: what
  // its contour says is what the equation says of the whole.
  constexpr double pixelMm = 0.25;
  constexpr int width = 240;
  constexpr int height = 400;
  const auto isVentricle = [](int x, int y) {
    const double across = (x - 120) * pixelMm / 22.0;
    const double along = (360 - y) * pixelMm / 85.0;
    const bool isMuscle = x > 160 && std::abs(y - 240) < 20;
    const bool isLeaflet = std::abs(x - 120) < 60 && y > 340;
    return y < 360 && across * across + along * along < 1.0 && !isMuscle && !isLeaflet;
  };
  std::vector<Vec2d> contour;
  for (const Vec2d& p : convexContour(outlineOf(width, height, isVentricle), { 125.0, 390.0 }))
  {
    contour.push_back(pixelMm * p);
  }
  const TracedVentricle ventricle = tracedVentricle(contour);
  EXPECT_NEAR(glm::length(ventricle.apex - ventricle.base), 85.0, 2.0 * pixelMm);
  EXPECT_NEAR(ventricle.base.x, 120 * pixelMm, 2.0 * pixelMm);
  const double exact = 2.0 / 3.0 * pi * 22.0 * 22.0 * 85.0 / 1000.0;
  EXPECT_NEAR(singlePlaneVolumeMl(ventricle), exact, 0.02 * exact);
  EXPECT_TRUE(outlineOf(10, 10, [](int, int) { return false; }).empty());
  EXPECT_TRUE(convexContour({}, { 0.0, 0.0 }).empty());
}
