#include "Echo/ComputedBeam.h"
#include "Echo/MovingScatterers.h"
#include "EchoScenes.h"
#include "ErrorText.h"
#include "Probe/ArrayField.h"
#include "Simulator.h"
#include "TestScenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>

namespace {

using namespace sono;
using namespace sono::test;

Tissue speckled(double backscatter)
{
  Tissue t = makeTissue("wall", 1.6, 1540.0, 0.0);
  t.scattererMean = 0.3;
  t.scattererSigma = 0.2;
  t.scattererProbability = 0.7;
  t.backscatterPerCmSr = backscatter;
  return t;
}

/// A block of 40 x 24 x 50 voxels of 1 mm, label 1 where asked, in label 0 that does not echo.
std::shared_ptr<const Scene> block(const std::function<bool(const Vec3d&)>& isWall,
                                   const std::function<Vec3d(const Vec3d&)>* displacement)
{
  Tissue silent = makeTissue("silent", 1.6, 1540.0, 0.0);
  LabelVolume volume = makeScene({ 40, 24, 50 }, Vec3d(1.0), { silent, speckled(1e-3) }, [&](const Vec3d& p) {
                         return isWall(p) ? 1 : 0;
                       })->volume();
  TissueTable table;
  table.add(silent);
  table.add(speckled(1e-3));
  std::shared_ptr<const TissueMotion> motion;
  if (displacement)
  {
    std::vector<Vec3f> u;
    for (int k = 0; k < 50; ++k)
    {
      for (int j = 0; j < 24; ++j)
      {
        for (int i = 0; i < 40; ++i)
        {
          u.push_back(Vec3f((*displacement)(volume.placement.worldFromIndex(Vec3d(i, j, k)))));
        }
      }
    }
    motion = std::make_shared<const TissueMotion>(volume.placement, u, std::set<int>{ 1 });
  }
  return std::make_shared<const Scene>(std::move(volume), table, "none", std::vector<std::uint8_t>{}, motion);
}

EchoSettings settings()
{
  EchoSettings s;
  s.device = Device::Cpu;
  s.centreFrequencyMHz = 2.5;
  s.depthMm = 50.0;
  return s;
}

std::vector<ScanLine> fan(const Vec3d& shift = Vec3d(0.0))
{
  std::vector<ScanLine> lines;
  for (int l = 0; l < 16; ++l)
  {
    lines.push_back(makeLine(Vec3d(12.0 + l, 12.0, 0.0) + shift, { 0.0, 0.0, 1.0 }));
  }
  return lines;
}

const std::function<bool(const Vec3d&)> everywhere = [](const Vec3d&) { return true; };

std::vector<PointScatterer> pointsOf(const std::function<Vec3d(const Vec3d&)>& u)
{
  const auto scene = block(everywhere, &u);
  return movingScatterers(*scene, movingStatistics(*scene, settings(), InterfaceModel::Acoustic));
}

/// Whether each point inside of the block by `marginMm` is one of `others`, brought there by `place`, to 1e-3 mm.
void expectMoved(const std::vector<PointScatterer>& before, const std::vector<PointScatterer>& after,
                 const std::function<Vec3d(const Vec3d&)>& place, double marginMm)
{
  const auto key = [](const Vec3d& p) {
    return std::array<long, 3>{ std::lround(p.x), std::lround(p.y), std::lround(p.z) };
  };
  std::map<std::array<long, 3>, std::vector<PointScatterer>> by;
  for (const PointScatterer& p : after)
  {
    by[key(p.positionMm)].push_back(p);
  }
  int looked = 0;
  int missed = 0;
  for (const PointScatterer& p : before)
  {
    const Vec3d to = place(p.positionMm);
    if (glm::any(glm::lessThan(to, Vec3d(marginMm))) ||
        glm::any(glm::greaterThan(to, Vec3d(40.0, 24.0, 50.0) - marginMm)))
    {
      continue;
    }
    ++looked;
    bool found = false;
    const auto home = key(to);
    for (int n = 0; n < 27 && !found; ++n)
    {
      for (const PointScatterer& q : by[{ home[0] + n % 3 - 1, home[1] + (n / 3) % 3 - 1, home[2] + n / 9 - 1 }])
      {
        found |= glm::distance(q.positionMm, to) < 1e-3 && q.amplitude == p.amplitude;
      }
    }
    missed += !found;
  }
  EXPECT_GT(looked, 10000);
  EXPECT_EQ(missed, 0) << "of " << looked;
}

TEST(TissueMotion, ScatterersRideOnATranslationARotationAndAStretch)
{
  const auto rest = pointsOf([](const Vec3d&) { return Vec3d(0.0); });
  const Vec3d shift(0.37, -1.21, 2.9);
  expectMoved(
    rest, pointsOf([&](const Vec3d&) { return shift; }), [&](const Vec3d& p) { return p + shift; }, 4.0);

  const Vec3d centre(20.0, 12.0, 25.0);
  const double angle = 0.15;
  const Mat3d turn(std::cos(angle), std::sin(angle), 0.0, -std::sin(angle), std::cos(angle), 0.0, 0.0, 0.0, 1.0);
  expectMoved(
    rest, pointsOf([&](const Vec3d& x) { return x - (centre + glm::transpose(turn) * (x - centre)); }),
    [&](const Vec3d& p) { return centre + turn * (p - centre); }, 6.0);

  const Vec3d factor(1.1, 0.8, 1.2);
  expectMoved(
    rest, pointsOf([&](const Vec3d& x) { return x - (centre + (x - centre) / factor); }),
    [&](const Vec3d& p) { return centre + factor * (p - centre); }, 4.0);
}

TEST(TissueMotion, ATranslationGivesTheTranslatedPicture)
{
  const Vec3d shift(1.3, -0.7, 2.4);
  const std::function<Vec3d(const Vec3d&)> none = [](const Vec3d&) { return Vec3d(0.0); };
  const std::function<Vec3d(const Vec3d&)> by = [&](const Vec3d&) { return shift; };
  Simulator before(block(everywhere, &none));
  Simulator after(block(everywhere, &by));
  const RfLines a = before.formRf(fan(-shift), {}, settings()).host();
  const RfLines b = after.formRf(fan(), {}, settings()).host();
  double error = 0.0;
  double power = 0.0;
  for (int l = 0; l < a.lineCount; ++l)
  {
    for (int s = a.sampleCount / 5; s < a.sampleCount * 4 / 5; ++s) // the block's faces did not move
    {
      const std::size_t at = std::size_t(l) * std::size_t(a.sampleCount) + std::size_t(s);
      error += std::norm(a.iq[at] - b.iq[at]);
      power += std::norm(a.iq[at]);
    }
  }
  EXPECT_GT(power, 0.0);
  EXPECT_LT(std::sqrt(error / power), 2e-3);
}

double meanPower(const std::shared_ptr<const Scene>& scene, InterfaceModel model)
{
  double sum = 0.0;
  int count = 0;
  for (int seed = 1; seed <= 24; ++seed)
  {
    EchoSettings s = settings();
    s.seed = std::uint64_t(seed);
    std::vector<ScanLine> lines;
    for (const double x : { 8.0, 14.0, 20.0, 26.0, 32.0 })
    {
      lines.push_back(makeLine({ x, 12.0, 0.0 }, { 0.0, 0.0, 1.0 }));
    }
    const TracedLines lit = fullyLit(lines.size(), s, model);
    Simulator simulator(scene);
    const RfLines rf = simulator.formRf(lines, TracedResult(lit), s).host();
    for (int l = 0; l < rf.lineCount; ++l)
    {
      for (int n = rf.sampleCount / 5; n < rf.sampleCount * 4 / 5; ++n)
      {
        sum += std::norm(rf.iq[std::size_t(l) * std::size_t(rf.sampleCount) + std::size_t(n)]);
        ++count;
      }
    }
  }
  return sum / count;
}

TEST(TissueMotion, EchoesAsStrongAsTissueThatStandsStill)
{
  const std::function<Vec3d(const Vec3d&)> none = [](const Vec3d&) { return Vec3d(0.0); };
  for (const InterfaceModel model : { InterfaceModel::Acoustic, InterfaceModel::Amadou2024 })
  {
    const double moving = meanPower(block(everywhere, &none), model);
    const double still = meanPower(block(everywhere, nullptr), model);
    EXPECT_NEAR(10.0 * std::log10(moving / still), 0.0, 0.3);
  }
}

TEST(TissueMotion, AMovingProbesScatterersAreFewerAndAsStrongTogether)
{
  const std::function<Vec3d(const Vec3d&)> none = [](const Vec3d&) { return Vec3d(0.0); };
  const auto scene = block(everywhere, &none);
  const auto countAndPower = [&](bool interactive) {
    EchoSettings s = settings();
    s.interactive = interactive;
    double power = 0.0;
    const std::vector<PointScatterer> points =
      movingScatterers(*scene, movingStatistics(*scene, s, InterfaceModel::Acoustic));
    for (const PointScatterer& p : points)
    {
      power += double(p.amplitude) * double(p.amplitude);
    }
    return std::pair(double(points.size()), power);
  };
  const auto [all, power] = countAndPower(false);
  const auto [few, powerOfFew] = countAndPower(true);
  EXPECT_NEAR(all / few, 5.0, 0.1);
  EXPECT_NEAR(10.0 * std::log10(powerOfFew / power), 0.0, 0.1);
}

TEST(TissueMotion, APhaseThatComesBackHasItsScatterersAsBefore)
{
  const std::function<Vec3d(const Vec3d&)> none = [](const Vec3d&) { return Vec3d(0.0); };
  const std::function<Vec3d(const Vec3d&)> shift = [](const Vec3d&) { return Vec3d(1.3, 0.0, 0.4); };
  const auto rest = block(everywhere, &none);
  const auto moved = block(everywhere, &shift);
  const auto samplesOf = [](Simulator& simulator) {
    return RfLines(simulator.formRf(fan(), {}, settings()).host()).rf();
  };
  Simulator simulator(rest);
  const std::vector<float> first = samplesOf(simulator);
  simulator.setScene(moved);
  const std::vector<float> second = samplesOf(simulator);
  simulator.setScene(rest);
  EXPECT_EQ(samplesOf(simulator), first);
  EXPECT_NE(second, first);
  Simulator fresh(moved);
  simulator.setScene(moved);
  EXPECT_EQ(samplesOf(simulator), samplesOf(fresh));
}

TEST(TissueMotion, OfSmallCellsThoseThatALineMayHearAreMade)
{
  const std::function<Vec3d(const Vec3d&)> wave = [](const Vec3d& p) {
    return Vec3d(std::sin(0.2 * p.z), 0.0, std::cos(0.1 * p.x));
  };
  const auto scene = block(everywhere, &wave);
  EchoSettings s = settings();
  s.centreFrequencyMHz = 4.0;
  for (const BeamForm beam : { BeamForm::Gaussian, BeamForm::Computed })
  {
    s.beam = beam;
    s.aperture = ProbeSettings().aperture();
    s.arrayField = beam == BeamForm::Computed ? std::make_shared<const ArrayField>(elementsOf(s), s.depthMm) : nullptr;
    const MovingStatistics statistics = movingStatistics(*scene, s, InterfaceModel::Acoustic);
    const std::vector<PointScatterer> all = movingScatterers(*scene, statistics);
    const auto partOf = [&](const std::vector<ScanLine>& lines) {
      return movingPart(*scene, statistics, lines, s, InterfaceModel::Acoustic);
    };
    const std::vector<ScanLine> two = { fan()[3], makeLine({ 30.0, 4.0, 0.0 }, { -0.6, 0.0, 0.8 }) };
    const MovingPart part = partOf(two);
    ASSERT_FALSE(part.isAll);
    const std::vector<PointScatterer> some = movingScatterers(*scene, statistics, part);
    EXPECT_LT(some.size(), all.size() * 9 / 10);
    const auto samplesOf = [&](const std::vector<PointScatterer>& points) {
      const PointScatterers sorted = sortedMoving(*scene, statistics, part, points);
      return formRf({ nullptr, nullptr, &sorted, InterfaceModel::Acoustic, nullptr }, two, s, {}).iq;
    };
    const auto wanted = samplesOf(all);
    EXPECT_EQ(samplesOf(some), wanted);
    // Of lines that mostly go elsewhere, too.
    std::vector<ScanLine> more = two;
    for (const double z : { 30.0, 35.0, 40.0, 45.0 })
    {
      more.push_back(makeLine({ 2.0, 12.0, z }, { 1.0, 0.0, 0.0 }));
    }
    const MovingPart larger = partOf(more);
    EXPECT_TRUE(larger.holds(part));
    EXPECT_FALSE(part.holds(larger));
    EXPECT_EQ(samplesOf(movingScatterers(*scene, statistics, larger)), wanted);
    EXPECT_GT(std::count_if(wanted.begin(), wanted.end(), [](const auto& v) { return std::norm(v) > 0.0f; }), 1000);
  }
  s.centreFrequencyMHz = 2.5;
  EXPECT_TRUE(
    movingPart(*scene, movingStatistics(*scene, s, InterfaceModel::Acoustic), fan(), s, InterfaceModel::Acoustic)
      .isAll);
}

TEST(TissueMotion, OnlyMovingLabelsRide)
{
  const std::function<Vec3d(const Vec3d&)> none = [](const Vec3d&) { return Vec3d(0.0); };
  const std::function<bool(const Vec3d&)> half = [](const Vec3d& p) { return p.z < 25.0; };
  const auto scene = block(half, &none);
  for (const PointScatterer& p :
       movingScatterers(*scene, movingStatistics(*scene, settings(), InterfaceModel::Acoustic)))
  {
    ASSERT_LT(p.positionMm.z, 25.0 + 1e-3);
  }
  EXPECT_EQ(scene->detailAt(0), 0.0f);
  EXPECT_EQ(scene->detailAt(std::size_t(40 * 24 * 49)), 1.0f);
}

TEST(TissueMotion, SaysWhatIsWrongWithAField)
{
  GridPlacement grid;
  grid.size = { 2, 2, 2 };
  using sono::testing::errorOf;
  using sono::testing::expectContains;
  expectContains(errorOf([&] { TissueMotion(grid, std::vector<Vec3f>(7), {}); }), "7 values");
  std::vector<Vec3f> field(8);
  field[5].y = NAN;
  expectContains(errorOf([&] { TissueMotion(grid, field, {}); }), "voxel 1, 0, 1");
}

} // namespace
