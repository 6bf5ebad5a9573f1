#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

// Loops over rows of numbers, from one source: g++ computes a vector's lanes at a time, and with nvcc a warp shares a
// row, each thread being a lane; whatever lies in no lane, all of its threads compute alike. What is compiled so lives
// in a namespace of its own, or the linker would take the one for the other. SONO_LANES_CALLED is for what is asked for
// in many places: copies of it would not fit into a GPU's cache of instructions.

#if defined(__CUDACC__)
#define SONO_LANES_NAMESPACE warp
#define SONO_LANES __device__
#define SONO_LANES_CALLED __device__ __noinline__
#define SONO_ROLLED _Pragma("unroll 1")
#else
#define SONO_LANES_NAMESPACE vectors
#define SONO_LANES
#define SONO_LANES_CALLED
#define SONO_ROLLED
#endif

namespace sono::stepfit {
inline namespace SONO_LANES_NAMESPACE {

#if defined(__CUDACC__)

using Floats = float;
constexpr int lanes = 32;

SONO_LANES inline int lane()
{
  return int(threadIdx.x) % lanes;
}

/// first, first + 1, first + 2, ...
SONO_LANES inline void countFrom(float first, Floats& to)
{
  to = first + float(lane());
}

SONO_LANES inline void load(const float* from, Floats& to)
{
  to = from[lane()];
}

SONO_LANES inline void load(const std::int8_t* from, Floats& to)
{
  to = float(from[lane()]);
}

SONO_LANES inline void rootOf(const Floats& v, Floats& to)
{
  to = sqrtf(v);
}

/// Calls f(n) for the numbers of a vector that the thread has, for numberOf().
template<class F>
SONO_LANES inline void forNumbers(const F& f)
{
  f(lane());
}

SONO_LANES inline float numberOf(const Floats& v, int)
{
  return v;
}

/// The lane's part of the sum.
SONO_LANES inline double sumOf(Floats v)
{
  return v;
}

/// Sums of the lanes' parts, to memory that they share.
template<int count>
SONO_LANES inline void wholeSums(const double (&parts)[count], double* to)
{
  static_assert(count <= lanes);
  // Half of what a lane has goes to another one, until each has a sum of its own.
  double left[lanes];
#pragma unroll
  for (int n = 0; n < lanes; ++n)
  {
    left[n] = n < count ? parts[n] : 0.0;
  }
#pragma unroll
  for (int half = lanes / 2; half > 0; half /= 2)
  {
    const bool isUpper = (lane() & half) != 0;
#pragma unroll
    for (int n = 0; n < half; ++n)
    {
      const double other = __shfl_xor_sync(0xffffffffu, isUpper ? left[n] : left[n + half], half);
      left[n] = (isUpper ? left[n + half] : left[n]) + other;
    }
  }
  if (lane() < count)
  {
    to[lane()] = left[0];
  }
  __syncwarp();
}

SONO_LANES inline float largestOf(Floats v)
{
  for (int other = lanes / 2; other > 0; other /= 2)
  {
    v = fmaxf(v, __shfl_xor_sync(0xffffffffu, v, other));
  }
  return v;
}

/// Calls f(n) for n in [0, count), in any order; what was written before is there.
template<class F>
SONO_LANES inline void forEach(int count, const F& f)
{
  __syncwarp();
  SONO_ROLLED
  for (int n = lane(); n < count; n += lanes)
  {
    f(n);
  }
  __syncwarp();
}

/// Calls f(row, column) for each cell of a table, likewise.
template<class F>
SONO_LANES inline void forCells(int rows, int columns, const F& f)
{
  forEach(rows * columns, [&](int n) { f(n / columns, n % columns); });
}

#else

using Floats = float __attribute__((vector_size(32)));
constexpr int lanes = 8;

/// first, first + 1, first + 2, ...
inline void countFrom(float first, Floats& to)
{
  to = Floats{ 0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f } + first;
}

inline void load(const float* from, Floats& to)
{
  std::memcpy(&to, from, sizeof to);
}

inline void load(const std::int8_t* from, Floats& to)
{
  using Bytes = std::int8_t __attribute__((vector_size(8)));
  Bytes bytes;
  std::memcpy(&bytes, from, sizeof bytes);
  to = __builtin_convertvector(bytes, Floats);
}

inline void store(const Floats& v, float* to)
{
  std::memcpy(to, &v, sizeof v);
}

inline void rootOf(const Floats& v, Floats& to)
{
  float roots[lanes];
  store(v, roots);
  for (float& root : roots)
  {
    root = std::sqrt(root);
  }
  load(roots, to);
}

/// Calls f(n) for the numbers of a vector that the thread has, for numberOf().
template<class F>
inline void forNumbers(const F& f)
{
  for (int n = 0; n < lanes; ++n)
  {
    f(n);
  }
}

inline float numberOf(const Floats& v, int n)
{
  return v[n];
}

inline double sumOf(const Floats& v)
{
  return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}

template<int count>
inline void wholeSums(const double (&parts)[count], double* to)
{
  std::copy(parts, parts + count, to);
}

inline float largestOf(const Floats& v)
{
  return std::max(std::max(std::max(v[0], v[1]), std::max(v[2], v[3])),
                  std::max(std::max(v[4], v[5]), std::max(v[6], v[7])));
}

/// Calls f(n) for n in [0, count), in any order.
template<class F>
inline void forEach(int count, const F& f)
{
  for (int n = 0; n < count; ++n)
  {
    f(n);
  }
}

template<class F>
inline void forCells(int rows, int columns, const F& f)
{
  for (int row = 0; row < rows; ++row)
  {
    for (int column = 0; column < columns; ++column)
    {
      f(row, column);
    }
  }
}

#endif

} // namespace SONO_LANES_NAMESPACE
} // namespace sono::stepfit
