#include "Labels/LabelTable.h"

#include "Core/Progress.h"
#include "Labels/CsvFile.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

namespace sono {

namespace {

namespace fs = std::filesystem;

constexpr const char* endings[] = { ".csv", ".label", ".ctbl", ".txt" };

bool isWhole(double value, double maximum)
{
  return value >= 0.0 && value <= maximum && value == std::floor(value);
}

bool isCsv(const std::string& path)
{
  const std::string ending = fs::path(path).extension().string();
  return ending == ".csv" || ending == ".CSV";
}

/// A number of a table within [0, maximum]; throws Error naming file, line and column.
double tableNumber(const CsvFile& csv, const CsvFile::Row& row, int column, double maximum)
{
  const std::string& text = row.fields[std::size_t(column)];
  const auto value = parseNumber(text);
  if (!value || !isWhole(*value, maximum))
  {
    throw Error(csv.where(row) + " has '" + text + "' in column '" + csv.header[std::size_t(column)] +
                "'; write a whole number from 0 to " + std::to_string(int(maximum)) + ".");
  }
  return *value;
}

/// The columns id, name, red, green, blue of either kind of CSV file; -1 for one that is not there.
std::array<int, 5> columnsOf(const CsvFile& csv)
{
  if (csv.column("LabelValue") >= 0)
  {
    return { csv.column("LabelValue"), csv.column("Name"), csv.column("Color_R"), csv.column("Color_G"),
             csv.column("Color_B") };
  }
  return { csv.column("id"), csv.column("name"), csv.column("r"), csv.column("g"), csv.column("b") };
}

std::vector<LabelInfo> labelsFromCsv(const std::string& path)
{
  const CsvFile csv = CsvFile::read(path);
  const auto column = columnsOf(csv);
  if (column[0] < 0 || column[1] < 0)
  {
    csv.requiredColumn("id");
    csv.requiredColumn("name");
  }
  const bool colored = *std::min_element(column.begin() + 2, column.end()) >= 0;
  const int tissue = csv.column("tissue");
  std::vector<LabelInfo> labels;
  for (const CsvFile::Row& row : csv.rows)
  {
    LabelInfo label;
    label.id = int(tableNumber(csv, row, column[0], 65535.0));
    label.name = row.fields[std::size_t(column[1])];
    if (colored && !row.fields[std::size_t(column[2])].empty())
    {
      for (std::size_t c = 0; c < 3; ++c)
      {
        label.color[c] = float(tableNumber(csv, row, column[2 + c], 255.0) / 255.0);
      }
      label.hasColor = true;
    }
    if (tissue >= 0)
    {
      label.tissue = row.fields[std::size_t(tissue)];
    }
    labels.push_back(std::move(label));
  }
  return labels;
}

/// The words of a line; a quoted one keeps its opening quote as a mark.
std::vector<std::string> wordsOf(const std::string& line)
{
  std::vector<std::string> words;
  for (std::size_t at = 0; at < line.size();)
  {
    if (std::isspace(static_cast<unsigned char>(line[at])))
    {
      ++at;
      continue;
    }
    const bool quoted = line[at] == '"';
    std::size_t end = quoted ? line.find('"', at + 1) : line.find_first_of(" \t\r", at);
    end = std::min(end, line.size());
    words.push_back(line.substr(at, end - at));
    at = end + (quoted ? 1 : 0);
  }
  return words;
}

bool setColor(const std::vector<std::string>& words, std::size_t first, LabelInfo& label)
{
  for (std::size_t c = 0; c < 3; ++c)
  {
    const auto value = parseNumber(words[first + c]);
    if (!value || !(*value >= 0.0 && *value <= 255.0))
    {
      return false;
    }
    label.color[c] = float(*value / 255.0);
  }
  label.hasColor = true;
  return true;
}

/// A line of one of the three kinds of text; empty when it is of none.
std::optional<LabelInfo> labelFromWords(const std::vector<std::string>& words)
{
  const auto id = parseNumber(words.front());
  if (!id || !isWhole(*id, 65535.0) || words.size() < 2)
  {
    return std::nullopt;
  }
  LabelInfo label;
  label.id = int(*id);
  if (words.size() == 8 && words.back()[0] == '"') // ITK-SNAP
  {
    label.name = words.back().substr(1);
    return setColor(words, 1, label) ? std::optional(label) : std::nullopt;
  }
  std::size_t numbers = 0; // at the end of the line
  while (numbers + 2 < words.size() && parseNumber(words[words.size() - 1 - numbers]))
  {
    ++numbers;
  }
  if (numbers >= 4)
  {
    numbers = 4;
    if (!setColor(words, words.size() - 4, label))
    {
      return std::nullopt;
    }
  }
  for (std::size_t n = 1; n + numbers < words.size(); ++n)
  {
    label.name += (n > 1 ? " " : "") + words[n].substr(words[n][0] == '"' ? 1 : 0);
  }
  return numbers <= 1 || numbers == 4 ? std::optional(label) : std::nullopt;
}

std::vector<LabelInfo> labelsFromText(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
  {
    throw Error("cannot read '" + path + "': no such file, or no permission to read it.");
  }
  std::vector<LabelInfo> labels;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number)
  {
    const std::vector<std::string> words = wordsOf(line);
    if (words.empty() || words.front()[0] == '#' || (labels.empty() && !parseNumber(words.front())))
    {
      continue;
    }
    auto label = labelFromWords(words);
    if (!label)
    {
      throw Error("'" + path + "' line " + std::to_string(number) +
                  " names no label; write a number from 0 to 65535 and a name.");
    }
    if (label->id != 0 || label->name != "Clear Label")
    {
      labels.push_back(std::move(*label));
    }
  }
  if (labels.empty())
  {
    throw Error("'" + path + "' names no label; begin a line with a label's number, then its name.");
  }
  return labels;
}

bool holdsLabels(const fs::path& path)
{
  std::error_code error;
  if (!fs::is_regular_file(path, error))
  {
    return false;
  }
  if (isCsv(path.string()))
  {
    // A broken line of a table that is meant for us is the user's to know of; a table for others is not.
    const auto column = columnsOf(CsvFile::read(path.string()));
    return column[0] >= 0 && column[1] >= 0;
  }
  try
  {
    return !labelsFromText(path.string()).empty();
  }
  catch (const Error&)
  {
    return false;
  }
}

/// The longest `<start>_labels<ending>` in the folder for which `name` begins with <start>_.
std::string tableOfSeries(const fs::path& folder, const std::string& name, const std::string& ending)
{
  for (std::size_t at = name.rfind('_'); at != std::string::npos && at > 0; at = name.rfind('_', at - 1))
  {
    const fs::path candidate = folder / (name.substr(0, at) + "_labels" + ending);
    if (holdsLabels(candidate))
    {
      return candidate.string();
    }
  }
  return {};
}

} // namespace

std::vector<LabelInfo> readLabels(const std::string& path)
{
  return isCsv(path) ? labelsFromCsv(path) : labelsFromText(path);
}

std::string labelTableBeside(const std::string& stem)
{
  const fs::path folder = fs::path(stem).parent_path();
  for (const char* ending : endings)
  {
    if (holdsLabels(stem + ending))
    {
      return stem + ending;
    }
  }
  for (const char* ending : endings)
  {
    const std::string table = tableOfSeries(folder, fs::path(stem).filename().string(), ending);
    if (!table.empty())
    {
      return table;
    }
  }
  for (const char* ending : endings)
  {
    const fs::path table = folder / (std::string("labels") + ending);
    if (holdsLabels(table))
    {
      return table.string();
    }
  }
  return {};
}

} // namespace sono
