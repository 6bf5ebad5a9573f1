#pragma once

#include "Probe/ScanGeometry.h"
#include "Scene/Scene.h"

namespace sono {

/// What a probe is to look at by default, world mm: the middle of all voxels of myocardium; where there are none, of
/// liver; where there are none either, of all tissue but the outside one. Throws Error when there is nothing but that.
Vec3d defaultTarget(const Scene& scene);

/// A pose from which the target can be seen: on the skin, looking at it, where bone and gas lie least in the way.
///
/// Of 4000 directions spread evenly over the sphere, those from behind (more than 30 degrees posterior of the frontal
/// plane) are left out, and so are those that meet the skin at more than 45 degrees to its normal or leave the body
/// where the label map ends. Of the rest the one wins that has the largest mean amplitude, attenuation and the
/// transmission through every boundary on a straight way taken together, over 17 ways from that point of the skin: to
/// the target, and to eight points each 15 and 30 degrees around it. `lateral` points to the patient's left, or, for a
/// pose from the side, to the feet.
/// `frequencyMHz`, > 0, sets the attenuation. Throws Error when the target is not within the label map's box, or no
/// direction is left.
ProbePose findAcousticWindow(const Scene& scene, const Vec3d& targetMm, double frequencyMHz);

} // namespace sono
