#include "HiddenVessels.h"

#include "Echo/FormRf.h"
#include "Folders.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Scene/AddScan.h"
#include "Stage.h"

#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace sono {

namespace {

constexpr double cellMm = 3.0;

/// A tree of three levels in a plane: a trunk, two branches, four twigs; distances in mm from its middle.
bool isVessel(const Vec3d& p)
{
  struct Tube
  {
    Vec2d from;
    Vec2d to;
    double radiusMm;
  };
  static const Tube tubes[] = { { { -25, 0 }, { -5, 0 }, 3.5 },   { { -5, 0 }, { 10, 12 }, 2.8 },
                                { { -5, 0 }, { 10, -12 }, 2.8 },  { { 10, 12 }, { 25, 10 }, 2.2 },
                                { { 10, 12 }, { 20, 25 }, 2.2 },  { { 10, -12 }, { 25, -9 }, 2.2 },
                                { { 10, -12 }, { 21, -25 }, 2.2 } };
  for (const Tube& tube : tubes)
  {
    const Vec2d along = tube.to - tube.from;
    const Vec2d q = Vec2d(p.x, p.z) - tube.from;
    const double t = glm::clamp(glm::dot(q, along) / glm::dot(along, along), 0.0, 1.0);
    if (glm::length(Vec3d(q - t * along, p.y)) < tube.radiusMm)
    {
      return true;
    }
  }
  return false;
}

struct Sums
{
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;

  void add(double a, double b)
  {
    n += 1.0;
    x += a;
    y += b;
    xx += a * a;
    yy += b * b;
    xy += a * b;
  }
  double correlation() const { return (n * xy - x * y) / std::sqrt((n * xx - x * x) * (n * yy - y * y)); }
};

} // namespace

void measureHiddenVessels()
{
  const std::string data = dataFolder();
  const auto map = LabelTissueMap::read(data + "/label_tissues.csv");
  const auto table = TissueTable::read(data + "/tissues.csv");
  LabelVolume volume = makeThoraxPhantom(1.0);
  std::map<int, std::string> tissueOf;
  {
    LabelVolume named = volume;
    assignTissues(named, map, table, "soft_tissue");
    for (const LabelInfo& label : named.labels)
    {
      tissueOf[label.id] = label.tissue;
    }
  }
  const GridPlacement& grid = volume.placement;
  const auto forVoxels = [&](const auto& visit) {
    std::size_t at = 0;
    for (int k = 0; k < grid.size.z; ++k)
    {
      for (int j = 0; j < grid.size.y; ++j)
      {
        for (int i = 0; i < grid.size.x; ++i, ++at)
        {
          visit(at, grid.worldFromIndex(Vec3d(i, j, k)));
        }
      }
    }
  };
  Vec3d middle(0.0);
  double count = 0.0;
  forVoxels([&](std::size_t at, const Vec3d& p) {
    const bool isLiver = tissueOf[volume.voxels[at]] == "liver";
    middle += isLiver ? p : Vec3d(0.0);
    count += isLiver ? 1.0 : 0.0;
  });
  if (count == 0.0)
  {
    throw std::runtime_error("the bundled thorax has no liver");
  }
  middle /= count;
  IntensityVolume scan;
  scan.placement = grid;
  scan.values.resize(volume.voxels.size());
  const std::map<std::string, float> hu{
    { "air", -1000.0f }, { "lung", -850.0f }, { "cortical_bone", 500.0f }, { "fat", -100.0f }, { "skin", 0.0f }
  };
  forVoxels([&](std::size_t at, const Vec3d& p) {
    const std::string& tissue = tissueOf[volume.voxels[at]];
    const auto found = hu.find(tissue);
    scan.values[at] = found == hu.end() ? 50.0f : found->second;
    scan.values[at] -= tissue == "liver" && isVessel(p - middle) ? 50.0f : 0.0f;
  });
  ScanDetailSettings settings;
  settings.fillFromCt = false;
  const AddedScan added = addScan(volume, scan, map, table, settings);
  assignTissues(volume, map, table, "soft_tissue");

  EchoSettings echo;
  echo.depthMm = 70.0;
  echo.lateralSigmaMm = echo.elevationalSigmaMm = 0.8;
  echo.centreFrequencyMHz = 4.0;
  std::vector<ScanLine> lines;
  for (int l = 0; l < 80; ++l)
  {
    ScanLine line;
    line.originMm = middle + Vec3d(-30.0 + 0.75 * l, 0.0, 35.0);
    line.axis = { 0.0, 0.0, -1.0 };
    line.lateral = { 1.0, 0.0, 0.0 };
    line.elevation = { 0.0, 1.0, 0.0 };
    lines.push_back(line);
  }
  const auto structure = [&](std::vector<std::uint8_t> detail) {
    const Scene scene(volume, table, "air", std::move(detail));
    const RfLines rf = formRf({ &scene, nullptr, nullptr }, lines, echo);
    struct Cell
    {
      double power = 0.0, vessel = 0.0, liver = 0.0, samples = 0.0;
    };
    std::map<std::pair<int, int>, Cell> cells;
    for (int l = 0; l < rf.lineCount; ++l)
    {
      for (int s = 0; s < rf.sampleCount; ++s)
      {
        const Vec3d p = lines[std::size_t(l)].originMm + lines[std::size_t(l)].axis * (s * rf.sampleMm);
        const Vec3i v(glm::round(grid.indexFromWorld(p)));
        if (glm::any(glm::lessThan(v, Vec3i(0))) || glm::any(glm::greaterThanEqual(v, grid.size)))
        {
          continue;
        }
        const std::size_t at =
          std::size_t(v.x) + std::size_t(grid.size.x) * (std::size_t(v.y) + std::size_t(grid.size.y) * v.z);
        Cell& cell = cells[{ int(std::floor(p.x / cellMm)), int(std::floor(p.z / cellMm)) }];
        cell.power += std::norm(rf.iq[std::size_t(l) * std::size_t(rf.sampleCount) + std::size_t(s)]);
        cell.vessel += isVessel(p - middle) ? 1.0 : 0.0;
        cell.liver += tissueOf[volume.voxels[at]] == "liver" ? 1.0 : 0.0;
        cell.samples += 1.0;
      }
    }
    Sums sums;
    for (const auto& [place, cell] : cells)
    {
      if (cell.liver == cell.samples) // all of it, away from walls that shine
      {
        sums.add(-10.0 * std::log10(cell.power / cell.samples), cell.vessel / cell.samples);
      }
    }
    return sums.correlation();
  };
  const double with = structure(added.detail);
  const double without = structure({});
  printFigure("ct_detail_structure_with", with, "of_1");
  printFigure("ct_detail_structure_without", without, "of_1");
  printFigure("ct_detail_ssim_gain", with - without, "of_1");
}

} // namespace sono
