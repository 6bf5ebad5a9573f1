#include "GpuParity.h"
#include "PhantomScene.h"
#include "Phantoms/ThoraxPhantom.h"
#include "SpoilDevice.h"

#include <cstdlib>

namespace {

using namespace sono;
using namespace sono::test;

std::vector<PlaneImage> simulate(const Scene& scene, int lines)
{
  ImageSettings s;
  s.geometry.lineCount = lines;
  s.tracing.pathsPerLine = 10;
  s.setDevice(Device::Cuda);
  s.matchStages();
  return imagesOf(scene, { thoraxPhantomA4C().orthonormalized() }, s);
}

TEST(GpuTrouble, NoMemoryIsAnErrorThatNamesTheBytesAndPasses)
{
  SONO_GPU_OR_SKIP();
  const auto scene = makePhantomScene(makeThoraxPhantom(2.0));
  {
    const TakenMemory taken;
    try
    {
      simulate(*scene, 2000);
      FAIL() << "no error";
    }
    catch (const Error& error)
    {
      const std::string message = error.what();
      EXPECT_NE(message.find("the GPU has no room for"), std::string::npos) << message;
      EXPECT_NE(message.find("bytes"), std::string::npos) << message;
      EXPECT_NE(message.find("choose the CPU"), std::string::npos) << message;
    }
  }
  EXPECT_EQ(simulate(*scene, 20).size(), 1u);
}

/// In a process of its own, since CUDA does not come back in one that lost it.
TEST(GpuTrouble, ALostDeviceIsAnErrorAndNoCrash)
{
  SONO_GPU_OR_SKIP();
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
    {
      const auto scene = makePhantomScene(makeThoraxPhantom(4.0));
      loseDevice();
      try
      {
        simulate(*scene, 20);
        std::exit(1);
      }
      catch (const Error&)
      {
        std::exit(0);
      }
    },
    testing::ExitedWithCode(0), "");
}

} // namespace
