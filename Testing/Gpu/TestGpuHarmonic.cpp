#include "GpuThorax.h"

#include <cstdlib>

namespace {

using namespace sono;
using namespace sono::test;

ImageInput harmonicInput(Device device)
{
  ImageInput input{ thoraxPhantomA4C().orthonormalized(), thoraxSettings(), {}, nullptr };
  input.settings.echo.imagingMode = ImagingMode::Harmonic;
  input.settings.echo.centreFrequencyMHz = 3.6;
  input.settings.echo.aperture = namedAperture();
  input.settings.setDevice(device);
  input.settings.matchStages();
  return input;
}

TEST(GpuHarmonic, EchoesAreThoseOfTheCpu)
{
  SONO_GPU_OR_SKIP();
  Simulator onGpu(borrowed(&thorax()));
  Simulator onCpu(borrowed(&thorax()));
  const RfResult gpu = onGpu.rf(harmonicInput(Device::Cuda));
  EXPECT_NE(gpu.onDevice(), nullptr);
  EXPECT_LE(rfDifference(gpu.host(), onCpu.rf(harmonicInput(Device::Cpu)).host()), rfTolerance);
}

TEST(GpuHarmonic, ASweepsPicturesAreThoseOfItsPoses)
{
  SONO_GPU_OR_SKIP();
  const ImageInput input = harmonicInput(Device::Cuda);
  ProbePose moved = input.pose;
  moved.positionMm += 3.0 * moved.lateral;
  const std::vector<ProbePose> poses{ input.pose, moved };
  Simulator simulator(borrowed(&thorax()));
  int seen = 0;
  simulator.sweep(poses, input.settings, false, [&](const SweptPictures& pictures) {
    for (int n = 0; n < pictures.count; ++n, ++seen)
    {
      Simulator alone(borrowed(&thorax()));
      const ImageInput one{ poses[std::size_t(seen)], input.settings, {}, nullptr };
      const ScanPicture picture = alone.picture(alone.image(one));
      const std::size_t first = std::size_t(n) * picture.grey.size;
      int differing = 0;
      for (std::size_t p = 0; p < picture.grey.size; ++p)
      {
        differing += std::abs(int(picture.grey[p]) - int(pictures.grey[first + p])) > 1;
      }
      EXPECT_LE(differing, int(picture.grey.size / 1000)) << seen;
    }
  });
  EXPECT_EQ(seen, 2);
}

} // namespace
