#include "Echo/NestedShares.h"

#include "Core/Simd.h"
#include "Echo/ResizeAll.h"
#include "Echo/WithProfile.h"
#include "Kernel/FastMath.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace sono {

namespace {

// This file is compiled without fused multiplication and addition: see roundedProduct.

/// Bricks as a beam meets them; arrays by brick, up to whole vectors.
struct MetBricks
{
  float* depthMm;
  float* lateralMm;
  float* elevationalMm;
  std::int32_t* at; ///< in the density's table, of the brick and of that of the next level in which it lies
  std::int32_t* parentAt;
};

/// `count` of a row.
SONO_SIMD_CLONES __attribute__((flatten)) void meetBricks(const Beam& b, const Vec3i& first, const Vec3i& step,
                                                          const DensityView& d, int level, int count,
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
  for (int n = 0; n < count; ++n)
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

/// relativeWeight of a Gaussian for the share of each brick, in place of its lateral place, and at the nearest place,
/// in place of the elevational one.
template<class ProfileOf>
inline void weighBricks(const ProfileOf& profileOf, const MetBricks& met, const Vec2f& halfMm, int count)
{
  const float* depthMm = met.depthMm;
  float* lateralMm = met.lateralMm;
  float* elevationalMm = met.elevationalMm;
#pragma GCC ivdep
  for (int n = 0; n < count; ++n)
  {
    const ProfileAt at = profileOf(larger(depthMm[n], 0.0f));
    const float l = std::fabs(lateralMm[n]);
    const float e = std::fabs(elevationalMm[n]);
    const float nearL = larger(0.0f, l - halfMm.x);
    const float nearE = larger(0.0f, e - halfMm.y);
    const float inL = larger(0.0f, l - nestedInward * halfMm.x);
    const float inE = larger(0.0f, e - nestedInward * halfMm.y);
    lateralMm[n] = expNegative(-0.5f * (inL * inL * at.perLateral2 + inE * inE * at.perElevational2));
    elevationalMm[n] = expNegative(-0.5f * (nearL * nearL * at.perLateral2 + nearE * nearE * at.perElevational2));
  }
}

SONO_SIMD_CLONES __attribute__((flatten)) void weighByGaussian(const Beam& b, const MetBricks& met, const Vec2f& halfMm,
                                                               int count)
{
  withProfile(b, [&](const auto& profile) { weighBricks(profile, met, halfMm, count); });
}

/// By the weights of bricks and of their nearest places. What is decided stays in memory from loop to loop: otherwise
/// the compiler makes branches of it.
SONO_SIMD_CLONES __attribute__((flatten)) void takeShares(const float* weight, const float* most, float edgeMm,
                                                          int count, const TakenBricks& bricks)
{
  const TakenBricks out = bricks;
#pragma GCC ivdep
  for (int n = 0; n < count; ++n)
  {
    out.scale[n] = nestedEighths(out.perMm3[n], edgeMm, weight[n]);
    out.faded[n] = out.perMm3[n] > 0.0f ? 1.0f : 0.0f;
    out.perMm3[n] = most[n] >= nestedLeastWeight ? 1.0f : 0.0f;
  }
#pragma GCC ivdep
  for (int n = 0; n < count; ++n)
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
                                                         const float* fz, const float* across, int count,
                                                         float* amplitude)
{
  const Vec3f a = axis;
#pragma GCC ivdep
  for (int n = 0; n < count; ++n)
  {
    const float cosine = fx[n] * a.x + fy[n] * a.y + fz[n] * a.z; // times the root of the anisotropy
    amplitude[n] = across[n] * expNegative(-cosine * cosine);
  }
}

/// What a beam takes of the bricks of these numbers.
struct TakenParts
{
  const std::int32_t* brick;
  const std::int32_t* count;
  const std::int32_t* whole;
  const float* scale;
  const float* faded;
};

/// A beam takes four of a brick on average: wider vectors would write mostly what is written over.
constexpr int fewScatterers = vectorWidth / 2;

__attribute__((always_inline)) inline void copyFew(const float* from, float* to)
{
  std::memcpy(to, from, fewScatterers * sizeof(float));
}

/// Places and amplitudes, brick by brick, written in whole vectors, each over the rest of the one before; how many
/// there are. `alongAxis` are the amplitudes of bricks with fibres as the beam hears them.
SONO_SIMD_CLONES __attribute__((flatten)) int takeScatterers(const NestedScatterers::Generated& from,
                                                             const float* alongAxis, int bricks,
                                                             const TakenParts& parts, float* toX, float* toY,
                                                             float* toZ, float* toAmplitude)
{
  const TakenParts part = parts;
  const float *x = from.x.data(), *y = from.y.data(), *z = from.z.data();
  const float* const amplitudes = from.amplitude.data();
  const int* firstOf = from.first.data();
  const char *echoes = from.echoes.data(), *hasFibres = from.hasFibres.data();
  int heard = 0;
  for (int k = 0; k < bricks; ++k)
  {
    const int b = part.brick[k];
    const int first = firstOf[b];
    const int taken = echoes[b] ? part.count[k] : 0;
    const int whole = part.whole[k];
    const float* const amplitude = hasFibres[b] ? alongAxis : amplitudes;
    const float scale = part.scale[k];
    const float faded = part.faded[k];
    for (int n = 0; n < taken; n += fewScatterers)
    {
      copyFew(x + first + n, toX + heard + n);
      copyFew(y + first + n, toY + heard + n);
      copyFew(z + first + n, toZ + heard + n);
      for (int m = 0; m < fewScatterers; ++m)
      {
        toAmplitude[heard + n + m] = amplitude[first + n + m] * (n + m < whole ? scale : faded);
      }
    }
    heard += taken;
  }
  return heard;
}

} // namespace

void NestedShares::meet(const Beam& beam, std::size_t index, const BrickRow& row, int before,
                        const DensityView& density, int level)
{
  const BrickRow::Span span = row.span(index);
  const int count = span.last - span.first + 1;
  if (count <= 0)
  {
    return;
  }
  const std::size_t room = std::size_t(met_ + count + vectorWidth);
  resizeAll({ &brick_, &at_, &parentAt_ }, room);
  resizeAll({ &depthMm_, &lateralMm_, &elevationalMm_, &perMm3_ }, room);
  const std::size_t from = std::size_t(met_);
  const Vec3i first = row.brick(span.first);
  meetBricks(beam, first, row.brick(span.first + 1) - first, density, level, inWholeVectors(count),
             { depthMm_.data() + from, lateralMm_.data() + from, elevationalMm_.data() + from, at_.data() + from,
               parentAt_.data() + from });
  const bool isByGaussian = isGaussian(beam);
  for (int n = 0; n < count; ++n)
  {
    const std::size_t k = from + std::size_t(n);
    brick_[k] = before + span.first + n;
    const bool isTaken =
      density.takesAt(level, at_[k], parentAt_[k]) && (isByGaussian || row.sees(index, span.first + n));
    perMm3_[k] = isTaken ? density.perMm3[at_[k]] : 0.0f;
  }
  const Vec2f halfMm = nestedHalfExtent(beam, level);
  for (int n = 0; !isByGaussian && n < count; ++n)
  {
    const std::size_t k = from + std::size_t(n);
    const Vec3f q = nestedBrickCentre(row.brick(span.first + n), level) - beam.origin;
    const float most = perMm3_[k] > 0.0f ? relativeWeight(beam, q, depthMm_[k], halfMm) : 0.0f;
    lateralMm_[k] = most >= nestedLeastWeight ? relativeWeight(beam, q, depthMm_[k], nestedInward * halfMm) : 0.0f;
    elevationalMm_[k] = most;
  }
  met_ += count;
}

void NestedShares::share(const Beam& beam, int level, int* wanted)
{
  const int count = inWholeVectors(met_);
  resizeAll({ &count_, &whole_ }, std::size_t(count));
  resizeAll({ &scale_, &faded_ }, std::size_t(count));
  std::fill(perMm3_.begin() + met_, perMm3_.begin() + count, 0.0f);
  const MetBricks met{ depthMm_.data(), lateralMm_.data(), elevationalMm_.data(), at_.data(), parentAt_.data() };
  if (isGaussian(beam))
  {
    weighByGaussian(beam, met, nestedHalfExtent(beam, level), count);
  }
  takeShares(met.lateralMm, met.elevationalMm, nestedCellMm(level), count,
             { perMm3_.data(), count_.data(), whole_.data(), scale_.data(), faded_.data() });
  taken_ = candidates_ = 0;
  for (std::size_t k = 0; k < std::size_t(met_); ++k)
  {
    // Written first and counted afterwards: without a branch, which would often be mispredicted.
    const std::size_t to = std::size_t(taken_);
    brick_[to] = brick_[k];
    count_[to] = count_[k];
    whole_[to] = whole_[k];
    scale_[to] = scale_[k];
    faded_[to] = faded_[k];
    int& most = wanted[brick_[k]];
    most = std::max(most, int(count_[k]));
    candidates_ += count_[k];
    taken_ += count_[k] > 0 ? 1 : 0;
  }
}

ScattererView NestedShares::hear(const NestedScatterers::Generated& scatterers, const Vec3f& axis)
{
  resizeAll({ &x_, &y_, &z_, &amplitude_ }, std::size_t(candidates_ + vectorWidth));
  const TakenParts parts{ brick_.data(), count_.data(), whole_.data(), scale_.data(), faded_.data() };
  resizeAll({ &alongAxis_ }, scatterers.x.size());
  for (int k = 0; k < taken_; ++k)
  {
    const std::size_t brick = std::size_t(brick_[std::size_t(k)]);
    if (scatterers.hasFibres[brick])
    {
      const std::ptrdiff_t first = scatterers.first[brick];
      hearAlong(axis, scatterers.fibreX.data() + first, scatterers.fibreY.data() + first,
                scatterers.fibreZ.data() + first, scatterers.amplitude.data() + first,
                inWholeVectors(count_[std::size_t(k)]), alongAxis_.data() + first);
    }
  }
  const int heard =
    takeScatterers(scatterers, alongAxis_.data(), taken_, parts, x_.data(), y_.data(), z_.data(), amplitude_.data());
  return { x_.data(), y_.data(), z_.data(), amplitude_.data(), heard, 1.0f, true };
}

} // namespace sono
