#pragma once

#include "Echo/FormRf.h"
#include "GpuOrSkip.h"
#include "Simulate.h"
#include "Trace/Trace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

inline Chain runChain(const EchoSources& sources, const std::vector<ScanLine>& lines, TraceSettings tracing,
                      EchoSettings echo, Device device, const std::vector<TargetSurface>& targets = {})
{
  tracing.device = echo.device = device;
  Chain chain;
  EchoSources all = sources;
  if (sources.scene)
  {
    chain.traced = trace(*sources.scene, lines, tracing, {}, targets);
    all.traced = &chain.traced;
  }
  chain.rf = formRf(all, lines, echo);
  return chain;
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

inline void expectSameRf(const Chain& gpu, const Chain& cpu, const std::string& what)
{
  ASSERT_EQ(gpu.rf.iq.size(), cpu.rf.iq.size()) << what;
  EXPECT_LE(rfDifference(gpu.rf, cpu.rf), rfTolerance) << what;
}

} // namespace sono::test
