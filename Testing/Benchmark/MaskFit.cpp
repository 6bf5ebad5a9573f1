#include "MaskFit.h"

#include "TestScenes.h"

#include "Simulator.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

namespace sono {

namespace {

using namespace sono::test;

constexpr double fatMm = 30.0;
constexpr double wallMm = 52.0;      ///< at the middle
constexpr double wallSlope = 0.0875; ///< 5 degrees
const Vec3d ball(20.0, 6.0, 42.0);
constexpr double ballMm = 6.0;
constexpr double middleMm = 20.0;

Tissue smooth(const std::string& name, double impedance, double speed)
{
  Tissue tissue = makeTissue(name, impedance, speed, 0.3);
  tissue.roughnessMm = 0.0;
  tissue.backscatterPerCmSr = 1e-9;
  return tissue;
}

std::shared_ptr<const Scene> wallsBehindFat()
{
  // What a column's voxels cannot tell is an eighth of a millimetre.
  return makeScene({ 40, 12, 280 }, Vec3d(1.0, 1.0, 0.25),
                   { smooth("fat", 1.38, 1450.0), smooth("liver", 1.65, 1550.0), smooth("cyst", 1.5, 1490.0),
                     smooth("muscle", 1.75, 1580.0) },
                   [](const Vec3d& p) {
                     if (p.z < fatMm)
                     {
                       return 0;
                     }
                     if (glm::distance(Vec3d(p.x, ball.y, p.z), ball) < ballMm)
                     {
                       return 2;
                     }
                     return p.z < wallMm + wallSlope * (p.x - middleMm) ? 1 : 3;
                   });
}

ImageInput linearInput()
{
  ImageInput input;
  input.pose.positionMm = { middleMm, 6.0, 0.0 };
  ImageSettings& s = input.settings;
  s.geometry.kind = ScanKind::Linear;
  s.geometry.lineCount = 97;
  s.geometry.widthMm = 24.0;
  s.geometry.depthMm = 64.0;
  s.tracing.pathsPerLine = 64;
  s.bmode.automaticReference = false;
  s.bmode.dynamicRangeDb = 150.0;
  s.bmode.tgcDbPerCm = 0.0;
  s.pixelMm = 0.1;
  s.matchStages();
  s.setDevice(Device::Cpu);
  return input;
}

/// Where a column is brightest within 1.5 mm of a row, in rows.
double brightest(const PlaneImage& image, int column, int row)
{
  const int reach = int(1.5 / image.pixelMm);
  const auto grey = [&](int j) {
    return double(image.value[std::size_t(j) * std::size_t(image.width) + std::size_t(column)]);
  };
  int best = std::max(1, row - reach);
  for (int j = best; j < std::min(image.height - 1, row + reach); ++j)
  {
    best = grey(j) > grey(best) ? j : best;
  }
  const double bend = grey(best + 1) - 2.0 * grey(best) + grey(best - 1);
  return bend < 0.0 ? best - 0.5 * (grey(best + 1) - grey(best - 1)) / bend : best;
}

} // namespace

double maskFitMm()
{
  Simulator simulator(wallsBehindFat());
  const ImageInput input = linearInput();
  const ImageResult image = simulator.image(input);
  const ScanPicture picture = simulator.picture(image, input.settings.geometry, input.pose, simulator.traced(input));
  const PlaneImage& plane = image.plane().host();
  double worst = 0.0;
  double first = 0.0;
  int edges = 0;
  for (int column = 0; column < plane.width; ++column)
  {
    const double lateral = plane.lateralMinMm + column * plane.pixelMm;
    // Beside the ball's poles its walls do not echo along the line.
    const bool atPoles = std::abs(lateral) < 0.15 * ballMm;
    const bool besideBall = std::abs(lateral) > 1.3 * ballMm;
    if (std::abs(lateral) > 10.5 || !(atPoles || besideBall))
    {
      continue;
    }
    for (int row = 1; row < plane.height; ++row)
    {
      const auto at = std::size_t(row) * std::size_t(plane.width) + std::size_t(column);
      if (picture.labels[at] == picture.labels[at - std::size_t(plane.width)] || !plane.mask[at] ||
          !plane.mask[at - std::size_t(plane.width)])
      {
        continue;
      }
      const double off = (brightest(plane, column, row) - (row - 0.5)) * plane.pixelMm;
      first = first == 0.0 ? plane.axialMinMm + (row - 0.5) * plane.pixelMm : first;
      worst = std::max(worst, std::abs(off));
      ++edges;
    }
  }
  std::fprintf(stderr, "mask: %d edges; the fat's, at %g mm, lies in the picture at %.2f mm (%.2f by time)\n", edges,
               fatMm, first, fatMm * 1540.0 / 1450.0);
  return edges > 0 ? worst : 1e9;
}

} // namespace sono
