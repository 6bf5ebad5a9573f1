#include "Core/Device.h"
#include "Core/Progress.h"
#include "GpuOrSkip.h"

namespace {

using namespace sono;

TEST(DeviceChoice, TheCpuNeedsNoReason)
{
  const DeviceChoice choice = chooseDevice(Device::Cpu);
  EXPECT_FALSE(choice.cuda);
  EXPECT_TRUE(choice.note.empty());
}

TEST(DeviceChoice, AutoTakesTheGpuOrSaysWhyNot)
{
  const DeviceChoice choice = chooseDevice(Device::Auto);
  EXPECT_EQ(choice.cuda, cudaStatus().usable);
  EXPECT_EQ(choice.cuda, choice.note.empty());
  EXPECT_EQ(choice.note.find('\n'), std::string::npos);
}

TEST(DeviceChoice, AMissingGpuIsAnErrorWhenItIsAskedFor)
{
  if (cudaStatus().usable)
  {
    EXPECT_TRUE(chooseDevice(Device::Cuda).cuda);
    return;
  }
  try
  {
    chooseDevice(Device::Cuda);
    FAIL() << "no error";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find(cudaStatus().what), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("choose Auto or CPU"), std::string::npos) << error.what();
  }
}

} // namespace
