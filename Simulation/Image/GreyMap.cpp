#include "Image/GreyMap.h"

#include "Core/Error.h"
#include "Labels/CsvFile.h"

#include <utility>

namespace sono {
namespace {

constexpr int stepCount = 1024;

double numberIn(const CsvFile& file, const CsvFile::Row& row, int column)
{
  const std::string& text = row.fields[std::size_t(column)];
  const std::optional<double> number = parseNumber(text);
  if (!number || !(*number >= 0.0 && *number <= 1.0))
  {
    throw Error(file.where(row) + ": '" + text + "' is no " + file.header[std::size_t(column)] +
                " from 0 to 1; correct it.");
  }
  return *number;
}

std::vector<std::pair<double, double>> pointsOf(const CsvFile& file)
{
  const int levels = file.requiredColumn("level");
  const int greys = file.requiredColumn("grey");
  std::vector<std::pair<double, double>> points;
  for (const CsvFile::Row& row : file.rows)
  {
    points.emplace_back(numberIn(file, row, levels), numberIn(file, row, greys));
    if (points.size() > 1 && !(points.back().first > points[points.size() - 2].first))
    {
      throw Error(file.where(row) + ": its level is not above that of the line before; sort the lines by level.");
    }
  }
  if (points.size() < 2 || points.front().first != 0.0 || points.back().first != 1.0)
  {
    throw Error("'" + file.path + "': the levels of a grey map begin at 0 and end at 1; add these lines.");
  }
  return points;
}

} // namespace

std::vector<float> readGreyMap(const std::string& path)
{
  const auto points = pointsOf(CsvFile::read(path));
  std::vector<float> map;
  std::size_t next = 1;
  for (int step = 0; step <= stepCount; ++step)
  {
    const double level = double(step) / stepCount;
    while (points[next].first < level)
    {
      ++next;
    }
    const auto& [below, dark] = points[next - 1];
    const auto& [above, bright] = points[next];
    map.push_back(float(dark + (bright - dark) * (level - below) / (above - below)));
  }
  return map;
}

} // namespace sono
