// Bodies drawn from seeds, at any phase: how many are valid, and stay closed when they are warped, and what one costs.
#include "Labels/SmoothWarp.h"
#include "Phantoms/CheckThorax.h"
#include "Phantoms/DrawThorax.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Stage.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>

namespace sono {
namespace {

void measureBodies()
{
  constexpr int bodies = 200;
  int valid = 0;
  int closed = 0; // as steeply as a warp may be
  double sumS = 0.0;
  double slowestS = 0.0;
  for (int seed = 1; seed <= bodies; ++seed)
  {
    const ThoraxParameters parameters = drawThoraxParameters(std::uint64_t(seed));
    Stopwatch watch;
    const LabelVolume labels = makeThoraxPhantom(2.0, parameters);
    const double seconds = watch.lap();
    sumS += seconds;
    slowestS = std::max(slowestS, seconds);
    const ThoraxFaults faults = checkThorax(labels, parameters);
    valid += faults.none() ? 1 : 0;
    const ThoraxFaults ofWarped = checkThorax(
      warped(labels, SmoothWarp(10.0, 10.0 * SmoothWarp::leastWavelengths, std::uint64_t(seed))), parameters);
    closed += ofWarped.open == 0 && ofWarped.apart == 0 ? 1 : 0;
    if (!faults.none())
    {
      std::fprintf(stderr, "seed %d: %d open faces, %d chambers in parts, %d chambers off their volume\n", seed,
                   faults.open, faults.apart, faults.volumes);
    }
  }
  printFigure("bodies_drawn", bodies, "bodies");
  printFigure("bodies_valid_percent", 100.0 * valid / bodies, "%", "100");
  printFigure("bodies_closed_when_warped_percent", 100.0 * closed / bodies, "%", "100");
  printFigure("body_2mm_mean_s", sumS / bodies, "s", "at most 1");
  printFigure("body_2mm_max_s", slowestS, "s");
}

const Stage stage("bodies", measureBodies);

} // namespace
} // namespace sono
