#include "Scene/AddScan.h"

#include "Labels/CtFill.h"

#include <cmath>

namespace sono {

namespace {

constexpr const char* outsideTissue = "air";
constexpr const char* unknownTissue = "soft_tissue";
constexpr double reachesAll = 0.98; // of the labelled voxels: masks may stand over the border by a voxel

} // namespace

AddedScan addScan(LabelVolume& volume, const IntensityView& scan, const LabelTissueMap& map, const TissueTable& table,
                  const ScanDetailSettings& settings, const Progress& progress)
{
  requireInRange(settings);
  volume.collectLabels();
  LabelVolume before; // their tissues
  before.labels = volume.labels;
  assignTissues(volume, map, table, unknownTissue);
  const MatchedScan matched = matchScan(volume, scan, partOf(progress, 0.0, 0.2));
  std::vector<ScanOfLabel> means = scanOfLabels(volume, matched, partOf(progress, 0.2, 0.25));
  requireSamePatient(volume, matched, means);
  AddedScan added;
  added.isCt = matched.isCt;
  if (!matched.notice.empty())
  {
    added.notices.push_back(matched.notice);
  }
  if (matched.reachedShare < reachesAll)
  {
    added.notices.push_back(
      "The scan ends before the labels: " + std::to_string(std::lround(100.0 * matched.reachedShare)) +
      " % of the labelled voxels lie in it, the others stay as the labels alone have them; if files of a "
      "DICOM series are missing, copy the whole series.");
  }
  if (matched.isCt && settings.fillFromCt)
  {
    added.names =
      fillFromCt(volume, matched, settings.skinMm, meanOfTissue(volume, means, "blood"), partOf(progress, 0.25, 0.6));
    assignTissues(volume, map, table, unknownTissue);
    means = scanOfLabels(volume, matched, partOf(progress, 0.6, 0.65));
  }
  added.detail = scanDetail(volume, matched, means, outsideTissue, settings, partOf(progress, 0.65, 1.0));
  for (LabelInfo& label : volume.labels)
  {
    const LabelInfo* known = before.find(label.id);
    label.tissue = known ? known->tissue : std::string();
  }
  return added;
}

} // namespace sono
