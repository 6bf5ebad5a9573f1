#include "Report.h"

#include "Labels/CsvFile.h"
#include "Progress.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

namespace sono::study {
namespace {

std::string escaped(const std::string& text)
{
  std::string out;
  for (const char c : text)
  {
    switch (c)
    {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

void writeTable(std::ostream& html, const CsvFile& table)
{
  html << "<table><tr>";
  for (const std::string& name : table.header)
  {
    html << "<th>" << escaped(name) << "</th>";
  }
  html << "</tr>\n";
  for (const CsvFile::Row& row : table.rows)
  {
    html << "<tr>";
    for (const std::string& field : row.fields)
    {
      html << "<td>" << escaped(field) << "</td>";
    }
    html << "</tr>\n";
  }
  html << "</table>\n";
}

std::vector<std::filesystem::path> tablesIn(const std::filesystem::path& folder)
{
  std::vector<std::filesystem::path> tables;
  if (std::filesystem::is_directory(folder))
  {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
    {
      if (entry.path().extension() == ".csv")
      {
        tables.push_back(entry.path());
      }
    }
  }
  std::sort(tables.begin(), tables.end());
  return tables;
}

} // namespace

void writeReport(const std::filesystem::path& folder)
{
  const auto tables = tablesIn(folder);
  if (tables.empty())
  {
    throw Error("'" + folder.string() + "' holds no tables: run the parts of the study first");
  }
  std::ofstream html(folder / "report.html");
  html << "<!DOCTYPE html><html><head><meta charset=\"utf-8\"><title>SonoVDB: the study</title></head><body>\n";
  for (const auto& path : tables)
  {
    html << "<h2>" << escaped(path.stem().string()) << "</h2>\n";
    writeTable(html, CsvFile::read(path.string()));
  }
  html << "</body></html>\n";
  html.flush();
  if (!html)
  {
    throw Error("'" + (folder / "report.html").string() + "' cannot be written: choose a folder that you may write to");
  }
}

} // namespace sono::study
