// Scatterers that are weighted in vectors add up to what each adds by itself.
#include "BeamFigures.h"
#include "TraceFigures.h"

#include "Core/Simd.h"
#include "Echo/BeamModel.h"
#include "Echo/BeamSplat.h"
#include "Probe/ArrayAperture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <memory>
#include <random>
#include <vector>

namespace sono::test {
namespace {

constexpr double depthMm = 100.0;

/// The sum over scatterers one by one, in double precision, each at its exact phase split between two samples.
void addExactly(const ScattererView& v, const Beam& beam, const LineGrid& grid, std::vector<std::complex<double>>& sum)
{
  for (int i = 0; i < v.count; ++i)
  {
    const Vec3f q = Vec3f(v.x[i], v.y[i], v.z[i]) - beam.origin;
    const float alongMm = glm::dot(q, beam.axis);
    const float lateralMm = glm::dot(q, beam.lateral);
    const float elevationalMm = glm::dot(q, beam.elevation);
    const BeamEcho echo = beamEchoAt(beam, lateralMm, elevationalMm, alongMm);
    const double position = double(echo.depthMm) * grid.samplesPerMm;
    if (alongMm < 0.0f || position >= grid.lastSample)
    {
      continue;
    }
    if (isGaussian(beam))
    {
      const ProfileAt at = gaussianAt(beam, alongMm);
      if (lateralMm * lateralMm * at.perLateral2 + elevationalMm * elevationalMm * at.perElevational2 >=
          beamCutSigma * beamCutSigma)
      {
        continue;
      }
    }
    const std::complex<double> a =
      double(v.scale) * v.amplitude[i] * std::complex<double>(echo.weight.re, echo.weight.im);
    const std::size_t before = std::size_t(position);
    const double share = position - double(before);
    sum[before] += a * std::polar(1.0 - share, -grid.radPerSample * share);
    sum[before + 1] += a * std::polar(share, grid.radPerSample * (1.0 - share));
  }
}

void expectSameSum(const EchoSettings& settings, InterfaceModel model)
{
  const BeamModel beams(settings, model);
  const Beam beam = beams.beamOf(makeScanLines(p42().geometry, ProbePose()).front(), Vec3d(1.0, 2.0, 3.0), Mat3d(1.0));
  LineSum sum{ std::vector<float>(2 * 6000, 0.0f), float(settings.sampleMm()),
               4.0 * M_PI * settings.centreFrequencyMHz / assumedSoundSpeedMmPerUs };
  const LineGrid grid = lineGrid(sum);
  std::vector<std::complex<double>> exact(6000);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  for (int brick = 0; brick < 400; ++brick)
  {
    const int count = brick < 300 ? brick % 10 : brick % 150;
    std::vector<float> x, y, z, amplitude;
    for (int i = 0; i < count; ++i)
    {
      // Behind the face and below the last sample, too.
      const Vec3f at = beam.origin + beam.axis * (55.0f * unit(random) + 48.0f) + beam.lateral * (6.0f * unit(random)) +
                       beam.elevation * (6.0f * unit(random));
      x.push_back(at.x);
      y.push_back(at.y);
      z.push_back(at.z);
      amplitude.push_back(unit(random));
    }
    const bool isPadded = brick % 2 == 1;
    for (std::vector<float>* values : { &x, &y, &z, &amplitude })
    {
      values->resize(std::size_t(isPadded ? inWholeVectors(count) : count), 1.0f); // which is heard if it is taken
    }
    const ScattererView view{ x.data(), y.data(), z.data(), amplitude.data(), count, 0.5f + 0.001f * float(brick),
                              isPadded };
    splat(view, beam, grid, sum);
    addExactly(view, beam, grid, exact);
  }
  double largest = 0.0;
  double worst = 0.0;
  for (std::size_t s = 0; s < exact.size(); ++s)
  {
    largest = std::max(largest, std::abs(exact[s]));
    worst = std::max(worst, std::abs(exact[s] - std::complex<double>(sum.iq[2 * s], sum.iq[2 * s + 1])));
  }
  EXPECT_GT(largest, 0.1);
  EXPECT_LT(worst, 1e-3 * largest); // the place between two samples in single precision
}

TEST(Splat, AddsWhatEachScattererAdds)
{
  EchoSettings settings = echoOf(p42(), depthMm);
  expectSameSum(settings, InterfaceModel::Acoustic);
  settings.aperture.elevationIsArray = true;
  expectSameSum(settings, InterfaceModel::Acoustic);
  expectSameSum(settings, InterfaceModel::Amadou2024);
  settings = echoOf(p42(), depthMm);
  settings.arrayField = std::make_shared<ArrayField>(apertureOf(p42()), depthMm);
  expectSameSum(settings, InterfaceModel::Acoustic);
}

} // namespace
} // namespace sono::test
