#pragma once

#include <string>
#include <vector>

namespace sono {

/// How the scan lines are laid out: a number of `scanKinds`.
enum class ScanKind
{
  Linear,       ///< parallel lines over the aperture's width
  PhasedSector, ///< lines from one apex on the face
  Curvilinear,  ///< lines along the radii of a convex face
  Matrix,       ///< lines from one apex over a grid of angles: a 3-D volume, or a plane of it
  Radial        ///< lines along the radii of a catheter, in the plane across it (ICE, IVUS)
};

/// Where the lines of a plane come from.
enum class LineOrigin
{
  Aperture,   ///< parallel from a flat face
  Apex,       ///< one point, at the pose's position
  ConvexFace, ///< the radii of a face that bulges towards the body; its middle is at the pose's position
  Catheter    ///< the radii of a circle around the pose's position
};

/// All that distinguishes a kind: presets, filters, panel, widget and scan conversion ask here.
struct ScanKindTraits
{
  const char* presetName; ///< in a preset file
  const char* label;      ///< in a panel
  const char* lines;      ///< how they lie, in a sentence that lists the kinds
  const char* dicomType;  ///< DICOM's Transducer Type (PS3.3 C.8.5.6.1.4)
  LineOrigin origin;
  bool takesPart;                   ///< a line is sent and heard by a part of the elements, those about its start
  bool isMatrix;                    ///< each elevation is such a plane, turned about the lateral axis
  double maxSectorDeg;              ///< of the outermost lines; 360 is allowed, 180 is not
  std::vector<std::string> numbers; ///< of ScanGeometry: those that it uses and not all do
};

/// By ScanKind.
const std::vector<ScanKindTraits>& scanKinds();

/// Throws Error when there is no such kind.
const ScanKindTraits& traitsOf(ScanKind kind);

/// For panels and sentences.
std::vector<const char*> scanKindLabels();
const char* scanKindSentence();

} // namespace sono
