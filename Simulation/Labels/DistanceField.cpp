#include "Labels/DistanceField.h"

#include "Core/LargeMemory.h"
#include "Core/ParallelFor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sono {

namespace {

constexpr float far = 1e12f; // squared mm

/// Lower envelope of the parabolas value[q] + (step (p - q))^2, at every p. Keeps its scratch memory.
class Envelope
{
public:
  void transform(float* line, std::ptrdiff_t stride, int count, double step)
  {
    value_.resize(std::size_t(count));
    vertex_.resize(std::size_t(count));
    start_.resize(std::size_t(count) + 1);
    bool isZero = true;
    for (int q = 0; q < count; ++q)
    {
      value_[std::size_t(q)] = line[q * stride];
      isZero = isZero && line[q * stride] == 0.0f;
    }
    if (isZero)
    {
      return; // and stays so, as most of a volume does
    }
    int last = -1;
    for (int q = 0; q < count; ++q)
    {
      if (value_[std::size_t(q)] >= double(far))
      {
        continue;
      }
      double from = -HUGE_VAL;
      while (last >= 0 && (from = crossing(vertex_[std::size_t(last)], q, step)) <= start_[std::size_t(last)])
      {
        --last;
      }
      ++last;
      vertex_[std::size_t(last)] = q;
      start_[std::size_t(last)] = last == 0 ? -HUGE_VAL : from;
    }
    if (last < 0)
    {
      return;
    }
    int at = 0;
    for (int p = 0; p < count; ++p)
    {
      while (at < last && start_[std::size_t(at) + 1] < p)
      {
        ++at;
      }
      const int q = vertex_[std::size_t(at)];
      const double away = step * (p - q);
      line[p * stride] = float(value_[std::size_t(q)] + away * away);
    }
  }

private:
  /// Where the parabola of q falls below that of the earlier r.
  double crossing(int r, int q, double step) const
  {
    const double rise = (value_[std::size_t(q)] - value_[std::size_t(r)]) / (step * step);
    return 0.5 * (rise / (q - r) + q + r);
  }

  std::vector<double> value_;
  std::vector<int> vertex_;
  std::vector<double> start_;
};

} // namespace

std::vector<float> distanceTo(const std::vector<char>& mask, const Vec3i& size, const Vec3d& spacingMm)
{
  auto squared = largeVector<float>(mask.size());
  const std::ptrdiff_t row = size.x;
  const std::ptrdiff_t plane = row * size.y;
  parallelFor(size.z, {}, [&](int k) {
    std::transform(mask.begin() + k * plane, mask.begin() + (k + 1) * plane, squared.begin() + k * plane,
                   [](char mark) { return mark ? 0.0f : far; });
    Envelope envelope;
    for (int j = 0; j < size.y; ++j)
    {
      envelope.transform(squared.data() + k * plane + j * row, 1, size.x, spacingMm.x);
    }
    for (int i = 0; i < size.x; ++i)
    {
      envelope.transform(squared.data() + k * plane + i, row, size.y, spacingMm.y);
    }
  });
  parallelFor(size.y, {}, [&](int j) {
    Envelope envelope;
    for (int i = 0; i < size.x; ++i)
    {
      envelope.transform(squared.data() + j * row + i, plane, size.z, spacingMm.z);
    }
    for (int k = 0; k < size.z; ++k)
    {
      float* line = squared.data() + k * plane + j * row;
      for (int i = 0; i < size.x; ++i)
      {
        line[i] = std::sqrt(line[i]);
      }
    }
  });
  return squared;
}

} // namespace sono
