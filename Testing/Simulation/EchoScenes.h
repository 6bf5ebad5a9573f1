#pragma once

#include "Core/SoundSpeed.h"
#include "Echo/FormRf.h"
#include "Echo/Pulse.h"
#include "Probe/ScanGeometry.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <random>
#include <vector>

namespace sono::test {

/// IQ of a line by Data/docs/physics.md section 4's sum in double precision: every scatterer in front of the transducer
/// into every sample, the pulse evaluated there, no grid. Terms below exp(-40) of a scatterer's amplitude are left out.
inline std::vector<std::complex<double>> directIq(
  const std::vector<PointScatterer>& points, const ScanLine& line, const EchoSettings& s,
  const std::function<double(double)>& intensity = [](double) { return 1.0; })
{
  const double twoK = 4.0 * M_PI * s.centreFrequencyMHz / assumedSoundSpeedMmPerUs;
  // exp(-k t^2), t = 2 r / c, is 10^-0.3 at half the width whose spectrum is b f wide at -6 dB.
  const double k =
    std::pow(M_PI * s.centreFrequencyMHz * s.fractionalBandwidth, 2) / (4.0 * std::log(std::pow(10.0, 0.3)));
  const double perMm2 = k * std::pow(2.0 / assumedSoundSpeedMmPerUs, 2);
  const double reach = std::sqrt(40.0 / perMm2);
  std::vector<std::complex<double>> iq(std::size_t(s.sampleCount()));
  for (const PointScatterer& p : points)
  {
    const Vec3d q = p.positionMm - line.originMm;
    const double r = glm::dot(q, line.axis);
    const double dl = glm::dot(q, line.lateral) / s.lateralSigmaMm;
    const double de = glm::dot(q, line.elevation) / s.elevationalSigmaMm;
    const double exponent = 0.5 * (dl * dl + de * de);
    if (r < 0.0 || exponent > 40.0)
    {
      continue;
    }
    const std::complex<double> a = std::polar(double(p.amplitude) * std::exp(-exponent) * intensity(r), -twoK * r);
    const int first = std::max(0, int(std::ceil((r - reach) / s.sampleMm())));
    const int last = std::min(s.sampleCount() - 1, int((r + reach) / s.sampleMm()));
    for (int n = first; n <= last; ++n)
    {
      const double d = n * s.sampleMm() - r;
      iq[std::size_t(n)] += a * std::exp(-perMm2 * d * d);
    }
  }
  return iq;
}

/// Lines that the whole intensity reaches, as if this model had traced them.
inline TracedLines fullyLit(std::size_t lineCount, const EchoSettings& s, InterfaceModel model)
{
  TracedLines traced;
  traced.model = model;
  traced.lineCount = int(lineCount);
  traced.binCount = 1;
  traced.binMm = s.depthMm;
  traced.intensity.assign(lineCount, 1.0f);
  traced.standardError.assign(lineCount, 0.0f);
  return traced;
}

/// Root of the summed squared errors over the root of the summed squared reference.
inline double nrmse(const std::complex<float>* got, const std::vector<std::complex<double>>& reference)
{
  double error = 0.0;
  double power = 0.0;
  for (std::size_t n = 0; n < reference.size(); ++n)
  {
    error += std::norm(std::complex<double>(got[n]) - reference[n]);
    power += std::norm(reference[n]);
  }
  return std::sqrt(error / power);
}

/// Scene S1 of Data/docs/physics.md section 4: 10^6 scatterers, 128 lines over +-37.5 degrees, 7792 samples a line.
struct SceneS1
{
  EchoSettings settings;
  std::vector<ScanLine> lines;
  std::vector<PointScatterer> points;

  explicit SceneS1(int count = 1000000, unsigned seed = 1)
  {
    settings.centreFrequencyMHz = 3.6;
    settings.fractionalBandwidth = 0.6;
    settings.samplingMHz = 50.0;
    settings.lateralSigmaMm = 1.0;
    settings.elevationalSigmaMm = 1.0;
    settings.depthMm = 7791.5 * settings.sampleMm();
    ScanGeometry geometry;
    geometry.kind = ScanKind::PhasedSector;
    geometry.lineCount = 128;
    geometry.sectorDeg = 75.0;
    geometry.depthMm = settings.depthMm;
    lines = makeScanLines(geometry, ProbePose{});
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::normal_distribution<double> normal(0.0, 1.0);
    for (int i = 0; i < count; ++i)
    {
      const double angle = (2.0 * uniform(random) - 1.0) * 40.0 * M_PI / 180.0;
      const double radius = std::sqrt(4.0 + uniform(random) * (122.0 * 122.0 - 4.0));
      const double elevation = (2.0 * uniform(random) - 1.0) * 5.0;
      points.push_back({ { radius * std::sin(angle), elevation, radius * std::cos(angle) }, float(normal(random)) });
    }
  }
};

/// What the paper's speckle experiment names: beam sigma 2 mm both ways. It names neither pulse nor probe: a linear
/// array here, b = 0.6, whose frequency decides how many independent samples a run holds (some 3000 at 15 MHz).
inline EchoSettings speckleEcho(double frequencyMHz = 15.0, double samplingMHz = 100.0)
{
  EchoSettings settings;
  settings.centreFrequencyMHz = frequencyMHz;
  settings.samplingMHz = samplingMHz;
  settings.fractionalBandwidth = 0.6;
  settings.lateralSigmaMm = 2.0;
  settings.elevationalSigmaMm = 2.0;
  settings.depthMm = 46.0;
  return settings;
}

/// The paper's speckle experiment: scatterers of amplitude 1 in a sheet of 40 x 40 mm. The envelope where the field is
/// uniform to 0.3 % (3 beam sigma from its sides, 0.5 mm from its ends), on lines half a sigma apart and at every RF
/// sample.
inline std::vector<float> speckleEnvelope(unsigned seed, const EchoSettings& settings = speckleEcho(),
                                          double densityPerMm2 = 600.0)
{
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> across(-20.0, 20.0);
  std::uniform_real_distribution<double> along(5.0, 45.0);
  std::vector<PointScatterer> points;
  for (int i = 0; i < int(densityPerMm2 * 40.0 * 40.0); ++i)
  {
    const double x = across(random);
    points.push_back({ { x, 0.0, along(random) }, 1.0f });
  }
  ScanGeometry geometry;
  geometry.kind = ScanKind::Linear;
  geometry.lineCount = 29;
  geometry.widthMm = 28.0;
  geometry.depthMm = settings.depthMm;
  const PointScatterers sorted(points);
  const RfLines rf = formRf({ nullptr, nullptr, &sorted }, makeScanLines(geometry, ProbePose{}), settings);
  const std::vector<float> envelope = rf.envelope();
  const int first = int(5.5 / rf.sampleMm);
  const int last = int(44.5 / rf.sampleMm);
  std::vector<float> out;
  for (int line = 0; line < rf.lineCount; ++line)
  {
    const auto row = envelope.begin() + std::ptrdiff_t(line) * rf.sampleCount;
    out.insert(out.end(), row + first, row + last);
  }
  return out;
}

/// Mean over standard deviation.
inline double signalToNoise(const std::vector<float>& envelope)
{
  double sum = 0.0;
  double squares = 0.0;
  for (const float e : envelope)
  {
    sum += e;
    squares += double(e) * e;
  }
  const double mean = sum / double(envelope.size());
  return mean / std::sqrt(squares / double(envelope.size()) - mean * mean);
}

/// An envelope's histogram beside the Rayleigh distribution of the same mean square, its maximum-likelihood fit: the
/// shares of 100 bins from 0 to 4 rms. The paper names neither its bins nor its normalisation.
struct RayleighFit
{
  static constexpr double binRms = 0.04;
  std::vector<double> share;
  std::vector<double> fit;
  double sse = 0.0; ///< sum of the squared differences; N independent samples of a Rayleigh variable leave about 1 / N
};

inline RayleighFit rayleighFit(const std::vector<float>& envelope)
{
  RayleighFit result;
  double squares = 0.0;
  for (const float e : envelope)
  {
    squares += double(e) * e;
  }
  const double width = RayleighFit::binRms * std::sqrt(squares / double(envelope.size()));
  result.share.resize(100);
  for (const float e : envelope)
  {
    const std::size_t bin = std::size_t(e / width);
    if (bin < result.share.size())
    {
      result.share[bin] += 1.0 / double(envelope.size());
    }
  }
  const auto above = [](double bin) { return std::exp(-std::pow(RayleighFit::binRms * bin, 2)); };
  for (std::size_t bin = 0; bin < result.share.size(); ++bin)
  {
    result.fit.push_back(above(double(bin)) - above(double(bin + 1)));
    result.sse += std::pow(result.share[bin] - result.fit[bin], 2);
  }
  return result;
}

} // namespace sono::test
