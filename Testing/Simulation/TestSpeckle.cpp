#include "EchoScenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace sono;
using namespace sono::test;

/// Sum over 100 bins of width 0.04 rms, from 0 to 4 rms, of the squared difference between the share of the samples in
/// the bin and the share that the fitted Rayleigh distribution (sigma^2 = mean square / 2, its maximum-likelihood fit)
/// has there. The paper names neither its bins nor its normalisation.
double rayleighError(const std::vector<float>& envelope)
{
  constexpr int bins = 100;
  double squares = 0.0;
  for (const float e : envelope)
  {
    squares += double(e) * e;
  }
  const double rms = std::sqrt(squares / double(envelope.size()));
  const double width = 0.04 * rms;
  std::vector<double> share(bins, 0.0);
  for (const float e : envelope)
  {
    const int bin = int(e / width);
    if (bin < bins)
    {
      share[std::size_t(bin)] += 1.0 / double(envelope.size());
    }
  }
  double error = 0.0;
  for (int b = 0; b < bins; ++b)
  {
    const double expected = std::exp(-std::pow(0.04 * b, 2)) - std::exp(-std::pow(0.04 * (b + 1), 2));
    error += std::pow(share[std::size_t(b)] - expected, 2);
  }
  return error;
}

TEST(Speckle, IsFullyDevelopedOverTenSeeds)
{
  std::vector<float> all;
  double snr = 0.0;
  double error = 0.0;
  for (unsigned seed = 1; seed <= 10; ++seed)
  {
    const std::vector<float> envelope = speckleEnvelope(seed);
    snr += signalToNoise(envelope) / 10.0;
    error += rayleighError(envelope) / 10.0;
    all.insert(all.end(), envelope.begin(), envelope.end());
  }
  EXPECT_NEAR(snr, 1.91, 0.02);
  // A run's error is what its finite number of independent samples leaves: pooled, ten runs leave a tenth.
  EXPECT_LE(error, 1.8e-5);
  EXPECT_LE(rayleighError(all), 0.25 * 1.8e-5);
  RecordProperty("snr", std::to_string(snr));
  RecordProperty("sse", std::to_string(1e5 * error) + "e-5");
}

TEST(Speckle, OfFewScatterersIsToldApart)
{
  // Less than one scatterer per resolution cell.
  const std::vector<float> envelope = speckleEnvelope(1, 1.0);
  EXPECT_LT(signalToNoise(envelope), 1.7);
  EXPECT_GT(rayleighError(envelope), 1e-3);
}

} // namespace
