#pragma once

#include "Probe/ScanGeometry.h"
#include "Probe/ViewPlans.h"
#include "Scene/Scene.h"

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace sono {

/// How much of a structure a view shows.
struct ShownStructure
{
  std::string structure;
  double percent = 0.0; ///< of its section by the ideal plane, in the image and in no shadow
};

/// A standard view of a patient, or why there is none. World LPS mm.
struct StandardView
{
  std::string name;    ///< "A4C"
  std::string title;   ///< "apical four-chamber"
  std::string preset;  ///< the probe, by the name of its preset file without extension
  std::string refusal; ///< one sentence: why it is not obtainable; empty: it is
  ProbePose pose;      ///< the best one, of a view that is refused the nearest miss; zero depth: none
  double depthMm = 0.0;
  double score = 0.0;         ///< 0 to 1
  double planeOffDeg = 0.0;   ///< between its plane and the ideal one
  double markOffMm = 0.0;     ///< its plane's distance from the apex, of a short axis from its level's centre
  double insidePercent = 0.0; ///< share of the image's area that lies within the label map's box
  std::vector<ShownStructure> shown;
  std::string shadow; ///< the tissue that takes most from what is to be shown, beyond soft tissue's loss; empty: none
  double shadowDb = 0.0; ///< that loss, one way, mean over what is to be shown
};

/// Gives the settings of a bundled probe by its preset's name.
using ProbeByPreset = std::function<ProbeSettings(const std::string& preset)>;

/// Looks for every view of planStandardViews, in its order; of those alone whose `names` are given, the others being
/// refused without a look.
///
/// A probe stands on the skin as for an acoustic window (findAcousticWindows), at no more than 55 degrees to its
/// normal, and looks as the plan says. Its plane contains the place on the skin and is that of least squares through
/// the plan's points; places where it is off by more than the plan allows do not count. From each, the image's lines
/// run straight through a grid of about 2.5 mm, rocked in the plane by up to 24 degrees. What has lost
/// 10 dB more than a way through soft tissue begins to lie in a shadow, and from 16 dB on is not shown. The score is
///   mean of the structures' shares x the worst of the shares over the least one asked, at most 1
///   x exp(-((planeOffDeg / 4)^2 + (markOffMm / 4)^2 + (2 lookOff / lookDeg)^2 + (rock / 18)^2) / 2)
///   x the image's share within the box,
/// a tenth for each 40 dB that what is shown has lost beyond soft tissue's loss, with lookOff between the plan's look
/// and the way from the place to the structures; the best places are then moved in steps down to 1.5 mm and 3 degrees.
/// A view is refused where the best one shows less of a structure than the plan asks, or where no place is left.
///
/// The same at each call. Throws what `probeOf` throws.
std::vector<StandardView> findStandardViews(const Scene& scene, const ProbeByPreset& probeOf,
                                            const Progress& progress = {}, const std::set<std::string>& names = {});

/// "A4C, apical four-chamber: shows 97 % of the left ventricle, ..., 2 degrees and 1 mm off the ideal plane." or "A4C,
/// apical four-chamber: not obtainable from this patient. ..."
std::string describe(const StandardView& view);

} // namespace sono
