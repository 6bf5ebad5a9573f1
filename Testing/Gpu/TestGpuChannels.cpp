#include "BeamScenes.h"
#include "Channels/ScenePoints.h"
#include "Cuda/DeviceChannels.h"
#include "GpuOrSkip.h"
#include "PhantomScene.h"
#include "Phantoms/ThoraxPhantom.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <tuple>

namespace {

using namespace sono;

double secondsSince(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Root mean square of the difference against the CPU's signals.
double difference(const ChannelData& gpu, const ChannelData& cpu)
{
  double off = 0.0;
  double all = 0.0;
  for (std::size_t n = 0; n < cpu.rf.size(); ++n)
  {
    off += std::pow(double(gpu.rf[n]) - double(cpu.rf[n]), 2);
    all += std::pow(double(cpu.rf[n]), 2);
  }
  return std::sqrt(off / all);
}

ChannelPoints cloud(int count)
{
  ChannelPoints points;
  for (int n = 0; n < count; ++n)
  {
    points.push({ float(35.0 * std::sin(3.1 * n)), float(3.0 * std::cos(5.3 * n)), float(15.0 + 60.0 * n / count) },
                float(std::sin(7.7 * n)), float(std::cos(9.1 * n)), float(0.4 * std::sin(0.3 * n)),
                0.002f * float(n % 90), float(n % 2));
  }
  return points;
}

TEST(GpuSmall, ChannelsAreThoseOfTheCpu)
{
  SONO_GPU_OR_SKIP();
  for (const bool flat : { false, true })
  {
    // Tiles of points, transmits and elements that are not full, elements of several pieces.
    for (const auto& [transmits, elements, widthMm] : { std::make_tuple(1, 17, 0.2), std::make_tuple(3, 64, 0.295),
                                                        std::make_tuple(37, 100, 0.15), std::make_tuple(2, 12, 1.5) })
    {
      ChannelSettings settings;
      settings.transmitCount = transmits;
      settings.elementCount = elements;
      settings.flat = flat;
      settings.attenuationDbPerCmMHz = 0.3;
      ProbeSettings probe = test::p42();
      probe.geometry.depthMm = 80.0;
      probe.elementWidthMm = widthMm;
      const ChannelPlan plan(settings, probe);
      const ChannelPoints points = cloud(203);
      EXPECT_LT(difference(formChannelsOnDevice(plan, points, {}), formChannels(plan, points)), 1e-3)
        << "flat " << flat << ", " << transmits << " transmits, " << elements << " elements";
    }
  }
}

TEST(GpuChannels, TenPlaneWavesOfTheA4C)
{
  ProbeSettings probe = test::p42();
  const ProbePose pose = thoraxPhantomA4C().orthonormalized();
  const auto scene = makePhantomScene(makeThoraxPhantom(1.0));
  EchoSettings echo = test::echoOf(test::p42(), probe.geometry.depthMm);
  EchoSources sources;
  sources.scene = scene.get();
  auto start = std::chrono::steady_clock::now();
  const ChannelPoints points = scenePoints(sources, probe, pose, echo, 15);
  std::size_t surfaces = 0;
  for (const float rise : points.rise)
  {
    surfaces += rise > 0.0f;
  }
  std::printf("A4C: %zu points, %zu of them of smooth surfaces, in %.2f s\n", points.size(), surfaces,
              secondsSince(start));
  ChannelSettings settings;
  settings.transmitSpanDeg = 40.0;
  const ChannelPlan plan(settings, probe);
  const ChannelShells shells = makeShells(plan, points);
  std::printf("%zu shells of %d samples, %d frequencies\n", shells.shells.size(), shells.samples, shells.bins);
  // Of every 100th point, which the CPU does in seconds too.
  std::vector<std::size_t> some;
  for (std::size_t n = 0; n < points.size(); n += 100)
  {
    some.push_back(n);
  }
  const ChannelPoints part = points.ordered(some);
  start = std::chrono::steady_clock::now();
  const ChannelData cpu = formChannels(plan, part);
  std::printf("of %zu points the CPU takes %.2f s\n", part.size(), secondsSince(start));
  SONO_GPU_OR_SKIP();
  formChannelsOnDevice(plan, cloud(10), {}); // the device wakes up
  start = std::chrono::steady_clock::now();
  const ChannelData data = formChannelsOnDevice(plan, points, {});
  const double seconds = secondsSince(start);
  std::printf("ten plane waves, 64 elements: %.2f s\n", seconds);
  EXPECT_LT(seconds, 30.0);
  EXPECT_LT(difference(formChannelsOnDevice(plan, part, {}), cpu), 1e-3);
}

} // namespace
