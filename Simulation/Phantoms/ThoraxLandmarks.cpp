#include "Phantoms/ThoraxLandmarks.h"

namespace sono {

HeartLandmarks thoraxLandmarks(const ThoraxBody& body)
{
  const HeartPoints points = heartPoints(body.heart());
  const HeartFrame& frame = body.frame();
  const auto annulus = [&frame](const Vec3d& centre, const Vec3d& normal, double radiusMm) {
    return Annulus{ frame.toWorld(centre), glm::normalize(frame.axes * normal), radiusMm };
  };
  const Vec3d up(0.0, 0.0, 1.0);
  HeartLandmarks landmarks;
  landmarks.apexMm = frame.toWorld(points.apex);
  landmarks.mitral = annulus(points.mitral, up, points.mitralRadiusMm);
  landmarks.tricuspid = annulus(points.tricuspid, up, points.tricuspidRadiusMm);
  landmarks.aortic = annulus(aorticValveCentreMm(), aorticFlowDirection(), points.aorticRadiusMm);
  landmarks.leftVentricleMm = frame.toWorld(points.leftVentricle);
  landmarks.rightVentricleMm = frame.toWorld(points.rightVentricle);
  landmarks.leftAtriumMm = frame.toWorld(points.leftAtrium);
  landmarks.rightAtriumMm = frame.toWorld(points.rightAtrium);
  return landmarks;
}

} // namespace sono
