#include "Kernel/Interface.h"
#include "Kernel/RoughSurface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace {

using namespace sono;

constexpr InterfaceModel acoustic = InterfaceModel::Acoustic;
constexpr InterfaceModel amadou = InterfaceModel::Amadou2024;

struct Pair
{
  double z1, z2, c1, c2;
};

/// Soft tissues, bone, air: impedance ratios from 1.002 to 5000, either way round.
std::vector<Pair> mediumPairs()
{
  std::vector<Pair> pairs;
  for (const Pair& p :
       { Pair{ 1.620, 1.623, 1550.0, 1552.0 }, Pair{ 1.38, 1.65, 1450.0, 1570.0 }, Pair{ 1.61, 1.65, 1584.0, 1550.0 },
         Pair{ 1.65, 7.8, 1550.0, 4080.0 }, Pair{ 1.0, 10.0, 1500.0, 1500.0 }, Pair{ 0.0004, 1.7, 330.0, 1580.0 },
         Pair{ 0.001, 5.0, 1000.0, 1000.0 } })
  {
    pairs.push_back(p);
    pairs.push_back({ p.z2, p.z1, p.c2, p.c1 });
  }
  return pairs;
}

TEST(Interface, PressureReflectionAndEnergyFluxFollowFluidAcoustics)
{
  for (const Pair& p : mediumPairs())
  {
    for (double degrees = 0.0; degrees < 89.95; degrees += 0.1)
    {
      const float cosine = float(std::cos(degrees * M_PI / 180.0));
      const double sin1 = std::sqrt(1.0 - double(cosine) * cosine);
      const double sin2 = sin1 * p.c2 / p.c1;
      const Reflection r = reflectionAt(acoustic, float(p.z1), float(p.z2), float(p.c1), float(p.c2), cosine);
      // The last bits around the critical angle belong to the single-precision speeds.
      if (std::abs(sin2 - 1.0) < 1e-6)
      {
        continue;
      }
      ASSERT_EQ(r.total, sin2 > 1.0) << degrees;
      if (r.total)
      {
        ASSERT_EQ(r.reflectance, 1.0f);
        continue;
      }
      const double cos2 = std::sqrt(1.0 - sin2 * sin2);
      const double pressure = (p.z2 * cosine - p.z1 * cos2) / (p.z2 * cosine + p.z1 * cos2);
      // d(cos2)/d(sin2) grows as 1/cos2 towards the critical angle.
      const double tolerance = 1e-6 + 1e-6 / cos2;
      ASSERT_NEAR(r.reflectance, pressure * pressure, tolerance) << p.z1 << " " << p.z2 << " " << degrees;
      ASSERT_NEAR(r.cosRefracted, cos2, tolerance);
      // Transmitted flux through a unit of surface: t^2 / (2 Z2) cos2 against 1 / (2 Z1) cos1.
      const double transmission = 2.0 * p.z2 * cosine / (p.z2 * cosine + p.z1 * cos2);
      const double flux = transmission * transmission * p.z1 * cos2 / (p.z2 * cosine);
      ASSERT_NEAR(r.reflectance + flux, 1.0, tolerance);
    }
  }
}

TEST(Interface, RefractedDirectionFollowsSnell)
{
  std::mt19937 random(1);
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> uniform;
  double worst = 0.0;
  for (const Pair& p : mediumPairs())
  {
    for (int i = 0; i < 5000; ++i)
    {
      const Vec3d n = glm::normalize(Vec3d(gauss(random), gauss(random), gauss(random)));
      const Vec3d tangent = glm::normalize(glm::cross(n, Vec3d(gauss(random), gauss(random), gauss(random))));
      const double critical = p.c2 > p.c1 ? std::asin(p.c1 / p.c2) : 0.5 * M_PI;
      // Within 0.1 % of the critical angle one rounding of the incident cosine exceeds the tolerance.
      const double t1 = uniform(random) * 0.999 * critical;
      const Vec3f normal(n);
      const Vec3f direction(n * std::cos(t1) + tangent * std::sin(t1));
      const float cosine = std::min(1.0f, glm::dot(direction, normal));
      const Reflection r = reflectionAt(acoustic, float(p.z1), float(p.z2), float(p.c1), float(p.c2), cosine);
      ASSERT_FALSE(r.total);
      const Vec3d out = glm::normalize(Vec3d(refractedDirection(direction, normal, cosine, r)));
      const double t2 = std::asin(std::sin(t1) * p.c2 / p.c1);
      const Vec3d expected = n * std::cos(t2) + tangent * std::sin(t2);
      worst = std::max(worst, std::atan2(glm::length(glm::cross(out, expected)), glm::dot(out, expected)));

      const Vec3d mirrored(mirrorDirection(direction, normal, cosine));
      ASSERT_NEAR(glm::length(mirrored - (tangent * std::sin(t1) - n * std::cos(t1))), 0.0, 1e-6);
    }
  }
  EXPECT_LT(worst, 1e-4);
  RecordProperty("snell_max_rad", std::to_string(worst));
}

TEST(Interface, ReflectsTotallyFromTheCriticalAngleOn)
{
  // sin t1 = 0.5 exactly at the critical angle of 1500 on 3000 m/s.
  for (const double sine : { 0.49, 0.499, 0.49999, 0.50001, 0.501, 0.51, 0.9, 0.999999 })
  {
    const Reflection r = reflectionAt(acoustic, 1.5f, 3.0f, 1500.0f, 3000.0f, float(std::sqrt(1.0 - sine * sine)));
    EXPECT_EQ(r.total, sine > 0.5) << sine;
    EXPECT_EQ(r.reflectance == 1.0f, sine > 0.5) << sine;
    for (const float choice : { 0.0f, 0.5f, 0.9999999f, 1.0f })
    {
      const Vec3f direction(float(sine), 0.0f, float(std::sqrt(1.0 - sine * sine)));
      const RoughBoundary rough{ 0.05f, 0.2f, 10.0f, 5.0f };
      const Scattered s =
        scatterRough(rough, direction, { 0, 0, 1 }, direction.z, r, r.reflectance, BounceSample{ choice, 0.5f, 0.5f });
      EXPECT_TRUE(s.reflected || !r.total);
      EXPECT_EQ(s.direction.z < 0.0f, s.reflected);
    }
  }
}

TEST(Interface, TableOfNormalIncidence)
{
  const auto pressure = [](float z1, float z2) {
    return std::sqrt(double(reflectionAt(acoustic, z1, z2, 1540.0f, 1600.0f, 1.0f).reflectance));
  };
  EXPECT_NEAR(pressure(1.65f, 7.80f), 0.651, 0.0005);   // liver, bone
  EXPECT_NEAR(pressure(1.38f, 1.65f), 0.089, 0.0005);   // fat, liver
  EXPECT_NEAR(pressure(1.61f, 1.65f), 0.0123, 0.00005); // blood, liver
  EXPECT_EQ(pressure(1.65f, 1.65f), 0.0);
  EXPECT_EQ(pressure(1.65f, 7.80f), pressure(7.80f, 1.65f));
}

TEST(Interface, AmadouEquationsOneToFour)
{
  for (const Pair& p : mediumPairs())
  {
    for (double degrees = 0.0; degrees < 89.95; degrees += 0.1)
    {
      const float cosine = float(std::cos(degrees * M_PI / 180.0));
      const double ratio = p.z1 / p.z2;
      const double squared = 1.0 - ratio * ratio * (1.0 - double(cosine) * cosine);
      if (std::abs(squared) < 1e-5)
      {
        continue;
      }
      const Reflection r = reflectionAt(amadou, float(p.z1), float(p.z2), float(p.c1), float(p.c2), cosine);
      ASSERT_EQ(r.total, squared < 0.0) << p.z1 << " " << p.z2 << " " << degrees;
      if (r.total)
      {
        ASSERT_EQ(r.reflectance, 1.0f);
        continue;
      }
      const double cos2 = std::sqrt(squared);
      const double root = (p.z2 * cos2 - p.z1 * cosine) / (p.z2 * cos2 + p.z1 * cosine);
      ASSERT_NEAR(r.cosRefracted, cos2, 1e-6 + 1e-6 / cos2);
      // One rounding of the squared sine, seen through both small cosines.
      ASSERT_NEAR(r.reflectance, root * root, 1e-6 + 4e-7 / (cosine * cos2)) << p.z1 << " " << p.z2 << " " << degrees;
    }
  }
}

TEST(Interface, AmadouBranchWeightIsEquationNineOverEquationThirteen)
{
  const double mu = 0.1;
  const double sigma = 0.5;
  const double a = 0.05;
  const double b = 1.4;
  const Lobe lobe = makeLobe(mu, sigma, a, b);
  const double mass = 0.5 * (std::erf((b - mu) / (sigma * M_SQRT2)) - std::erf((a - mu) / (sigma * M_SQRT2)));
  const Vec3f normal(0.0f, 0.0f, 1.0f);
  const Vec3f direction(0.6f, 0.0f, 0.8f);
  const Reflection r = reflectionAt(amadou, 1.5f, 2.5f, 1500.0f, 1500.0f, 0.8f);
  for (int i = 0; i < 2000; ++i)
  {
    const BounceSample u = independentSample(5, 0, 0, std::uint32_t(i), 0);
    const Scattered s = scatterByLobe(lobe, direction, normal, 0.8f, r, u);
    ASSERT_EQ(s.reflected, u.choice < r.reflectance);
    const double phi = samplePolar(lobe, u.polar);
    const double psi =
      std::exp(-0.5 * (phi - mu) * (phi - mu) / (sigma * sigma)) / (sigma * std::sqrt(2.0 * M_PI) * mass);
    const double density = psi / (2.0 * M_PI * std::sin(phi));
    const double branch = s.reflected ? r.reflectance : 1.0 - r.reflectance;
    const double expected = branch * std::abs(s.direction.z) / density;
    ASSERT_NEAR(s.throughput, expected, 1e-5 * expected + 1e-7);
  }
}

TEST(Interface, AmadouMirrorKeepsTheCosine)
{
  const Vec3f direction(0.6f, 0.0f, 0.8f);
  const Reflection r = reflectionAt(amadou, 1.5f, 2.5f, 1500.0f, 1500.0f, 0.8f);
  const Scattered back = scatterByLobe(Lobe{}, direction, { 0, 0, 1 }, 0.8f, r, BounceSample{ 0.0f, 0.5f, 0.5f });
  const Scattered on = scatterByLobe(Lobe{}, direction, { 0, 0, 1 }, 0.8f, r, BounceSample{ 0.999f, 0.5f, 0.5f });
  EXPECT_NEAR(back.throughput, r.reflectance * 0.8, 1e-6);
  const double cos2 = std::sqrt(1.0 - 0.36 * 0.36); // sin t2 = Z1/Z2 sin t1 = 0.6 x 0.6
  EXPECT_NEAR(on.throughput, (1.0 - r.reflectance) * cos2, 1e-6);
}

TEST(Interface, DirectionOnTheWrongSideIsMirroredAcrossTheTangentPlane)
{
  const Lobe wide = makeLobe(0.0, 3.0, 0.0, 1.570796);
  std::mt19937 random(3);
  std::normal_distribution<double> gauss;
  int turned = 0;
  for (int i = 0; i < 20000; ++i)
  {
    const Vec3f n(glm::normalize(Vec3d(gauss(random), gauss(random), gauss(random))));
    Vec3f d(glm::normalize(Vec3d(gauss(random), gauss(random), gauss(random))));
    d *= glm::dot(d, n) < 0.0f ? -1.0f : 1.0f;
    const float cosine = glm::dot(d, n);
    const Reflection r = reflectionAt(acoustic, 1.5f, 2.0f, 1500.0f, 1600.0f, cosine);
    const BounceSample u = independentSample(8, 0, 0, std::uint32_t(i), 0);
    const Scattered s = scatterByLobe(wide, d, n, cosine, r, u);
    const float side = glm::dot(s.direction, n);
    ASSERT_TRUE(s.reflected ? side <= 1e-6f : side >= -1e-6f);
    ASSERT_NEAR(glm::length(s.direction), 1.0f, 1e-6f);
    // Either the sampled direction or its mirror image stands at phi from the centre.
    const Vec3f centre =
      glm::normalize(s.reflected ? mirrorDirection(d, n, cosine) : refractedDirection(d, n, cosine, r));
    const float phi = samplePolar(wide, u.polar);
    const double kept = std::abs(glm::dot(centre, s.direction) - std::cos(phi));
    const double mirrored = std::abs(glm::dot(centre, s.direction - n * (2.0f * side)) - std::cos(phi));
    ASSERT_LT(std::min(kept, mirrored), 2e-6);
    turned += mirrored < kept;
  }
  EXPECT_GT(turned, 1000);
}

TEST(InterfaceEcho, IsLinearInIntensityAtTheNeutralExponents)
{
  for (const Pair& p : mediumPairs())
  {
    const double r0 = std::abs(p.z2 - p.z1) / (p.z2 + p.z1);
    for (const float cosine : { 1.0f, 0.5f, 1e-4f })
    {
      for (const float intensity : { 1.0f, 0.3f, 1e-20f })
      {
        const auto echo = [&](InterfaceModel model, float tau, float gamma) {
          return double(boundaryEcho(model, float(p.z1), float(p.z2), intensity, cosine, tau, gamma));
        };
        EXPECT_NEAR(echo(acoustic, 1.0f, 0.0f), r0 * intensity, 1e-6 * intensity);
        EXPECT_NEAR(echo(amadou, 1.0f, 0.0f), r0 * r0 * intensity, 1e-6 * intensity);
        const double tau = 0.7;
        const double gamma = 1.3;
        const double shaping = std::pow(double(intensity), tau) * std::pow(std::max(1e-3, double(cosine)), gamma);
        EXPECT_NEAR(echo(acoustic, float(tau), float(gamma)), r0 * shaping, 1e-5 * shaping);
        EXPECT_NEAR(echo(amadou, float(tau), float(gamma)), r0 * r0 * shaping, 1e-5 * shaping);
      }
    }
  }
}

TEST(InterfaceEcho, StaysFiniteAtGrazingIncidence)
{
  for (const float cosine : { 1e-2f, 1e-3f, 1e-6f, 1e-30f, 0.0f })
  {
    for (const float gamma : { -2.0f, -1.0f, -0.5f, 0.0f, 0.5f, 2.0f })
    {
      const float echo = boundaryEcho(acoustic, 0.0004f, 7.8f, 1.0f, cosine, 1.0f, gamma);
      EXPECT_TRUE(std::isfinite(echo) && echo >= 0.0f && echo <= 1.0001e6f) << cosine << " " << gamma;
    }
    for (const InterfaceModel model : { acoustic, amadou })
    {
      for (const Pair& p : mediumPairs())
      {
        const Reflection r = reflectionAt(model, float(p.z1), float(p.z2), float(p.c1), float(p.c2), cosine);
        EXPECT_TRUE(r.reflectance >= 0.0f && r.reflectance <= 1.0f) << cosine << " " << p.z1 << " " << p.z2;
      }
    }
  }
}

} // namespace
