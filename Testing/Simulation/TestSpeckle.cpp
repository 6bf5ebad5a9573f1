#include "EchoScenes.h"

#include <gtest/gtest.h>

namespace {

using namespace sono;
using namespace sono::test;

TEST(Speckle, IsFullyDevelopedOverTenSeeds)
{
  std::vector<float> all;
  double snr = 0.0;
  double error = 0.0;
  for (unsigned seed = 1; seed <= 10; ++seed)
  {
    const std::vector<float> envelope = speckleEnvelope(seed);
    snr += signalToNoise(envelope) / 10.0;
    error += rayleighFit(envelope).sse / 10.0;
    all.insert(all.end(), envelope.begin(), envelope.end());
  }
  EXPECT_NEAR(snr, 1.91, 0.02);
  // A run's error is what its finite number of independent samples leaves: pooled, ten runs leave a tenth.
  EXPECT_LE(error, 1.8e-5);
  EXPECT_LE(rayleighFit(all).sse, 0.25 * 1.8e-5);
  RecordProperty("snr", std::to_string(snr));
  RecordProperty("sse", std::to_string(1e5 * error) + "e-5");
}

TEST(Speckle, OfFewScatterersIsToldApart)
{
  // Less than one scatterer per resolution cell.
  const std::vector<float> envelope = speckleEnvelope(1, speckleEcho(), 1.0);
  EXPECT_LT(signalToNoise(envelope), 1.7);
  EXPECT_GT(rayleighFit(envelope).sse, 1e-3);
}

} // namespace
