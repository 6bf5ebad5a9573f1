#pragma once

#include "Kernel/Vec.h"

#include <string>
#include <vector>

namespace sono {

/// How the scan lines are laid out.
enum class ScanKind
{
  Linear,       ///< parallel lines over the aperture's width
  PhasedSector, ///< lines from one apex on the face
  Curvilinear,  ///< lines along the radii of a convex face
  Matrix,       ///< lines from one apex over a grid of angles: a 3-D volume
  Radial        ///< lines along the radii of a catheter, in the plane across it (ICE, IVUS)
};

/// Where a probe stands: `axial` points into the body, `lateral` along the array, elevation = axial x lateral.
/// World LPS mm.
struct ProbePose
{
  Vec3d positionMm{ 0.0, 0.0, 0.0 }; ///< centre of the transducer's face; of the catheter, when radial
  Vec3d axial{ 0.0, 0.0, 1.0 };
  Vec3d lateral{ 1.0, 0.0, 0.0 };

  /// Unit axial; lateral made orthogonal to it. Throws Error when they are zero, parallel or not finite.
  ProbePose orthonormalized() const;
};

/// The layout of a probe's scan lines, used by the tracer, the outline and the scan converter alike.
struct ScanGeometry
{
  ScanKind kind = ScanKind::PhasedSector;
  int lineCount = 128;     ///< 1 to 4096; of each elevation, when a matrix
  double depthMm = 160.0;  ///< > 0, along each line from the face
  double sectorDeg = 90.0; ///< opening angle between the outermost lines, all but linear, (0, 180). Radial: (0, 360],
                           ///< where 360 closes the circle and the last line stands one step before the first
  double radiusMm = 60.0;  ///< curvilinear and radial: radius of the face, > 0
  double widthMm = 38.0;   ///< linear: distance between the outermost lines, > 0
  int elevationLineCount = 32;      ///< matrix: 1 to 4096, at most 65536 lines altogether
  double elevationSectorDeg = 60.0; ///< matrix: opening angle between the outermost elevations, (0, 180)

  /// Of all elevations.
  int totalLineCount() const { return kind == ScanKind::Matrix ? lineCount * elevationLineCount : lineCount; }
  /// Whether the line before the first is the last one.
  bool closesCircle() const { return kind == ScanKind::Radial && sectorDeg == 360.0 && lineCount > 1; }
  /// Distance of the face from the centre that the lines of a fan come from; 0 for lines from an apex.
  double faceRadiusMm() const;
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

/// The lines in order of increasing lateral position (a matrix: for each elevation, in increasing order), in world
/// coordinates.
///
/// A matrix's elevation is a phased sector whose plane is turned by phi about the lateral axis: its line at angle theta
/// points to (lateral, elevational, axial) = (sin theta, cos theta sin phi, cos theta cos phi).
std::vector<ScanLine> makeScanLines(const ScanGeometry& geometry, const ProbePose& pose);

/// Position in the probe's image plane, (lateral, axial) mm from the pose's position, of depth `r` on a line whose
/// index may be fractional; and back. `beamFromPlane` returns (line, r) with line in [0, lineCount - 1] and r in
/// [0, depthMm]; points outside of that (beyond 1e-3 line or mm, for rounding) give NaN. On a closed circle line is in
/// [0, lineCount), where the first line follows the last. A curvilinear face's centre of curvature lies at
/// axial = -radiusMm; a radial one's at (0, 0), where a sector's lines all start. A matrix's plane is that of phi = 0.
/// The geometry must be valid.
Vec2f planeFromBeam(const ScanGeometry& geometry, double line, double r);
Vec2f beamFromPlane(const ScanGeometry& geometry, double lateralMm, double axialMm);

/// The same in the volume that a matrix scans: (lateral, elevational, axial) mm of depth `r` on a line of an elevation,
/// both fractional; and back, as (line, elevation, r), NaN for points outside. The geometry must be a valid matrix.
Vec3d volumeFromBeam(const ScanGeometry& geometry, double line, double elevation, double r);
Vec3d beamFromVolume(const ScanGeometry& geometry, const Vec3d& positionMm);

/// What the lines cover, to draw: polylines of (lateral, elevational, axial) mm in the frame of the pose, first the
/// border of the scanned area, then the face; of a volume the border of its far end, then its four edges. A closed
/// one ends where it started. Arcs have at most 2 degrees a step. Throws as validate().
std::vector<std::vector<Vec3d>> scanOutline(const ScanGeometry& geometry);

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

/// Reads a preset: a JSON object with "name", "scan" ("linear", "phased_sector", "curvilinear", "matrix" or "radial")
/// and numbers, each as {"value": ..., "source": "..."}: numberOfLines, depthMm, widthMm (linear), sectorDeg (the
/// others), radiusMm (curvilinear, radial), numberOfElevations and elevationSectorDeg (matrix), centreFrequencyMHz,
/// fractionalBandwidth, elementCount, elementWidthMm, elementHeightMm, kerfMm, elevationFocusMm, transmitFocusMm.
/// Throws Error naming file and key for one that is missing, out of range or unknown.
ProbePreset readProbePreset(const std::string& path);

} // namespace sono
