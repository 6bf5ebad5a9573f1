#pragma once

#include "Core/Progress.h"
#include "Echo/EchoSettings.h"
#include "Echo/PointScatterers.h"
#include "Kernel/Scatterer.h"
#include "Probe/ScanGeometry.h"
#include "Scene/Scene.h"
#include "Trace/TraceSettings.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

namespace sono {

/// What the scatterers of moving tissue are, of one echo setting: cells of edge `cellMm` in the reference phase hold
/// one with the tissue's probability.
struct MovingStatistics
{
  double cellMm = 0.0;
  std::array<float, 256> mean{}, sigma{}, probability{}; ///< by tissue index, amplitudes as they echo
  bool signs = false;                                    ///< by chance, so that powers add
  std::uint64_t seed = 0;

  bool operator==(const MovingStatistics& o) const
  {
    return cellMm == o.cellMm && mean == o.mean && sigma == o.sigma && probability == o.probability &&
           signs == o.signs && seed == o.seed;
  }
};

/// Acoustic: all of a tissue are of one strength, of its backscatter coefficient; cells of 0.72 wavelengths, at least
/// 0.15 and at most 0.5 mm, which is 10 and more in a cardiac probe's resolution cell from 40 mm on. A tissue with
/// fibres has the mean of its power over all directions, for a scatterer alone has none. Amadou2024: as tissues that
/// stand still. Throws Error for settings out of range.
MovingStatistics movingStatistics(const Scene& scene, const EchoSettings& settings, InterfaceModel model);

/// Which of a scene's moving scatterers are made. Where cells are small, as of a probe for what lies near the skin, all
/// of a heart's would be some 10^8: then those that lines may hear, by cubes of movingCubeMm.
struct MovingPart
{
  bool isAll = true;
  std::vector<Vec3i> cubes; ///< in the scene's coordinates, by z, y and x: cube c fills [c, c + 1) * movingCubeMm

  bool holds(const MovingPart& o) const
  {
    return isAll == o.isAll && std::includes(cubes.begin(), cubes.end(), o.cubes.begin(), o.cubes.end(), isBefore);
  }
  static bool isBefore(const Vec3i& a, const Vec3i& b) { return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x); }
};

constexpr double movingCubeMm = 8.0;
constexpr double smallMovingCellMm = 0.3; ///< chosen: cells below it are small

/// Of lines in the world. `statistics` are those of the same arguments. Throws Error for settings out of range.
MovingPart movingPart(const Scene& scene, const MovingStatistics& statistics, const std::vector<ScanLine>& lines,
                      const EchoSettings& settings, InterfaceModel model);

/// The scatterers of the scene's moving labels, where its motion brings them: a hash of the cell in the reference phase
/// places each there, at X, and x = X + u(x) is where it is now. A scatterer whose label is not a moving one at x is
/// left out. Where the field folds, there are none. The order depends on nothing but the arguments. The scene has a
/// motion.
std::vector<PointScatterer> movingScatterers(const Scene& scene, const MovingStatistics& statistics,
                                             const MovingPart& part = {}, const Progress& progress = {});

/// These and the user's, sorted. Of a part in bricks that do not depend on which part it is, each of which is whole
/// where a line of it hears one: any part that holds what some lines hear gives these lines the same, to the bit.
/// Throws Aborted.
PointScatterers sortedMoving(const Scene& scene, const MovingStatistics& statistics, const MovingPart& part,
                             const std::vector<PointScatterer>& points, const Progress& progress = {});

} // namespace sono
