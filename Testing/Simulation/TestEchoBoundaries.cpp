#include "Core/SoundSpeed.h"
#include "EchoScenes.h"
#include "TestScenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace sono;
using namespace sono::test;

/// What a tracer hands on for boundaries at these depths: amplitudes split linearly between two samples of its grid,
/// in each with the phase of the way to it.
TracedLines tracedEchoes(const std::vector<PointScatterer>& echoes, const EchoSettings& s, double echoSampleMm)
{
  TracedLines traced;
  traced.model = InterfaceModel::Amadou2024; // whose paths bring boundaries
  traced.lineCount = 1;
  traced.binMm = 0.25;
  traced.binCount = int(s.depthMm / traced.binMm);
  traced.intensity.assign(std::size_t(traced.binCount), 0.125f); // must not touch the boundaries, which carry theirs
  traced.standardError.assign(std::size_t(traced.binCount), 0.0f);
  traced.echoSampleMm = echoSampleMm;
  traced.echoCount = int(s.depthMm / echoSampleMm) + 1;
  traced.boundaryEcho.resize(std::size_t(traced.echoCount));
  const double twoK = 4.0 * M_PI * s.centreFrequencyMHz / assumedSoundSpeedMmPerUs;
  for (const PointScatterer& e : echoes)
  {
    const double r = e.positionMm.z;
    const int before = int(r / echoSampleMm);
    for (int i = before; i < before + 2; ++i)
    {
      const double share = e.amplitude * (1.0 - std::abs(r / echoSampleMm - i));
      traced.boundaryEcho[std::size_t(i)] += std::complex<float>(std::polar(share, -twoK * (r - i * echoSampleMm)));
    }
  }
  return traced;
}

TEST(EchoBoundary, KeepsAmplitudeAndPhaseOnAnySamplingGrid)
{
  EchoSettings s;
  s.depthMm = 60.0;
  std::vector<PointScatterer> echoes;
  for (int i = 0; i < 25; ++i)
  {
    echoes.push_back({ { 0.0, 0.0, 2.0 + 2.3137 * i }, 0.1f + 0.03f * float(i) });
  }
  const ScanLine line = makeLine({ 0, 0, 0 }, { 0, 0, 1 });
  for (const double samplingMHz : { 50.0, 40.0, 31.7 })
  {
    s.samplingMHz = samplingMHz;
    const auto exact = directIq(echoes, line, s);
    for (const double echoSampleMm : { s.sampleMm(), 0.0154, 0.0077, 0.02 })
    {
      const TracedLines traced = tracedEchoes(echoes, s, echoSampleMm);
      const RfLines rf = formRf({ nullptr, &traced, nullptr }, { line }, s);
      EXPECT_LT(nrmse(rf.iq.data(), exact), 2e-3) << samplingMHz << " MHz from " << echoSampleMm << " mm";
      for (const PointScatterer& e : echoes)
      {
        const std::size_t at = std::size_t(std::lround(e.positionMm.z / rf.sampleMm));
        EXPECT_NEAR(std::abs(rf.iq[at]) / std::abs(exact[at]), 1.0, 2e-3);
        EXPECT_NEAR(std::arg(std::complex<double>(rf.iq[at]) / exact[at]), 0.0, 2e-3);
      }
    }
  }
}

TEST(EchoBoundary, OnTheSameGridIsNotSplitAgain)
{
  EchoSettings s;
  s.samplingMHz = 50.0;
  s.depthMm = 100.0;
  TracedLines traced = tracedEchoes({}, s, s.sampleMm());
  const std::size_t at = 6011;
  traced.boundaryEcho[at] = { 0.5f, 0.0f };
  const RfLines rf = formRf({ nullptr, &traced, nullptr }, { makeLine({ 0, 0, 0 }, { 0, 0, 1 }) }, s);
  const std::vector<float> envelope = rf.envelope();
  EXPECT_EQ(std::max_element(envelope.begin(), envelope.end()) - envelope.begin(), std::ptrdiff_t(at));
  for (std::size_t i = 1; i < 40; ++i)
  {
    ASSERT_NEAR(envelope[at - i], envelope[at + i], 1e-6);
  }
}

TEST(EchoBoundary, OfATracedMirrorHasItsReflectionCoefficientAndPlace)
{
  // Tracer and image formation together: a lossless half space behind another.
  Tissue front = makeTissue("a", 1.5, 1540, 0.0);
  Tissue back = makeTissue("b", 3.0, 1540, 0.0);
  front.roughnessMm = back.roughnessMm = 0.0;
  const auto scene =
    makeScene({ 40, 40, 60 }, Vec3d(1.0), { front, back }, [](const Vec3d& p) { return p.z < 30.0 ? 0 : 1; });
  TraceSettings tracing;
  tracing.model = InterfaceModel::Amadou2024; // whose boundaries echo
  tracing.deterministic = true;
  tracing.depthMm = 55.0;
  EchoSettings s;
  s.depthMm = 55.0;
  const std::vector<ScanLine> lines{ makeLine({ 20.2, 20.4, 0.0 }, { 0, 0, 1 }) };
  const RfLines rf = formRf(*scene, lines, trace(*scene, lines, tracing), s);
  const std::vector<float> envelope = rf.envelope();
  const auto peak = std::max_element(envelope.begin(), envelope.end());
  EXPECT_NEAR(*peak, 1.0 / 9.0, 1e-3); // r0^2, its equation
  EXPECT_NEAR(double(peak - envelope.begin()) * rf.sampleMm, 30.0, 0.01);
}

} // namespace
