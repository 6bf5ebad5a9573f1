#include "PeersReport.h"

#include "Html.h"
#include "SvgPlot.h"

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>
#include <vector>

namespace sono::study {
namespace {

std::string commandOf(const char* part)
{
  return std::string("Testing/study.sh FOLDER ") + part + " report";
}

std::optional<CsvFile> tableIn(const std::filesystem::path& folder, const std::string& name, std::ostringstream& text)
{
  if (!std::filesystem::exists(folder / name))
  {
    text << htmlParagraph("Not measured: " + name + " is missing.");
    return std::nullopt;
  }
  return CsvFile::read((folder / name).string());
}

/// A scene's programs on the CPU or on a GPU, each a curve of its settings; rows without an error are no points.
std::string peersPlot(const CsvFile& csv, const std::string& scene, bool gpu)
{
  std::vector<Curve> curves;
  for (const CsvFile::Row& row : csv.rows)
  {
    if (row.fields[0] != scene || row.fields[7].empty() || gpu == (row.fields[8] == "CPU"))
    {
      continue;
    }
    const std::string name = row.fields[1] + " " + row.fields[2];
    auto curve = std::find_if(curves.begin(), curves.end(), [&](const Curve& c) { return c.name == name; });
    if (curve == curves.end())
    {
      curve = curves.insert(curve, Curve{ name, {}, {}, CurveKind::Dots });
    }
    curve->x.push_back(numberOf(row.fields[gpu ? 4 : 5]));
    curve->y.push_back(numberOf(row.fields[7]));
  }
  if (curves.empty())
  {
    return {};
  }
  return svgPlot("Scene '" + scene + (gpu ? "' on a GPU: error over time" : "': error over core seconds"),
                 { gpu ? "seconds by the wall, one call" : "seconds of all cores, one call", true },
                 { "root mean square error, share of the rms", true }, curves);
}

} // namespace

std::string peersSection(const std::filesystem::path& folder)
{
  std::ostringstream text;
  text << "<h2>Programs of others on the same scenes</h2>\n";
  const auto csv = tableIn(folder, "peers.csv", text);
  if (!csv)
  {
    return text.str();
  }
  text << htmlParagraph(
    "What every element hears of focused waves from points in water, by each program's own call, against a direct"
    " sum in double precision over pieces of the elements (peers/reference.py). Each scene is one that its "
    "programs can do, with their pulse, which ours takes from a file. 'plane': two dimensions, soft baffle. "
    "'lens': elements 14 mm high behind a lens. 'array': elements so low (0.5 mm) that points lie in their far "
    "field, as zea wants it. 'waves': a grid of waves in two dimensions, 32 line sources and 24 weak points. The "
    "others have 64 elements, three transmits and 1000 points. One factor for each transmit is free, and for "
    "theirs one delay. Seconds are of a call after the first, so that what is compiled at run time is not "
    "counted; the table has the first call, too. Those of a GPU end with the signals in the host's memory. Ours has no "
    "setting of accuracy.");
  std::vector<std::string> scenes;
  for (const CsvFile::Row& row : csv->rows)
  {
    if (!row.fields[0].empty() && std::find(scenes.begin(), scenes.end(), row.fields[0]) == scenes.end())
    {
      scenes.push_back(row.fields[0]);
      text << peersPlot(*csv, row.fields[0], false) << peersPlot(*csv, row.fields[0], true);
    }
  }
  text << htmlParagraph(
    "At equal error: of a program's settings the fastest that is no further off than ours, or than it ever comes, on "
    "the same device: on the CPU by core seconds, on a GPU by the wall.");
  for (const char* name : { "peers_equal.csv", "peers.csv", "peers_reference.csv" })
  {
    if (const auto table = tableIn(folder, name, text))
    {
      text << htmlTable(*table, commandOf("peers"));
    }
  }
  return text.str();
}

std::string growthSection(const std::filesystem::path& folder)
{
  std::ostringstream text;
  text << "<h2>Growth</h2>\n";
  const auto csv = tableIn(folder, "growth.csv", text);
  if (!csv)
  {
    return text.str();
  }
  text << htmlParagraph(
    "A scene and pictures by the Simulator with its defaults, on the CPU, each case in a process of its own, whose "
    "largest resident memory is given. The first picture lays out what the fan reaches; the next one has other paths. "
    "Labels, lines, depth, elevations and cores: a synthetic torso of 400 x 400 x 300 mm, 256 x 256 x 192 voxels, 40 "
    "labels, P4-2 with 128 lines (elevations: a matrix of 64 lines in each). Volume: the bundled thorax in voxels of 2 "
    "to 0.5 mm. Slopes are exponents, of core seconds (of cores: of the wall), with how far the worst point lies off "
    "the line; a straight line is what costs the same for each one more, its deviation in per cent of the value.");
  std::vector<std::pair<std::string, std::vector<const CsvFile::Row*>>> axes;
  for (const CsvFile::Row& row : csv->rows)
  {
    if (axes.empty() || axes.back().first != row.fields[0])
    {
      axes.push_back({ row.fields[0], {} });
    }
    axes.back().second.push_back(&row);
  }
  std::vector<Curve> memory;
  for (const auto& [name, rows] : axes)
  {
    const bool byWall = name == "cores";
    const std::string unit = byWall ? "seconds, by the wall" : "seconds of all cores";
    Curve first{ "first picture", {}, {}, CurveKind::Line };
    Curve next{ "next picture", {}, {}, CurveKind::Line };
    Curve peak{ name, {}, {}, CurveKind::Line };
    const double smallest = numberOf(rows.front()->fields[1]);
    for (const CsvFile::Row* row : rows)
    {
      for (auto [curve, column] : { std::pair{ &first, byWall ? 3 : 4 }, { &next, byWall ? 5 : 6 } })
      {
        curve->x.push_back(numberOf(row->fields[1]));
        curve->y.push_back(numberOf(row->fields[std::size_t(column)]));
      }
      peak.x.push_back(numberOf(row->fields[1]) / smallest);
      peak.y.push_back(numberOf(row->fields[7]));
    }
    if (!first.y.empty() && first.y.front() > 0.0)
    {
      text << svgPlot("Time over " + name, { name, true }, { unit, true }, { first, next });
      memory.push_back(peak);
    }
  }
  text << svgPlot("Memory over all of them", { "times the smallest", true }, { "peak, MB", true }, memory);
  for (const char* name : { "growth_slopes.csv", "growth_lines.csv", "growth.csv" })
  {
    if (const auto table = tableIn(folder, name, text))
    {
      text << htmlTable(*table, commandOf("growth"));
    }
  }
  return text.str();
}

} // namespace sono::study
