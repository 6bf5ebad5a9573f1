#include "Echo/NestedScatterers.h"

#include "Core/Simd.h"
#include "Kernel/FastMath.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr float never = 2.0f;                   // no probability is above it
constexpr double npPerDb = 0.11512925464970229; // ln(10) / 20

using Row = NestedScatterers::Row;

/// nestedBrickHash of each brick.
SONO_SIMD_CLONES __attribute__((flatten)) void hashBricks(std::uint64_t seed, int level,
                                                          const NestedScatterers::BrickLine& bricks,
                                                          std::uint32_t* hash)
{
  const Vec3i first = bricks.first;
  const Vec3i step(bricks.axis == 0, bricks.axis == 1, bricks.axis == 2);
  const int up = nestedRootLevel - (level + 2);
  const int count = inWholeVectors(bricks.count);
  for (int n = 0; n < count; ++n)
  {
    hash[n] =
      nestedRoot(seed, { (first.x + n * step.x) >> up, (first.y + n * step.y) >> up, (first.z + n * step.z) >> up });
  }
  for (int l = up - 1; l >= 0; --l)
  {
    for (int n = 0; n < count; ++n)
    {
      const std::uint32_t x = std::uint32_t(((first.x + n * step.x) >> l) & 1);
      const std::uint32_t y = std::uint32_t(((first.y + n * step.y) >> l) & 1);
      const std::uint32_t z = std::uint32_t(((first.z + n * step.z) >> l) & 1);
      hash[n] = nestedDescend(hash[n], x | (y << 1) | (z << 2));
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
SONO_SIMD_CLONES __attribute__((flatten)) void draw(const NestedScatterers::BrickLine& bricks, int level, int count,
                                                    const Vec3f& perMm, const Vec3i& volume, Row& row, float* sign)
{
  const Vec3i size = volume;
  std::int32_t* i = row.i.data();
  std::int32_t* j = row.j.data();
  std::int32_t* k = row.k.data();
  std::uint32_t* hash = row.hash.data();
  const std::int32_t* brick = row.brick.data();
  const std::int32_t* number = row.number.data();
  const std::uint32_t* brickHash = row.brickHash.data();
  const Vec3i first = bricks.first;
  const Vec3i step(bricks.axis == 0, bricks.axis == 1, bricks.axis == 2);
#pragma GCC ivdep
  for (int n = 0; n < count; ++n)
  {
    std::int32_t ci = first.x + brick[n] * step.x;
    std::int32_t cj = first.y + brick[n] * step.y;
    std::int32_t ck = first.z + brick[n] * step.z;
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
  float* x = row.x.data();
  float* y = row.y.data();
  float* z = row.z.data();
  float* presence = row.presence.data();
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

/// Leaves the candidates of these numbers, ascending, with their amplitudes.
SONO_SIMD_CLONES void keep(const std::int32_t* kept, const float* factor, int count, Row& row)
{
  float* x = row.x.data();
  float* y = row.y.data();
  float* z = row.z.data();
  float* amplitude = row.amplitude.data();
#pragma GCC ivdep
  for (int to = 0; to < count; ++to) // none overtakes its candidate
  {
    const std::int32_t n = kept[to];
    x[to] = x[n];
    y[to] = y[n];
    z[to] = z[n];
    amplitude[to] = amplitude[n] * factor[to];
  }
}

/// Numbers the candidates of a row, and makes room for them.
int layOut(const NestedScatterers::BrickLine& bricks, const int* wanted, Row& row)
{
  std::size_t count = 0;
  for (int b = 0; b < bricks.count; ++b)
  {
    count += std::size_t(wanted[b]);
  }
  for (std::vector<float>* values : { &row.x, &row.y, &row.z, &row.amplitude, &row.presence, &row.factor })
  {
    values->resize(count + vectorWidth);
  }
  for (std::vector<std::int32_t>* values : { &row.i, &row.j, &row.k, &row.brick, &row.number, &row.kept })
  {
    values->resize(count + vectorWidth);
  }
  row.hash.resize(count + vectorWidth);
  row.brickHash.resize(std::size_t(inWholeVectors(bricks.count)));
  row.firstCandidate.resize(std::size_t(bricks.count));
  row.reached.resize(count + 1);
  std::size_t n = 0;
  for (int b = 0; b < bricks.count; ++b)
  {
    row.firstCandidate[std::size_t(b)] = int(n);
    for (int number = 0; number < wanted[b]; ++number, ++n)
    {
      row.brick[n] = b;
      row.number[n] = number;
    }
  }
  std::fill_n(row.brick.begin() + std::ptrdiff_t(count), vectorWidth, 0);
  std::fill_n(row.number.begin() + std::ptrdiff_t(count), vectorWidth, 0);
  return int(count);
}

NestedMedium mediumOf(const Tissue& tissue, double frequencyMHz, double amplitudePerRoot)
{
  const bool scatters = tissue.scattererMean != 0.0 || tissue.scattererSigma != 0.0;
  if (!scatters || !(tissue.scattererProbability > 0.0) || !(tissue.backscatterPerCmSr > 0.0))
  {
    return {};
  }
  return { float(amplitudePerRoot * std::sqrt(backscatterPerMmSr(tissue, frequencyMHz) / tissue.scattererProbability)),
           float(tissue.scattererProbability) };
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

void NestedScatterers::generate(int level, const BrickLine& bricks, const int* wanted, Row& row) const
{
  const Vec3i size = scene_.placement().size;
  const std::uint8_t* tissues = scene_.tissueVoxels().data();
  const int candidates = layOut(bricks, wanted, row);
  hashBricks(seed_, level, bricks, row.brickHash.data());
  draw(bricks, level, inWholeVectors(candidates), 1.0f / Vec3f(scene_.placement().spacingMm), size, row,
       row.amplitude.data());
  row.before.assign(std::size_t(bricks.count) + 1, 0);
  // Pointers of their own let the compiler see that none changes.
  std::int32_t* const kept = row.kept.data();
  int* const reached = row.reached.data();
  float* const factor = row.factor.data();
  const float* const presence = row.presence.data();
  const std::int32_t* const i = row.i.data();
  const std::int32_t* const j = row.j.data();
  const std::int32_t* const k = row.k.data();
  const auto voxelOf = [&](int n) {
    return std::size_t(i[n]) + std::size_t(size.x) * (std::size_t(j[n]) + std::size_t(size.y) * std::size_t(k[n]));
  };
  bool anyAligned = false;
  int n = 0;
  int to = 0;
  for (int b = 0; b < bricks.count; ++b)
  {
    for (const int end = n + wanted[b]; n < end; ++n)
    {
      // Written first and counted afterwards: without a branch, which would often be mispredicted.
      const std::size_t voxel = voxelOf(n);
      const std::uint8_t tissue = tissues[voxel];
      kept[to] = n;
      reached[n] = to;
      factor[to] = scene_.detailAt(voxel) * amplitudes_[tissue];
      const bool isThere = presence[n] < probabilities_[tissue];
      anyAligned |= isThere & (fibreScale_[tissue] > 0.0f);
      to += isThere;
    }
    row.before[std::size_t(b) + 1] = to;
  }
  anyAligned &= fibres_ != nullptr;
  reached[n] = to;
  row.hasFibres = anyAligned;
  if (anyAligned)
  {
    for (std::vector<float>* values : { &row.fibreX, &row.fibreY, &row.fibreZ })
    {
      values->resize(std::size_t(to) + vectorWidth);
    }
  }
  for (int a = 0; anyAligned && a < to; ++a)
  {
    const int from = kept[a];
    const float scale = fibreScale_[tissues[voxelOf(from)]];
    const Vec3f fibre = scale > 0.0f ? fibres_->at({ i[from], j[from], k[from] }) * scale : Vec3f(0.0f);
    row.fibreX[std::size_t(a)] = fibre.x;
    row.fibreY[std::size_t(a)] = fibre.y;
    row.fibreZ[std::size_t(a)] = fibre.z;
  }
  keep(kept, factor, to, row);
}

} // namespace sono
