#include "Echo/NestedScatterers.h"

#include "Core/Simd.h"
#include "Kernel/FastMath.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr int cells = NestedScatterers::cellCount;
constexpr std::uint8_t nowhere = 255;           // never a tissue: a scene has at most 255, from 0
constexpr double npPerDb = 0.11512925464970229; // ln(10) / 20

/// The candidates of a brick by number, with the voxel in which each lies.
struct Candidates
{
  float x[cells], y[cells], z[cells];
  std::int32_t i[cells], j[cells], k[cells]; // cell, then voxel
  std::uint32_t hash[cells];
  float presence[cells], sign[cells];
};

inline void descend(Candidates& c, int n, std::uint32_t child)
{
  const NestedCell to = NestedCell{ { c.i[n], c.j[n], c.k[n] }, c.hash[n] }.child(child);
  c.i[n] = to.cell.x;
  c.j[n] = to.cell.y;
  c.k[n] = to.cell.z;
  c.hash[n] = to.hash;
}

/// nestedFinestCell and nestedCandidate, level by level for all.
SONO_SIMD_CLONES void draw(const NestedCell brick, int level, int count, const Vec3f perMm, Candidates& c)
{
  for (int n = 0; n < count; ++n)
  {
    c.i[n] = brick.cell.x;
    c.j[n] = brick.cell.y;
    c.k[n] = brick.cell.z;
    c.hash[n] = brick.hash;
    descend(c, n, childOfRank(c.hash[n], std::uint32_t(n & 7)));
    descend(c, n, childOfRank(c.hash[n], std::uint32_t(n >> 3)));
  }
  for (int l = level; l > 0; --l)
  {
    for (int n = 0; n < count; ++n)
    {
      descend(c, n, chosenChild(c.hash[n]));
    }
  }
  for (int n = 0; n < count; ++n)
  {
    const NestedCandidate candidate = nestedCandidate({ { c.i[n], c.j[n], c.k[n] }, c.hash[n] });
    c.x[n] = candidate.positionMm.x;
    c.y[n] = candidate.positionMm.y;
    c.z[n] = candidate.positionMm.z;
    c.i[n] = std::int32_t(std::floor(c.x[n] * perMm.x));
    c.j[n] = std::int32_t(std::floor(c.y[n] * perMm.y));
    c.k[n] = std::int32_t(std::floor(c.z[n] * perMm.z));
    c.presence[n] = candidate.presence;
    c.sign[n] = candidate.sign;
  }
}

/// B(t) = B_par + anisotropy sin^2 t (Data/docs/physics.md eq. 11.4); the amplitudes are those across the fibres.
SONO_SIMD_CLONES void seeAlong(const Vec3f axis, const float* fx, const float* fy, const float* fz,
                               const float* amplitude, int count, float* along)
{
  for (int n = 0; n < count; ++n)
  {
    const float cosine = fx[n] * axis.x + fy[n] * axis.y + fz[n] * axis.z; // times the root of the anisotropy
    along[n] = amplitude[n] * expNegative(-cosine * cosine);
  }
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

void NestedScatterers::generate(int level, const Vec3i& brick, int candidates, Buffer& buffer) const
{
  const Vec3i size = scene_.placement().size;
  const std::uint8_t* tissues = scene_.tissueVoxels().data();
  std::uint8_t tissue[cells];
  Candidates c;
  draw({ brick, nestedBrickHash(seed_, brick, level) }, level, candidates, 1.0f / Vec3f(scene_.placement().spacingMm),
       c);
  bool hasFibres = false;
  for (int n = 0; n < candidates; ++n)
  {
    const Vec3i voxel(c.i[n], c.j[n], c.k[n]);
    const bool inside = glm::all(glm::greaterThanEqual(voxel, Vec3i(0))) && glm::all(glm::lessThan(voxel, size));
    const std::size_t at =
      std::size_t(voxel.x) + std::size_t(size.x) * (std::size_t(voxel.y) + std::size_t(size.y) * std::size_t(voxel.z));
    tissue[n] = inside ? tissues[at] : nowhere;
    c.sign[n] *= inside ? scene_.detailAt(at) : 1.0f;
    hasFibres |= fibreScale_[tissue[n]] > 0.0f;
  }
  buffer.hasFibres = hasFibres && fibres_;
  int count = 0;
  for (int n = 0; n < candidates; ++n)
  {
    // Written first and counted afterwards: without a branch, which would often be mispredicted.
    const std::size_t to = std::size_t(count);
    const NestedMedium& medium = media_[tissue[n]];
    buffer.before[std::size_t(n)] = count;
    buffer.x[to] = c.x[n];
    buffer.y[to] = c.y[n];
    buffer.z[to] = c.z[n];
    buffer.amplitude[to] = c.sign[n] * medium.amplitude;
    if (buffer.hasFibres)
    {
      const Vec3f fibre = fibres_->at({ c.i[n], c.j[n], c.k[n] }) * fibreScale_[tissue[n]];
      buffer.fibreX[to] = fibre.x;
      buffer.fibreY[to] = fibre.y;
      buffer.fibreZ[to] = fibre.z;
    }
    count += c.presence[n] < medium.probability;
  }
  buffer.before[std::size_t(candidates)] = count;
}

ScattererView NestedScatterers::seen(Buffer& buffer, const NestedShare& share, const Vec3f& axis)
{
  const int count = buffer.before[std::size_t(share.count)];
  float* along = buffer.along.data();
  if (buffer.hasFibres)
  {
    seeAlong(axis, buffer.fibreX.data(), buffer.fibreY.data(), buffer.fibreZ.data(), buffer.amplitude.data(), count,
             along);
  }
  else
  {
    std::copy_n(buffer.amplitude.data(), count, along);
  }
  for (int n = buffer.before[std::size_t(share.whole)]; n < count; ++n)
  {
    along[n] *= share.last;
  }
  return { buffer.x.data(), buffer.y.data(), buffer.z.data(), along, count, share.scale };
}

} // namespace sono
