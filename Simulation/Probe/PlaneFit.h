#pragma once

#include "Kernel/Vec.h"

#include <vector>

namespace sono {

/// The plane of least squares through points.
struct PlaneFit
{
  Vec3d middleMm{ 0.0 };
  Mat3d axes{ 1.0 };      ///< columns: the normal, then the directions in the plane, the longer one last
  Vec3d spreadMm2{ 0.0 }; ///< mean square of the points' distances along these
  Vec3d normal() const { return axes[0]; }
};

/// Through the points' own middle. There must be at least one; of points on a line the normal is one of many.
PlaneFit fitPlane(const std::vector<Vec3d>& points);

/// Through a fixed point: the normal is what moves points with these weights least off the plane.
PlaneFit fitPlaneThrough(const Vec3d& fixedMm, const std::vector<Vec3d>& points, const std::vector<double>& weights);

} // namespace sono
