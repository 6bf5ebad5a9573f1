#include "DataSets/ImageLandmarks.h"

#include <cmath>
#include <utility>

namespace sono {

namespace {

constexpr double leastTilt = 1e-6; // sine of the angle between ring and plane

ImageLandmark annulusInImage(const char* name, const Annulus& ring, const ProbePose& pose, const ImageSight& sight)
{
  ImageLandmark landmark{ name, sight.pointAt(ring.centreMm), ring, {} };
  for (const Vec3d& place : crossings(ring, pose))
  {
    landmark.hinges.push_back(sight.pointAt(place));
  }
  if (landmark.hinges.size() == 2 && landmark.hinges[1].column < landmark.hinges[0].column)
  {
    std::swap(landmark.hinges[0], landmark.hinges[1]);
  }
  return landmark;
}

} // namespace

std::vector<Vec3d> crossings(const Annulus& ring, const ProbePose& pose)
{
  const Vec3d elevation = glm::cross(pose.axial, pose.lateral);
  // In the ring's plane, towards the image's.
  const Vec3d across = elevation - glm::dot(elevation, ring.normal) * ring.normal;
  const double tilt = glm::length(across);
  if (tilt < leastTilt)
  {
    return {};
  }
  const double towardsMm = -glm::dot(ring.centreMm - pose.positionMm, elevation) / tilt;
  if (std::abs(towardsMm) >= ring.radiusMm)
  {
    return {};
  }
  const Vec3d middle = ring.centreMm + towardsMm / tilt * across;
  const Vec3d along =
    std::sqrt(ring.radiusMm * ring.radiusMm - towardsMm * towardsMm) / tilt * glm::cross(ring.normal, across);
  return { middle - along, middle + along };
}

std::vector<ImageLandmark> landmarksInImage(const HeartLandmarks& heart, const ProbePose& pose, const ImageSight& sight)
{
  std::vector<ImageLandmark> landmarks{ { "apex", sight.pointAt(heart.apexMm), {}, {} },
                                        annulusInImage("mitralAnnulus", heart.mitral, pose, sight) };
  if (heart.tricuspid)
  {
    landmarks.push_back(annulusInImage("tricuspidAnnulus", *heart.tricuspid, pose, sight));
  }
  if (heart.aortic)
  {
    landmarks.push_back(annulusInImage("aorticAnnulus", *heart.aortic, pose, sight));
  }
  return landmarks;
}

} // namespace sono
