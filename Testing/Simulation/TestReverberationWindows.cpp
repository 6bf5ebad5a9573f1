#include "Trace/ReverberationWindows.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <tuple>

// All bins of a line at once against one after the other, as the GPU has them.

namespace sono::test {
namespace {

ReverberationRows randomRows(int lines, int bins)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  ReverberationRows rows(lines, bins);
  for (int l = 0; l < lines; ++l)
  {
    for (int b = 0; b < bins; ++b)
    {
      rows.set(l, b, { uniform(random), uniform(random), uniform(random), uniform(random), uniform(random) });
    }
  }
  return rows;
}

void expectAlike(const ReverberationAround& found, const ReverberationAround& expected, const std::string& where)
{
  const auto expectNear = [&](float a, float b, float most) { EXPECT_NEAR(a, b, 1e-5f * most) << where; };
  expectNear(found.cellPower, expected.cellPower, 100.0f);
  expectNear(found.power, expected.power, 100.0f);
  expectNear(found.chance, expected.chance, 1000.0f);
  expectNear(found.straightPower, expected.straightPower, 100.0f);
  expectNear(found.straightWeight, expected.straightWeight, 100.0f);
}

/// Fewer bins than a window has, and more; fewer lines, and more; bins wider than a window.
class ReverberationWindowsOfBins : public testing::TestWithParam<std::tuple<int, int, float>>
{
protected:
  int lines_ = std::get<0>(GetParam());
  int bins_ = std::get<1>(GetParam());
  float mm_ = std::get<2>(GetParam());
  ReverberationRows in_ = randomRows(lines_, bins_);

  template<class Expected>
  void expectAll(const ReverberationRows& found, int foundLine, int line, const Expected& expected)
  {
    for (int b = 0; b < bins_; ++b)
    {
      expectAlike(found.at(foundLine, b), expected(line, b),
                  "line " + std::to_string(line) + ", bin " + std::to_string(b));
    }
  }
};

TEST_P(ReverberationWindowsOfBins, AlongALine)
{
  ReverberationRows along(lines_, bins_);
  for (int l = 0; l < lines_; ++l)
  {
    sumAlongLine(in_, l, mm_, along, l);
    expectAll(along, l, l, [&](int line, int bin) {
      return sumAlongLine(bin, bins_, mm_, [&](int near) { return in_.at(line, near); });
    });
  }
}

TEST_P(ReverberationWindowsOfBins, OverTheLines)
{
  ReverberationRows around(lines_, bins_);
  for (int l = 0; l < lines_; ++l)
  {
    sumOverLines(in_, l, around);
    expectAll(around, l, l, [&](int line, int bin) {
      return sumOverLines(line, 0, lines_, [&](int near) { return in_.at(near, bin); });
    });
  }
}

TEST_P(ReverberationWindowsOfBins, FurtherOut)
{
  for (int l = 0; l < lines_; ++l)
  {
    ReverberationRows further(1, bins_);
    sumFurther(in_, l, mm_, further);
    expectAll(further, 0, l, [&](int line, int bin) {
      return sumFurther(line, 0, lines_, bin, bins_, mm_,
                        [&](int nearLine, int near) { return in_.at(nearLine, near); });
    });
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, ReverberationWindowsOfBins,
                         testing::Values(std::tuple{ 40, 67, 0.5f }, std::tuple{ 3, 7, 0.5f },
                                         std::tuple{ 20, 11, 15.0f }, std::tuple{ 1, 1, 0.5f }));

} // namespace
} // namespace sono::test
