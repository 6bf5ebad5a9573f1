#pragma once

#include "Echo/FormRf.h"
#include "GpuOrSkip.h"
#include "Probe/ArrayField.h"
#include "Simulator.h"
#include "Trace/Trace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace sono::test {

/// Bounds of the difference between the two devices: of the RF's peak. One path in 10^5 or so takes another branch on
/// the GPU, where a cosine rounds to the other side of a limit.
constexpr double rfTolerance = 1e-3;

struct Chain
{
  TracedLines traced;
  RfLines rf;
};

/// Something that others own, for as long as the tests need it.
template<class T>
std::shared_ptr<const T> borrowed(const T* object)
{
  return { std::shared_ptr<void>(), object };
}

/// Both stages with the probe's aperture, which the settings of image formation name.
inline Chain runChain(const EchoSources& sources, const std::vector<ScanLine>& lines, TraceSettings tracing,
                      EchoSettings echo, Device device, const std::vector<TargetSurface>& targets = {})
{
  tracing.device = echo.device = device;
  tracing.aperture = echo.aperture;
  Simulator simulator(borrowed(sources.scene));
  Chain chain;
  TracedResult traced;
  if (sources.scene)
  {
    traced = simulator.trace(lines, tracing, targets);
    EXPECT_EQ(traced.onDevice() != nullptr, device == Device::Cuda);
    chain.traced = traced.host();
  }
  chain.rf = simulator.formRf(lines, traced, echo, borrowed(sources.points)).host();
  return chain;
}

/// The images of some poses, one by one.
inline std::vector<PlaneImage> imagesOf(const Scene& scene, const std::vector<ProbePose>& poses,
                                        const ImageSettings& settings, const Progress& progress = {})
{
  Simulator simulator(borrowed(&scene));
  std::vector<PlaneImage> images;
  for (const ProbePose& pose : poses)
  {
    images.push_back(simulator.image({ pose, settings, {}, nullptr }, progress).plane().host());
  }
  return images;
}

/// Largest difference of the RF, of its peak.
inline double rfDifference(const RfLines& a, const RfLines& b)
{
  double worst = 0.0;
  double peak = 0.0;
  for (std::size_t i = 0; i < b.iq.size(); ++i)
  {
    worst = std::max(worst, double(std::abs(a.iq[i] - b.iq[i])));
    peak = std::max(peak, double(std::abs(b.iq[i])));
  }
  return peak > 0.0 ? worst / peak : worst;
}

/// The aperture of a P4-2.
inline BeamAperture namedAperture()
{
  return ProbeSettings().aperture();
}

/// Its computed beam.
inline std::shared_ptr<const ArrayField> computedBeam(double depthMm)
{
  ArrayAperture aperture;
  aperture.fractionalBandwidth = 0.74;
  return std::make_shared<const ArrayField>(aperture, depthMm);
}

inline void expectSameRf(const Chain& gpu, const Chain& cpu, const std::string& what)
{
  ASSERT_EQ(gpu.rf.iq.size(), cpu.rf.iq.size()) << what;
  const double difference = rfDifference(gpu.rf, cpu.rf);
  EXPECT_LE(difference, rfTolerance) << what;
  std::printf("%s: %.2g\n", what.c_str(), difference);
}

} // namespace sono::test
