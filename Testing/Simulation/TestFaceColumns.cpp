#include "Scene/FaceColumns.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace {

using namespace sono;

/// Whole vectors of a wide volume, and a narrow one's few, against sums one by one.
TEST(FaceColumns, AreTheWeightsOfTheFaces)
{
  std::mt19937 random(3);
  for (const Vec3i size : { Vec3i(40, 9, 8), Vec3i(12, 9, 8) })
  {
    std::vector<std::uint8_t> tissues(std::size_t(size.x) * size.y * size.z);
    for (std::uint8_t& tissue : tissues)
    {
      tissue = std::uint8_t(random() % 3 + 200); // also those that are negative as signed bytes
    }
    const std::vector<float> weightY{ 0.1f, 0.3f, 0.5f, 0.3f, 0.1f, 0.05f, 0.02f };
    const std::vector<float> weightZ{ 0.2f, 0.6f, 0.2f, 0.1f, 0.3f, 0.4f };
    const auto at = [&](int x, int y, int z) { return tissues[std::size_t(x + size.x * (y + size.y * z))]; };
    const Vec3i low(1, 1, 1);
    const Vec3i count = glm::min(Vec3i(FaceColumns::most, 100, 100), size - 2);
    FaceColumns columns;
    sumFaces(&tissues[std::size_t(1 + size.x * (1 + size.y))], size, 201, count, weightY.data(), weightZ.data(),
             columns);
    for (int i = 0; i < count.x; ++i)
    {
      for (int a = 0; a < 3; ++a)
      {
        const Vec3i step(a == 0, a == 1, a == 2);
        double toward = 0.0;
        double away = 0.0;
        for (int k = 0; k < count.z; ++k)
        {
          for (int j = 0; j < count.y; ++j)
          {
            const Vec3i v = low + Vec3i(i, j, k);
            const double weight = at(v.x, v.y, v.z) == 201 ? weightY[std::size_t(j)] * weightZ[std::size_t(k)] : 0.0;
            toward += at(v.x + step.x, v.y + step.y, v.z + step.z) != 201 ? weight : 0.0;
            away += at(v.x - step.x, v.y - step.y, v.z - step.z) != 201 ? weight : 0.0;
          }
        }
        EXPECT_NEAR(columns.toward[a][i], toward, 1e-6);
        EXPECT_NEAR(columns.away[a][i], away, 1e-6);
      }
    }
  }
}

} // namespace
