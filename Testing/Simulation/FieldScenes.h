#pragma once

#include "Core/SoundSpeed.h"
#include "EchoScenes.h"
#include "Probe/ArrayBeam.h"
#include "TestScenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace sono::test {

/// Trilinear interpolation in double precision, by the sum over all eight corners. 0 beside the table and in front of
/// it; beyond the last depth the table's end holds.
inline double trilinear(const PulseEchoField& field, double lateralMm, double elevationalMm, double depthMm)
{
  const FieldGrid& grid = field.grid();
  const std::array<const FieldAxis*, 3> axes{ &grid.lateral, &grid.elevational, &grid.depth };
  std::array<double, 3> at{ lateralMm, elevationalMm, std::min(depthMm, grid.depth.maxMm()) };
  std::array<int, 3> first{};
  std::array<double, 3> share{};
  for (std::size_t i = 0; i < 3; ++i)
  {
    const FieldAxis& axis = *axes[i];
    at[i] = i < 2 && axis.minMm == 0.0 ? std::abs(at[i]) : at[i];
    if (at[i] < axis.minMm || at[i] > axis.maxMm())
    {
      return 0.0;
    }
    const double place = (at[i] - axis.minMm) / axis.stepMm;
    first[i] = std::min(int(place), axis.count - 2);
    share[i] = place - first[i];
  }
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    double weight = 1.0;
    std::array<int, 3> n{};
    for (std::size_t i = 0; i < 3; ++i)
    {
      const int up = (corner >> i) & 1;
      n[i] = first[i] + up;
      weight *= up ? share[i] : 1.0 - share[i];
    }
    const std::size_t index =
      std::size_t(n[0]) +
      std::size_t(grid.lateral.count) * (std::size_t(n[1]) + std::size_t(grid.elevational.count) * std::size_t(n[2]));
    sum += weight * field.values()[index];
  }
  return sum;
}

/// A table of a function w(lateral, elevational, depth).
inline std::shared_ptr<const PulseEchoField> tabulate(const FieldGrid& grid,
                                                      const std::function<double(double, double, double)>& w)
{
  std::vector<float> values;
  for (int d = 0; d < grid.depth.count; ++d)
  {
    for (int e = 0; e < grid.elevational.count; ++e)
    {
      for (int l = 0; l < grid.lateral.count; ++l)
      {
        values.push_back(float(w(grid.lateral.at(l), grid.elevational.at(e), grid.depth.at(d))));
      }
    }
  }
  return std::make_shared<PulseEchoField>(grid, std::move(values));
}

/// The envelope of a round trip's pulse at depth r behind its scatterer, in double precision, 0 beyond `reachMm`.
struct ExactPulse
{
  std::function<std::complex<double>(double)> envelope;
  double reachMm;
};

/// IQ of a line as the double-precision sum over every scatterer and sample, with any weights and pulse.
inline std::vector<std::complex<double>> directIq(const std::vector<PointScatterer>& points, const ScanLine& line,
                                                  const EchoSettings& s,
                                                  const std::function<double(double, double, double)>& weight,
                                                  const ExactPulse& pulse)
{
  const double twoK = 4.0 * M_PI * s.centreFrequencyMHz / assumedSoundSpeedMmPerUs;
  std::vector<std::complex<double>> iq(std::size_t(s.sampleCount()));
  for (const PointScatterer& p : points)
  {
    const Vec3d q = p.positionMm - line.originMm;
    const double r = glm::dot(q, line.axis);
    const double w = r < 0.0 ? 0.0 : weight(glm::dot(q, line.lateral), glm::dot(q, line.elevation), r);
    if (w == 0.0)
    {
      continue;
    }
    const std::complex<double> a = std::polar(double(p.amplitude) * w, -twoK * r);
    const int first = std::max(0, int(std::ceil((r - pulse.reachMm) / s.sampleMm())));
    const int last = std::min(s.sampleCount() - 1, int((r + pulse.reachMm) / s.sampleMm()));
    for (int n = first; n <= last; ++n)
    {
      iq[std::size_t(n)] += a * pulse.envelope(n * s.sampleMm() - r);
    }
  }
  return iq;
}

/// A box full of scatterers with a mean square amplitude of 1, one a cell.
inline std::unique_ptr<Scene> scatteringBox(const Vec3i& sizeMm)
{
  Tissue tissue = makeTissue("tissue", 1.5, 1540, 0.0);
  tissue.scattererMean = 0.0;
  tissue.scattererSigma = 1.0;
  tissue.scattererProbability = 1.0;
  return makeScene(sizeMm, Vec3d(1.0), { tissue }, [](auto&) { return 0; });
}

/// Parallel lines along +z, side by side along x from the first.
inline std::vector<ScanLine> parallelLines(int count, const Vec3d& firstMm, double pitchMm)
{
  std::vector<ScanLine> lines;
  for (int i = 0; i < count; ++i)
  {
    lines.push_back({ firstMm + Vec3d(pitchMm * i, 0.0, 0.0), { 0, 0, 1 }, { 1, 0, 0 }, { 0, 1, 0 } });
  }
  return lines;
}

/// The Gaussian pulse of the settings.
inline ExactPulse gaussianPulse(const EchoSettings& s)
{
  const double sigmaMm = pulseSigmaMm(s.centreFrequencyMHz, s.fractionalBandwidth);
  return { [sigmaMm](double r) { return std::complex<double>(std::exp(-0.5 * r * r / (sigmaMm * sigmaMm))); },
           9.0 * sigmaMm };
}

} // namespace sono::test
