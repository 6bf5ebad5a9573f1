#include "Echo/NestedLines.h"

#include <algorithm>

namespace sono {

namespace {

constexpr int bricksTogether = 256; // whose scatterers are made and heard at once: as many as stay close to a core

/// What lines take of the scatterers of bricks, some rows at a time.
class LinesOfBricks
{
public:
  LinesOfBricks(const EchoSetup& setup, const std::vector<BeamReach>& beams, NestedRoom& room,
                std::vector<LineSum>& sums)
    : nested_(*setup.nested)
    , density_(setup.density->view())
    , grid_(lineGrid(sums.front()))
    , beams_(beams)
    , sums_(sums)
    , room_(room)
  {
    room_.shares.resize(std::max(room_.shares.size(), beams.size()));
  }

  void add(int level, const BrickRow& row)
  {
    for (std::size_t i = 0; i < beams_.size(); ++i)
    {
      room_.shares[i].meet(beams_[i].beam, i, row, room_.bricks.count(), density_, level);
    }
    room_.bricks.append(row.brick(0), row.axis(), row.count());
    if (room_.bricks.count() >= bricksTogether)
    {
      finish(level);
    }
  }
  /// Adds what the rows of the level so far echo.
  void finish(int level)
  {
    if (room_.bricks.count() == 0)
    {
      return;
    }
    room_.wanted.assign(std::size_t(room_.bricks.count()), 0);
    for (std::size_t i = 0; i < beams_.size(); ++i)
    {
      room_.shares[i].share(beams_[i].beam, level, room_.wanted.data());
    }
    nested_.generate(level, room_.bricks, room_.wanted.data(), room_.scatterers);
    for (std::size_t i = 0; i < beams_.size(); ++i)
    {
      if (room_.shares[i].takesAny())
      {
        splat(room_.shares[i].hear(room_.scatterers, beams_[i].beam.axis), beams_[i].beam, grid_, sums_[i]);
      }
      room_.shares[i].clear();
    }
    room_.bricks.clear();
  }

private:
  const NestedScatterers& nested_;
  DensityView density_;
  LineGrid grid_;
  const std::vector<BeamReach>& beams_;
  std::vector<LineSum>& sums_;
  NestedRoom& room_;
};

} // namespace

void addNested(const EchoSetup& setup, const std::vector<BeamReach>& beams, const YieldPoint& yieldPoint,
               NestedRoom& room, std::vector<LineSum>& sums)
{
  const DensityView density = setup.density->view();
  LinesOfBricks lines(setup, beams, room, sums);
  for (int level = density.finest; level <= density.coarsest; ++level)
  {
    const ScattererDensity::Range range = setup.density->range(level);
    std::vector<BeamReach> reaching = beams;
    for (BeamReach& beam : reaching)
    {
      beam.share = isGaussian(beam.beam) ? nestedReach : 1.0f;
      beam.fromMm = range.fromMm;
      beam.depthMm = std::min(beam.depthMm, range.toMm);
      beam.sight = setup.nestedSight.empty() ? nullptr : &setup.nestedSight[std::size_t(level - density.finest)];
    }
    forBrickRows(setup.nested->grid(level), reaching, [&](const BrickRow& row) {
      yieldPoint();
      lines.add(level, row);
    });
    lines.finish(level);
  }
}

} // namespace sono
