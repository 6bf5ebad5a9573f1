#include "Trace/AxisWay.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace sono;

TEST(AxisWay, StepsThatAreAlikeAreThoseOneByOne)
{
  const FlightStep step{ 0.0643f, 0.0021f, 0.0019f };
  const FlightStep boundary{ 0.0617f, 0.31f, 0.002f };
  constexpr int runs[] = { 1000, 1, 643 }; // no whole vectors
  AxisWay way;
  way.rangeMm.resize(1644);
  way.amplitude.resize(1644);
  way.absorbedNp.resize(1644);
  AxisSums sums;
  int first = 0;
  for (const int count : runs)
  {
    goOn(count == 1 ? boundary : step, first, count, sums, way);
    first += count;
  }
  double range = 0.0;
  double lost = 0.0;
  double absorbed = 0.0;
  for (std::size_t s = 0; s < way.rangeMm.size(); ++s)
  {
    ASSERT_NEAR(way.rangeMm[s], range, 1e-6 * (1.0 + range)) << s;
    ASSERT_NEAR(way.amplitude[s], std::exp(-0.5 * lost), 1e-6 * std::exp(-0.5 * lost)) << s;
    ASSERT_NEAR(way.absorbedNp[s], absorbed, 1e-6 * (1.0 + absorbed)) << s;
    const FlightStep& next = s == 1000 ? boundary : step;
    range += double(next.rangeMm);
    lost += double(next.lostNp);
    absorbed += double(next.absorbedNp);
  }
  EXPECT_NEAR(sums.rangeMm, range, 1e-9 * range);
  EXPECT_NEAR(sums.amplitude, std::exp(-0.5 * lost), 1e-9);
}
