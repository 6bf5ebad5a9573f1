#include "Echo/NestedScatterers.h"

#include "Core/Simd.h"
#include "Echo/ResizeAll.h"
#include "Echo/ScattererDensity.h"
#include "Kernel/FastMath.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr float never = 2.0f;                   // no probability is above it
constexpr double npPerDb = 0.11512925464970229; // ln(10) / 20

using Generated = NestedScatterers::Generated;

/// nestedBrickHash of each brick.
SONO_SIMD_CLONES __attribute__((flatten)) void hashBricks(std::uint64_t seed, int level, const NestedBricks& bricks,
                                                          std::uint32_t* hash)
{
  const std::int32_t* x = bricks.x();
  const std::int32_t* y = bricks.y();
  const std::int32_t* z = bricks.z();
  const int up = nestedRootLevel - (level + 2);
  const int count = inWholeVectors(bricks.count());
#pragma GCC ivdep
  for (int n = 0; n < count; ++n)
  {
    hash[n] = nestedRoot(seed, { x[n] >> up, y[n] >> up, z[n] >> up });
  }
  for (int l = up - 1; l >= 0; --l)
  {
#pragma GCC ivdep
    for (int n = 0; n < count; ++n)
    {
      const std::uint32_t child =
        std::uint32_t(((x[n] >> l) & 1) | (((y[n] >> l) & 1) << 1) | (((z[n] >> l) & 1) << 2));
      hash[n] = nestedDescend(hash[n], child);
    }
  }
}

inline void descend(std::int32_t& i, std::int32_t& j, std::int32_t& k, std::uint32_t& hash, std::uint32_t child)
{
  const NestedCell to = NestedCell{ { i, j, k }, hash }.child(child);
  i = to.cell.x;
  j = to.cell.y;
  k = to.cell.z;
  hash = to.hash;
}

/// nestedFinestCell and nestedCandidate, level by level for all, of which brick and number are known; with the voxel
/// that each lies in. Those outside of the volume are never present.
SONO_SIMD_CLONES __attribute__((flatten)) void draw(const NestedBricks& bricks, int level, int count,
                                                    const Vec3f& perMm, const Vec3i& volume, Generated& out,
                                                    float* sign)
{
  const Vec3i size = volume;
  std::int32_t* i = out.i.data();
  std::int32_t* j = out.j.data();
  std::int32_t* k = out.k.data();
  std::uint32_t* hash = out.hash.data();
  const std::int32_t* brick = out.brick.data();
  const std::int32_t* number = out.number.data();
  const std::uint32_t* brickHash = out.brickHash.data();
  const std::int32_t* brickI = bricks.x();
  const std::int32_t* brickJ = bricks.y();
  const std::int32_t* brickK = bricks.z();
#pragma GCC ivdep
  for (int n = 0; n < count; ++n)
  {
    std::int32_t ci = brickI[brick[n]];
    std::int32_t cj = brickJ[brick[n]];
    std::int32_t ck = brickK[brick[n]];
    std::uint32_t h = brickHash[brick[n]];
    descend(ci, cj, ck, h, childOfRank(h, std::uint32_t(number[n] & 7)));
    descend(ci, cj, ck, h, childOfRank(h, std::uint32_t(number[n] >> 3)));
    i[n] = ci;
    j[n] = cj;
    k[n] = ck;
    hash[n] = h;
  }
  for (int l = level; l > 0; --l)
  {
#pragma GCC ivdep
    for (int n = 0; n < count; ++n)
    {
      descend(i[n], j[n], k[n], hash[n], chosenChild(hash[n]));
    }
  }
  float* x = out.x.data();
  float* y = out.y.data();
  float* z = out.z.data();
  float* presence = out.presence.data();
#pragma GCC ivdep
  for (int n = 0; n < count; ++n)
  {
    const NestedCandidate candidate = nestedCandidate({ { i[n], j[n], k[n] }, hash[n] });
    x[n] = candidate.positionMm.x;
    y[n] = candidate.positionMm.y;
    z[n] = candidate.positionMm.z;
    const std::int32_t vi = std::int32_t(std::floor(candidate.positionMm.x * perMm.x));
    const std::int32_t vj = std::int32_t(std::floor(candidate.positionMm.y * perMm.y));
    const std::int32_t vk = std::int32_t(std::floor(candidate.positionMm.z * perMm.z));
    const bool isInside = (vi >= 0) & (vi < size.x) & (vj >= 0) & (vj < size.y) & (vk >= 0) & (vk < size.z);
    i[n] = isInside ? vi : 0;
    j[n] = isInside ? vj : 0;
    k[n] = isInside ? vk : 0;
    presence[n] = isInside ? candidate.presence : never;
    sign[n] = candidate.sign;
  }
}

/// Numbers the candidates, and makes room for them.
void layOut(int brickCount, const int* wanted, Generated& out)
{
  out.first.assign(1, 0);
  for (int b = 0; b < brickCount; ++b)
  {
    out.first.push_back(out.first.back() + wanted[b]);
  }
  const std::size_t room = std::size_t(out.count()) + vectorWidth;
  resizeAll({ &out.x, &out.y, &out.z, &out.amplitude, &out.presence }, room);
  resizeAll({ &out.i, &out.j, &out.k, &out.brick, &out.number }, room);
  resizeAll({ &out.hash }, room);
  resizeAll({ &out.tissue }, room);
  out.brickHash.resize(std::size_t(inWholeVectors(brickCount)));
  out.echoes.resize(std::size_t(brickCount));
  out.hasFibres.resize(std::size_t(brickCount));
  std::size_t n = 0;
  for (int b = 0; b < brickCount; ++b)
  {
    for (int number = 0; number < wanted[b]; ++number, ++n)
    {
      out.brick[n] = b;
      out.number[n] = number;
    }
  }
  std::fill_n(out.brick.begin() + std::ptrdiff_t(n), vectorWidth, 0);
  std::fill_n(out.number.begin() + std::ptrdiff_t(n), vectorWidth, 0);
}

NestedMedium mediumOf(const Tissue& tissue, double frequencyMHz, double amplitudePerRoot)
{
  const bool scatters = tissue.scattererMean != 0.0 || tissue.scattererSigma != 0.0;
  if (!scatters || !(tissue.scattererProbability > 0.0) || !(tissue.backscatterPerCmSr > 0.0))
  {
    return {};
  }
  const double probability = candidateProbability(tissue.scattererProbability);
  return { float(amplitudePerRoot * std::sqrt(backscatterPerMmSr(tissue, frequencyMHz) / probability)),
           float(probability) };
}

} // namespace

NestedScatterers::NestedScatterers(const Scene& scene, double frequencyMHz, double amplitudePerRoot, std::uint64_t seed)
  : scene_(scene)
  , seed_(seed)
{
  bool anisotropic = false;
  for (std::size_t t = 0; t < scene.tissues().size(); ++t)
  {
    const Tissue& tissue = scene.tissues()[t];
    media_[t] = mediumOf(tissue, frequencyMHz, amplitudePerRoot);
    const bool echoes = media_[t].amplitude != 0.0f;
    fibreScale_[t] = echoes ? float(std::sqrt(npPerDb * tissue.fibreAnisotropyDb)) : 0.0f;
    amplitudes_[t] = media_[t].amplitude;
    probabilities_[t] = media_[t].probability;
    any_ |= echoes;
    anisotropic |= fibreScale_[t] > 0.0f;
  }
  fibres_ = anisotropic ? scene.fibres() : nullptr;
}

BrickGrid NestedScatterers::grid(int level) const
{
  BrickGrid grid;
  grid.edgeMm = nestedCellMm(level) * float(nestedBrickCells);
  if (any_)
  {
    grid.highMm = Vec3f(scene_.placement().size) * Vec3f(scene_.placement().spacingMm);
  }
  return grid;
}

template<bool hasDetail, bool hasFibres>
void NestedScatterers::findTissues(Generated& out) const
{
  const Vec3i size = scene_.placement().size;
  const std::uint8_t* const tissues = scene_.tissueVoxels().data();
  // Pointers of their own let the compiler see that none changes.
  const float* const amplitudes = amplitudes_.data();
  const float* const probabilities = probabilities_.data();
  const float* const fibreScale = fibreScale_.data();
  const float* const presence = out.presence.data();
  const std::int32_t *const i = out.i.data(), *const j = out.j.data(), *const k = out.k.data();
  float* const amplitude = out.amplitude.data();
  std::uint8_t* const ofCandidate = out.tissue.data();
  for (std::size_t b = 0; b < out.echoes.size(); ++b)
  {
    bool echoes = false;
    bool isAligned = false;
    for (int n = out.first[b]; n < out.first[b + 1]; ++n)
    {
      const std::size_t voxel =
        std::size_t(i[n]) + std::size_t(size.x) * (std::size_t(j[n]) + std::size_t(size.y) * std::size_t(k[n]));
      const std::uint8_t tissue = tissues[voxel];
      const bool isThere = presence[n] < probabilities[tissue];
      amplitude[n] *= isThere ? amplitudes[tissue] : 0.0f;
      echoes |= isThere;
      if constexpr (hasDetail)
      {
        amplitude[n] *= scene_.detailAt(voxel);
      }
      if constexpr (hasFibres)
      {
        ofCandidate[n] = tissue;
        isAligned |= fibreScale[tissue] > 0.0f;
      }
    }
    out.echoes[b] = char(echoes);
    out.hasFibres[b] = char(isAligned);
  }
}

void NestedScatterers::findFibres(Generated& out) const
{
  resizeAll({ &out.fibreX, &out.fibreY, &out.fibreZ }, out.x.size());
  for (std::size_t b = 0; b < out.hasFibres.size(); ++b)
  {
    const std::size_t end = std::size_t(out.hasFibres[b] ? out.first[b + 1] : 0);
    for (std::size_t n = std::size_t(out.first[b]); n < end; ++n)
    {
      const float scale = fibreScale_[out.tissue[n]];
      const Vec3f fibre = scale > 0.0f ? fibres_->at({ out.i[n], out.j[n], out.k[n] }) * scale : Vec3f(0.0f);
      out.fibreX[n] = fibre.x;
      out.fibreY[n] = fibre.y;
      out.fibreZ[n] = fibre.z;
    }
  }
}

void NestedScatterers::generate(int level, const NestedBricks& bricks, const int* wanted, Generated& out) const
{
  layOut(bricks.count(), wanted, out);
  hashBricks(seed_, level, bricks, out.brickHash.data());
  draw(bricks, level, inWholeVectors(out.count()), 1.0f / Vec3f(scene_.placement().spacingMm), scene_.placement().size,
       out, out.amplitude.data());
  const bool hasDetail = !scene_.stillDetail().empty();
  if (fibres_)
  {
    hasDetail ? findTissues<true, true>(out) : findTissues<false, true>(out);
    findFibres(out);
  }
  else
  {
    hasDetail ? findTissues<true, false>(out) : findTissues<false, false>(out);
  }
}

} // namespace sono
