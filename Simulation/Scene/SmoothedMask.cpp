#include "Scene/SmoothedMask.h"

#include "Core/Simd.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace sono {

namespace {

// Not wider than AVX2's: the compiler keeps what is wider on the stack there, which takes several times as long.
constexpr int lanes = 8;
using Floats = float __attribute__((vector_size(4 * lanes)));
using Masks = std::int32_t __attribute__((vector_size(4 * lanes)));
using Bytes = std::uint8_t __attribute__((vector_size(lanes)));
using Words = std::uint16_t __attribute__((vector_size(2 * lanes)));

/// Sums of so many vectors of numbers, in registers.
template<int vectors>
inline void sumVectors(const float* in, std::ptrdiff_t stride, const float* weight, int taps, float* out)
{
  Floats sum[vectors]{};
  for (int k = 0; k < taps; ++k, in += stride)
  {
    for (int v = 0; v < vectors; ++v)
    {
      Floats row;
      std::memcpy(&row, in + v * lanes, sizeof row);
      sum[v] += weight[k] * row;
    }
  }
  std::memcpy(out, sum, sizeof sum);
}

/// out[i] = sum over k of weight[k] in[i + k stride], for `length` contiguous i.
SONO_SIMD_CLONES __attribute__((flatten)) void weightedSum(const float* in, std::ptrdiff_t stride, const float* weight,
                                                           int taps, int length, float* out)
{
  int i = 0;
  for (; i + 8 * lanes <= length; i += 8 * lanes)
  {
    sumVectors<8>(in + i, stride, weight, taps, out + i);
  }
  for (; i + lanes <= length; i += lanes)
  {
    sumVectors<1>(in + i, stride, weight, taps, out + i);
  }
  if (i < length && length >= lanes) // the rest with some of those before, once more
  {
    sumVectors<1>(in + length - lanes, stride, weight, taps, out + length - lanes);
    return;
  }
  for (; i < length; ++i)
  {
    float sum = 0.0f;
    for (int k = 0; k < taps; ++k)
    {
      sum += weight[k] * in[i + k * stride];
    }
    out[i] = sum;
  }
}

/// 1 where a row has the value, 0 elsewhere.
template<class Voxel>
inline void markRow(const Voxel* row, Voxel value, int count, float* out)
{
  using Voxels = std::conditional_t<sizeof(Voxel) == 1, Bytes, Words>;
  const Voxels wanted = Voxels{} + value;
  const Masks one = (Masks)(Floats{} + 1.0f);
  const auto markVector = [&](int i) {
    Voxels own;
    std::memcpy(&own, row + i, sizeof own);
    const Masks isIt = __builtin_convertvector(own == wanted, Masks) & one;
    std::memcpy(out + i, &isIt, sizeof isIt);
  };
  int i = 0;
  for (; i + lanes <= count; i += lanes)
  {
    markVector(i);
  }
  if (i < count && count >= lanes)
  {
    markVector(count - lanes);
    return;
  }
  for (; i < count; ++i)
  {
    out[i] = row[i] == value ? 1.0f : 0.0f;
  }
}

/// A part of a slice, which its border continues.
template<class Voxel>
struct SlicePart
{
  const Voxel* slice;
  int width, height; ///< of the slice
  int firstX, firstY;
  int countX, countY;
};

/// 1 where it has the value, 0 elsewhere.
template<class Voxel>
inline void markRows(const SlicePart<Voxel>& part, Voxel value, float* out)
{
  const bool isInside = part.firstX >= 0 && part.firstX + part.countX <= part.width;
  for (int j = 0; j < part.countY; ++j, out += part.countX)
  {
    const Voxel* row = part.slice + std::ptrdiff_t(part.width) * std::clamp(part.firstY + j, 0, part.height - 1);
    if (isInside)
    {
      markRow(row + part.firstX, value, part.countX, out);
      continue;
    }
    for (int i = 0; i < part.countX; ++i)
    {
      out[i] = row[std::clamp(part.firstX + i, 0, part.width - 1)] == value ? 1.0f : 0.0f;
    }
  }
}

SONO_SIMD_CLONES __attribute__((flatten)) void mark(const SlicePart<std::uint8_t>& part, std::uint8_t value, float* out)
{
  markRows(part, value, out);
}

SONO_SIMD_CLONES __attribute__((flatten)) void mark(const SlicePart<std::uint16_t>& part, std::uint16_t value,
                                                    float* out)
{
  markRows(part, value, out);
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
  const std::size_t rows = std::size_t(wide.x) * count.y * count.z;
  // Room that is there stays: all that is read is written before.
  const auto makeRoom = [](std::vector<float>& room, std::size_t size) {
    if (room.size() < size)
    {
      room.resize(size);
    }
  };
  makeRoom(indicator_, std::size_t(plane) * wide.z);
  makeRoom(alongZ_, std::size_t(plane) * count.z);
  makeRoom(alongY_, rows);
  makeRoom(alongX_, rows);

  for (int k = 0; k < wide.z; ++k)
  {
    const int z = std::clamp(first.z - r.z + k, 0, size_.z - 1);
    const SlicePart<Voxel> part{
      voxels_ + std::ptrdiff_t(size_.x) * size_.y * z, size_.x, size_.y, first.x - r.x, first.y - r.y, wide.x, wide.y
    };
    mark(part, value, indicator_.data() + k * plane);
  }
  for (int k = 0; k < count.z; ++k)
  {
    weightedSum(indicator_.data() + k * plane, plane, gaussian.weight[2].data(), 2 * r.z + 1, int(plane),
                alongZ_.data() + k * plane);
    weightedSum(alongZ_.data() + k * plane, wide.x, gaussian.weight[1].data(), 2 * r.y + 1, wide.x * count.y,
                alongY_.data() + std::ptrdiff_t(k) * wide.x * count.y);
  }
  // All rows in one run; what mixes two of them is not taken over.
  weightedSum(alongY_.data(), 1, gaussian.weight[0].data(), 2 * r.x + 1, int(rows) - 2 * r.x, alongX_.data());
  for (int row = 0; row < count.y * count.z; ++row)
  {
    std::copy_n(alongX_.data() + std::ptrdiff_t(row) * wide.x, count.x, out + std::ptrdiff_t(row) * count.x);
  }
}

template class MaskSmoother<std::uint8_t>;
template class MaskSmoother<std::uint16_t>;

} // namespace sono
