#include "Phantoms/PhantomTargets.h"

#include "Core/Progress.h"
#include "Labels/CsvFile.h"

#include <cmath>

namespace sono {

namespace {

class TargetRows
{
public:
  explicit TargetRows(const std::string& path)
    : csv_(CsvFile::read(path))
  {
  }

  std::vector<PhantomTarget> targets() const
  {
    std::vector<PhantomTarget> targets;
    for (const CsvFile::Row& row : csv_.rows)
    {
      targets.push_back(target(row));
    }
    if (targets.empty())
    {
      throw Error("'" + csv_.path + "' holds no targets: add a line for each wire or cylinder");
    }
    return targets;
  }

private:
  const std::string& field(const CsvFile::Row& row, const char* column) const
  {
    return row.fields[std::size_t(csv_.requiredColumn(column))];
  }

  [[noreturn]] void refuse(const CsvFile::Row& row, const char* column, const std::string& range) const
  {
    throw Error(csv_.where(row) + ": '" + field(row, column) + "' in column '" + column + "' must be " + range);
  }

  double number(const CsvFile::Row& row, const char* column, double low, double high) const
  {
    const auto value = parseNumber(field(row, column));
    if (!value || !(*value >= low && *value <= high))
    {
      refuse(row, column, "a number from " + std::to_string(low) + " to " + std::to_string(high));
    }
    return *value;
  }

  PhantomTarget target(const CsvFile::Row& row) const
  {
    PhantomTarget target;
    const std::string& kind = field(row, "kind");
    if (kind != "wire" && kind != "cylinder")
    {
      refuse(row, "kind", "'wire' or 'cylinder'");
    }
    target.kind = kind == "wire" ? PhantomTargetKind::Wire : PhantomTargetKind::Cylinder;
    const double view = number(row, "view", 1.0, phantomViewCount);
    if (view != std::floor(view))
    {
      refuse(row, "view", "a whole number");
    }
    target.view = int(view);
    target.name = field(row, "name");
    target.lateralMm = number(row, "lateral_mm", -1000.0, 1000.0);
    target.depthMm = number(row, "depth_mm", 0.01, 1000.0);
    target.diameterMm = number(row, "diameter_mm", 0.001, 1000.0);
    target.tissue = field(row, "tissue");
    if (target.tissue.empty())
    {
      refuse(row, "tissue", "the name of a tissue");
    }
    return target;
  }

  CsvFile csv_;
};

} // namespace

std::vector<PhantomTarget> readPhantomTargets(const std::string& path)
{
  return TargetRows(path).targets();
}

} // namespace sono
