#pragma once

#include "Labels/AssignTissues.h"
#include "Labels/LabelVolume.h"
#include "Labels/TissueTable.h"

#include <random>
#include <string>
#include <vector>

namespace sono {

/// What became of windows in volumes that were cut at random.
struct CutFigures
{
  int cuts = 0;
  int windows = 0;        ///< all that were offered
  int onCutFaces = 0;     ///< of these, on no skin, or before what was cut away (WindowCuts::isOnSkin)
  int withoutWindow = 0;  ///< cuts
  double deepestMm = 0.0; ///< of a filled part's windows, the way out of the whole's body
};

/// Cuts a body at random and looks for windows in what is left. A cut is a box with sides of 30 to 100 % of the
/// whole's, as a crop leaves it; in a map with skin it is one time in four what lies on one side of a plane askew, and
/// the rest becomes 0.
class WindowCuts
{
public:
  /// `dataDir` holds the tables. `isFilled`: the map has no skin, so that each cut is filled, and so is the whole, for
  /// the truth.
  WindowCuts(LabelVolume whole, bool isFilled, const std::string& dataDir, unsigned seed);

  /// Adds a number of cuts, the n-th with the n-th of `targets` and so on in turn.
  void run(int count, const std::vector<std::string>& targets, CutFigures& figures);

  /// Whether a probe stands on skin there, and not on a cut. In a map that has skin: the whole has skin within 5 mm,
  /// and outside of it nothing of the body. In a filled one, where skin is an estimate that depends on what the part
  /// has: the part has its own skin within 5 mm with air outside, and the way out from there, in a width of 20 mm,
  /// leaves the whole's body before it leaves the part's box. On a cut face, or beside one, that way meets what was cut
  /// away.
  bool isOnSkin(const LabelVolume& part, const Vec3d& world, const Vec3d& outward) const;
  /// The way out of the whole's body from a place, at most 60 mm.
  double wayOutMm(const Vec3d& world, const Vec3d& outward) const;

private:
  LabelVolume cutBox();
  LabelVolume cutAskew();
  double random(double low, double high);

  TissueTable table_;
  LabelTissueMap map_;
  LabelVolume whole_;
  LabelVolume truth_; ///< the whole, filled where it has no skin
  bool isFilled_;
  std::mt19937 random_;
};

} // namespace sono
