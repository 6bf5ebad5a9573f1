#include "Image/Calipers.h"

#include "Core/Error.h"

#include <gtest/gtest.h>

#include <cmath>

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
