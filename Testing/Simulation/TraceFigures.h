#pragma once

#include "TestScenes.h"

#include "Trace/Trace.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

// What rough surfaces do to the traced intensity (Data/docs/physics.md section 10), as a test judges it and `measure
// picture` prints it.

namespace sono::test {

inline Tissue roughTissue(const std::string& name, double impedance, double speed, double attenuation, double heightMm)
{
  Tissue t = makeTissue(name, impedance, speed, attenuation);
  t.roughnessMm = heightMm;
  return t;
}

/// Of a line down the axis of a ball between 30 and 50 mm, in gel.
inline TracedLines traceThroughBall(const Tissue& gel, const Tissue& ball, const TraceSettings& s)
{
  const auto scene = makeScene(Vec3i(60, 60, 100), Vec3d(1.0), { gel, ball },
                               [](const Vec3d& p) { return glm::length(p - Vec3d(30.0, 30.0, 40.0)) < 10.0 ? 1 : 0; });
  return trace(*scene, { makeLine({ 30.0, 30.0, 0.0 }, { 0, 0, 1 }) }, s);
}

inline TraceSettings ballSettings()
{
  TraceSettings s;
  s.depthMm = 90.0;
  s.frequencyMHz = 2.5;
  s.pathsPerLine = 4096;
  return s;
}

/// Largest change of the intensity by a boundary of that roughness where both sides are alike to within 6e-7, dB.
inline double matchedBoundaryDb(double heightMm)
{
  const Tissue gel = roughTissue("gel", 1.54, 1540.0, 0.5, 0.1);
  const auto through = [&](double impedance) {
    return traceThroughBall(gel, roughTissue("ball", impedance, 1540.0, 0.5, heightMm), ballSettings()).intensity;
  };
  const std::vector<float> with = through(1.54 * (1.0 + 6e-7));
  const std::vector<float> without = through(1.54);
  double worst = 0.0;
  for (std::size_t b = 0; b < with.size(); ++b)
  {
    worst = std::max(worst, std::abs(20.0 * std::log10(double(with[b]) / without[b])));
  }
  return worst;
}

constexpr double waterCystEnhancementDb = 4.95; ///< section 10.7

/// What lies behind a ball of water against what lies there without it, dB.
inline std::vector<double> enhancementsDb(double heightMm)
{
  const auto through = [&](const Tissue& ball) {
    return traceThroughBall(roughTissue("gel", 1.60, 1540.0, 0.5, heightMm), ball, ballSettings());
  };
  const TracedLines with = through(roughTissue("water", 1.48, 1480.0, 0.0022, heightMm));
  const TracedLines without = through(roughTissue("none", 1.60, 1540.0, 0.5, heightMm));
  std::vector<double> out;
  for (const double depthMm : { 55.0, 70.0, 85.0 })
  {
    const std::size_t bin = std::size_t(depthMm / with.binMm);
    out.push_back(20.0 * std::log10(double(with.intensity[bin]) / without.intensity[bin]));
  }
  return out;
}

} // namespace sono::test
