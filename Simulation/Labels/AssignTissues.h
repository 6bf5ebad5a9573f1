#pragma once

#include "Labels/LabelVolume.h"
#include "Labels/TissueTable.h"

#include <string>
#include <utility>
#include <vector>

namespace sono {

/// Which tissue a label name stands for: rows of (pattern, tissue), first match wins. A pattern is compared
/// with the whole name, without regard to case; `*` stands for any run of characters.
class LabelTissueMap
{
public:
  /// CSV with columns pattern,tissue and lines starting with '#'. Throws Error naming the file and line.
  static LabelTissueMap read(const std::string& path);

  void add(std::string pattern, std::string tissue);
  /// Empty when no pattern matches.
  std::string find(const std::string& labelName) const;
  const std::vector<std::pair<std::string, std::string>>& rows() const { return rows_; }

private:
  std::vector<std::pair<std::string, std::string>> rows_;
};

/// Fills LabelInfo::tissue where it is empty. Labels that no pattern matches fall to `fallback`; their names
/// are returned, for one warning. Throws Error when a tissue (of the map, a label or the fallback) is not in
/// the table, naming the label and the tissue.
std::vector<std::string> assignTissues(LabelVolume& volume, const LabelTissueMap& map, const TissueTable& table,
                                       const std::string& fallback);

} // namespace sono
