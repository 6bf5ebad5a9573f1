#pragma once

#include "TestScenes.h"

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace sono::test {

struct Layer
{
  double endMm;
  double impedance;
  double speed;
  double attenuation;
};

/// Layers across z, whose ends are multiples of a voxel's height; `change` may say more of their tissues.
inline std::unique_ptr<Scene> layeredScene(
  const std::vector<Layer>& layers, const std::function<void(Tissue&)>& change = [](Tissue&) {}, double voxelMm = 0.5)
{
  std::vector<Tissue> tissues;
  for (std::size_t i = 0; i < layers.size(); ++i)
  {
    tissues.push_back(
      makeTissue("layer" + std::to_string(i), layers[i].impedance, layers[i].speed, layers[i].attenuation));
    change(tissues.back());
  }
  const auto layerAt = [&](const Vec3d& p) {
    std::size_t layer = 0;
    while (layer + 1 < layers.size() && p.z > layers[layer].endMm)
    {
      ++layer;
    }
    return int(layer);
  };
  return makeScene({ 40, 40, int(std::lround(layers.back().endMm / voxelMm)) }, Vec3d(0.5, 0.5, voxelMm), tissues,
                   layerAt);
}

} // namespace sono::test
