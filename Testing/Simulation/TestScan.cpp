#include "EchoScenes.h"
#include "ErrorText.h"
#include "Folders.h"
#include "TestScenes.h"

#include "Kernel/DetailCode.h"
#include "Labels/CtFill.h"
#include "Labels/MatchedScan.h"
#include "Scene/AddScan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <set>

namespace {

using namespace sono;
using namespace sono::test;
using sono::testing::errorOf;
using sono::testing::expectContains;

GridPlacement gridOf(const Vec3i& size, const Vec3d& spacingMm, const Vec3d& originMm)
{
  GridPlacement grid;
  grid.size = size;
  grid.spacingMm = spacingMm;
  grid.originMm = originMm;
  return grid;
}

template<class Value>
void forVoxels(const GridPlacement& grid, const Value& visit)
{
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
}

LabelVolume labelled(const GridPlacement& grid, const std::vector<std::pair<std::string, std::string>>& names,
                     const std::function<int(const Vec3d&)>& idAt)
{
  LabelVolume volume;
  volume.placement = grid;
  volume.voxels.resize(grid.voxelCount());
  forVoxels(grid, [&](std::size_t at, const Vec3d& p) { volume.voxels[at] = std::uint16_t(idAt(p)); });
  for (std::size_t n = 0; n < names.size(); ++n)
  {
    LabelInfo label;
    label.id = int(n);
    label.name = names[n].first;
    label.tissue = names[n].second;
    volume.labels.push_back(label);
  }
  volume.collectLabels();
  return volume;
}

IntensityVolume scanned(const GridPlacement& grid, const std::function<double(const Vec3d&)>& valueAt)
{
  IntensityVolume scan;
  scan.placement = grid;
  scan.values.resize(grid.voxelCount());
  forVoxels(grid, [&](std::size_t at, const Vec3d& p) { scan.values[at] = float(valueAt(p)); });
  return scan;
}

/// A body across the whole volume along z: fat around muscle, in it a lung, a bone, gas and the labelled liver; beneath
/// it a table.
constexpr double bodyMm = 60.0; // radius

double torsoHu(const Vec3d& p)
{
  const double r = std::hypot(p.x, p.y);
  if (r > bodyMm)
  {
    return p.y > 75.0 && p.y < 80.0 && std::abs(p.x) < 70.0 ? -150.0 : -1000.0;
  }
  if (glm::length(p - Vec3d(-20.0, -10.0, 0.0)) < 22.0)
  {
    return -820.0;
  }
  if (std::hypot(p.x - 25.0, p.y - 25.0) < 8.0)
  {
    return 700.0;
  }
  if (glm::length(p - Vec3d(20.0, -20.0, 0.0)) < 9.0)
  {
    return -990.0;
  }
  return r > 45.0 ? -100.0 : 55.0;
}

bool isLiver(const Vec3d& p)
{
  return glm::length(p - Vec3d(-15.0, 27.0, 0.0)) < 12.0;
}

TEST(MatchedScan, IsTheScanWhereTheLabelMapHasItsVoxels)
{
  // A linear function is what it is between voxels, too.
  const auto linear = [](const Vec3d& p) { return 3.0 * p.x - 2.0 * p.y + 1.5 * p.z - 300.0; };
  GridPlacement own = gridOf({ 40, 50, 30 }, { 2.1, 1.7, 2.6 }, { -40.0, -45.0, -30.0 });
  const double a = 0.3;
  own.direction = Mat3d(Vec3d(std::cos(a), std::sin(a), 0.0), Vec3d(std::sin(a), -std::cos(a), 0.0), Vec3d(0, 0, 1));
  own.originMm = { -50.0, 25.0, -35.0 };
  const GridPlacement grid = gridOf({ 21, 17, 19 }, { 1.3, 1.1, 1.9 }, { -18.0, -14.0, -12.0 });
  const LabelVolume labels = labelled(grid, { { "air", "air" }, { "liver", "liver" } }, [](const Vec3d&) { return 1; });
  const MatchedScan matched = matchScan(labels, scanned(own, linear));
  EXPECT_TRUE(matched.isCt);
  forVoxels(grid, [&](std::size_t at, const Vec3d& p) {
    const Vec3d index = own.indexFromWorld(p);
    if (glm::all(glm::greaterThan(index, Vec3d(0.0))) && glm::all(glm::lessThan(index, Vec3d(own.size - 1))))
    {
      ASSERT_NEAR(matched.values[at], linear(p), 0.51);
    }
    else if (glm::any(glm::lessThan(index, Vec3d(-0.51))))
    {
      ASSERT_EQ(matched.values[at], MatchedScan::nothing);
    }
  });
}

TEST(MatchedScan, OfShortsIsThatOfTheSameNumbers)
{
  const GridPlacement grid = gridOf({ 60, 60, 20 }, Vec3d(2.0), { -60.0, -60.0, -20.0 });
  GridPlacement finer = gridOf({ 117, 118, 39 }, Vec3d(1.03), { -59.7, -59.9, -19.6 });
  const LabelVolume labels = labelled(grid, { { "", "" }, { "liver", "liver" } }, isLiver);
  const auto torso = [](const Vec3d& p) { return torsoHu(p); };
  const auto padded = [](const Vec3d& p) { return p.x < -50.0 ? -32768.0 : torsoHu(p); };
  const auto mr = [](const Vec3d& p) { return std::round(700.0 + 3.0 * p.x); };
  for (const std::function<double(const Vec3d&)>& value :
       { std::function<double(const Vec3d&)>(torso), { padded }, { mr } })
  {
    for (const GridPlacement& own : { grid, finer })
    {
      const IntensityVolume floats = scanned(own, value);
      IntensityVolume shorts;
      shorts.placement = own;
      shorts.shorts = SharedSpan<std::int16_t>(std::vector<std::int16_t>(floats.values.begin(), floats.values.end()));
      const MatchedScan expected = matchScan(labels, floats);
      const MatchedScan matched = matchScan(labels, shorts);
      EXPECT_EQ(matched.isCt, expected.isCt);
      EXPECT_EQ(matched.notice, expected.notice);
      ASSERT_EQ(matched.values.size, expected.values.size);
      EXPECT_TRUE(std::equal(matched.values.begin(), matched.values.end(), expected.values.begin()));
    }
  }
}

TEST(MatchedScan, OfAnotherPlaceOrPatientIsRefused)
{
  const GridPlacement grid = gridOf({ 60, 60, 20 }, Vec3d(2.0), { -60.0, -60.0, -20.0 });
  LabelVolume labels = labelled(grid, { { "", "" }, { "liver", "liver" } }, isLiver);
  GridPlacement elsewhere = grid;
  elsewhere.originMm.z += 40.0;
  expectContains(errorOf([&] { matchScan(labels, scanned(elsewhere, torsoHu)); }), "0 % of the labelled voxels");
  const MatchedScan shifted = matchScan(labels, scanned(grid, [](const Vec3d& p) { return torsoHu(p + 40.0); }));
  const std::vector<ScanOfLabel> means = scanOfLabels(labels, shifted);
  const std::string sentence = errorOf([&] { requireSamePatient(labels, shifted, means); });
  expectContains(sentence, "another patient");
  expectContains(sentence, "'liver'");
  const MatchedScan right = matchScan(labels, scanned(grid, torsoHu));
  requireSamePatient(labels, right, scanOfLabels(labels, right));
}

TEST(MatchedScan, ValuesThatAreNoHounsfieldUnitsAreRefused)
{
  const GridPlacement grid = gridOf({ 60, 60, 20 }, Vec3d(2.0), { -60.0, -60.0, -20.0 });
  const LabelVolume labels = labelled(grid, { { "", "" }, { "liver", "liver" } }, isLiver);
  for (const char* modality : { "", "CT" })
  {
    IntensityVolume scan = scanned(grid, [](const Vec3d& p) { return 1e5 * torsoHu(p); });
    scan.modality = modality;
    const std::string sentence = errorOf([&] { matchScan(labels, scan); });
    expectContains(sentence, "from -1e+08 to 7e+07");
    expectContains(sentence, "divide them");
  }
  const auto mr = [](const Vec3d& p) { return 1e5 * (500.0 + 3.0 * p.x); };
  EXPECT_FALSE(matchScan(labels, scanned(grid, mr)).isCt); // an MR has any scale
  IntensityVolume padded = scanned(grid, [](const Vec3d& p) { return p.x < -50.0 ? -32768.0 : torsoHu(p); });
  padded.modality = "CT";
  EXPECT_TRUE(matchScan(labels, padded).isCt);
}

TEST(CtFill, NamesWhatACtShowsOutsideOfTheLabels)
{
  for (const Vec3d spacing : { Vec3d(1.5), Vec3d(1.0, 1.0, 4.0) })
  {
    const GridPlacement grid = gridOf(Vec3i(Vec3d(180.0, 180.0, 60.0) / spacing), spacing, { -90.0, -90.0, -30.0 });
    LabelVolume volume = labelled(grid, { { "outside", "" }, { "liver", "" } }, isLiver);
    const MatchedScan ct = matchScan(volume, scanned(grid, torsoHu));
    const std::vector<std::string> names = fillFromCt(volume, ct, 4.0, 0.0);
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()),
              (std::set<std::string>{ "skin", "gas", "lung", "fat", "muscle", "bone" }));
    // Away from the surfaces of what there is, by more than blocks and voxels may mistake.
    forVoxels(grid, [&](std::size_t at, const Vec3d& p) {
      double nearest = HUGE_VAL;
      const double here = torsoHu(p);
      for (const double step : { 1.0, 3.0, 6.5 })
      {
        for (const Vec3d d : { Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1) })
        {
          nearest =
            torsoHu(p + step * d) != here || torsoHu(p - step * d) != here || isLiver(p + step * d) != isLiver(p)
              ? std::min(nearest, step)
              : nearest;
        }
      }
      if (nearest < 7.0 || std::abs(std::hypot(p.x, p.y) - bodyMm) < 6.5)
      {
        return;
      }
      const std::string name = volume.find(volume.voxels[at])->name;
      const double r = std::hypot(p.x, p.y);
      const std::string expected = isLiver(p)       ? "liver"
                                   : r > bodyMm     ? "outside"
                                   : here == -820.0 ? "lung"
                                   : here == -990.0 ? "gas"
                                   : here == 700.0  ? "bone"
                                   : here == -100.0 ? "fat"
                                                    : "muscle";
      ASSERT_EQ(name, expected) << p.x << ' ' << p.y << ' ' << p.z;
    });
    // The skin: all around at its depth, not at the cut faces.
    int skins = 0;
    for (int turn = 0; turn < 360; turn += 5)
    {
      const double angle = turn * M_PI / 180.0;
      const Vec3d p = (bodyMm - 1.5) * Vec3d(std::cos(angle), std::sin(angle), 0.0);
      const Vec3i v(glm::round(grid.indexFromWorld(p)));
      const std::size_t at =
        std::size_t(v.x) + std::size_t(grid.size.x) * (std::size_t(v.y) + std::size_t(grid.size.y) * v.z);
      skins += volume.find(volume.voxels[at])->name == "skin" ? 1 : 0;
    }
    EXPECT_GE(skins, 66);
    EXPECT_EQ(
      volume.find(volume.voxels[std::size_t(grid.size.x) * (std::size_t(grid.size.y) / 2) + grid.size.x / 2])->name,
      "muscle");
  }
}

TEST(ScanDetail, FollowsTheScanAndKeepsEachTissuesMean)
{
  const GridPlacement grid = gridOf({ 50, 40, 30 }, Vec3d(1.0), Vec3d(0.0));
  const LabelVolume labels =
    labelled(grid, { { "outside", "air" }, { "liver", "liver" }, { "kidney", "kidney" } }, [](const Vec3d& p) {
      return p.z < 2.0 ? 0 : p.x < 25.0 ? 1 : 2;
    });
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 25.0);
  const MatchedScan ct = matchScan(labels, scanned(grid, [&](const Vec3d& p) {
                                     return (p.x < 25.0 ? 60.0 : 35.0) + (p.y > 20.0 ? 40.0 : 0.0) + noise(random) -
                                            (p.z < 2.0 ? 1000.0 : 0.0);
                                   }));
  const std::vector<ScanOfLabel> means = scanOfLabels(labels, ct);
  ScanDetailSettings settings;
  for (const auto direction : { DetailDirection::Rises, DetailDirection::Falls })
  {
    settings.direction = direction;
    const std::vector<std::uint8_t> codes = scanDetail(labels, ct, means, "air", settings);
    double power[3] = {};
    double count[3] = {};
    double low = 0.0;
    double high = 0.0;
    for (std::size_t at = 0; at < codes.size(); ++at)
    {
      const int label = labels.voxels[at];
      const double factor = double(detailFactor(codes[at]));
      power[label] += factor * factor;
      count[label] += 1.0;
      const double db = 20.0 * std::log10(factor);
      const int y = int(at / 50) % 40;
      (y > 23 ? high : low) += label == 1 && (y < 18 || y > 23) ? db : 0.0;
    }
    EXPECT_EQ(power[0], count[0]); // nothing changes outside
    for (int label = 1; label < 3; ++label)
    {
      EXPECT_NEAR(10.0 * std::log10(power[label] / count[label]), 0.0, 0.07); // half a step
    }
    const double voxels = 25.0 * 28.0;
    const double step = high / (voxels * 16.0) - low / (voxels * 18.0);
    EXPECT_NEAR(step, (direction == DetailDirection::Rises ? 1.0 : -1.0) * 0.15 * 40.0, 0.4);
  }
}

/// Whatever the scale: in a kidney of two halves, 300 and 500, as much as they differ, and in a liver that is even but
/// for noise next to nothing.
TEST(ScanDetail, OfAnMrFollowsStructureNotNoise)
{
  const GridPlacement grid = gridOf({ 60, 40, 30 }, Vec3d(1.0), Vec3d(0.0));
  const LabelVolume labels =
    labelled(grid, { { "outside", "air" }, { "liver", "liver" }, { "kidney", "kidney" } }, [](const Vec3d& p) {
      return p.x < 20.0 ? 0 : p.x < 40.0 ? 1 : 2;
    });
  for (const double scale : { 1e-3, 1.0, 1e4 })
  {
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0.0, 20.0);
    const MatchedScan mr =
      matchScan(labels, scanned(grid, [&](const Vec3d& p) {
                  const double kidney = p.y > 20.0 ? 500.0 : 300.0;
                  return scale * std::max(0.0, (p.x < 20.0 ? 5.0 : p.x < 40.0 ? 300.0 : kidney) + noise(random));
                }));
    EXPECT_FALSE(mr.isCt);
    const std::vector<std::uint8_t> codes = scanDetail(labels, mr, scanOfLabels(labels, mr), "air", {});
    double step = 0.0;
    double squares = 0.0;
    for (std::size_t at = 0; at < codes.size(); ++at)
    {
      const double db = 20.0 * std::log10(double(detailFactor(codes[at])));
      const int y = int(at / 60) % 40;
      squares += labels.voxels[at] == 1 ? db * db / (20.0 * 40.0 * 30.0) : 0.0;
      step += labels.voxels[at] == 2 && std::abs(y - 20) > 3 ? (y > 20 ? db / 16.0 : -db / 17.0) / (20.0 * 30.0) : 0.0;
    }
    // A third of the values is 5, one 300, of one a half 300 and a half 500.
    const double mean = (5.0 + 300.0 + 400.0) / 3.0;
    const double deviation = std::sqrt((25.0 + 9e4 + 0.5 * (9e4 + 25e4)) / 3.0 - mean * mean);
    EXPECT_NEAR(step, 15.0 * 200.0 / deviation, 0.6) << scale;
    EXPECT_LT(std::sqrt(squares), 0.5) << scale;
  }
}

TEST(ScanDetail, IsWhatOneEchoesMore)
{
  // Half of a box is 9 dB weaker. Its echoes are.
  Tissue tissue = makeTissue("liver", 1.6, 1540.0, 0.0);
  tissue.scattererSigma = 0.3;
  tissue.scattererProbability = 0.7;
  const GridPlacement grid = gridOf({ 80, 30, 90 }, Vec3d(1.0), Vec3d(0.5));
  for (const InterfaceModel model : { InterfaceModel::Acoustic, InterfaceModel::Amadou2024 })
  {
    LabelVolume volume = labelled(grid, { { "liver", "liver" } }, [](const Vec3d&) { return 0; });
    std::vector<std::uint8_t> detail(volume.voxels.size(), std::uint8_t(detailNone));
    forVoxels(grid, [&](std::size_t at, const Vec3d& p) {
      detail[at] = std::uint8_t(p.z > 45.0 ? detailNone - 72 : detailNone);
    });
    TissueTable table;
    table.add(tissue);
    const Scene scene(std::move(volume), table, "none", std::move(detail));
    EchoSettings s = speckleEcho(5.0, 40.0);
    s.depthMm = 85.0;
    s.lateralSigmaMm = s.elevationalSigmaMm = 0.6;
    std::vector<ScanLine> lines;
    for (int n = 0; n < 60; ++n)
    {
      lines.push_back(makeLine({ 10.0 + n, 15.0, 1.0 }, { 0, 0, 1 }));
    }
    EchoSources sources{ &scene, nullptr, nullptr };
    sources.model = model;
    const RfLines rf = formRf(sources, lines, s);
    double power[2] = {};
    for (int l = 0; l < rf.lineCount; ++l)
    {
      for (int n = 0; n < rf.sampleCount; ++n)
      {
        const double z = 1.0 + n * rf.sampleMm;
        const double p = std::norm(rf.iq[std::size_t(l) * std::size_t(rf.sampleCount) + std::size_t(n)]);
        power[0] += z > 8.0 && z < 42.0 ? p : 0.0;
        power[1] += z > 48.0 && z < 82.0 ? p : 0.0;
      }
    }
    EXPECT_NEAR(10.0 * std::log10(power[1] / power[0]), -9.0, 0.4);
  }
}

TEST(ScanDetail, StaysWhereItIsOnALargerGrid)
{
  const GridPlacement own = gridOf({ 3, 4, 2 }, { 1.0, 2.0, 3.0 }, { 5.0, 6.0, 7.0 });
  GridPlacement larger = own;
  larger.size = { 6, 9, 5 };
  larger.originMm -= own.spacingMm * Vec3d(2.0, 1.0, 3.0);
  std::vector<std::uint8_t> codes(own.voxelCount());
  forVoxels(own, [&](std::size_t at, const Vec3d& p) { codes[at] = std::uint8_t(7.0 * p.x + p.y + p.z); });
  const std::vector<std::uint8_t> wide = detailOnLargerGrid(codes, own, larger);
  forVoxels(larger, [&](std::size_t at, const Vec3d& p) {
    const Vec3d index = own.indexFromWorld(p);
    const bool isOwn =
      glm::all(glm::greaterThan(index, Vec3d(-0.5))) && glm::all(glm::lessThan(index, Vec3d(own.size) - 0.5));
    ASSERT_EQ(wide[at], isOwn ? std::uint8_t(7.0 * p.x + p.y + p.z) : detailNone);
  });
}

TEST(AddScan, SaysWhatTheScanDoesNotReach)
{
  const GridPlacement grid = gridOf({ 60, 60, 20 }, Vec3d(2.0), { -60.0, -60.0, -20.0 });
  const LabelVolume labels = labelled(grid, { { "", "" }, { "liver", "" } }, isLiver);
  const auto map = LabelTissueMap::read(dataFile("label_tissues.csv"));
  const auto table = TissueTable::read(dataFile("tissues.csv"));
  LabelVolume whole = labels;
  EXPECT_TRUE(addScan(whole, scanned(grid, torsoHu), map, table, {}).notices.empty());
  GridPlacement half = grid; // its upper eleven slices, as a series that was copied in part
  half.size.z = 11;
  half.originMm.z += 18.0;
  LabelVolume cut = labels;
  const AddedScan added = addScan(cut, scanned(half, torsoHu), map, table, {});
  ASSERT_EQ(added.notices.size(), 1u);
  expectContains(added.notices[0], " % of the labelled voxels lie in it");
  expectContains(added.notices[0], "DICOM series");
  const auto last = std::size_t(grid.size.x) * grid.size.y * 9; // below that slice
  EXPECT_TRUE(std::all_of(added.detail.begin(), added.detail.begin() + std::ptrdiff_t(last),
                          [](std::uint8_t code) { return code == detailNone; }));
}

/// Ten times too large, with metal or without, and its modality not said.
TEST(AddScan, SaysWhatAScanWithoutModalityIsTakenFor)
{
  const GridPlacement grid = gridOf({ 60, 60, 20 }, Vec3d(2.0), { -60.0, -60.0, -20.0 });
  const auto map = LabelTissueMap::read(dataFile("label_tissues.csv"));
  const auto table = TissueTable::read(dataFile("tissues.csv"));
  const auto said = [&](const auto& value, const char* modality) {
    LabelVolume labels = labelled(grid, { { "", "" }, { "liver", "" } }, isLiver);
    IntensityVolume scan = scanned(grid, value);
    scan.modality = modality;
    const AddedScan added = addScan(labels, scan, map, table, {});
    EXPECT_EQ(added.isCt, added.notices.empty() && scan.modality != "MR");
    EXPECT_LE(added.notices.size(), 1u);
    return added.notices.empty() ? std::string() : added.notices[0];
  };
  const auto tenTimes = [](const Vec3d& p) { return 10.0 * torsoHu(p); };
  const auto withMetal = [](const Vec3d& p) { return glm::length(p) < 4.0 ? 4e4 : 10.0 * torsoHu(p); };
  expectContains(said(tenTimes, ""), "from -10000 to 7000");
  expectContains(said(withMetal, ""), "from -10000 to 40000");
  expectContains(said(withMetal, ""), "taken for an MR");
  expectContains(said(withMetal, ""), "needs Hounsfield units");
  EXPECT_EQ(said(torsoHu, ""), "");
  EXPECT_EQ(said(torsoHu, "CT"), "");
  EXPECT_EQ(said([](const Vec3d& p) { return p.x < -50.0 ? -3024.0 : torsoHu(p); }, ""), ""); // padding
  const auto mr = [](const Vec3d& p) { return 500.0 + 3.0 * p.x; };
  expectContains(said(mr, ""), "taken for an MR");
  EXPECT_EQ(said(mr, "MR"), "");
}

TEST(AddScan, LeavesTheGuessToAnMr)
{
  const GridPlacement grid = gridOf({ 60, 60, 20 }, Vec3d(2.0), { -60.0, -60.0, -20.0 });
  LabelVolume labels = labelled(grid, { { "", "" }, { "liver", "" } }, isLiver);
  const auto before = labels.voxels;
  const auto map = LabelTissueMap::read(dataFile("label_tissues.csv"));
  const auto table = TissueTable::read(dataFile("tissues.csv"));
  const AddedScan added =
    addScan(labels, scanned(grid, [](const Vec3d& p) { return 500.0 + 3.0 * p.x; }), map, table, {});
  EXPECT_FALSE(added.isCt);
  EXPECT_TRUE(added.names.empty());
  EXPECT_EQ(labels.voxels, before);
  EXPECT_EQ(added.detail.size(), before.size());
  // Through the liver's middle the level rises with the values, 15 dB for half of their mean, 497.
  const auto codeAt = [&](double x) {
    const Vec3i v(glm::round(grid.indexFromWorld({ x, 26.0, 0.0 })));
    return int(added.detail[(std::size_t(v.z) * 60 + std::size_t(v.y)) * 60 + std::size_t(v.x)]);
  };
  EXPECT_NEAR((codeAt(-8.0) - codeAt(-22.0)) * detailStepDb, 15.0 * 3.0 * 14.0 / (0.5 * 497.0), 0.3);
  ScanDetailSettings wrong;
  wrong.detailDbPer100Hu = 1000.0;
  expectContains(errorOf([&] { addScan(labels, scanned(grid, torsoHu), map, table, wrong); }), "detail");
}

} // namespace
