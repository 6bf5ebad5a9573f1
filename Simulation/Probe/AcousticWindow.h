#pragma once

#include "Probe/ScanGeometry.h"
#include "Probe/WindowTarget.h"
#include "Scene/Scene.h"

#include <string>
#include <vector>

namespace sono {

/// A place on the skin from which a probe sees its target, and what it sees.
struct AcousticWindow
{
  ProbePose pose;
  double depthMm = 0.0;       ///< that the image needs, 40 (linear: 20) or more
  double seenPercent = 0.0;   ///< area of the target that the image shows, of its largest section through its middle
  double lossDb = 0.0;        ///< mean on the straight ways there, one way: attenuation and all boundaries
  double insidePercent = 0.0; ///< share of the image's area that lies within the label map's box
  double score = 0.0;         ///< what the windows are sorted by
};

/// The places from which a target can be seen best, best first; at most `count`, and no two that are neighbours.
///
/// A probe can stand where the body's outer surface is skin: next to the air around it, not within 6 mm of the box's
/// border, since a cut ends there, and, in a map that has the tissue skin, where skin is. Of a body that was filled and
/// goes on beyond the box, skin is an estimate: not within 15 mm of the border, and with 40 mm of the box in front. Its
/// face (aperture, or the outermost lines) lies on the skin within 6 mm, its handle of 70 mm meets no body, and it
/// looks at the target at no more than 45 degrees to the skin's normal (linear: 20), not from behind (more than 30
/// degrees posterior of the frontal plane), nor steeply from the head or the feet (more than 50 degrees).
///
/// There, the image's own lines run straight through a grid of about 2.5 mm. What is left of the amplitude of 1 beyond
/// that of a way through soft tissue weighs the area of the target that they meet, as a share of the area of the
/// target's largest section through its middle, within the box: `seenPercent`. The score is that times the share of
/// the image within the box (less still where that is below 65 %), times (1 + share of the image that is not in a
/// shadow) / 2, a tenth for each 40 dB that are lost on the way. Of the planes about the probe's axis the one that
/// shows most of the target is taken, where that is a tenth more than the usual one does: across the body, from a side
/// along it. `lateral` points to the patient's left, or, in a plane along the body, to the feet.
///
/// The same at each call. Throws Error when no part of the target lies in the label map's box, or there is no such
/// place.
std::vector<AcousticWindow> findAcousticWindows(const Scene& scene, const WindowTarget& target,
                                                const ProbeSettings& probe, int count = 5);

/// "From the front and the right: shows 63 % of the liver's largest section, 11 dB lost on the way, 92 % of the image
/// inside the volume."
std::string describe(const AcousticWindow& window, const WindowTarget& target);

} // namespace sono
