#pragma once

#include "Kernel/Vec.h"
#include "Phantoms/ThoraxHeart.h"

namespace sono {

/// How far the beat has gone, 0 to 1, at a phase of the cycle (its fraction counts; 0 is the end of diastole): systole
/// in the first 35 %, then early filling, diastasis and the atrium's kick.
double contractionAt(double phase);

/// How far the mitral and the tricuspid valve are open, over their opening at the end of diastole: they close in the
/// first 4 % and open in early filling, swing half shut in diastasis and open again with the kick.
double inflowOpeningAt(double phase);

/// How far the aortic valve is open, 0 to 1: from 4 to 37 %.
double outflowOpeningAt(double phase);

/// The beat of a heart of the family: a smooth map of space in the heart's own frame (ThoraxHeart.h), given backwards.
/// About the left ventricle's long axis, what is now at radius r, depth z stood at the end of diastole at
///   Z = z + a d(z),  R^2 = r^2 / m + a E(Z),  m = dZ/dz,  turned by a phi(z, r),
/// so that R dR dZ = r dr dz in the wall: it keeps its volume, shortens, thickens and twists, whatever its shape. d
/// rises by the way of the annulus between apex and base and goes back to 0 at the roof of the atria. E is a share of
/// the squared radius of the cavity, an ellipsoid: the cavity loses a pi integral E dZ, and the same share of its
/// volume whatever its size, so that E follows from the ejection fraction; and the annulus' way with it, up to 13 mm.
/// Inside of the cavity R^2 / r^2 is bounded, so that the papillary muscles come together; beyond the wall the way
/// inwards stays that of the epicardium; outside of the pericardium everything fades to rest over 24 mm. a(t) is
/// contractionAt.
class HeartBeat
{
public:
  /// @param ejectionPercent of the left ventricle's blood, over a whole systole
  HeartBeat(const HeartShape& shape, double ejectionPercent, double phase);

  /// Where, in mm, what is at `p` at this phase stands at the end of diastole.
  Vec3d restingPlaceMm(const Vec3d& p) const;
  /// The same where bounds of how far outside of the heart a point lies are known (Heart::outsideMm), mostly quicker.
  Vec3d restingPlaceMm(const Vec3d& p, const DistanceBounds& outsideMm) const;
  /// Whether the distance itself is needed for that: the heart's at `p` then tells least and most of it.
  bool asksFor(const Vec3d& p, const DistanceBounds& outsideMm) const;
  /// Whether nothing is carried there.
  bool isAtRest(const DistanceBounds& outsideMm) const;
  const Heart& heart() const { return heart_; }
  /// The reverse, by iteration to 10^-9 mm.
  Vec3d placeMm(const Vec3d& resting) const;

private:
  struct AlongAxis
  {
    double mm;    ///< d
    double slope; ///< its derivative
  };
  AlongAxis wayAt(double z) const;

  bool isFar(const Vec3d& p) const;
  Vec3d carried(const Vec3d& p, double share) const;

  Heart heart_;
  double contraction_;
  double squeeze_; ///< E over the cavity's squared radius
  double annulusWayMm_;
  Vec2d cavityMm_, wallMm_; ///< radius and half length of the ellipsoids
  double apexMm_;           ///< depth of the cavity's
  double apexLowMm_, apexHighMm_;
  double roofLowMm_, roofHighMm_;
};

} // namespace sono
