#include "Phantoms/ThoraxLandmarks.h"

#include "Probe/PlaneFit.h"

#include <cmath>
#include <vector>

namespace sono {

namespace {

/// Of the end of diastole, in the heart's frame.
struct Ring
{
  Vec3d centre;
  Vec3d normal;
  double radiusMm;
};

/// Where the beat has carried it: what lies nearest to the points of the ring.
Annulus carried(const Ring& ring, const ThoraxBody& body)
{
  constexpr int count = 24;
  const Vec3d first = glm::normalize(glm::cross(ring.normal, Vec3d(0.0, 1.0, 0.0)));
  const Vec3d second = glm::cross(ring.normal, first);
  std::vector<Vec3d> points;
  for (int i = 0; i < count; ++i)
  {
    const double turn = i * 2.0 * M_PI / count;
    const Vec3d resting = ring.centre + ring.radiusMm * (std::cos(turn) * first + std::sin(turn) * second);
    points.push_back(body.placeMm(body.frame().toWorld(resting)));
  }
  const PlaneFit fit = fitPlane(points);
  const Vec3d outwards = body.frame().axes * ring.normal;
  Annulus annulus{ fit.middleMm, glm::dot(fit.normal(), outwards) < 0.0 ? -fit.normal() : fit.normal(), 0.0 };
  for (const Vec3d& point : points)
  {
    annulus.radiusMm += glm::distance(point, annulus.centreMm) / count;
  }
  return annulus;
}

} // namespace

HeartLandmarks thoraxLandmarks(const ThoraxBody& body)
{
  const HeartPoints points = heartPoints(body.heart());
  const auto place = [&body](const Vec3d& resting) { return body.placeMm(body.frame().toWorld(resting)); };
  const Vec3d up(0.0, 0.0, 1.0);
  HeartLandmarks landmarks;
  landmarks.apexMm = place(points.apex);
  landmarks.mitral = carried({ points.mitral, up, points.mitralRadiusMm }, body);
  landmarks.tricuspid = carried({ points.tricuspid, up, points.tricuspidRadiusMm }, body);
  landmarks.aortic = carried({ aorticValveCentreMm(), aorticFlowDirection(), points.aorticRadiusMm }, body);
  landmarks.leftVentricleMm = place(points.leftVentricle);
  landmarks.rightVentricleMm = place(points.rightVentricle);
  landmarks.leftAtriumMm = place(points.leftAtrium);
  landmarks.rightAtriumMm = place(points.rightAtrium);
  return landmarks;
}

} // namespace sono
