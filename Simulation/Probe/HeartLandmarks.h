#pragma once

#include "Labels/LabelVolume.h"
#include "Probe/HeartParts.h"

#include <optional>

namespace sono {

/// The ring that a valve hangs in.
struct Annulus
{
  Vec3d centreMm{ 0.0 };
  Vec3d normal{ 0.0 };   ///< unit; out of the ventricle
  double radiusMm = 0.0; ///< mean
};

/// Points of a heart that views are defined by. World LPS mm.
struct HeartLandmarks
{
  Vec3d apexMm{ 0.0 }; ///< of the left ventricle's cavity: its point that is farthest from the mitral annulus
  Annulus mitral;
  std::optional<Annulus> tricuspid; ///< in a map with a right atrium
  std::optional<Annulus> aortic;    ///< in a map with an aorta: where it leaves the left ventricle
  Vec3d leftVentricleMm{ 0.0 };     ///< centroid of the cavity
  Vec3d rightVentricleMm{ 0.0 };
  Vec3d leftAtriumMm{ 0.0 };
  std::optional<Vec3d> rightAtriumMm;

  double lengthMm() const { return glm::distance(apexMm, mitral.centreMm); }
  Vec3d longAxis() const { return (mitral.centreMm - apexMm) / lengthMm(); } ///< of the left ventricle, to its base
  /// What of a vector is across the long axis.
  Vec3d across(const Vec3d& v) const { return v - glm::dot(v, longAxis()) * longAxis(); }
  /// Unit, across the long axis to the right side of the heart: to the tricuspid annulus, where there is none to the
  /// right ventricle's middle.
  Vec3d septal() const;
};

/// Finds them from labels with tissues alone. An annulus is a ring that is fitted, in 24 sectors that count alike, to
/// where a valve's label begins beside something that is not one of its two cavities. Where there is no such label: to
/// where the ventricle and what follows it meet, within 3 mm (of cavities that are apart within 5 or 8 mm), beside
/// something else.
///
/// Throws Error, one sentence that says what is missing, where the map has no left ventricle, left atrium or right
/// ventricle, where two of these that should meet do not, and where the box cuts the left ventricle.
HeartLandmarks findHeartLandmarks(const LabelVolume& volume);

} // namespace sono
