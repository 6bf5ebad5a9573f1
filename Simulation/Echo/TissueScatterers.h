#pragma once

#include "Echo/BrickWalk.h"
#include "Echo/ScattererView.h"
#include "Kernel/Scatterer.h"
#include "Scene/Scene.h"

#include <array>
#include <cstdint>

namespace sono {

/// The procedural scatterers of a scene, generated brick by brick where they are needed; nothing is stored.
/// Positions are local to the scene.
class TissueScatterers
{
public:
  static constexpr int brickCells = 4; ///< cells along an edge of a brick
  static constexpr int cellCount = brickCells * brickCells * brickCells;

  /// Room for the scatterers of one brick.
  struct Buffer
  {
    std::array<float, cellCount> x, y, z, amplitude;
  };

  /// `cellMm` is the edge h of a cell; all amplitudes are multiplied by `scale`. The scene must outlive this.
  TissueScatterers(const Scene& scene, double cellMm, double scale, std::uint64_t seed);

  /// Bricks that may hold scatterers: none when no tissue has any.
  const BrickGrid& grid() const { return grid_; }
  /// By tissue index, amplitudes scaled.
  const std::array<ScatteringMedium, 256>& media() const { return media_; }
  /// The scatterers of a brick, which lie in the buffer. Those of amplitude 0 are left out.
  ScattererView generate(const Vec3i& brick, Buffer& buffer) const;

private:
  const Scene& scene_;
  float cellMm_;
  std::uint64_t seed_;
  BrickGrid grid_;
  std::array<ScatteringMedium, 256> media_; // those that are no tissue of the scene hold nothing
};

} // namespace sono
