#include "Echo/NestedShares.h"

#include "Core/Simd.h"
#include "Echo/WithProfile.h"
#include "Kernel/FastMath.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace sono {

namespace {

// This file is compiled without fused multiplication and addition: see roundedProduct.

/// A row's bricks as a beam meets them; arrays by brick, up to whole vectors. Loops are from `from` to in front of
/// `to`.
struct MetBricks
{
  float* depthMm;
  float* lateralMm;
  float* elevationalMm;
  std::int32_t* at; ///< in the density's table, of the brick and of that of the next level in which it lies
  std::int32_t* parentAt;
};

SONO_SIMD_CLONES __attribute__((flatten)) void meetBricks(const Beam& b, const Vec3i& first, const Vec3i& step,
                                                          const DensityView& d, int level, int from, int to,
                                                          const MetBricks& out)
{
  const Vec3f origin = b.origin;
  const Vec3f axis = b.axis;
  const Vec3f lateral = b.lateral;
  const Vec3f elevation = b.elevation;
  const DensityView density = d;
  float* depthMm = out.depthMm;
  float* lateralMm = out.lateralMm;
  float* elevationalMm = out.elevationalMm;
  std::int32_t* at = out.at;
  std::int32_t* parentAt = out.parentAt;
#pragma GCC ivdep
  for (int n = from; n < to; ++n)
  {
    const Vec3i brick(first.x + n * step.x, first.y + n * step.y, first.z + n * step.z);
    const Vec3f q = nestedBrickCentre(brick, level) - origin;
    const Vec3i parent(brick.x >> 1, brick.y >> 1, brick.z >> 1);
    const float depth = nestedBrickDepth(brick, level, origin, axis);
    depthMm[n] = depth;
    lateralMm[n] = q.x * lateral.x + q.y * lateral.y + q.z * lateral.z;
    elevationalMm[n] = q.x * elevation.x + q.y * elevation.y + q.z * elevation.z;
    at[n] = density.at(depth);
    parentAt[n] = density.at(nestedBrickDepth(parent, level + 1, origin, axis));
  }
}

/// The shares of bricks, as DensityView::share; arrays by brick.
struct TakenBricks
{
  float* perMm3; ///< needed, 0: not taken
  std::int32_t* count;
  std::int32_t* whole;
  float* scale;
  float* faded;
};

/// relativeWeight of a Gaussian for each brick, in place of its lateral place, and at the nearest place, in place of
/// the elevational one.
template<class ProfileOf>
inline void weighBricks(const ProfileOf& profileOf, const MetBricks& met, const Vec2f& halfMm, int from, int to)
{
  const float* depthMm = met.depthMm;
  float* lateralMm = met.lateralMm;
  float* elevationalMm = met.elevationalMm;
#pragma GCC ivdep
  for (int n = from; n < to; ++n)
  {
    const ProfileAt at = profileOf(larger(depthMm[n], 0.0f));
    const float l = std::fabs(lateralMm[n]);
    const float e = std::fabs(elevationalMm[n]);
    const float nearL = larger(0.0f, l - halfMm.x);
    const float nearE = larger(0.0f, e - halfMm.y);
    lateralMm[n] = expNegative(-0.5f * (l * l * at.perLateral2 + e * e * at.perElevational2));
    elevationalMm[n] = expNegative(-0.5f * (nearL * nearL * at.perLateral2 + nearE * nearE * at.perElevational2));
  }
}

SONO_SIMD_CLONES __attribute__((flatten)) void weighByGaussian(const Beam& b, const MetBricks& met, const Vec2f& halfMm,
                                                               int from, int to)
{
  withProfile(b, [&](const auto& profile) { weighBricks(profile, met, halfMm, from, to); });
}

/// By the weights of bricks and of their nearest places. What is decided stays in memory from loop to loop: otherwise
/// the compiler makes branches of it.
SONO_SIMD_CLONES __attribute__((flatten)) void takeShares(const float* weight, const float* most, float edgeMm,
                                                          int from, int to, const TakenBricks& bricks)
{
  const TakenBricks out = bricks;
#pragma GCC ivdep
  for (int n = from; n < to; ++n)
  {
    out.scale[n] = nestedEighths(out.perMm3[n], edgeMm, weight[n]);
    out.faded[n] = out.perMm3[n] > 0.0f ? 1.0f : 0.0f;
    out.perMm3[n] = most[n] >= nestedLeastWeight ? 1.0f : 0.0f;
  }
#pragma GCC ivdep
  for (int n = from; n < to; ++n)
  {
    const NestedShare share = nestedShareOf(out.scale[n], edgeMm);
    out.count[n] = int(float(share.count) * out.faded[n] * out.perMm3[n]);
    out.whole[n] = share.whole;
    out.scale[n] = share.scale;
    out.faded[n] = share.scale * share.last;
  }
}

/// B(t) = B_par + anisotropy sin^2 t (Data/docs/physics.md eq. 11.4); the amplitudes are those across the fibres.
SONO_SIMD_CLONES __attribute__((flatten)) void hearAlong(const Vec3f& axis, const float* fx, const float* fy,
                                                         const float* fz, int count, float* amplitude)
{
  const Vec3f a = axis;
  for (int n = 0; n < count; ++n)
  {
    const float cosine = fx[n] * a.x + fy[n] * a.y + fz[n] * a.z; // times the root of the anisotropy
    amplitude[n] *= expNegative(-cosine * cosine);
  }
}

/// What a beam takes of each brick of a row.
struct TakenParts
{
  const std::int32_t* count;
  const std::int32_t* whole;
  const float* scale;
  const float* faded;
};

/// Places and amplitudes of scatterers.
struct HeardScatterers
{
  float *x, *y, *z, *amplitude;
};

/// A beam takes four of a brick on average: wider vectors would write mostly what is written over.
constexpr int fewScatterers = vectorWidth / 2;

/// Brick by brick, written in whole vectors, each over the rest of the one before; how many there are.
SONO_SIMD_CLONES __attribute__((flatten)) int takeScatterers(const NestedScatterers::Row& row, int first, int last,
                                                             const TakenParts& parts, const HeardScatterers& to)
{
  const TakenParts part = parts;
  const HeardScatterers out = to;
  const int* before = row.before.data();
  const int* firstCandidate = row.firstCandidate.data();
  const int* reached = row.reached.data();
  int heard = 0;
  for (int b = first; b <= last; ++b)
  {
    const int* ofBrick = reached + firstCandidate[b];
    const int from = before[b];
    const int taken = ofBrick[part.count[b]] - from;
    const int whole = ofBrick[std::min(part.whole[b], part.count[b])] - from;
    const float scale = part.scale[b];
    const float faded = part.faded[b];
    const float *x = row.x.data() + from, *y = row.y.data() + from, *z = row.z.data() + from;
    const float* amplitude = row.amplitude.data() + from;
    float *toX = out.x + heard, *toY = out.y + heard, *toZ = out.z + heard, *toAmplitude = out.amplitude + heard;
    for (int n = 0; n < taken; n += fewScatterers)
    {
      std::memcpy(toX + n, x + n, fewScatterers * sizeof(float));
      std::memcpy(toY + n, y + n, fewScatterers * sizeof(float));
      std::memcpy(toZ + n, z + n, fewScatterers * sizeof(float));
    }
    const int end = inWholeVectors(taken);
#pragma GCC ivdep
    for (int n = 0; n < end; ++n)
    {
      toAmplitude[n] = amplitude[n] * (n < whole ? scale : faded);
    }
    heard += taken;
  }
  return heard;
}

} // namespace

void NestedShares::resize(std::size_t bricks)
{
  for (std::vector<std::int32_t>* values : { &count_, &whole_, &at_, &parentAt_ })
  {
    values->resize(std::max(values->size(), bricks));
  }
  for (std::vector<float>* values : { &scale_, &faded_, &depthMm_, &lateralMm_, &elevationalMm_, &perMm3_ })
  {
    values->resize(std::max(values->size(), bricks));
  }
}

void NestedShares::look(const Beam& beam, std::size_t index, const BrickRow& row, const DensityView& density, int level)
{
  const BrickRow::Span span = row.span(index);
  first_ = 0;
  last_ = -1;
  if (span.last < span.first)
  {
    return;
  }
  resize(std::size_t(row.count() + vectorWidth));
  const int end = span.first + inWholeVectors(span.last - span.first + 1);
  const MetBricks met{ depthMm_.data(), lateralMm_.data(), elevationalMm_.data(), at_.data(), parentAt_.data() };
  const Vec3i first = row.brick(0);
  meetBricks(beam, first, row.brick(1) - first, density, level, span.first, end, met);
  const bool isByGaussian = isGaussian(beam);
  bool takesAny = false;
  std::fill(perMm3_.begin() + span.last + 1, perMm3_.begin() + end, 0.0f);
  for (int n = span.first; n <= span.last; ++n)
  {
    const std::size_t k = std::size_t(n);
    const bool isTaken = density.takesAt(level, at_[k], parentAt_[k]) && (isByGaussian || row.sees(index, n));
    perMm3_[k] = isTaken ? density.perMm3[at_[k]] : 0.0f;
    takesAny |= isTaken;
  }
  if (!takesAny)
  {
    return;
  }
  const Vec2f halfMm = nestedHalfExtent(beam, level);
  if (isByGaussian)
  {
    weighByGaussian(beam, met, halfMm, span.first, end);
  }
  for (int n = span.first; !isByGaussian && n <= span.last; ++n)
  {
    const Vec3f q = nestedBrickCentre(row.brick(n), level) - beam.origin;
    const float depthMm = met.depthMm[n];
    const float most = perMm3_[std::size_t(n)] > 0.0f ? relativeWeight(beam, q, depthMm, halfMm) : 0.0f;
    met.lateralMm[n] = most >= nestedLeastWeight ? relativeWeight(beam, q, depthMm) : 0.0f;
    met.elevationalMm[n] = most;
  }
  takeShares(met.lateralMm, met.elevationalMm, nestedCellMm(level), span.first, end,
             { perMm3_.data(), count_.data(), whole_.data(), scale_.data(), faded_.data() });
  first_ = span.first;
  last_ = span.last;
  while (first_ <= last_ && count(first_) == 0)
  {
    ++first_;
  }
  while (first_ <= last_ && count(last_) == 0)
  {
    --last_;
  }
}

ScattererView NestedShares::hear(const NestedScatterers::Row& row, const Vec3f& axis)
{
  const int most = row.before[std::size_t(last_) + 1] - row.before[std::size_t(first_)];
  for (std::vector<float>* values : { &x_, &y_, &z_, &amplitude_, &fibreX_, &fibreY_, &fibreZ_ })
  {
    values->resize(std::max(values->size(), std::size_t(most + vectorWidth)));
  }
  const TakenParts parts{ count_.data(), whole_.data(), scale_.data(), faded_.data() };
  const int heard = takeScatterers(row, first_, last_, parts, { x_.data(), y_.data(), z_.data(), amplitude_.data() });
  if (row.hasFibres)
  {
    int to = 0;
    for (int b = first_; b <= last_; ++b)
    {
      const int from = row.before[std::size_t(b)];
      const int taken = row.among(b, count(b));
      std::copy_n(row.fibreX.data() + from, taken, fibreX_.data() + to);
      std::copy_n(row.fibreY.data() + from, taken, fibreY_.data() + to);
      std::copy_n(row.fibreZ.data() + from, taken, fibreZ_.data() + to);
      to += taken;
    }
    hearAlong(axis, fibreX_.data(), fibreY_.data(), fibreZ_.data(), inWholeVectors(heard), amplitude_.data());
  }
  return { x_.data(), y_.data(), z_.data(), amplitude_.data(), heard, 1.0f, true };
}

} // namespace sono
