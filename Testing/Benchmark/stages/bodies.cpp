// Bodies drawn from seeds: how many are valid, and what one costs.
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
    if (!faults.none())
    {
      std::fprintf(stderr, "seed %d: %d open faces, %d chambers in parts, %d chambers off their volume\n", seed,
                   faults.open, faults.apart, faults.volumes);
    }
  }
  printFigure("bodies_drawn", bodies, "bodies");
  printFigure("bodies_valid_percent", 100.0 * valid / bodies, "%", "100");
  printFigure("body_2mm_mean_s", sumS / bodies, "s", "at most 1");
  printFigure("body_2mm_max_s", slowestS, "s");
}

const Stage stage("bodies", measureBodies);

} // namespace
} // namespace sono
