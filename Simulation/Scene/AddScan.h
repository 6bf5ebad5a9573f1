#pragma once

#include "Labels/AssignTissues.h"
#include "Labels/ReadIntensities.h"
#include "Scene/ScanDetail.h"

#include <string>
#include <vector>

namespace sono {

/// What a scan added to a label map.
struct AddedScan
{
  bool isCt = false;
  std::vector<std::string> names;   ///< of the labels that label 0 became
  std::vector<std::uint8_t> detail; ///< see scanDetail
  std::vector<std::string> notices; ///< sentences on what the scan was taken for and does not reach
};

/// Matches a scan to a label map (matchScan), refuses one of another patient (requireSamePatient), names what a CT
/// shows where the map has 0 (fillFromCt, unless the settings say otherwise) and makes the detail (scanDetail). The
/// tissues that the labels' names stand for tell what to expect; labels that have one keep it, the others have none
/// afterwards. Throws Error and Aborted as these do.
AddedScan addScan(LabelVolume& volume, const IntensityView& scan, const LabelTissueMap& map, const TissueTable& table,
                  const ScanDetailSettings& settings, const Progress& progress = {});

} // namespace sono
