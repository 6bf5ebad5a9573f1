#include "Echo/ScattererBricks.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr int brickCells = 4;

/// The part of a beam's axis inside the slab low <= x[axis] <= high, as parameters along it; empty when from > to.
void clipToSlab(const BeamReach& b, int axis, float low, float high, float& from, float& to)
{
  const float o = b.beam.origin[axis];
  const float d = b.beam.axis[axis];
  if (std::fabs(d) < 1e-6f)
  {
    if (o < low || o > high)
    {
      to = -1.0f;
    }
    return;
  }
  const float t0 = (low - o) / d;
  const float t1 = (high - o) / d;
  from = std::max(from, std::min(t0, t1));
  to = std::min(to, std::max(t0, t1));
}

} // namespace

ScattererBricks::ScattererBricks(const Scene& scene, double cellMm, std::uint64_t seed)
  : scene_(scene)
  , cellMm_(float(cellMm))
  , seed_(seed)
{
  for (const Tissue& t : scene.tissues())
  {
    media_.push_back({ float(t.scattererMean), float(t.scattererSigma), float(t.scattererProbability) });
  }
}

void ScattererBricks::generate(const Vec3i& brick, ScattererList& list) const
{
  list.clear();
  const Vec3i size = scene_.placement().size;
  const Vec3f perMm = 1.0f / Vec3f(scene_.placement().spacingMm);
  const std::uint8_t* tissues = scene_.tissueVoxels().data();
  for (int i = 0; i < brickCells * brickCells * brickCells; ++i)
  {
    const Vec3i cell =
      brick * brickCells + Vec3i(i % brickCells, (i / brickCells) % brickCells, i / (brickCells * brickCells));
    const ScattererSeed seed = scattererSeed(seed_, cell);
    const Vec3f position = (Vec3f(cell) + seed.fraction) * cellMm_;
    const Vec3i voxel(glm::floor(position * perMm));
    if (glm::any(glm::lessThan(voxel, Vec3i(0))) || glm::any(glm::greaterThanEqual(voxel, size)))
    {
      continue;
    }
    const std::uint8_t tissue =
      tissues[std::size_t(voxel.x) + std::size_t(size.x) * (std::size_t(voxel.y) + std::size_t(size.y) * voxel.z)];
    const float amplitude = scattererAmplitude(media_[tissue], seed);
    if (amplitude != 0.0f)
    {
      list.add(position, amplitude);
    }
  }
}

void ScattererBricks::forGroup(const std::vector<BeamReach>& group,
                               const std::function<void(const ScattererList&, std::size_t)>& visit) const
{
  Vec3f heading(0.0f);
  float longest = 0.0f;
  for (const BeamReach& b : group)
  {
    heading += glm::abs(b.beam.axis);
    longest = std::max(longest, b.depthMm);
  }
  if (longest <= 0.0f)
  {
    return;
  }
  const int axis = heading.x >= heading.y && heading.x >= heading.z ? 0 : (heading.y >= heading.z ? 1 : 2);
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const float edge = cellMm_ * brickCells;
  const float diagonal = 0.5f * edge * std::sqrt(3.0f);

  // Bricks that a beam can see have their centre within `radius` of its axis.
  std::vector<float> radius;
  Vec3f low(1e30f);
  Vec3f high(-1e30f);
  for (const BeamReach& b : group)
  {
    radius.push_back(beamCutSigma * std::max(b.beam.lateralSigmaMm, b.beam.elevationalSigmaMm) + diagonal);
    const Vec3f end = b.beam.origin + b.beam.axis * std::max(0.0f, b.depthMm);
    low = glm::min(low, glm::min(b.beam.origin, end) - radius.back());
    high = glm::max(high, glm::max(b.beam.origin, end) + radius.back());
  }
  const Vec3f extent = Vec3f(scene_.placement().size) * Vec3f(scene_.placement().spacingMm);
  low = glm::max(low, Vec3f(0.0f));
  high = glm::min(high, extent);

  ScattererList list;
  std::vector<std::size_t> seeing;
  for (int layer = int(std::floor(low[axis] / edge)); float(layer) * edge < high[axis]; ++layer)
  {
    // Range of bricks in this layer over all beams.
    Vec2f first(1e30f);
    Vec2f last(-1e30f);
    for (std::size_t i = 0; i < group.size(); ++i)
    {
      const BeamReach& b = group[i];
      float from = 0.0f;
      float to = b.depthMm;
      clipToSlab(b, axis, float(layer) * edge - radius[i], float(layer + 1) * edge + radius[i], from, to);
      if (b.depthMm <= 0.0f || from > to)
      {
        continue;
      }
      // Between the two ends of the piece the axis is straight: its bounds are theirs.
      for (const float t : { from, to })
      {
        const Vec3f p = b.beam.origin + b.beam.axis * t;
        first = glm::min(first, Vec2f(p[u], p[v]) - radius[i]);
        last = glm::max(last, Vec2f(p[u], p[v]) + radius[i]);
      }
    }
    first = glm::max(first, Vec2f(low[u], low[v]));
    last = glm::min(last, Vec2f(high[u], high[v]));
    for (int j = int(std::floor(first.x / edge)); float(j) * edge < last.x; ++j)
    {
      for (int k = int(std::floor(first.y / edge)); float(k) * edge < last.y; ++k)
      {
        Vec3i brick;
        brick[axis] = layer;
        brick[u] = j;
        brick[v] = k;
        const Vec3f centre = (Vec3f(brick) + 0.5f) * edge;
        seeing.clear();
        for (std::size_t i = 0; i < group.size(); ++i)
        {
          const BeamReach& b = group[i];
          const Vec3f q = centre - b.beam.origin;
          const float r = glm::dot(q, b.beam.axis);
          if (b.depthMm > 0.0f && r > -diagonal && r < b.depthMm + diagonal &&
              glm::dot(q, q) - r * r < radius[i] * radius[i])
          {
            seeing.push_back(i);
          }
        }
        if (seeing.empty())
        {
          continue;
        }
        generate(brick, list);
        if (list.count() == 0)
        {
          continue;
        }
        for (const std::size_t i : seeing)
        {
          visit(list, i);
        }
      }
    }
  }
}

} // namespace sono
