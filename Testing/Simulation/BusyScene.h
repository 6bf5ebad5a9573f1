#pragma once

#include "TestScenes.h"

#include "Trace/Trace.h"

#include <cmath>

namespace sono::test {

/// Curved and flat boundaries of middling contrast, in a volume that every probe's reach covers whole. All of it
/// scatters.
inline std::unique_ptr<Scene> makeBusyScene()
{
  std::vector<Tissue> tissues = { makeTissue("a", 1.5, 1540, 0.4), makeTissue("b", 2.4, 1700, 0.6),
                                  makeTissue("c", 4.0, 2500, 1.0), makeTissue("d", 1.2, 1400, 0.3) };
  for (Tissue& t : tissues)
  {
    t.scattererMean = 0.3;
    t.scattererSigma = 0.2;
    t.scattererProbability = 0.5;
  }
  return makeScene(Vec3i(64, 48, 64), Vec3d(1.0), tissues, [](const Vec3d& p) {
    if (glm::length(p - Vec3d(30.0, 24.0, 30.0)) < 9.0)
    {
      return 2;
    }
    return p.z < 14.0 + 0.2 * p.x ? 0 : (p.z < 45.0 ? 1 : 3);
  });
}

inline std::vector<ScanLine> fan(int count)
{
  std::vector<ScanLine> lines;
  for (int i = 0; i < count; ++i)
  {
    const double angle = (i - 0.5 * (count - 1)) * 0.05;
    lines.push_back(makeLine({ 32.3, 24.2, 0.0 }, { std::sin(angle), 0.01, std::cos(angle) }));
  }
  return lines;
}

inline TraceSettings busySettings()
{
  TraceSettings s;
  s.depthMm = 60.0;
  s.radialBinMm = 0.5;
  s.pathsPerLine = 256;
  s.coherenceMm = 5.0;
  return s;
}

} // namespace sono::test
