#include "Echo/TissueScatterers.h"

#include "Core/Simd.h"

#include <cmath>

namespace sono {

namespace {

constexpr int cells = TissueScatterers::cellCount;
constexpr std::uint8_t nowhere = 255; // never a tissue: a scene has at most 255, from 0

/// The candidates of a brick's cells, with the voxel in which each lies.
struct Candidates
{
  float x[cells], y[cells], z[cells];
  std::int32_t i[cells], j[cells], k[cells];
  float presence[cells], deviate[cells];
  float mean[cells], sigma[cells], probability[cells];
  float amplitude[cells];
};

SONO_SIMD_CLONES void draw(std::uint64_t seed, const Vec3i first, float cellMm, const Vec3f perMm, Candidates& c)
{
  for (int n = 0; n < cells; ++n)
  {
    const Vec3i cell(first.x + (n & 3), first.y + ((n >> 2) & 3), first.z + (n >> 4));
    const ScattererSeed s = scattererSeed(seed, cell);
    c.x[n] = (float(cell.x) + s.fraction.x) * cellMm;
    c.y[n] = (float(cell.y) + s.fraction.y) * cellMm;
    c.z[n] = (float(cell.z) + s.fraction.z) * cellMm;
    c.i[n] = std::int32_t(std::floor(c.x[n] * perMm.x));
    c.j[n] = std::int32_t(std::floor(c.y[n] * perMm.y));
    c.k[n] = std::int32_t(std::floor(c.z[n] * perMm.z));
    c.presence[n] = s.presence;
    c.deviate[n] = s.deviate;
  }
}

SONO_SIMD_CLONES void decide(Candidates& c)
{
  for (int n = 0; n < cells; ++n)
  {
    c.amplitude[n] = scattererAmplitude({ c.mean[n], c.sigma[n], c.probability[n] }, c.presence[n], c.deviate[n]);
  }
}

} // namespace

TissueScatterers::TissueScatterers(const Scene& scene, double cellMm, double scale, std::uint64_t seed)
  : scene_(scene)
  , cellMm_(float(cellMm))
  , seed_(seed)
{
  bool any = false;
  for (std::size_t t = 0; t < scene.tissues().size(); ++t)
  {
    const Tissue& tissue = scene.tissues()[t];
    media_[t] = { float(scale * tissue.scattererMean), float(scale * tissue.scattererSigma),
                  float(tissue.scattererProbability) };
    any |= media_[t].probability > 0.0f && (media_[t].mean != 0.0f || media_[t].sigma != 0.0f);
  }
  grid_.edgeMm = cellMm_ * float(brickCells);
  if (any)
  {
    grid_.highMm = Vec3f(scene.placement().size) * Vec3f(scene.placement().spacingMm);
  }
}

ScattererView TissueScatterers::generate(const Vec3i& brick, Buffer& buffer) const
{
  const Vec3i size = scene_.placement().size;
  const std::uint8_t* tissues = scene_.tissueVoxels().data();
  Candidates c;
  draw(seed_, brick * brickCells, cellMm_, 1.0f / Vec3f(scene_.placement().spacingMm), c);
  for (int n = 0; n < cells; ++n)
  {
    const Vec3i voxel(c.i[n], c.j[n], c.k[n]);
    const bool inside = glm::all(glm::greaterThanEqual(voxel, Vec3i(0))) && glm::all(glm::lessThan(voxel, size));
    const std::size_t at =
      std::size_t(voxel.x) + std::size_t(size.x) * (std::size_t(voxel.y) + std::size_t(size.y) * std::size_t(voxel.z));
    const ScatteringMedium& medium = media_[inside ? tissues[at] : nowhere];
    const float detail = inside ? scene_.detailAt(at) : 1.0f;
    c.mean[n] = detail * medium.mean;
    c.sigma[n] = detail * medium.sigma;
    c.probability[n] = medium.probability;
  }
  decide(c);
  int count = 0;
  for (int n = 0; n < cells; ++n)
  {
    // Written first and counted afterwards: without a branch, which would often be mispredicted.
    const std::size_t to = std::size_t(count);
    buffer.x[to] = c.x[n];
    buffer.y[to] = c.y[n];
    buffer.z[to] = c.z[n];
    buffer.amplitude[to] = c.amplitude[n];
    count += c.amplitude[n] != 0.0f;
  }
  return { buffer.x.data(), buffer.y.data(), buffer.z.data(), buffer.amplitude.data(), count };
}

} // namespace sono
