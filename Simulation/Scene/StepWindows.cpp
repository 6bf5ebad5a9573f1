#include "Scene/StepWindows.h"

#include <algorithm>

namespace sono::stepfit {

WindowTables::WindowTables()
{
  for (int radius = 0; radius <= widest; ++radius)
  {
    first.push_back(weight.size());
    float sum = 0.0f;
    for (int j = -radius; j <= radius; ++j)
    {
      for (int i = -radius; i <= radius; ++i)
      {
        const double q = std::max(0.0, 1.0 - double(i * i + j * j) / ((radius + 1.0) * (radius + 1.0)));
        weight.push_back(float(q));
        sum += weight.back();
        strictness.push_back(float(std::min(1.0, 2.0 * q * q)));
      }
    }
    total.push_back(sum);
  }
  weight.resize(weight.size() + mostLanes);
  strictness.resize(weight.size());
}

std::vector<Window> WindowTables::windows(const float* weights, const float* strictnesses) const
{
  std::vector<Window> all;
  for (std::size_t radius = 0; radius < first.size(); ++radius)
  {
    all.push_back({ weights + first[radius], strictnesses + first[radius], total[radius] });
  }
  return all;
}

const WindowTables& windowTables()
{
  static const WindowTables tables;
  return tables;
}

const Window* hostWindows()
{
  static const std::vector<Window> all =
    windowTables().windows(windowTables().weight.data(), windowTables().strictness.data());
  return all.data();
}

} // namespace sono::stepfit
