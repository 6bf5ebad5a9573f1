#include "Probe/BeamReachTable.h"

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using sono::BeamReachTable;
using sono::Vec2f;

// Any two depths, before, in and behind the table, against a look at each step between them.
TEST(BeamReachTable, TellsTheWidestStepBetweenTwoDepths)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<float> reachMm(0.0f, 40.0f);
  for (const int steps : { 1, 2, 3, 37, 64 })
  {
    BeamReachTable table(0.5f);
    for (int n = 0; n < steps; ++n)
    {
      table.add(Vec2f(reachMm(random), reachMm(random)));
    }
    ASSERT_EQ(table.steps(), steps);
    for (int from = -2; from < steps + 2; ++from)
    {
      for (int to = from; to < steps + 2; ++to)
      {
        Vec2f widest(0.0f);
        for (int n = from; n <= to; ++n)
        {
          widest = glm::max(widest, table.step(std::min(std::max(n, 0), steps - 1)));
        }
        EXPECT_EQ(table.widest(0.5f * (float(from) + 0.1f), 0.5f * (float(to) + 0.9f)), widest) << from << " to " << to;
      }
    }
  }
}
