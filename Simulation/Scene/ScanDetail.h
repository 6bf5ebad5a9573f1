#pragma once

#include "Core/Parameters.h"
#include "Core/Progress.h"
#include "Labels/MatchedScan.h"

#include <cstdint>
#include <vector>

namespace sono {

/// Which way a tissue's backscatter goes with the values of a scan.
enum class DetailDirection
{
  Automatic, ///< falls in a CT whose blood has a contrast agent, else rises
  Rises,
  Falls
};

/// How a scan's values change the backscatter within each label, and what becomes of label 0.
struct ScanDetailSettings
{
  double detailDbPer100Hu = 15.0;
  DetailDirection direction = DetailDirection::Automatic;
  bool fillFromCt = true;
  double skinMm = 2.0;

  template<class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor(
      self.detailDbPer100Hu,
      Parameter{ "detailDbPer100Hu", "Detail (dB per 100 HU)", between(0, 200),
                 "How much the backscatter within a label follows a CT, dB per 100 HU, 0 to 200; of an MR, dB per "
                 "standard deviation of all its values or half their mean, whichever is more." });
    visitor(self.direction,
            Parameter{ "detailDirection",
                       "Detail Direction",
                       {},
                       "Whether backscatter rises or falls with the scan's values. Automatic: it falls in a CT with "
                       "contrast agent (blood above 90 HU), so that vessels are dark, and rises otherwise.",
                       { "Automatic", "Rises", "Falls" } });
    visitor(self.fillFromCt, Parameter{ "fillFromCt",
                                        "Fill From CT",
                                        {},
                                        "Whether what has label 0 inside the body becomes skin, fat, muscle, lung, "
                                        "bone and gas, as a CT shows them." });
    visitor(self.skinMm, Parameter{ "skinMm", "Skin (mm)", between(0, 20),
                                    "Thickness of the skin that a CT's fill makes, in mm, 0 to 20." });
  }
};

/// The backscatter's level against its tissue's table, in steps of `detailStepDb`, one code a voxel of the label map;
/// Kernel/DetailCode.h says what a code means. Within each label (Data/docs/physics.md eq. 11.5)
///   L = clamp(s (h - <h>), +-10 dB) - 10 log10 <10^(L/10)>
/// with the value h smoothed by (1 2 1)/4 along each axis over voxels of the same label, its mean <h> over the label
/// and the slope s of the settings: so the label's mean backscatter coefficient stays that of its tissue. Where the
/// scan does not reach and in labels of `outsideTissue` L = 0. `means` are those of scanOfLabels, each label has its
/// tissue. Throws Error for a setting out of range, Aborted.
std::vector<std::uint8_t> scanDetail(const LabelVolume& labels, const MatchedScan& scan,
                                     const std::vector<ScanOfLabel>& means, const std::string& outsideTissue,
                                     const ScanDetailSettings& settings, const Progress& progress = {});

/// The codes of a grid on a larger one with the same voxels, such as batheOrgan makes; around them there is no detail.
std::vector<std::uint8_t> detailOnLargerGrid(const std::vector<std::uint8_t>& codes, const GridPlacement& own,
                                             const GridPlacement& larger);

} // namespace sono
