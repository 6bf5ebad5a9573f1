#pragma once

#include "Kernel/EchoSplat.h"

#include <cuda_runtime.h>

#include <cstdint>

// One block sums the scatterers of a chunk of a line's samples: which cells of a lattice it has to look at, and sums
// that do not depend on the order.

namespace sono {

constexpr int chunkSamples = 512;
constexpr float halfDiagonal = 0.8660254f; // of a cube of edge 1: from its centre to its corners

/// Sums of a chunk in shared memory as integers: for amplitudes of which it is known how many come together.
struct ShortSums
{
  int value_[2 * chunkSamples];

  __device__ void clear()
  {
    for (int i = threadIdx.x; i < 2 * chunkSamples; i += blockDim.x)
    {
      value_[i] = 0;
    }
  }
  __device__ int samples() const { return chunkSamples; }
  __device__ void add(int i, float value) { atomicAdd(value_ + i, __float2int_rn(value)); }
  __device__ float value(int i, float perUnit) const { return float(value_[i]) * perUnit; }
};

/// The same of any number of samples, in a block's dynamic shared memory.
struct WindowSums
{
  int* value_;
  int samples_;

  __device__ void clear()
  {
    for (int i = threadIdx.x; i < 2 * samples_; i += blockDim.x)
    {
      value_[i] = 0;
    }
  }
  __device__ int samples() const { return samples_; }
  __device__ void add(int i, float value) { atomicAdd(value_ + i, __float2int_rn(value)); }
};

/// The same for any number of amplitudes, each below 2^31 units: 64 bits in two halves, each added to by a native
/// atomic.
struct LongSums
{
  std::uint32_t low[2 * chunkSamples];
  std::uint32_t high[2 * chunkSamples];

  __device__ void clear()
  {
    for (int i = threadIdx.x; i < 2 * chunkSamples; i += blockDim.x)
    {
      low[i] = 0u;
      high[i] = 0u;
    }
  }
  __device__ int samples() const { return chunkSamples; }
  __device__ void add(int i, float value)
  {
    const int v = __float2int_rn(value);
    const std::uint32_t before = atomicAdd(low + i, std::uint32_t(v));
    const std::uint32_t highPart = (v < 0 ? 0xffffffffu : 0u) + (before + std::uint32_t(v) < before ? 1u : 0u);
    if (highPart != 0u)
    {
      atomicAdd(high + i, highPart);
    }
  }
  __device__ float value(int i, float perUnit) const
  {
    return float((long long)((std::uint64_t(high[i]) << 32) | low[i])) * perUnit;
  }
};

/// Adds a scatterer to sums that begin at sample `first`.
template<class Sums>
__device__ void addScatterer(Sums& sums, const ScattererSplit& split, int first, float scale)
{
  const int at = 2 * (int(split.sample) - first);
  if (at >= 0 && at + 3 < 2 * sums.samples())
  {
#pragma unroll
    for (int c = 0; c < 4; ++c)
    {
      sums.add(at + c, split.added[c] * scale);
    }
    return;
  }
  for (int c = 0; c < 4; ++c)
  {
    if (at + c >= 0 && at + c < 2 * sums.samples())
    {
      sums.add(at + c, split.added[c] * scale);
    }
  }
}

/// What the lanes of a warp found, until there is enough for all of them to work on.
template<class Item>
struct WarpQueue
{
  Item items[2 * 32];

  /// All lanes of the warp: those with `found` hand in an item. `process` runs when 32 are there.
  template<class Process>
  __device__ void push(bool found, const Item& item, int& queued, const Process& process)
  {
    const int lane = int(threadIdx.x) % 32;
    const unsigned mask = __ballot_sync(0xffffffffu, found);
    if (found)
    {
      items[queued + __popc(mask & ((1u << lane) - 1u))] = item;
    }
    queued += __popc(mask);
    __syncwarp();
    if (queued >= 32)
    {
      queued -= 32;
      process(items[queued + lane]);
      __syncwarp();
    }
  }
  template<class Process>
  __device__ void finish(int queued, const Process& process)
  {
    if (int(threadIdx.x) % 32 < queued)
    {
      process(items[int(threadIdx.x) % 32]);
    }
  }
};

/// What a beam sees around its axis: an ellipse with these half axes, mm, between two depths.
struct BeamPiece
{
  float fromMm;
  float toMm;
  float lateralMm;
  float elevationalMm;
};

/// The cells of a cubic lattice that a piece of a beam may see, found row by row: layers across the
/// lattice's axis that the beams follow most, in each the rows around the ellipses in which the layer cuts the beams,
/// of each row the cells whose cubes the beam may touch.
class CellRows
{
public:
  /// Cells of one row: `count` from `first` on, along the lattice's axis `u`.
  struct Row
  {
    int layer;
    int v;
    int first;
    int count;
  };

  /// Inside the box [low, high] mm of the lattice. The beam must outlive this.
  __device__ CellRows(const Beam& beam, const BeamPiece& piece, float cellEdge, const Vec3f& low, const Vec3f& high)
    : beam_(beam)
    , edge_(cellEdge)
  {
    const Vec3f size = glm::abs(beam.axis);
    axis_ = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const float margin = halfDiagonal * edge_;
    from_ = piece.fromMm - margin;
    to_ = piece.toMm + margin;
    // An ellipse grown in proportion holds all that is within the margin of it.
    const float grown = 1.0f + margin / fminf(piece.lateralMm, piece.elevationalMm);
    perLateral_ = 1.0f / (piece.lateralMm * grown);
    perElevational_ = 1.0f / (piece.elevationalMm * grown);
    const float radius = grown * fmaxf(piece.lateralMm, piece.elevationalMm);

    const float d = beam.axis[axis_];
    const float across = radius * sqrtf(fmaxf(0.0f, 1.0f - d * d));
    const float a = beam.origin[axis_] + d * from_;
    const float b = beam.origin[axis_] + d * to_;
    const float first = fmaxf(fminf(a, b) - across, low[axis_]);
    const float last = fminf(fmaxf(a, b) + across, high[axis_]);
    firstLayer_ = int(floorf(first / edge_));
    layers_ = last > first ? int(floorf(last / edge_)) - firstLayer_ + 1 : 0;
    slopeV_ = beam.axis[vAxis()] / d;
    reachV_ = radius * sqrtf(1.0f + slopeV_ * slopeV_);
    rowsOfLayer_ = int(2.0f * reachV_ / edge_) + 3;
  }

  __device__ int rowCount() const { return layers_ * rowsOfLayer_; }
  __device__ Row row(int index) const
  {
    Row row;
    row.layer = firstLayer_ + index / rowsOfLayer_;
    const float along = (float(row.layer) + 0.5f) * edge_ - beam_.origin[axis_];
    const float from = beam_.origin[vAxis()] + slopeV_ * along - reachV_;
    row.v = int(floorf(from / edge_)) + index % rowsOfLayer_;
    float low;
    float high;
    interval(row.layer, row.v, low, high);
    row.first = int(ceilf(low - 1e-3f));
    row.count = high >= low ? max(0, int(floorf(high + 1e-3f)) - row.first + 1) : 0;
    return row;
  }
  __device__ Vec3i cell(int layer, int v, int u) const
  {
    return axis_ == 0 ? Vec3i(layer, u, v) : (axis_ == 1 ? Vec3i(v, layer, u) : Vec3i(u, v, layer));
  }

private:
  __device__ int uAxis() const { return axis_ == 2 ? 0 : axis_ + 1; }
  __device__ int vAxis() const { return axis_ == 0 ? 2 : axis_ - 1; }

  /// The cells [low, high] of a row that the beam may touch; none when high < low.
  __device__ void interval(int layer, int rowV, float& low, float& high) const
  {
    const Beam& beam = beam_;
    const int u = uAxis();
    const int v = vAxis();
    // The centre of cell 0 of the row, seen from the beam's origin, and the step to the next.
    Vec3f q;
    q[axis_] = (float(layer) + 0.5f) * edge_ - beam.origin[axis_];
    q[v] = (float(rowV) + 0.5f) * edge_ - beam.origin[v];
    q[u] = 0.5f * edge_ - beam.origin[u];
    const float lateral = glm::dot(q, beam.lateral) * perLateral_;
    const float elevational = glm::dot(q, beam.elevation) * perElevational_;
    const float stepLateral = edge_ * beam.lateral[u] * perLateral_;
    const float stepElevational = edge_ * beam.elevation[u] * perElevational_;
    // |(lateral, elevational) + n (steps)| <= 1 for n between the roots.
    const float a = stepLateral * stepLateral + stepElevational * stepElevational;
    const float b = lateral * stepLateral + elevational * stepElevational;
    const float c = lateral * lateral + elevational * elevational - 1.0f;
    const float root = b * b - a * c;
    low = root > 0.0f ? (-b - sqrtf(root)) / a : 1.0f;
    high = root > 0.0f ? (-b + sqrtf(root)) / a : -1.0f;
    const float depth = glm::dot(q, beam.axis);
    const float step = edge_ * beam.axis[u];
    if (fabsf(step) > 1e-6f * edge_)
    {
      const float s = (from_ - depth) / step;
      const float t = (to_ - depth) / step;
      low = fmaxf(low, fminf(s, t));
      high = fminf(high, fmaxf(s, t));
    }
    else if (depth < from_ || depth > to_)
    {
      high = low - 1.0f;
    }
  }

  const Beam& beam_;
  float edge_;
  int axis_;
  float from_;
  float to_;
  float perLateral_;
  float perElevational_;
  float slopeV_;
  float reachV_;
  int firstLayer_;
  int layers_;
  int rowsOfLayer_;
};

/// A list of lists, one a lane, gone through as one by a whole warp. All lanes call `work(owner, place)` for 32 items
/// at a time, with the lane that owns the item and its place in that lane's list; those beyond the end get owner -1.
template<class Work>
__device__ void forItemsOfWarp(int count, const Work& work)
{
  const int lane = int(threadIdx.x) % 32;
  int end = count; // of this lane's items among all
  for (int step = 1; step < 32; step *= 2)
  {
    const int before = __shfl_up_sync(0xffffffffu, end, unsigned(step));
    end += lane >= step ? before : 0;
  }
  const int total = __shfl_sync(0xffffffffu, end, 31);
  for (int first = 0; first < total; first += 32)
  {
    const int item = first + lane;
    int owner = 0; // lanes whose items end at or before this one
    for (int step = 16; step > 0; step /= 2)
    {
      owner += __shfl_sync(0xffffffffu, end, owner + step - 1) <= item ? step : 0;
    }
    owner = min(owner, 31);
    const int start = __shfl_sync(0xffffffffu, end - count, owner);
    work(item < total ? owner : -1, item - start);
  }
}

} // namespace sono
