// Any segmentation: names of public lists that no rule knows, or knows as another tissue; windows in volumes cut at
// random.
#include "HiddenVessels.h"
#include "Labels/AssignTissues.h"
#include "Labels/CsvFile.h"
#include "Labels/ReadLabelMap.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Stage.h"
#include "WindowCuts.h"

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace sono {
namespace {

void measureNames()
{
  const LabelTissueMap map = LabelTissueMap::read(std::string(SONOVDB_DATA_DIR) + "/label_tissues.csv");
  const CsvFile names = CsvFile::read(SONOVDB_LABEL_NAMES);
  const auto name = std::size_t(names.requiredColumn("name"));
  const auto tissue = std::size_t(names.requiredColumn("tissue"));
  int unknown = 0;
  int wrong = 0;
  for (const CsvFile::Row& row : names.rows)
  {
    const std::string found = map.find(row.fields[name]);
    unknown += found.empty() ? 1 : 0;
    wrong += !found.empty() && found != row.fields[tissue] ? 1 : 0;
  }
  printFigure("labels_listed", double(names.rows.size()), "names");
  printFigure("labels_unknown", unknown, "names", "0");
  printFigure("labels_wrong", wrong, "names", "0");
}

void measureWindows()
{
  const std::string data = SONOVDB_DATA_DIR;
  CutFigures figures;
  WindowCuts(makeThoraxPhantom(2.0), false, data, 1).run(1000, { "heart", "liver", "", "aorta lumen" }, figures);
  const std::filesystem::path shared = SONOVDB_SHARED_DATA_DIR;
  CutFigures filled; // where the skin of the part and that of the whole are two estimates
  const auto cutFile = [&](const char* file, bool isFilled, const std::vector<std::string>& targets) {
    if (std::filesystem::exists(shared / file))
    {
      WindowCuts(readLabelMap((shared / file).string()), isFilled, data, 2)
        .run(100, targets, isFilled ? filled : figures);
    }
    else
    {
      std::fprintf(stderr, "%s is not there\n", (shared / file).c_str());
    }
  };
  cutFile("thorax_heart/thorax_heart.nii.gz", false, { "heart", "liver", "right kidney", "thyroid" });
  cutFile("totalseg_s0327/s0327_total_v2_labelmap.nii.gz", true, { "heart", "liver", "spleen", "aorta" });
  printFigure("windows_on_cut_faces", figures.onCutFaces, "windows", "0");
  printFigure("windows_cuts", figures.cuts, "cuts");
  printFigure("windows_found", figures.windows, "windows");
  printFigure("windows_cuts_without", figures.withoutWindow, "cuts");
  printFigure("windows_filled_off_skin", filled.onCutFaces, "windows");
  printFigure("windows_filled_found", filled.windows, "windows");
}

void measureLabels()
{
  measureNames();
  measureHiddenVessels();
  measureWindows();
}

const Stage stage("labels", measureLabels);

} // namespace
} // namespace sono
