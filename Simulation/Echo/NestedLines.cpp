#include "Echo/NestedLines.h"

#include "Echo/NestedShares.h"

#include <algorithm>

namespace sono {

namespace {

constexpr int bricksTogether = 256; // whose scatterers are made and heard at once: as many as stay close to a core

/// What lines take of the scatterers of bricks, some rows at a time.
class LinesOfBricks
{
public:
  LinesOfBricks(const EchoSetup& setup, const std::vector<BeamReach>& beams, std::vector<LineSum>& sums)
    : nested_(*setup.nested)
    , density_(setup.density->view())
    , grid_(lineGrid(sums.front()))
    , beams_(beams)
    , sums_(sums)
    , shares_(beams.size())
  {
  }

  void add(int level, const BrickRow& row)
  {
    for (std::size_t i = 0; i < beams_.size(); ++i)
    {
      shares_[i].meet(beams_[i].beam, i, row, bricks_.count(), density_, level);
    }
    bricks_.append(row.brick(0), row.axis(), row.count());
    if (bricks_.count() >= bricksTogether)
    {
      finish(level);
    }
  }
  /// Adds what the rows of the level so far echo.
  void finish(int level)
  {
    if (bricks_.count() == 0)
    {
      return;
    }
    wanted_.assign(std::size_t(bricks_.count()), 0);
    for (std::size_t i = 0; i < beams_.size(); ++i)
    {
      shares_[i].share(beams_[i].beam, level, wanted_.data());
    }
    nested_.generate(level, bricks_, wanted_.data(), scatterers_);
    for (std::size_t i = 0; i < beams_.size(); ++i)
    {
      if (shares_[i].takesAny())
      {
        splat(shares_[i].hear(scatterers_, beams_[i].beam.axis), beams_[i].beam, grid_, sums_[i]);
      }
      shares_[i].clear();
    }
    bricks_.clear();
  }

private:
  const NestedScatterers& nested_;
  DensityView density_;
  LineGrid grid_;
  const std::vector<BeamReach>& beams_;
  std::vector<LineSum>& sums_;
  NestedBricks bricks_;
  std::vector<NestedShares> shares_; // of each beam
  std::vector<int> wanted_;
  NestedScatterers::Generated scatterers_;
};

} // namespace

void addNested(const EchoSetup& setup, const std::vector<BeamReach>& beams, const YieldPoint& yieldPoint,
               std::vector<LineSum>& sums)
{
  const DensityView density = setup.density->view();
  LinesOfBricks lines(setup, beams, sums);
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
