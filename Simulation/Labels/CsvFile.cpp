#include "Labels/CsvFile.h"

#include "Core/Progress.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>

namespace sono {

namespace {

std::string trimmed(const std::string& text)
{
  const char* blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  return first == std::string::npos ? std::string() : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Takes one field off `line` at `position`, leaving it behind the comma; false for a broken quote.
bool takeField(const std::string& line, std::size_t& position, std::string& field)
{
  const std::size_t start = line.find_first_not_of(" \t", position);
  if (start == std::string::npos || line[start] != '"')
  {
    const std::size_t comma = std::min(line.find(',', position), line.size());
    field = trimmed(line.substr(position, comma - position));
    position = comma + 1;
    return true;
  }
  field.clear();
  std::size_t at = start + 1;
  for (; at < line.size(); ++at)
  {
    if (line[at] == '"' && (at + 1 == line.size() || line[at + 1] != '"'))
    {
      break;
    }
    at += line[at] == '"' ? 1 : 0; // "" stands for one quote
    field += line[at];
  }
  if (at >= line.size())
  {
    return false;
  }
  const std::size_t comma = std::min(line.find(',', at), line.size());
  position = comma + 1;
  return trimmed(line.substr(at + 1, comma - at - 1)).empty();
}

bool isTabbed(const std::string& path)
{
  return path.size() > 4 &&
         (path.compare(path.size() - 4, 4, ".tsv") == 0 || path.compare(path.size() - 4, 4, ".TSV") == 0);
}

std::vector<std::string> splitAtTabs(const std::string& line)
{
  std::vector<std::string> fields;
  for (std::size_t position = 0; position <= line.size();)
  {
    const std::size_t tab = std::min(line.find('\t', position), line.size());
    fields.push_back(trimmed(line.substr(position, tab - position)));
    position = tab + 1;
  }
  return fields;
}

std::vector<std::string> splitLine(const std::string& line, const std::string& where)
{
  std::vector<std::string> fields;
  for (std::size_t position = 0; position <= line.size();)
  {
    std::string field;
    if (!takeField(line, position, field))
    {
      throw Error(where + " has a quote that does not enclose a whole field; close it before the next comma.");
    }
    fields.push_back(std::move(field));
  }
  return fields;
}

CsvFile readTable(std::istream& stream, const std::string& path)
{
  CsvFile csv;
  csv.path = path;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number)
  {
    if (number == 1 && line.compare(0, 3, "\xEF\xBB\xBF") == 0)
    {
      line.erase(0, 3); // the byte order mark that spreadsheets write
    }
    const std::string content = trimmed(line);
    if (content.empty() || content[0] == '#')
    {
      continue;
    }
    CsvFile::Row row;
    row.line = number;
    row.fields = isTabbed(path) ? splitAtTabs(line) : splitLine(content, csv.where(row));
    if (csv.header.empty())
    {
      csv.header = std::move(row.fields);
      continue;
    }
    if (row.fields.size() > csv.header.size())
    {
      throw Error(csv.where(row) + " has " + std::to_string(row.fields.size()) + " fields for " +
                  std::to_string(csv.header.size()) + " columns; put quotes around a field that holds a comma.");
    }
    row.fields.resize(csv.header.size());
    csv.rows.push_back(std::move(row));
  }
  if (csv.header.empty())
  {
    throw Error("'" + path + "' has no header line; begin it with the names of its columns.");
  }
  return csv;
}

} // namespace

CsvFile CsvFile::read(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
  {
    throw Error("cannot read '" + path + "': no such file, or no permission to read it.");
  }
  return readTable(stream, path);
}

CsvFile CsvFile::parse(const std::string& text, const std::string& name)
{
  std::istringstream stream(text);
  return readTable(stream, name);
}

int CsvFile::column(const std::string& name) const
{
  const auto at = std::find(header.begin(), header.end(), name);
  return at == header.end() ? -1 : int(at - header.begin());
}

int CsvFile::requiredColumn(const std::string& name) const
{
  const int index = column(name);
  if (index < 0)
  {
    throw Error("'" + path + "' has no column '" + name + "'; add it to the header line.");
  }
  return index;
}

std::string CsvFile::where(const Row& row) const
{
  return "'" + path + "' line " + std::to_string(row.line);
}

std::optional<double> parseNumber(const std::string& text)
{
  const char* first = text.data();
  const char* last = first + text.size();
  first += first != last && *first == '+' ? 1 : 0;
  double value = 0.0;
  const auto [end, error] = std::from_chars(first, last, value);
  if (error != std::errc() || end != last)
  {
    return std::nullopt;
  }
  return value;
}

std::string csvField(const std::string& text)
{
  const bool edgeBlank = trimmed(text) != text;
  if (text.find_first_of(",\"#\r\n") == std::string::npos && !edgeBlank)
  {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text)
  {
    quoted += c == '"' ? std::string("\"\"") : std::string(1, c == '\n' || c == '\r' ? ' ' : c);
  }
  return quoted + "\"";
}

} // namespace sono
