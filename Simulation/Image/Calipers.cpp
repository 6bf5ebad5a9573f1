#include "Image/Calipers.h"

#include "Core/Error.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sono {
namespace {

constexpr double pi = 3.14159265358979323846;

Vec2d turned(const Vec2d& v)
{
  return { -v.y, v.x };
}

} // namespace

double distanceMm(const Vec3d& a, const Vec3d& b)
{
  return glm::length(b - a);
}

Vec3d ellipseHalfAxis(const Vec3d& a, const Vec3d& b, const Vec3d& side)
{
  const Vec3d axis = b - a;
  const double square = glm::dot(axis, axis);
  const Vec3d to = side - a;
  return square > 0.0 ? to - glm::dot(to, axis) / square * axis : to;
}

double ellipseAreaMm2(const Vec3d& a, const Vec3d& b, const Vec3d& side)
{
  return pi / 2.0 * distanceMm(a, b) * glm::length(ellipseHalfAxis(a, b, side));
}

double angleDeg(const Vec3d& vertex, const Vec3d& a, const Vec3d& b)
{
  const Vec3d one = a - vertex;
  const Vec3d other = b - vertex;
  return std::atan2(glm::length(glm::cross(one, other)), glm::dot(one, other)) * 180.0 / pi;
}

std::vector<double> discDiametersMm(const TracedVentricle& ventricle, int count)
{
  const Vec2d axis = ventricle.apex - ventricle.base;
  const double length = glm::length(axis);
  if (ventricle.contour.size() < 3 || !(length > 0.0) || count < 1)
  {
    throw Error(
      "A ventricle's volume needs contours of at least 3 points, each with a long axis from the middle of the "
      "annulus to the apex, and at least one disc; trace them again.");
  }
  const Vec2d across = turned(axis / length);
  std::vector<double> diameters;
  for (int disc = 0; disc < count; ++disc)
  {
    const double heightMm = (disc + 0.5) / count * length;
    double first = std::numeric_limits<double>::infinity();
    double last = -first;
    for (std::size_t i = 0; i < ventricle.contour.size(); ++i)
    {
      const Vec2d from = ventricle.contour[i] - ventricle.base;
      const Vec2d to = ventricle.contour[(i + 1) % ventricle.contour.size()] - ventricle.base;
      const double fromMm = glm::dot(from, axis) / length - heightMm;
      const double toMm = glm::dot(to, axis) / length - heightMm;
      if ((fromMm < 0.0) != (toMm < 0.0))
      {
        const double at = glm::dot(from + fromMm / (fromMm - toMm) * (to - from), across);
        first = std::min(first, at);
        last = std::max(last, at);
      }
    }
    diameters.push_back(std::max(0.0, last - first));
  }
  return diameters;
}

double biplaneVolumeMl(const TracedVentricle& fourChamber, const TracedVentricle& twoChamber, int count)
{
  constexpr double mm3PerMl = 1000.0;
  const std::vector<double> a = discDiametersMm(fourChamber, count);
  const std::vector<double> b = discDiametersMm(twoChamber, count);
  double sum = 0.0;
  for (int i = 0; i < count; ++i)
  {
    sum += a[i] * b[i];
  }
  const double lengthMm =
    std::max(glm::length(fourChamber.apex - fourChamber.base), glm::length(twoChamber.apex - twoChamber.base));
  return pi / 4.0 * lengthMm / count * sum / mm3PerMl;
}

} // namespace sono
