#include "GpuThorax.h"

#include "Cuda/GreyTexture.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <vector>

namespace {

using namespace sono;
using namespace sono::test;

/// As an exam has them: held and set otherwise each, some with other numbers of paths, some by their second harmonic.
std::vector<ImageInput> exam()
{
  std::vector<ImageInput> inputs;
  for (int i = 0; i < 8; ++i)
  {
    ImageInput input;
    input.settings.geometry.lineCount = 48; // whose beams overlap at the focus
    input.settings.tracing.pathsPerLine = i % 3 == 2 ? 120 : 80;
    input.settings.tracing.seed = 100u + std::uint64_t(i);
    input.settings.echo.imagingMode = i % 3 == 1 ? ImagingMode::Harmonic : ImagingMode::Fundamental;
    input.settings.echo.aperture = namedAperture();
    input.settings.setDevice(Device::Cuda);
    input.settings.matchStages();
    input.settings.bmode.gainDb = i;
    input.settings.bmode.addNoise = i % 2 == 1;
    input.settings.bmode.noiseSeed = std::uint64_t(i);
    input.settings.bmode.addHaze = i % 4 == 3;
    input.pose = thoraxPhantomA4C().orthonormalized();
    input.pose.positionMm += 0.5 * i * input.pose.lateral;
    inputs.push_back(input);
  }
  return inputs;
}

/// Pixels in which two pictures differ.
template<class T>
int differing(const SharedSpan<T>& a, const SharedSpan<T>& b)
{
  EXPECT_EQ(a.size, b.size);
  int count = 0;
  for (std::size_t i = 0; i < std::min(a.size, b.size); ++i)
  {
    count += a[i] != b[i] ? 1 : 0;
  }
  return count;
}

TEST(GpuPictures, ThoseMadeTogetherAreThoseMadeAlone)
{
  SONO_GPU_OR_SKIP();
  const std::shared_ptr<Scene> scene = makePhantomScene(makeThoraxPhantom(2.0));
  const std::vector<ImageInput> inputs = exam();
  scene->shareRegion({ Vec3i(0), scene->placement().size });
  const std::vector<SeenPicture> together = Simulator(scene).pictures(inputs);
  ASSERT_EQ(together.size(), inputs.size());
  for (std::size_t i = 0; i < inputs.size(); ++i)
  {
    Simulator simulator(scene);
    const TracedResult traced = simulator.traced(inputs[i]);
    const ScanPicture alone =
      simulator.picture(simulator.image(inputs[i]), inputs[i].settings.geometry, inputs[i].pose, traced);
    EXPECT_EQ(differing(together[i].picture.grey, alone.grey), 0) << i;
    EXPECT_EQ(differing(together[i].picture.mask, alone.mask), 0) << i;
    EXPECT_EQ(differing(together[i].picture.labels, alone.labels), 0) << i;
    EXPECT_GT(*std::max_element(alone.grey.begin(), alone.grey.end()), 100) << i;
    EXPECT_TRUE(together[i].arrivals->intensity == traced.host().intensity) << i;
    EXPECT_TRUE(together[i].arrivals->depthOffsetMm == traced.host().depthOffsetMm) << i;
  }
}

TEST(GpuPictures, AProbeThatMovesReverberatesAsOneThatRests)
{
  SONO_GPU_OR_SKIP();
  const ImageInput input = exam().front();
  const std::shared_ptr<Scene> scene = makePhantomScene(makeThoraxPhantom(2.0));
  scene->shareRegion({ Vec3i(0), scene->placement().size });
  const ScanPicture alone = Simulator(scene).pictures({ input }).front().picture;
  ProbePose moved = input.pose;
  moved.positionMm += 3.0 * moved.lateral;
  Simulator(scene).sweep({ input.pose, moved }, input.settings, false, [&](const SweptPictures& swept) {
    EXPECT_TRUE(std::equal(alone.grey.begin(), alone.grey.end(), swept.grey));
  });
}

/// Surfaces are fitted where some image may hear them, and stay.
TEST(GpuPictures, DoNotDependOnSurfacesThatOthersHadFitted)
{
  SONO_GPU_OR_SKIP();
  ImageInput input = exam()[1]; // whose second harmonic hears surfaces up to some slope alone
  input.settings.echo.centreFrequencyMHz = 1.7;
  input.settings.matchStages();
  const ProbePose pose = input.pose;
  std::vector<ProbePose> poses;
  for (int i = 0; i < 8; ++i)
  {
    const double turn = 0.4 * i;
    ProbePose turned = pose;
    turned.lateral = std::cos(turn) * pose.lateral + std::sin(turn) * glm::cross(pose.axial, pose.lateral);
    turned.axial = pose.axial + 0.5 * std::sin(turn) * pose.lateral;
    poses.push_back(turned.orthonormalized());
  }
  const auto rfOf = [&](const std::vector<ProbePose>& shown) {
    const std::shared_ptr<Scene> scene = makePhantomScene(makeThoraxPhantom(1.5));
    scene->shareRegion({ Vec3i(0), scene->placement().size });
    Simulator simulator(scene);
    std::vector<std::vector<std::complex<float>>> iq;
    for (const ProbePose& each : shown)
    {
      iq.push_back(simulator.rf({ each, input.settings, {}, nullptr }).host().iq);
    }
    return iq;
  };
  const auto inOrder = rfOf(poses);
  std::reverse(poses.begin(), poses.end());
  const auto inReverse = rfOf(poses);
  for (std::size_t i = 0; i < poses.size(); ++i)
  {
    EXPECT_TRUE(inOrder[i] == inReverse[poses.size() - 1 - i]) << i;
  }
}

TEST(GpuPictures, StayOnTheGpuUntilTheHostReadsThem)
{
  SONO_GPU_OR_SKIP();
  const std::vector<ImageInput> inputs = exam();
  const std::shared_ptr<Scene> scene = makePhantomScene(makeThoraxPhantom(2.0));
  const auto pictureOf = [&](const ImageInput& input) {
    Simulator simulator(scene);
    return simulator.picture(simulator.image(input));
  };
  const ScanPicture onHost = pictureOf(inputs[0]);
  const ScanPicture other = pictureOf(inputs[5]);
  EXPECT_FALSE(isOnGpu(onHost.grey.data.get()));
  keepPicturesOnGpu();
  ScanPicture onGpu = pictureOf(inputs[0]);
  EXPECT_TRUE(isOnGpu(onGpu.grey.data.get()));
  EXPECT_FALSE(isOnGpu(onGpu.mask.data.get()));
  EXPECT_EQ(differing(onGpu.grey, onHost.grey), 0);
  EXPECT_GT(differing(onGpu.grey, other.grey), 1000);
  onGpu = {}; // whose memory, which the host has read, the next one gets
  onGpu = pictureOf(inputs[5]);
  EXPECT_TRUE(isOnGpu(onGpu.grey.data.get()));
  EXPECT_EQ(differing(onGpu.grey, other.grey), 0);
}

} // namespace
