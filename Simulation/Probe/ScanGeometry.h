#pragma once

#include "Kernel/Vec.h"

#include <string>
#include <vector>

namespace sono {

/// How the scan lines are laid out in the image plane.
enum class ScanKind
{
  Linear,       ///< parallel lines over the aperture's width
  PhasedSector, ///< lines from one apex on the face
  Curvilinear   ///< lines along the radii of a convex face
};

/// Where a probe stands: `axial` points into the body, `lateral` along the array, elevation = axial x lateral.
/// World LPS mm.
struct ProbePose
{
  Vec3d positionMm{ 0.0, 0.0, 0.0 }; ///< centre of the transducer's face
  Vec3d axial{ 0.0, 0.0, 1.0 };
  Vec3d lateral{ 1.0, 0.0, 0.0 };

  /// Unit axial; lateral made orthogonal to it. Throws Error when they are zero, parallel or not finite.
  ProbePose orthonormalized() const;
};

/// The layout of a probe's scan lines, used by the tracer, the outline and the scan converter alike.
struct ScanGeometry
{
  ScanKind kind = ScanKind::PhasedSector;
  int lineCount = 128;     ///< 1 to 4096
  double depthMm = 160.0;  ///< > 0, along each line from the face
  double sectorDeg = 90.0; ///< opening angle between the outermost lines, sector and curvilinear, (0, 180)
  double radiusMm = 60.0;  ///< curvilinear: radius of the face, > 0
  double widthMm = 38.0;   ///< linear: distance between the outermost lines, > 0

  /// Throws Error naming the parameter.
  void validate() const;
};

/// One scan line (a main beam). Unit vectors, origin on the transducer's face.
struct ScanLine
{
  Vec3d originMm;
  Vec3d axis;
  Vec3d lateral;
  Vec3d elevation;
};

/// The lines in order of increasing lateral position, in world coordinates.
std::vector<ScanLine> makeScanLines(const ScanGeometry& geometry, const ProbePose& pose);

/// Position in the probe's image plane, (lateral, axial) mm from the face's centre, of depth `r` on a line whose
/// index may be fractional; and back. `beamFromPlane` returns (line, r) with line in [0, lineCount - 1] and r in
/// [0, depthMm]; points outside of that (beyond 1e-3 line or mm, for rounding) give NaN. A curvilinear face's centre of
/// curvature lies at axial = -radiusMm; a sector's lines all start at (0, 0).
/// The geometry must be valid.
Vec2f planeFromBeam(const ScanGeometry& geometry, double line, double r);
Vec2f beamFromPlane(const ScanGeometry& geometry, double lateralMm, double axialMm);

/// What a probe is: numbers as a preset file gives them.
struct ProbePreset
{
  std::string name;
  ScanGeometry geometry;
  double centreFrequencyMHz = 2.5;
  double fractionalBandwidth = 0.6; ///< at -6 dB
  double elementWidthMm = 0.0;
  double elementHeightMm = 0.0;
  double kerfMm = 0.0;
  int elementCount = 1;
  double elevationFocusMm = 0.0;
  double transmitFocusMm = 0.0;
};

/// Reads a preset: a JSON object with "name", "scan" ("linear", "phased_sector" or "curvilinear") and numbers, each as
/// {"value": ..., "source": "..."}: numberOfLines, depthMm, widthMm (linear), sectorDeg (the others), radiusMm
/// (curvilinear), centreFrequencyMHz, fractionalBandwidth, elementCount, elementWidthMm, elementHeightMm, kerfMm,
/// elevationFocusMm, transmitFocusMm. Throws Error naming file and key for one that is missing, out of range or
/// unknown.
ProbePreset readProbePreset(const std::string& path);

} // namespace sono
