#include "Probe/PlaneFit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sono {
namespace {

/// Eigenvalues, ascending, and vectors of a symmetric matrix, by Jacobi's rotations (Golub and Van Loan, section 8.5).
PlaneFit eigen(Mat3d a)
{
  constexpr int sweeps = 12;
  // Of what lies on the diagonal, after which turns move no digit.
  const double negligible = 1e-20 * (std::abs(a[0][0]) + std::abs(a[1][1]) + std::abs(a[2][2]));
  Mat3d vectors(1.0);
  for (int sweep = 0; sweep < sweeps; ++sweep)
  {
    for (const auto& [p, q] : { std::array<int, 2>{ 0, 1 }, std::array<int, 2>{ 0, 2 }, std::array<int, 2>{ 1, 2 } })
    {
      if (std::abs(a[p][q]) <= negligible)
      {
        continue;
      }
      const double ratio = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
      const double t = (ratio < 0.0 ? -1.0 : 1.0) / (std::abs(ratio) + std::sqrt(ratio * ratio + 1.0));
      const double c = 1.0 / std::sqrt(t * t + 1.0);
      const double s = t * c;
      Mat3d turn(1.0);
      turn[p][p] = turn[q][q] = c;
      turn[q][p] = s; // columns: the second one's first row
      turn[p][q] = -s;
      a = glm::transpose(turn) * a * turn;
      vectors = vectors * turn;
    }
  }
  std::array<int, 3> order{ 0, 1, 2 };
  std::sort(order.begin(), order.end(), [&](int i, int j) { return a[i][i] < a[j][j]; });
  PlaneFit fit;
  for (int i = 0; i < 3; ++i)
  {
    fit.axes[i] = vectors[order[std::size_t(i)]];
    fit.spreadMm2[i] = a[order[std::size_t(i)]][order[std::size_t(i)]];
  }
  return fit;
}

} // namespace

PlaneFit fitPlaneThrough(const Vec3d& fixedMm, const std::vector<Vec3d>& points, const std::vector<double>& weights)
{
  Mat3d scatter(0.0);
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const Vec3d from = points[i] - fixedMm;
    scatter += weights[i] * glm::outerProduct(from, from);
    sum += weights[i];
  }
  PlaneFit fit = eigen(scatter / sum);
  fit.middleMm = fixedMm;
  return fit;
}

PlaneFit fitPlane(const std::vector<Vec3d>& points)
{
  Vec3d sum(0.0);
  for (const Vec3d& point : points)
  {
    sum += point;
  }
  return fitPlaneThrough(sum / double(points.size()), points, std::vector<double>(points.size(), 1.0));
}

} // namespace sono
