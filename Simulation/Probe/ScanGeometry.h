#pragma once

#include "Core/Parameters.h"
#include "Core/SoundSpeed.h"
#include "Kernel/PlaneScan.h"
#include "Kernel/Vec.h"
#include "Probe/ImagingMode.h"
#include "Probe/ScanKinds.h"

#include <string>
#include <vector>

namespace sono {

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
  int lineCount = 128;
  double depthMm = 160.0;  ///< along each line from the face, as it is shown
  double sectorDeg = 90.0; ///< 360 closes a radial probe's circle: the last line stands one step before the first
  double radiusMm = 60.0;
  double widthMm = 38.0;
  int elevationLineCount = 32; ///< at most 65536 lines altogether
  double elevationSectorDeg = 60.0;
  int compoundFans = 1; ///< spatial compounding, of kinds whose lines have starts of their own
  double compoundSpanDeg = 20.0;
  double assumedSoundSpeedMPerS = 1540.0; ///< with which the scanner turns time into the distance that it shows

  /// The numbers that a kind does not have (see ScanKinds.h) are not used and may be anything.
  template<class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitLayout(self, visitor);
    visitSoundSpeed(self, visitor);
    visitCompounding(self, visitor);
  }
  /// What a preset says.
  template<class Self, class Visitor>
  static void visitLayout(Self& self, Visitor&& visitor)
  {
    visitor(self.kind, Parameter{ "scanKind", "Scan Kind", {}, scanKindSentence(), scanKindLabels() });
    visitor(self.lineCount, Parameter{ "lineCount", "Line Count", between(1, 4096),
                                       "Number of scan lines, 1 to 4096, no unit; of a matrix, in each elevation." });
    visitor(self.depthMm,
            Parameter{ "depthMm", "Depth (mm)", above(0), "Depth along each scan line from the face in mm, above 0." });
    visitor(self.sectorDeg, Parameter{ "sectorDeg", "Sector (deg)", aboveUpTo(0, 360),
                                       "Angle between the outermost lines in degrees, between 0 and 180, or up to 360 "
                                       "where they may close a circle." });
    visitor(self.radiusMm, Parameter{ "radiusMm", "Radius (mm)", above(0), "Radius of a round face in mm, above 0." });
    visitor(self.widthMm, Parameter{ "widthMm", "Width (mm)", above(0),
                                     "Distance of the outermost lines on a flat face in mm, above 0." });
    visitor(self.elevationLineCount,
            Parameter{ "elevationLineCount", "Elevation Line Count", between(1, 4096),
                       "Elevations of a matrix probe, 1 to 4096, no unit; at most 65,536 lines altogether. 1 makes a "
                       "picture of the plane in the middle instead of a volume." });
    visitor(self.elevationSectorDeg,
            Parameter{ "elevationSectorDeg", "Elevation Sector (deg)", inside(0, 180),
                       "Angle between the outermost elevations of a matrix probe in degrees, between 0 and 180." });
  }
  template<class Self, class Visitor>
  static void visitSoundSpeed(Self& self, Visitor&& visitor)
  {
    visitor(
      self.assumedSoundSpeedMPerS,
      Parameter{ "assumedSoundSpeedMPerS", "Assumed Sound Speed (m per s)", between(1400, 1700),
                 "Speed of sound with which the scanner turns the time of an echo into the distance that it "
                 "shows, in m/s, 1400 to 1700. Faster tissue is shown too near, slower tissue too deep; the model "
                 "Amadou 2024 takes all tissue for one of 1540 m/s." });
  }
  template<class Self, class Visitor>
  static void visitCompounding(Self& self, Visitor&& visitor)
  {
    visitor(self.compoundFans,
            Parameter{ "compoundFans", "Compound Fans", between(1, maxCompoundFans),
                       "Number of fans, each steered to another angle, whose images are averaged (spatial "
                       "compounding), 1 to 15, no unit. The lines from one point see each place from one side only: "
                       "there is nothing to compound." });
    visitor(self.compoundSpanDeg, Parameter{ "compoundSpanDeg", "Compound Span (deg)", between(0, 60),
                                             "Angle between the outermost of these fans in degrees, 0 to 60." });
  }

  /// Whether the kind uses a number, and what it may be.
  bool uses(const Parameter& number) const;
  Range rangeOf(const Parameter& number) const;
  /// Whether the array has rows that are focused by delays, too: a matrix.
  bool isMatrix() const { return traitsOf(kind).isMatrix; }
  /// Whether the lines fill a volume instead of a plane: those of a matrix of more than one elevation.
  bool isVolume() const { return isMatrix() && elevationLineCount > 1; }
  LineOrigin lineOrigin() const { return traitsOf(kind).origin; }
  /// Fans that are compounded; of lines from one point, 1.
  int fanCount() const { return traitsOf(kind).takesPart ? compoundFans : 1; }
  /// How far a fan is steered, from the first, towards the lateral beginning, to the last.
  double steeringDeg(int fan) const;
  /// What is shown of a millimetre of range, which all stages count at 1540 m/s; exactly 1 there.
  double shownPerRange() const { return assumedSoundSpeedMPerS / (1000.0 * assumedSoundSpeedMmPerUs); }
  /// The range that is shown at the lines' ends, mm: how deep the stages look.
  double rangeMm() const { return depthMm / shownPerRange(); }
  /// Of all elevations or fans.
  int totalLineCount() const { return lineCount * (isVolume() ? elevationLineCount : fanCount()); }
  /// Whether the line before the first is the last one.
  bool closesCircle() const { return traitsOf(kind).maxSectorDeg == 360.0 && sectorDeg == 360.0 && lineCount > 1; }
  /// Distance of the face from the centre that the lines of a fan come from; 0 for lines from an apex.
  double faceRadiusMm() const;
  /// Where that centre lies before the pose's position: behind a convex face.
  double fanCentreAxialMm() const;
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
  /// Share of the axis along the array and across it: how far the line is steered away from the face's normal. 0 for
  /// lines that leave the face straight.
  double steeringLateral = 0.0;
  double steeringElevational = 0.0;
};

/// The lines in order of increasing lateral position (a matrix: for each elevation, compounded ones: for each fan, in
/// increasing order), in world coordinates. A steered line starts where the straight one does.
///
/// A matrix's elevation is a phased sector whose plane is turned by phi about the lateral axis: its line at angle theta
/// points to (lateral, elevational, axial) = (sin theta, cos theta sin phi, cos theta cos phi).
std::vector<ScanLine> makeScanLines(const ScanGeometry& geometry, const ProbePose& pose);
/// Of several poses, one after the other.
std::vector<ScanLine> makeScanLines(const ScanGeometry& geometry, const std::vector<ProbePose>& poses);

/// Position in the probe's image plane, (lateral, axial) mm from the pose's position, of depth `r` on a line whose
/// index may be fractional; and back; of lines that are not steered. `beamFromPlane` returns (line, r) with line in [0,
/// lineCount - 1] and r in [0, depthMm]; points outside of that (beyond 1e-3 line or mm, for rounding) give NaN. On a
/// closed circle line is in [0, lineCount), where the first line follows the last. A curvilinear face's centre of
/// curvature lies at axial = -radiusMm; a radial one's at (0, 0), where a sector's lines all start. A matrix's plane is
/// that of phi = 0. The geometry must be valid.
Vec2f planeFromBeam(const ScanGeometry& geometry, double line, double r);
Vec2f beamFromPlane(const ScanGeometry& geometry, double lateralMm, double axialMm);

/// The plane's map for the kernels: beamFromPlane in single precision; of steered fans their own (see PlaneScan).
PlaneBeams planeBeams(const ScanGeometry& geometry);

/// Bounding box of the scanned plane, symmetric about the axis. A single line has no width.
struct PlaneExtent
{
  double halfWidthMm;
  double axialMinMm;
  double axialMaxMm;
};
PlaneExtent planeExtent(const ScanGeometry& geometry);

/// The same in the volume that a matrix scans: (lateral, elevational, axial) mm of depth `r` on a line of an elevation,
/// both fractional; and back, as (line, elevation, r), NaN for points outside. The geometry must be a valid matrix.
Vec3d volumeFromBeam(const ScanGeometry& geometry, double line, double elevation, double r);
Vec3d beamFromVolume(const ScanGeometry& geometry, const Vec3d& positionMm);

/// What the lines cover, to draw: polylines of (lateral, elevational, axial) mm in the frame of the pose, first the
/// border of the scanned area, then the face; of a volume the border of its far end, then its four edges. A closed
/// one ends where it started. Arcs have at most 2 degrees a step. Throws as validate().
std::vector<std::vector<Vec3d>> scanOutline(const ScanGeometry& geometry);

/// The active aperture that makes the beam of a line (Data/docs/physics.md section 12.1). 0: not named.
struct BeamAperture
{
  double apertureMm = 0.0;
  double elevationApertureMm = 0.0;
  double transmitFocusMm = 0.0;
  double elevationFocusMm = 0.0;
  double elementWidthMm = 0.0;
  bool elevationIsArray = false; ///< of a matrix: focused across the plane by delays, as along it, and not by a lens

  /// Whether it says how wide the beam is.
  bool isNamed() const { return apertureMm > 0.0 && elevationApertureMm > 0.0; }
  /// Focus across the plane when transmitting.
  double focusAcrossMm() const { return elevationIsArray ? transmitFocusMm : elevationFocusMm; }

  template<class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor(self.apertureMm, Parameter{ "apertureMm", "Aperture (mm)", between(0, 1000),
                                        "Width of the elements that send and receive a line, along the array, in mm, 0 "
                                        "to 1000. 0: not known; the beam then has the same width at each depth, the "
                                        "sigmas of the image formation, and all paths of a line start at one point." });
    visitor(self.elevationApertureMm,
            Parameter{ "elevationApertureMm", "Elevation Aperture (mm)", between(0, 1000),
                       "Height of the elements, of a matrix that of all of them together, in mm, 0 to 1000. 0: not "
                       "known, as for the aperture." });
    visitor(self.transmitFocusMm, Parameter{ "transmitFocusMm", "Transmit Focus (mm)", between(0, 10000),
                                             "Depth at which the transmitted beam is focused, in mm, 0 to 10,000. 0: "
                                             "not focused." });
    visitor(self.elevationFocusMm,
            Parameter{ "elevationFocusMm", "Elevation Focus (mm)", between(0, 10000),
                       "Depth at which the lens focuses across the image plane, in mm, 0 to 10,000; not for a matrix. "
                       "0: not focused." });
    visitor(self.elementWidthMm,
            Parameter{ "elementWidthMm", "Element Width (mm)", between(0, 1000),
                       "Width of one element in mm, 0 to 1000: the wider it is, the weaker are steered lines. 0: a "
                       "point." });
  }
};

bool operator==(const BeamAperture& a, const BeamAperture& b);

/// What a probe is, wherever it stands. One that says nothing has the aperture of the bundled P4-2.
struct ProbeSettings : BeamAperture
{
  ProbeSettings()
    : BeamAperture{ 20.455, 14.0, 65.0, 60.0, 0.295, false }
  {
  }

  ScanGeometry geometry;
  double centreFrequencyMHz = 2.5;
  double fractionalBandwidth = 0.6; ///< at -6 dB
  ImagingMode imagingMode = ImagingMode::Fundamental;
  /// Of the harmonic alone. 1 MPa is chosen: a P4-2 that sends 1.8 MHz through 0.5 dB/(cm MHz) makes 1.5 MPa at its
  /// focus of it, a mechanical index of 1.1.
  double facePressureKPa = 1000.0;
  int elementCount = 64;
  double kerfMm = 0.025;

  template<class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitPreset(self, visitor);
    ScanGeometry::visitSoundSpeed(self.geometry, visitor);
    ScanGeometry::visitCompounding(self.geometry, visitor);
    visitMode(self, visitor);
  }
  template<class Self, class Visitor>
  static void visitPreset(Self& self, Visitor&& visitor)
  {
    ScanGeometry::visitLayout(self.geometry, visitor);
    visitPulse(self, visitor);
    BeamAperture::visit(self, visitor);
    visitElements(self, visitor);
  }
  template<class Self, class Visitor>
  static void visitPulse(Self& self, Visitor&& visitor)
  {
    visitor(self.centreFrequencyMHz, Parameter{ "centreFrequencyMHz", "Centre Frequency (MHz)", above(0),
                                                "Centre frequency of the pulse in MHz, above 0." });
    visitor(self.fractionalBandwidth, Parameter{ "fractionalBandwidth", "Fractional Bandwidth", inside(0, 2),
                                                 "Bandwidth of the pulse at -6 dB as a part of the centre frequency, "
                                                 "between 0 and 2, no unit." });
  }

  /// Of the array as it is built, for files of lines: no picture depends on them.
  template<class Self, class Visitor>
  static void visitElements(Self& self, Visitor&& visitor)
  {
    visitor(self.elementCount,
            Parameter{
              "elementCount", "Element Count", between(0, 65536),
              "Elements of the array, of a matrix of all its rows together, 0 to 65,536, no unit, as files of RF lines "
              "have them. Where the aperture or the lines' face needs more, it is so many." });
    visitor(self.kerfMm, Parameter{ "kerfMm", "Kerf (mm)", between(0, 1000),
                                    "Gap between two elements in mm, 0 to 1000, as files of RF lines have it." });
  }

  /// No preset says it.
  template<class Self, class Visitor>
  static void visitMode(Self& self, Visitor&& visitor)
  {
    visitor(self.imagingMode,
            Parameter{ "imagingMode",
                       "Imaging Mode",
                       {},
                       "What makes the picture: the sound that was sent, or its second harmonic, which grows on the "
                       "way and comes back at twice the Centre Frequency. A scanner sends lower for that: 1.5 to 2 MHz "
                       "into a heart.",
                       { "Fundamental", "Harmonic" } });
    visitor(self.facePressureKPa,
            Parameter{ "facePressureKPa", "Face Pressure (kPa)", aboveUpTo(0, 10000),
                       "Amplitude of the pressure at the transducer's face in kPa, above 0 up to 10,000; of the "
                       "harmonic alone, which grows in proportion to it." });
  }

  double receivedMHz() const { return sono::receivedMHz(imagingMode, centreFrequencyMHz); }
  double receivedBandwidth() const { return sono::receivedBandwidth(imagingMode, fractionalBandwidth); }
  /// The aperture, as image formation wants it.
  BeamAperture aperture() const;
};

/// The same as a preset file gives it; its aperture is that of the active elements (see apertureOf). A matrix has as
/// many elements along the array as across it.
struct ProbePreset : ProbeSettings
{
  std::string name;
  double elementHeightMm = 0.0; ///< of a matrix, too, that of one element
};

/// Reads a preset: a JSON object with "name", "scan" (a kind's presetName, see ScanKinds.h) and numbers, each as
/// {"value": ..., "source": "..."}: numberOfLines, depthMm, those of the kind (numberOfElevations for
/// elevationLineCount), centreFrequencyMHz, fractionalBandwidth, elementCount, elementWidthMm, elementHeightMm, kerfMm,
/// elevationFocusMm, transmitFocusMm. Throws Error naming file and key for one that is missing, out of range or
/// unknown.
ProbePreset readProbePreset(const std::string& path);

} // namespace sono
