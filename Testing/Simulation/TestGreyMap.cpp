#include "Folders.h"
#include "Image/BMode.h"
#include "Image/GreyMap.h"
#include "ImageTestTools.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

using namespace sono;

namespace {

class GreyMaps : public ::testing::Test
{
protected:
  std::string write(const std::string& text)
  {
    const std::string path = folder_.file("map.csv");
    std::ofstream(path) << text;
    return path;
  }

private:
  sono::testing::TemporaryFolder folder_;
};

/// Grey of levels between black and white; 0 dB is 1, black is -60 dB.
std::vector<float> greyOf(const std::vector<double>& levels, const std::vector<float>& map)
{
  BModeSettings settings;
  settings.tgcDbPerCm = 0.0;
  settings.automaticReference = false;
  settings.greyMap = map;
  std::vector<float> envelope;
  for (const double level : levels)
  {
    envelope.push_back(float(std::pow(10.0, 3.0 * (level - 1.0))));
  }
  return makeBMode(envelope, 1, int(envelope.size()), 1.0, settings).grey;
}

TEST_F(GreyMaps, BundledTablesAreTheirClosedForms)
{
  const std::vector<double> levels{ 0.013, 0.1, 1.0 / 3.0, 0.5, 0.7071, 0.95, 1.0 };
  const auto sShaped = greyOf(levels, readGreyMap(dataFile("grey_maps/s_shaped.csv")));
  const auto root = greyOf(levels, readGreyMap(dataFile("grey_maps/square_root.csv")));
  for (std::size_t n = 0; n < levels.size(); ++n)
  {
    const double x = levels[n];
    // A chord of a curve bent by 6 and 1/(4 x^1.5) strays by step^2/8 of that; 1/128 and, of the root, 2 sqrt(x)/128.
    EXPECT_NEAR(sShaped[n], x * x * (3.0 - 2.0 * x), 6.0 / 8.0 / 128.0 / 128.0 + 1e-5) << x;
    EXPECT_NEAR(root[n], std::sqrt(x), 0.5 / 8.0 / 128.0 / 128.0 / std::sqrt(x) + 1e-4) << x;
  }
}

TEST_F(GreyMaps, ATableIsStraightBetweenItsLines)
{
  const auto map = readGreyMap(write("level,grey\n# a comment\n0,0.1\n0.25,0.6\n1,0.9\n"));
  const auto grey = greyOf({ 0.125, 0.25, 0.5, 1.0 }, map);
  EXPECT_NEAR(grey[0], 0.35, 1e-5);
  EXPECT_NEAR(grey[1], 0.6, 1e-5);
  EXPECT_NEAR(grey[2], 0.7, 1e-5);
  EXPECT_NEAR(grey[3], 0.9, 1e-5);
}

TEST_F(GreyMaps, WhatIsNoneIsRefusedWithItsLine)
{
  expectError([&] { readGreyMap(write("level,grey\n0,0\n0.5,x\n1,1\n")); }, "line 3");
  expectError([&] { readGreyMap(write("level,grey\n0,0\n0.5,1.5\n1,1\n")); }, "1.5");
  expectError([&] { readGreyMap(write("level,grey\n0,0\n0.5,0.4\n0.5,0.5\n1,1\n")); }, "line 4");
  expectError([&] { readGreyMap(write("level,grey\n0.1,0\n1,1\n")); }, "begin at 0");
  expectError([&] { readGreyMap(write("level\n0\n1\n")); }, "grey");
  expectError([&] { readGreyMap("nowhere.csv"); }, "nowhere.csv");
}

} // namespace
