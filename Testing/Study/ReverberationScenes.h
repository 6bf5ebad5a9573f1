#pragma once

#include "Scene/Scene.h"
#include "Simulator.h"

#include <memory>
#include <vector>

namespace sono::study {

/// What a picture of the part `reverberation` shows: small scenes of one artefact each, in world mm with the probe's
/// face around z = 0.
struct ArtefactScene
{
  std::shared_ptr<const Scene> scene;
  ImageInput input; ///< in the fundamental
};

/// Body wall of 12 mm, its last one connective tissue, over aerated lung between two ribs, under the L14-5.
/// `roughnessMm`: of the pleura, rms height.
ArtefactScene pleuraScene(double roughnessMm, bool quick);
constexpr double pleuraMm = 12.0;

/// Liver with a bright ball and a vein in front of a diaphragm, part of a sphere with lung behind it, under the C5-2.
ArtefactScene diaphragmScene(double roughnessMm, bool quick);
/// Where the ball's mirror image must lie: of all lines that the sphere mirrors the one that comes nearest to the
/// ball's middle, and the ranges of image and diaphragm on it, mm.
struct MirrorPlace
{
  int line;
  double imageMm;
  double diaphragmMm;
};
MirrorPlace ballBehindDiaphragm(const ScanGeometry& geometry, const ProbePose& pose);

/// Two pieces of steel, seen from the side, in soft tissue under the L14-5: a round needle at the lateral beginning,
/// and a strip 6 mm wide.
ArtefactScene needleScene(bool quick);
constexpr double needleTopMm = 22.0;
constexpr double needleThickMm = 1.2;

/// A cyst in liver behind a body wall under the C5-2. Both modes hear the same frequency.
ArtefactScene cystScene(ImagingMode mode, bool quick);
constexpr double cystRadiusMm = 8.0;
extern const Vec3d cystMm;

/// A4C of the bundled thorax, P4-2.
ArtefactScene heartScene(bool quick);

} // namespace sono::study
