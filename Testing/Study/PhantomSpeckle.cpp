// The seed's speckle experiment: envelope SNR and the fit of a Rayleigh distribution, over ten seeds.
#include "PhantomSpeckle.h"

#include "Echo/FormRf.h"
#include "EchoScenes.h"
#include "Progress.h"
#include "Study.h"

#include <cmath>
#include <random>

namespace sono::study {
namespace {

constexpr double sideMm = 40.0;
constexpr double faceMm = 5.0; // the field's distance from the transducer

/// Amplitude 1, 600 a mm^2, in a sheet of 40 x 40 mm, as the seed has it.
std::vector<PointScatterer> sheet(unsigned seed, double densityPerMm2)
{
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(0.0, sideMm);
  std::vector<PointScatterer> points(std::size_t(densityPerMm2 * sideMm * sideMm));
  for (PointScatterer& p : points)
  {
    const double x = place(random) - 0.5 * sideMm;
    p = { { x, 0.0, faceMm + place(random) }, 1.0f };
  }
  return points;
}

EchoSettings speckleEcho()
{
  EchoSettings echo;
  echo.lateralSigmaMm = 2.0;     // the seed's
  echo.elevationalSigmaMm = 2.0; // the seed's
  // The seed names neither pulse nor probe. The fit's error is what the number of independent samples leaves, so the
  // pulse is short. A wider band would reach down to zero frequency, where scatterers that are all alike add up.
  echo.centreFrequencyMHz = 25.0;
  echo.fractionalBandwidth = 0.6;
  echo.samplingMHz = 150.0;
  echo.depthMm = faceMm + sideMm + 1.0;
  return echo;
}

} // namespace

std::vector<float> speckleSamples(unsigned seed, double densityPerMm2)
{
  const EchoSettings echo = speckleEcho();
  ScanGeometry geometry;
  geometry.kind = ScanKind::Linear;
  geometry.depthMm = echo.depthMm;
  // Three beam sigma from the sides, where the field is uniform to 0.3 %; lines half a sigma apart.
  geometry.widthMm = sideMm - 6.0 * echo.lateralSigmaMm;
  geometry.lineCount = int(geometry.widthMm / (0.5 * echo.lateralSigmaMm)) + 1;
  const PointScatterers points(sheet(seed, densityPerMm2));
  const RfLines rf = formRf({ nullptr, nullptr, &points }, makeScanLines(geometry, ProbePose{}), echo);
  const std::vector<float> envelope = rf.envelope();
  const int first = int((faceMm + 0.5) / rf.sampleMm);
  const int last = int((faceMm + sideMm - 0.5) / rf.sampleMm);
  std::vector<float> samples;
  for (int line = 0; line < rf.lineCount; ++line)
  {
    const auto row = envelope.begin() + std::ptrdiff_t(line) * rf.sampleCount;
    samples.insert(samples.end(), row + first, row + last);
  }
  return samples;
}

double rayleighSse(const std::vector<float>& envelope, std::vector<std::vector<std::string>>* histogram)
{
  constexpr int bins = 100;
  constexpr double binRms = 0.04;
  double squares = 0.0;
  for (const float e : envelope)
  {
    squares += double(e) * e;
  }
  const double rms = std::sqrt(squares / double(envelope.size()));
  std::vector<double> share(bins, 0.0);
  for (const float e : envelope)
  {
    const int bin = int(e / (binRms * rms));
    if (bin < bins)
    {
      share[std::size_t(bin)] += 1.0 / double(envelope.size());
    }
  }
  double sse = 0.0;
  for (int b = 0; b < bins; ++b)
  {
    const double fit = std::exp(-std::pow(binRms * b, 2)) - std::exp(-std::pow(binRms * (b + 1), 2));
    sse += std::pow(share[std::size_t(b)] - fit, 2);
    if (histogram)
    {
      histogram->push_back({ number((b + 0.5) * binRms), number(share[std::size_t(b)]), number(fit) });
    }
  }
  return sse;
}

namespace {

void run(Output& output)
{
  const int seeds = 10;
  double snr = 0.0;
  double snrSquares = 0.0;
  double sse = 0.0;
  std::vector<std::vector<std::string>> histogram;
  std::vector<float> all;
  for (int seed = 1; seed <= seeds; ++seed)
  {
    const std::vector<float> samples = speckleSamples(unsigned(seed), 600.0);
    const double ratio = test::signalToNoise(samples);
    snr += ratio / seeds;
    snrSquares += ratio * ratio / seeds;
    sse += rayleighSse(samples, seed == 1 ? &histogram : nullptr) / seeds;
    all.insert(all.end(), samples.begin(), samples.end());
  }
  output.table("phantom_speckle.csv", { "envelope of rms", "share", "Rayleigh" }, histogram);
  output.figure("speckle_snr", snr, "1");
  output.figure("speckle_snr_std", std::sqrt(std::max(0.0, snrSquares - snr * snr)), "1");
  output.figure("rayleigh_sse", sse, "1");
  output.figure("rayleigh_sse_of_ten_seeds_pooled", rayleighSse(all), "1");
}

const Part part("phantom_speckle", run);

} // namespace
} // namespace sono::study
