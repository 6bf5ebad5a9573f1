#pragma once

#include "Kernel/Interface.h"
#include "Kernel/Lobe.h"
#include "Kernel/RoughSurface.h"
#include "Kernel/Vec.h"

#include <cstdint>

namespace sono {

/// A tissue as the tracer needs it.
struct TraceMedium
{
  float impedance = 1.5f;  ///< MRayl
  float speed = 1540.0f;   ///< m/s
  float rangePerMm = 1.0f; ///< c0 / c: what a millimetre counts where range is time; 1 where it is not
  float decayPerMm = 0.0f; ///< k: intensity falls by exp(-k l)
  float tau = 1.0f;
  float gamma = 0.0f;
  float roughnessMm = 0.0f;   ///< h, rms height of its surface
  float correlationMm = 1.0f; ///< l, of that height
  float scatter = 0.0f;       ///< amplitude of its speckle against the tissue that reverberation refers to
  bool rings = false;         ///< of a rod: what comes back from within it has a closed form (Echo/RodRing.h)
};

/// One main beam (see ScanLine) in the region's local millimetres; the axis is a unit vector. Where paths start apart,
/// they do so at origin + u lateral + v elevation, u and v in [-1, 1].
struct TraceLine
{
  Vec3f origin;
  Vec3f axis;
  Vec3f lateral = Vec3f(0.0f);
  Vec3f elevation = Vec3f(0.0f);
  Vec3f face = Vec3f(0.0f); ///< unit normal of the transducer's face, into the body
  float aheadMm = 0.0f;     ///< of a path's own: how far its place on the aperture sends before the middle, to focus
};

/// Of the face's intensity, before the usual decay: below this a path that has been reflected plays roulette. Chosen:
/// with more the A4C's noise rises as fast as its time falls.
constexpr float reflectedRoulette = 0.16f;

/// Everything a path needs beside the space it runs through, trivially copyable.
struct TraceView
{
  const TraceMedium* media = nullptr; ///< by tissue index, then one for each target
  int firstTargetMedium = 0;
  int outsideTissue = -1;
  float rouletteIntensity = 1e-5f; ///< fainter paths survive with probability intensity / this; 0: none plays
  float usualDecayPerMm = 0.0f;    ///< of the intensity of paths that have been reflected: less is faint for them
  InterfaceModel model = InterfaceModel::Acoustic;
  Lobe lobe;                    ///< of Amadou2024
  float waveNumberAtOne = 0.0f; ///< k times c, rad/mm at 1 m/s: 2000 pi f with f in MHz
  bool lowDiscrepancy = true;
  bool deterministic = false;
  bool startsApart = false;       ///< each path starts at a place of its own on the aperture
  float perTransmitFocus = 0.0f;  ///< 1/mm, of the aperture along the array; 0: not focused
  float perElevationFocus = 0.0f; ///< and across it
  bool reverberates = true;       ///< Acoustic: paths that have been reflected go on; otherwise they end there
  bool favoursReflections = true; ///< Acoustic: boundaries reflect as many paths as serves what reverberates
  float faceReflection = 0.0f;    ///< of the amplitude, by the transducer's face
  float faceRadiusMm = 10.0f;
  float cellLateralPerMm = 0.0f; ///< how wide the line hears at a range, mm of each (see resolutionCell); 0: not known
  float cellElevationPerMm = 0.0f;
  Vec3f cornerMm = Vec3f(0.0f); ///< the region's in the scene, where cells of the tissue stay while regions come and go
  int maxCollisions = 7;
  float coherenceMm = 0.1f;
  float depthMm = 160.0f;
};

/// The surface between two media: the rougher side's, and of two alike in height the steeper one's, whichever is in
/// front.
SONO_HD inline RoughBoundary roughBoundary(const TraceView& view, const TraceMedium& from, const TraceMedium& to)
{
  const bool rougher =
    from.roughnessMm != to.roughnessMm ? from.roughnessMm > to.roughnessMm : from.correlationMm < to.correlationMm;
  const TraceMedium& side = rougher ? from : to;
  return { side.roughnessMm, smaller(steepestAlpha, 2.0f * side.roughnessMm / side.correlationMm),
           view.waveNumberAtOne / from.speed, view.waveNumberAtOne / to.speed };
}

/// w_R = C0 / (C0 + distance) (Data/docs/physics.md section 3). A micrometre is on the axis: C0 = 0 keeps exactly that.
SONO_HD inline float coherenceWeight(float c0, float distance)
{
  return distance < 1e-3f ? 1.0f : c0 / (c0 + distance);
}

} // namespace sono
