#pragma once

#include "Kernel/Vec.h"

#include <functional>
#include <utility>
#include <vector>

namespace sono {

// What a person measures in a picture; places in mm.

double distanceMm(const Vec3d& a, const Vec3d& b);

/// Of the ellipse with the axis from `a` to `b` whose border runs through as wide a place as `side` lies away from that
/// axis: pi / 4 * |b - a| * 2 d, in mm^2.
double ellipseAreaMm2(const Vec3d& a, const Vec3d& b, const Vec3d& side);
/// Its other half axis, from the centre towards `side`; 0 where `side` lies on the axis.
Vec3d ellipseHalfAxis(const Vec3d& a, const Vec3d& b, const Vec3d& side);

/// Between the arms from `vertex`, in degrees, 0 to 180; 0 where an arm has no length.
double angleDeg(const Vec3d& vertex, const Vec3d& a, const Vec3d& b);

/// A ventricle as traced in one view: a closed contour in the picture's plane, lateral and depth in mm, and its long
/// axis from the middle of the annulus to the apex.
struct TracedVentricle
{
  std::vector<Vec2d> contour; ///< in order, the last joins the first; at least 3
  Vec2d base;
  Vec2d apex;
};

/// Of a contour as it is traced by hand: from one end of the annulus along the wall to the other, lateral and depth in
/// mm. The long axis goes from the middle of the annulus to the place of the contour that is farthest from it.
TracedVentricle tracedVentricle(const std::vector<Vec2d>& contour);

/// Diameters of the contour across the long axis, in mm, in the middle of each of `count` discs of equal height, from
/// the base; 0 where the contour has none. Where a disc's line meets the contour more than twice, the outermost places
/// count. Throws Error for fewer than 3 points or an axis without length.
std::vector<double> discDiametersMm(const TracedVentricle& ventricle, int count);

/// The two ends of each of these diameters, in mm, from the base on; both in the axis where the contour has none.
/// Throws Error as discDiametersMm().
std::vector<std::pair<Vec2d, Vec2d>> discEnds(const TracedVentricle& ventricle, int count);

/// Simpson's biplane method of discs: V = pi / 4 * L / n * sum a_i b_i in ml, where a_i, b_i are the discs' diameters
/// in the two views and L the longer of the two long axes (Lang et al., J Am Soc Echocardiogr 28:1-39, 2015, recommend
/// 20 discs). Throws Error as discDiametersMm().
double biplaneVolumeMl(const TracedVentricle& fourChamber, const TracedVentricle& twoChamber, int count = 20);

/// The same from one view, as if the ventricle were round: V = pi / 4 * L / n * sum a_i^2 in ml. Throws Error as
/// discDiametersMm().
double singlePlaneVolumeMl(const TracedVentricle& view, int count = 20);

/// The longest closed outline of the pixels of a picture of `width` by `height` that `isInside` says yes to, along the
/// pixels' edges; in pixels, the middle of the first one at (0, 0). Empty where there is no such pixel.
std::vector<Vec2d> outlineOf(int width, int height, const std::function<bool(int column, int row)>& isInside);

/// A ventricle's contour as a person traces it, straight over papillary muscles and what hangs from the annulus: the
/// convex hull of its outline, from one end of the edge that faces `atrium`, a place in the atrium, to the other.
/// Empty for fewer than 3 points, or where the hull faces the place with no edge.
std::vector<Vec2d> convexContour(const std::vector<Vec2d>& outline, const Vec2d& atrium);

} // namespace sono
