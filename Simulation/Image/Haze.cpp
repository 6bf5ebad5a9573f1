#include "Image/Haze.h"

#include "Core/ParallelFor.h"
#include "Core/Simd.h"
#include "Kernel/GreyLevel.h"
#include "Kernel/NormalDeviate.h"
#include "Trace/SecondHarmonic.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace sono {
namespace {

constexpr double nodeMm = 0.25; // the level is straight in between
// A cubic B-spline of cells c wide is correlated with itself over 1.92 c, at half of the height: 1.5 mm along and, 75
// cells across 90 degrees, 2.6 mm across at 65 mm, as the speckle of real cavities (Data/docs/pictures.md).
constexpr double cellMm = 0.8;
constexpr double cellsAcross = 75.0;
constexpr double bodyWallMm = 10.0; // chosen

/// Between fat and muscle (Data/tissues.csv).
Tissue bodyWall()
{
  Tissue wall;
  wall.impedanceMRayl = 1.53;
  wall.soundSpeedMPerS = 1515.0;
  wall.nonlinearity = 5.4;
  return wall;
}

/// What of the haze's power is there of a harmonic, at a depth.
double grownShare(double growthPerMm, double depthMm)
{
  const double grown = growthPerMm * std::min(depthMm, bodyWallMm);
  return grown * grown / 3.0;
}

/// A position among cells and the blend of the four nodes about it, of unit length.
struct Blend
{
  explicit Blend(double position)
    : first(std::size_t(position))
    , weights(cubicSpline(float(position - double(first))))
  {
    float length2 = 0.0f;
    for (const float w : weights.w)
    {
      length2 += w * w;
    }
    for (float& w : weights.w)
    {
      w /= std::sqrt(length2);
    }
  }

  std::size_t first;
  SplineWeights weights;
};

/// Normals of (seed, row, column), of a whole row.
SONO_SIMD_CLONES void drawRow(std::uint64_t seed, std::uint32_t row, std::uint32_t count, float* __restrict normals)
{
  constexpr std::uint32_t hazeUse = 0x68617a65u; // keeps the stream apart from others of the same seed
  for (std::uint32_t n = 0; n < count; ++n)
  {
    const RandomWords words = philox(seed, row, n, 0u, hazeUse);
    normals[n] = normalDeviate(uniformFrom(words.v[0]));
  }
}

/// Normals at the corners of the cells, functions of (seed, place) alone, and a smooth field of unit variance between.
class SmoothNormal
{
public:
  SmoothNormal(std::uint64_t seed, double depthMm)
    : along_(std::size_t(depthMm / cellMm) + 4)
    , normals_((std::size_t(cellsAcross) + 4) * along_)
  {
    for (std::size_t row = 0; row < normals_.size() / along_; ++row)
    {
      drawRow(seed, std::uint32_t(row), std::uint32_t(along_), normals_.data() + row * along_);
    }
  }

  /// The corners' on a line along the cells.
  std::vector<float> row(const Blend& across) const
  {
    std::vector<float> row(along_, 0.0f);
    for (std::size_t a = 0; a < 4; ++a)
    {
      const float* normals = normals_.data() + (across.first + a) * along_;
      const float weight = across.weights.w[a];
      for (std::size_t n = 0; n < along_; ++n)
      {
        row[n] += weight * normals[n];
      }
    }
    return row;
  }

private:
  std::size_t along_;
  std::vector<float> normals_;
};

/// What lines share at a node.
struct HazeNode
{
  Blend along;
  float power; ///< where the field is 0
};

} // namespace

HazePower makeHaze(const BModeSettings& settings, int lineCount, int sampleCount, double sampleMm)
{
  HazePower haze;
  if (!settings.addHaze)
  {
    return haze;
  }
  haze.nodesPerSample = float(sampleMm / nodeMm);
  haze.nodeCount = int(float(sampleCount - 1) * haze.nodesPerSample) + 2;
  haze.power.resize(std::size_t(lineCount) * std::size_t(haze.nodeCount));
  const int linesAcross = settings.linesAcross > 0 ? std::min(settings.linesAcross, lineCount) : lineCount;
  const double fallDbPerMm = settings.hazeFallDbPerCmMHz * settings.frequencyMHz / 10.0;
  const double neperPerDb = std::log(10.0) / 10.0; // of power
  const double spread = neperPerDb * settings.hazeVariationDb;
  const SmoothNormal field(settings.noiseSeed, haze.nodeCount * nodeMm);
  std::vector<HazeNode> nodes;
  nodes.reserve(std::size_t(haze.nodeCount));
  for (int node = 0; node < haze.nodeCount; ++node)
  {
    const double depthMm = node * nodeMm;
    const double level = neperPerDb * (settings.hazeDb - fallDbPerMm * depthMm);
    const double grown = settings.hazeGrowthPerMm > 0.0 ? grownShare(settings.hazeGrowthPerMm, depthMm) : 1.0;
    nodes.push_back({ Blend(depthMm / cellMm), float(std::exp(level - 0.5 * spread * spread) * grown) });
  }
  parallelFor(lineCount, {}, [&](int line) {
    const Blend across(cellsAcross * (line % linesAcross) / std::max(1, linesAcross - 1));
    const std::vector<float> normals = field.row(across);
    float* power = haze.power.data() + std::size_t(line) * std::size_t(haze.nodeCount);
    for (const HazeNode& node : nodes)
    {
      const float* w = node.along.weights.w;
      const float* n = normals.data() + node.along.first;
      const float normal = w[0] * n[0] + w[1] * n[1] + w[2] * n[2] + w[3] * n[3];
      *power++ = node.power * std::exp(float(spread) * normal);
    }
  });
  return haze;
}

double bodyWallGrowthPerMm(ImagingMode mode, double sentMHz, double facePressureKPa)
{
  const Tissue wall = bodyWall();
  return mode == ImagingMode::Harmonic ? harmonicSourcePerMm(wall, wall.impedanceMRayl, { sentMHz, facePressureKPa })
                                       : 0.0;
}

} // namespace sono
