#include "Scene/SmoothedMask.h"

#include "Core/Simd.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

/// out[i] = sum over k of weight[k] in[i + k stride], for `length` contiguous i.
SONO_SIMD_CLONES void weightedSum(const float* in, std::ptrdiff_t stride, const float* weight, int taps, int length,
                                  float* out)
{
  for (int i = 0; i < length; ++i)
  {
    out[i] = weight[0] * in[i];
  }
  for (int k = 1; k < taps; ++k)
  {
    const float w = weight[k];
    const float* row = in + k * stride;
    for (int i = 0; i < length; ++i)
    {
      out[i] += w * row[i];
    }
  }
}

} // namespace

GaussianAxes makeGaussian(const Vec3d& spacingMm, double sigmaMm)
{
  GaussianAxes axes;
  for (int a = 0; a < 3; ++a)
  {
    const double sigma = sigmaMm / spacingMm[a];
    const int radius = std::max(1, int(std::ceil(2.6 * sigma)));
    axes.radius[a] = radius;
    auto& weight = axes.weight[std::size_t(a)];
    double sum = 0.0;
    for (int i = -radius; i <= radius; ++i)
    {
      // The Gaussian's integral over a voxel: the sum over a half space is then exact at the voxel centres.
      const double scale = 1.0 / (sigma * std::sqrt(2.0));
      const double w = 0.5 * (std::erf((i + 0.5) * scale) - std::erf((i - 0.5) * scale));
      weight.push_back(float(w));
      sum += w;
    }
    for (float& w : weight)
    {
      w = float(w / sum);
    }
  }
  return axes;
}

template<class Voxel>
void MaskSmoother<Voxel>::smooth(Voxel value, const Vec3i& first, const Vec3i& count, const GaussianAxes& gaussian,
                                 float* out)
{
  const Vec3i r = gaussian.radius;
  const Vec3i wide = count + r + r;
  const std::ptrdiff_t plane = std::ptrdiff_t(wide.x) * wide.y;
  indicator_.resize(std::size_t(plane) * wide.z);
  alongZ_.resize(std::size_t(plane) * count.z);
  alongY_.resize(std::size_t(wide.x) * count.y * count.z);

  const int x0 = first.x - r.x;
  const bool inside = x0 >= 0 && x0 + wide.x <= size_.x;
  float* to = indicator_.data();
  for (int k = 0; k < wide.z; ++k)
  {
    const int z = std::clamp(first.z - r.z + k, 0, size_.z - 1);
    for (int j = 0; j < wide.y; ++j, to += wide.x)
    {
      const int y = std::clamp(first.y - r.y + j, 0, size_.y - 1);
      const Voxel* row = voxels_ + std::size_t(size_.x) * (std::size_t(y) + std::size_t(size_.y) * z);
      for (int i = 0; i < wide.x; ++i)
      {
        const int x = inside ? x0 + i : std::clamp(x0 + i, 0, size_.x - 1);
        to[i] = row[x] == value ? 1.0f : 0.0f;
      }
    }
  }
  for (int k = 0; k < count.z; ++k)
  {
    weightedSum(indicator_.data() + k * plane, plane, gaussian.weight[2].data(), 2 * r.z + 1, int(plane),
                alongZ_.data() + k * plane);
    weightedSum(alongZ_.data() + k * plane, wide.x, gaussian.weight[1].data(), 2 * r.y + 1, wide.x * count.y,
                alongY_.data() + std::ptrdiff_t(k) * wide.x * count.y);
  }
  for (int row = 0; row < count.y * count.z; ++row)
  {
    weightedSum(alongY_.data() + std::ptrdiff_t(row) * wide.x, 1, gaussian.weight[0].data(), 2 * r.x + 1, count.x,
                out + std::ptrdiff_t(row) * count.x);
  }
}

template class MaskSmoother<std::uint8_t>;
template class MaskSmoother<std::uint16_t>;

} // namespace sono
