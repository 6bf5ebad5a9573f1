#include "Labels/LabelTable.h"

#include "Core/Progress.h"
#include "Labels/CsvFile.h"
#include "Labels/LabelCode.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>

namespace sono {

namespace {

namespace fs = std::filesystem;

constexpr const char* endings[] = { ".csv", ".label", ".ctbl", ".tsv", ".txt" };

bool isWhole(double value, double maximum)
{
  return value >= 0.0 && value <= maximum && value == std::floor(value);
}

/// Whether the file is a table with a header line, rather than text.
bool hasColumns(const std::string& path)
{
  const std::string ending = fs::path(path).extension().string();
  return ending == ".csv" || ending == ".CSV" || ending == ".tsv" || ending == ".TSV";
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

/// Whether each field of a column, where it is there, is a whole number: other tables have names in a column "label".
bool isNumbers(const CsvFile& csv, int column)
{
  return column >= 0 && std::all_of(csv.rows.begin(), csv.rows.end(), [&](const CsvFile::Row& row) {
           const auto value = parseNumber(row.fields[std::size_t(column)]);
           return value && isWhole(*value, 65535.0);
         });
}

/// The columns of a table, by what it calls the first; -1 for one that is not there.
struct LabelColumns
{
  int id = -1;
  int name = -1;
  std::array<int, 3> channels{ -1, -1, -1 };
  int hexColor = -1; ///< "#rrggbb"

  explicit LabelColumns(const CsvFile& csv)
  {
    const bool isSlicers = csv.column("LabelValue") >= 0;
    const bool isBids = !isSlicers && csv.column("index") >= 0;
    id = csv.column(isSlicers ? "LabelValue" : isBids ? "index" : "id");
    id = id < 0 && isNumbers(csv, csv.column("label")) ? csv.column("label") : id;
    name = csv.column(isSlicers ? "Name" : "name");
    const std::array<const char*, 3> colors = isSlicers ? std::array<const char*, 3>{ "Color_R", "Color_G", "Color_B" }
                                                        : std::array<const char*, 3>{ "r", "g", "b" };
    std::transform(colors.begin(), colors.end(), channels.begin(), [&csv](const char* c) { return csv.column(c); });
    hexColor = isBids ? csv.column("color") : -1;
  }
  bool found() const { return id >= 0 && name >= 0; }
};

/// "#rrggbb"; leaves the label as it is for anything else.
void setHexColor(const std::string& text, LabelInfo& label)
{
  if (text.size() != 7 || text[0] != '#' || text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
  {
    return;
  }
  for (std::size_t c = 0; c < 3; ++c)
  {
    label.color[c] = float(std::stoi(text.substr(1 + 2 * c, 2), nullptr, 16)) / 255.0f;
  }
  label.hasColor = true;
}

/// What the property type of a segment is, where a table of 3D Slicer has the columns.
void describeByColumns(const CsvFile& csv, const CsvFile::Row& row, LabelInfo& label)
{
  const auto field = [&](const std::string& sequence, const std::string& part) {
    const int column = csv.column(sequence + "CodeSequence." + part);
    return column < 0 ? std::string() : row.fields[std::size_t(column)];
  };
  const auto codeOf = [&field](const std::string& sequence) -> CodedConcept {
    return { field(sequence, "CodingSchemeDesignator"), field(sequence, "CodeValue"), field(sequence, "CodeMeaning") };
  };
  describeByCode(codeOf("SegmentedPropertyType"), codeOf("SegmentedPropertyTypeModifier"), label);
}

std::vector<LabelInfo> labelsFromColumns(const CsvFile& csv)
{
  const LabelColumns column(csv);
  if (!column.found())
  {
    csv.requiredColumn("id");
    csv.requiredColumn("name");
  }
  const bool colored = *std::min_element(column.channels.begin(), column.channels.end()) >= 0;
  const int tissue = csv.column("tissue");
  std::vector<LabelInfo> labels;
  for (const CsvFile::Row& row : csv.rows)
  {
    LabelInfo label;
    label.id = int(tableNumber(csv, row, column.id, 65535.0));
    label.name = row.fields[std::size_t(column.name)];
    if (colored && !row.fields[std::size_t(column.channels[0])].empty())
    {
      for (std::size_t c = 0; c < 3; ++c)
      {
        label.color[c] = float(tableNumber(csv, row, column.channels[c], 255.0) / 255.0);
      }
      label.hasColor = true;
    }
    if (column.hexColor >= 0)
    {
      setHexColor(row.fields[std::size_t(column.hexColor)], label);
    }
    if (tissue >= 0)
    {
      label.tissue = row.fields[std::size_t(tissue)];
    }
    describeByColumns(csv, row, label);
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

/// A line of 3D Slicer's colour tables for a colour without a name.
bool isNameless(const std::vector<std::string>& words)
{
  return (words.size() == 5 && std::all_of(words.begin(), words.end(), [](const auto& w) { return parseNumber(w); })) ||
         (words.size() == 6 && words[1] == "(none)");
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
    if (words.empty() || words.front()[0] == '#' || (labels.empty() && !parseNumber(words.front())) ||
        isNameless(words))
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
  if (hasColumns(path.string()))
  {
    // A broken line of a table that is meant for us is the user's to know of; a table for others is not.
    return LabelColumns(CsvFile::read(path.string())).found();
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

/// The first of the paths that holds labels; empty when none does.
std::string firstOf(const std::vector<fs::path>& candidates)
{
  const auto found = std::find_if(candidates.begin(), candidates.end(), holdsLabels);
  return found == candidates.end() ? std::string() : found->string();
}

std::vector<fs::path> withEndings(const fs::path& stem)
{
  std::vector<fs::path> paths;
  for (const char* ending : endings)
  {
    paths.emplace_back(stem.string() + ending);
  }
  return paths;
}

/// The files of a folder, by name.
std::vector<fs::path> filesOf(const fs::path& folder)
{
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator at(folder.empty() ? fs::path(".") : folder, error), end; !error && at != end;
       at.increment(error))
  {
    files.push_back(folder / at->path().filename());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool startsWith(const std::string& text, const std::string& start)
{
  return text.compare(0, start.size(), start) == 0;
}

bool isTable(const fs::path& path)
{
  return std::any_of(std::begin(endings), std::end(endings), [&path](const char* e) { return path.extension() == e; });
}

/// The longest `<start>_labels<ending>` in the folder for which `name` begins with <start>_.
std::string tableOfSeries(const fs::path& folder, const std::string& name)
{
  for (const char* ending : endings)
  {
    for (std::size_t at = name.rfind('_'); at != std::string::npos && at > 0; at = name.rfind('_', at - 1))
    {
      const fs::path candidate = folder / (name.substr(0, at) + "_labels" + ending);
      if (holdsLabels(candidate))
      {
        return candidate.string();
      }
    }
  }
  return {};
}

/// A table whose name goes on where the label map's ends: NAME-lut.ctbl, NAME_ColorTable.ctbl.
std::string tableThatGoesOn(const std::vector<fs::path>& files, const std::string& name)
{
  std::vector<fs::path> candidates;
  std::copy_if(files.begin(), files.end(), std::back_inserter(candidates), [&name](const fs::path& file) {
    const std::string stem = file.stem().string();
    return isTable(file) && startsWith(stem, name) && stem.size() > name.size() &&
           std::isalnum(static_cast<unsigned char>(stem[name.size()])) == 0;
  });
  return firstOf(candidates);
}

std::set<std::string> entitiesOf(const std::string& name)
{
  std::set<std::string> entities;
  std::istringstream stream(name);
  for (std::string part; std::getline(stream, part, '_');)
  {
    entities.insert(part);
  }
  return entities;
}

/// BIDS: a `..._dseg.tsv` holds for the label maps in its folder and below that have all parts of its name. The data
/// set ends where its description lies.
std::string tableOfDataset(fs::path folder, const std::string& name)
{
  const std::set<std::string> own = entitiesOf(name);
  std::error_code error;
  folder = fs::absolute(folder, error);
  const bool isDataset = own.count("dseg") > 0;
  for (int level = 0; isDataset && level < 6 && !error; ++level, folder = folder.parent_path())
  {
    std::vector<fs::path> candidates;
    for (const fs::path& file : filesOf(folder))
    {
      const std::set<std::string> theirs = entitiesOf(file.stem().string());
      if (file.extension() == ".tsv" && theirs.count("dseg") > 0 &&
          std::includes(own.begin(), own.end(), theirs.begin(), theirs.end()))
      {
        candidates.push_back(file);
      }
    }
    const std::string table = firstOf(candidates);
    if (!table.empty() || fs::exists(folder / "dataset_description.json", error))
    {
      return table;
    }
  }
  return {};
}

/// The only .ctbl or .label of the folder, unless it bears the name of another file there.
std::string onlyTable(const std::vector<fs::path>& files)
{
  std::vector<fs::path> tables;
  std::copy_if(files.begin(), files.end(), std::back_inserter(tables), [](const fs::path& file) {
    return (file.extension() == ".ctbl" || file.extension() == ".label") && holdsLabels(file);
  });
  const auto isNamesake = [&tables](const fs::path& file) {
    return file != tables[0] && startsWith(file.filename().string(), tables[0].stem().string() + ".");
  };
  return tables.size() == 1 && std::none_of(files.begin(), files.end(), isNamesake) ? tables[0].string()
                                                                                    : std::string();
}

} // namespace

std::vector<LabelInfo> readLabels(const std::string& path)
{
  return hasColumns(path) ? labelsFromColumns(CsvFile::read(path)) : labelsFromText(path);
}

std::vector<LabelInfo> parseLabels(const std::string& text, const std::string& name)
{
  return labelsFromColumns(CsvFile::parse(text, name));
}

std::string labelTableBeside(const std::string& stem)
{
  const fs::path folder = fs::path(stem).parent_path();
  const std::string name = fs::path(stem).filename().string();
  const std::vector<fs::path> files = filesOf(folder);
  std::string table = firstOf(withEndings(stem));
  table = table.empty() ? tableOfSeries(folder, name) : table;
  table = table.empty() ? tableThatGoesOn(files, name) : table;
  table = table.empty() ? tableOfDataset(folder, name) : table;
  table = table.empty() ? firstOf(withEndings(folder / "labels")) : table;
  return table.empty() ? onlyTable(files) : table;
}

} // namespace sono
