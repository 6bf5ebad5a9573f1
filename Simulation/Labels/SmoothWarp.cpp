#include "Labels/SmoothWarp.h"

#include "Core/Error.h"
#include "Core/ParallelFor.h"
#include "Kernel/Rng.h"
#include "Labels/LabelContacts.h"
#include "Labels/PadLabels.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

namespace sono {

namespace {

constexpr std::uint32_t stream = 0x5741u; // apart from whatever else draws from this seed

Vec3d directionOf(const RandomWords& words)
{
  const double z = 2.0 * double(uniformFrom(words.v[0])) - 1.0;
  const double turn = 2.0 * M_PI * double(uniformFrom(words.v[1]));
  const double across = std::sqrt(1.0 - z * z);
  return { across * std::cos(turn), across * std::sin(turn), z };
}

std::uint16_t labelAt(const LabelVolume& volume, const Vec3i& voxel)
{
  const Vec3i& size = volume.placement.size;
  const Vec3i v = glm::clamp(voxel, Vec3i(0), size - 1);
  return volume.voxels[(std::size_t(v.z) * size.y + v.y) * size.x + v.x];
}

/// Labels of the 27 voxels around a place, the nearest one's first.
std::vector<std::uint16_t> labelsAround(const LabelVolume& volume, const Vec3d& index)
{
  const Vec3i middle(glm::round(index));
  std::vector<std::pair<double, std::uint16_t>> all;
  for (int n = 0; n < 27; ++n)
  {
    const Vec3i v = middle + Vec3i(n % 3, n / 3 % 3, n / 9) - 1;
    all.emplace_back(glm::length(volume.placement.spacingMm * (Vec3d(v) - index)), labelAt(volume, v));
  }
  std::sort(all.begin(), all.end());
  std::vector<std::uint16_t> labels;
  for (const auto& [distanceMm, label] : all)
  {
    if (std::find(labels.begin(), labels.end(), label) == labels.end())
    {
      labels.push_back(label);
    }
  }
  return labels;
}

} // namespace

SmoothWarp::SmoothWarp(double amplitudeMm, double wavelengthMm, std::uint64_t seed)
  : amplitudeMm_(amplitudeMm)
{
  if (!(amplitudeMm >= 0.0 && wavelengthMm > 0.0 && wavelengthMm >= leastWavelengths * amplitudeMm))
  {
    std::ostringstream message;
    message << "A warp by " << amplitudeMm << " mm with a wavelength of " << wavelengthMm
            << " mm could fold the body; let its wavelength be at least " << leastWavelengths << " times as long.";
    throw Error(message.str());
  }
  for (std::size_t n = 0; n < waves_.size(); ++n)
  {
    const RandomWords towards = philox(seed, std::uint32_t(n), 0u, 0u, stream);
    const RandomWords along = philox(seed, std::uint32_t(n), 1u, 0u, stream);
    waves_[n] = { amplitudeMm / double(waves_.size()) * directionOf(towards),
                  2.0 * M_PI / wavelengthMm * directionOf(along), 2.0 * M_PI * double(uniformFrom(along.v[2])) };
  }
}

Vec3d SmoothWarp::originalPlaceMm(const Vec3d& place) const
{
  Vec3d original = place;
  for (const Wave& wave : waves_)
  {
    original -= wave.amplitudeMm * std::cos(glm::dot(wave.radPerMm, place) + wave.phaseRad);
  }
  return original;
}

Vec3d SmoothWarp::placeMm(const Vec3d& original) const
{
  Vec3d place = original;
  for (int step = 0; step < 200; ++step) // each makes the error 0.45 times as large at most
  {
    const Vec3d missing = original - originalPlaceMm(place);
    place += missing;
    if (glm::length(missing) < 1e-10)
    {
      break;
    }
  }
  return place;
}

Mat3d SmoothWarp::originalSlope(const Vec3d& place) const
{
  Mat3d slope(1.0);
  for (const Wave& wave : waves_)
  {
    slope +=
      glm::outerProduct(wave.amplitudeMm, wave.radPerMm) * std::sin(glm::dot(wave.radPerMm, place) + wave.phaseRad);
  }
  return slope;
}

LabelVolume warped(const LabelVolume& volume, const SmoothWarp& warp)
{
  const GridPlacement& from = volume.placement;
  LabelVolume out;
  out.placement = padding(volume, warp.amplitudeMm()).placement;
  out.labels = volume.labels;
  out.notice = volume.notice;
  const Vec3i size = out.placement.size;
  out.voxels.resize(out.placement.voxelCount());
  const auto stoodAt = [&](const Vec3i& v) {
    return from.indexFromWorld(warp.originalPlaceMm(out.placement.worldFromIndex(Vec3d(v))));
  };
  parallelFor(size.z, {}, [&](int k) {
    std::uint16_t* voxel = out.voxels.data() + std::size_t(k) * size.x * size.y;
    for (int j = 0; j < size.y; ++j)
    {
      for (int i = 0; i < size.x; ++i)
      {
        *voxel++ = labelAt(volume, Vec3i(glm::round(stoodAt(Vec3i(i, j, k)))));
      }
    }
  });
  const auto aroundIt = [&](const Vec3i& v) { return labelsAround(volume, stoodAt(v)); };
  keepApart(out, LabelContacts(volume), aroundIt);
  out.collectLabels();
  return out;
}

} // namespace sono
