#pragma once

#include "Kernel/Vec.h"

namespace sono {

// The beat of the bundled heart: a smooth map of space in the heart's own frame (ThoraxHeart.h), given backwards. About
// the left ventricle's long axis, what is now at radius r, depth z stood at
//   Z = z + a d(z),  R^2 = r^2 / m + a E(z),  m = dZ/dz,  turned by a phi(z, r),
// so that R dR dZ = r dr dz in the wall: it keeps its volume, shortens, thickens and twists. d rises by the way of the
// annulus between apex and base and goes back to 0 in the atria. Inside of the cavity R^2 / r^2 is bounded, so that the
// papillary muscles come together; beyond the wall the way inwards stays that of the epicardium; outside of the
// pericardium everything fades to rest over 24 mm. a(t) is 0 at the end of diastole, 1 at that of systole.

/// How far the beat has gone, 0 to 1, at a phase of the cycle (its fraction counts): systole in the first 35 %, then
/// early filling, diastasis and the atrium's kick.
double contractionAt(double phase);

/// Where, in mm, what is at `p` at this phase stands at phase 0.
Vec3d heartRestingPlaceMm(const Vec3d& p, double phase);

/// The reverse, by iteration to 10^-9 mm.
Vec3d heartPlaceMm(const Vec3d& resting, double phase);

} // namespace sono
