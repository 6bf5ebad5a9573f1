#pragma once

#include "Echo/BeamSplat.h"
#include "Kernel/Scatterer.h"
#include "Scene/Scene.h"

#include <functional>
#include <vector>

namespace sono {

/// A beam and the depth to which it is needed.
struct BeamReach
{
  GaussianBeam beam;
  float depthMm; ///< <= 0: not needed at all
};

/// The procedural scatterers of a scene, generated brick by brick (4 x 4 x 4 cells) where beams see them; nothing is
/// stored.
class ScattererBricks
{
public:
  /// `cellMm` is the edge h of a cell. The scene must outlive this.
  ScattererBricks(const Scene& scene, double cellMm, std::uint64_t seed);

  /// Calls visit(scatterers, b) for every brick that beam b of the group may see, in a fixed order. The bricks of a
  /// group are generated once for all of its beams, so beams of a group should be neighbours.
  void forGroup(const std::vector<BeamReach>& group,
                const std::function<void(const ScattererList&, std::size_t)>& visit) const;

private:
  void generate(const Vec3i& brick, ScattererList& list) const;

  const Scene& scene_;
  float cellMm_;
  std::uint64_t seed_;
  std::vector<ScatteringMedium> media_;
};

} // namespace sono
