// Any segmentation: names of public lists that no rule knows, or knows as another tissue; windows in volumes cut at
// random.
#include "Folders.h"
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
  const LabelTissueMap map = LabelTissueMap::read(dataFile("label_tissues.csv"));
  const CsvFile names = CsvFile::read(labelNamesFile());
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
  const std::string data = dataFolder();
  CutFigures figures;
  WindowCuts(makeThoraxPhantom(2.0), false, data, 1).run(1000, { "heart", "liver", "", "aorta lumen" }, figures);
  const std::filesystem::path shared = sharedDataFolder();
  CutFigures filled;
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
  std::fprintf(stderr,
               "windows_on_cut_faces: windows that stand on no skin of the whole (within 5 mm, nothing of the "
               "body outside). In a map without skin, where part and whole are filled: on no skin of the part's "
               "fill, or from where the way out meets what was cut away of the body before it is outside.\n");
  printFigure("windows_on_cut_faces", figures.onCutFaces + filled.onCutFaces, "windows", "0");
  printFigure("windows_cuts", figures.cuts + filled.cuts, "cuts");
  printFigure("windows_found", figures.windows + filled.windows, "windows");
  printFigure("windows_cuts_without", figures.withoutWindow + filled.withoutWindow, "cuts");
  printFigure("windows_filled_found", filled.windows, "windows");
  printFigure("windows_filled_deepest_mm", filled.deepestMm, "mm"); // below the skin that the whole's fill has
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
