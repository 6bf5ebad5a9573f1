#include "Labels/AssignTissues.h"

#include "Core/Progress.h"
#include "Labels/CsvFile.h"

#include <cctype>
#include <cstddef>

namespace sono {

namespace {

bool sameLetter(char a, char b)
{
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

/// Whether `text` matches a pattern in which '*' stands for any run of characters.
bool matches(const std::string& pattern, const std::string& text)
{
  std::size_t p = 0;
  std::size_t t = 0;
  std::size_t star = std::string::npos; // the last '*' seen, and how far it reaches so far
  std::size_t starEnd = 0;
  while (t < text.size())
  {
    if (p < pattern.size() && pattern[p] == '*')
    {
      star = p++;
      starEnd = t;
    }
    else if (p < pattern.size() && sameLetter(pattern[p], text[t]))
    {
      ++p;
      ++t;
    }
    else if (star != std::string::npos)
    {
      p = star + 1;
      t = ++starEnd;
    }
    else
    {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string::npos;
}

} // namespace

LabelTissueMap LabelTissueMap::read(const std::string& path)
{
  const CsvFile csv = CsvFile::read(path);
  const auto pattern = std::size_t(csv.requiredColumn("pattern"));
  const auto tissue = std::size_t(csv.requiredColumn("tissue"));
  LabelTissueMap map;
  for (const CsvFile::Row& row : csv.rows)
  {
    if (row.fields[pattern].empty() || row.fields[tissue].empty())
    {
      throw Error(csv.where(row) + " lacks a pattern or a tissue; write both, or remove the line.");
    }
    map.add(row.fields[pattern], row.fields[tissue]);
  }
  return map;
}

void LabelTissueMap::add(std::string pattern, std::string tissue)
{
  rows_.emplace_back(std::move(pattern), std::move(tissue));
}

std::string LabelTissueMap::find(const std::string& labelName) const
{
  for (const auto& [pattern, tissue] : rows_)
  {
    if (matches(pattern, labelName))
    {
      return tissue;
    }
  }
  return {};
}

std::vector<std::string> assignTissues(LabelVolume& volume, const LabelTissueMap& map, const TissueTable& table,
                                       const std::string& fallback)
{
  if (!table.find(fallback))
  {
    throw Error("the tissue '" + fallback +
                "' for labels without a pattern is not in the tissue table; choose one of "
                "its tissues.");
  }
  std::vector<LabelInfo> labels = volume.labels; // so that an Error leaves the volume as it was
  std::vector<std::string> unmatched;
  for (LabelInfo& label : labels)
  {
    if (label.tissue.empty())
    {
      label.tissue = map.find(label.name);
    }
    if (label.tissue.empty())
    {
      unmatched.push_back(label.name);
      label.tissue = fallback;
    }
    if (!table.find(label.tissue))
    {
      throw Error("the tissue '" + label.tissue + "' of label " + std::to_string(label.id) + " '" + label.name +
                  "' is not in the tissue table; add it there or choose another.");
    }
  }
  volume.labels = std::move(labels);
  return unmatched;
}

} // namespace sono
