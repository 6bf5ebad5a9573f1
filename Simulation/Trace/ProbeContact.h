#pragma once

#include "Probe/ScanGeometry.h"
#include "Scene/Scene.h"

#include <optional>
#include <string>
#include <vector>

namespace sono {

/// What a person should know about where the transducer's face, the origins of the lines, stands: one sentence with the
/// way out, or nothing. A face is in the wrong place where most of it is in a tissue that reflects more than 0.3 of the
/// intensity that comes from water (bone, lung, gas other than the scene's outside), or where it is more than 10 mm off
/// the body: what lies between is then taken for coupling gel. Of a scene without a body that is said.
std::string probeContactWarning(const Scene& scene, const std::vector<ScanLine>& lines);

/// What a person should know about where the whole image lies: one sentence with the way out, or nothing. A transducer
/// that is no catheter is in the wrong place where its face lies more than 15 mm inside the body; and of an image of
/// which less than half lies in the label map's box, most is unknown.
std::string probePlaceWarning(const Scene& scene, const ScanGeometry& geometry, const ProbePose& pose);

/// Share of the image's area, of a matrix that of the plane without elevation, that lies in the label map's box.
double shareInsideVolume(const Scene& scene, const ScanGeometry& geometry, const ProbePose& pose);

/// The pose moved along its axis onto the body's surface: from inside back to the first place that is outside, from
/// outside on to the first that is not, at most 60 mm, by half a voxel's edge. None where no surface lies there.
std::optional<ProbePose> poseOnSkin(const Scene& scene, const ProbePose& pose);

/// The pose of a probe on the skin that a hand presses in by `pressMm`, mm along its axis: what the face displaces is
/// out of its way. Less far, by steps of half a voxel's edge, where any of nine places over the aperture, of one that
/// is not named the middle, would come into a tissue that keeps sound out (probeContactWarning), such as a rib.
ProbePose pressedIn(const Scene& scene, const ProbePose& pose, const BeamAperture& aperture, double pressMm);

} // namespace sono
