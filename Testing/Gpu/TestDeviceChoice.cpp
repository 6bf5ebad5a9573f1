#include "Core/Device.h"
#include "Core/Progress.h"
#include "GpuOrSkip.h"
#include "Trace/TraceDevice.h"

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

TEST(DeviceChoice, AutoSaysWhenTheReferenceMarchLeavesAGpuAside)
{
  TraceSettings s;
  s.march = March::NanoVDB;
  const DeviceChoice choice = chooseDevice(s);
  EXPECT_FALSE(choice.cuda);
  EXPECT_NE(choice.note.find(cudaStatus().usable ? "NanoVDB" : cudaStatus().what), std::string::npos) << choice.note;
  EXPECT_EQ(choice.note.find('\n'), std::string::npos);
  s.device = Device::Cpu;
  EXPECT_TRUE(chooseDevice(s).note.empty());
  s.device = Device::Cuda;
  EXPECT_THROW(chooseDevice(s), Error);
}

TEST(DeviceChoice, TheDeviceIsAskedOnce)
{
  EXPECT_EQ(&cudaStatus(), &cudaStatus());
}

} // namespace
