// Any segmentation: names of public lists that no rule knows, or knows as another tissue.
#include "Labels/AssignTissues.h"
#include "Labels/CsvFile.h"
#include "Stage.h"

#include <cstddef>
#include <string>

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

void measureLabels()
{
  measureNames();
}

const Stage stage("labels", measureLabels);

} // namespace
} // namespace sono
