#include "Cuda/DeviceImager.h"

#include "Cuda/DeviceChannels.h"
#include "Cuda/GreyTexture.h"
#include "Cuda/OwnImager.h"

// Stands in for the GPU where SonoVDB was built without nvcc: there is no imager, so nobody can ask it for anything.

namespace sono {

struct DeviceImager::Work
{
};

class DeviceImager::Download
{
};

const DeviceStatus& cudaStatus()
{
  static const DeviceStatus status{ false, "this SonoVDB was built without CUDA", 0, {} };
  return status;
}

DeviceImager& DeviceImager::instance()
{
  throw Error("the GPU cannot be used: " + cudaStatus().what + "; choose the CPU");
}

OwnImager::OwnImager(int number)
  : number_(number)
{
}
OwnImager::~OwnImager() = default;
void OwnImager::beginDevices() {}

std::shared_ptr<const DeviceTraced> DeviceImager::trace(const std::shared_ptr<const TraceJob>&, LineRange,
                                                        const Progress&)
{
  return nullptr;
}

std::shared_ptr<const DeviceTraced> DeviceImager::traceHarmonic(const std::shared_ptr<const TraceJob>&,
                                                                const std::shared_ptr<const TraceJob>&,
                                                                const HarmonicJob&, const Progress&)
{
  return nullptr;
}

void DeviceImager::prepare(const std::shared_ptr<const EchoJob>&) {}

std::shared_ptr<const DeviceRf> DeviceImager::formRf(const std::shared_ptr<const EchoJob>&, LineRange,
                                                     const DeviceTraced*, bool)
{
  return nullptr;
}

std::shared_ptr<const DeviceGrey> DeviceImager::compress(const std::shared_ptr<const BModeJob>&, const DeviceRf&, int)
{
  return nullptr;
}

std::shared_ptr<const DeviceGrey> DeviceImager::compress(const std::vector<std::shared_ptr<const BModeJob>>&,
                                                         const DeviceRf&)
{
  return nullptr;
}

std::shared_ptr<const DevicePicture> DeviceImager::convert(const PlaneScan&, std::shared_ptr<const DeviceGrey>)
{
  return nullptr;
}

std::shared_ptr<const DeviceLabelSlice> DeviceImager::slice(const LabelJob&, const DevicePicture&, const DeviceTraced*)
{
  return nullptr;
}

FetchedArrivals DeviceImager::fetchArrivals(const DeviceTraced&)
{
  return {};
}

FetchedTrace DeviceImager::fetch(const DeviceTraced&)
{
  return {};
}

std::vector<std::complex<float>> DeviceImager::fetchIq(const DeviceRf&)
{
  return {};
}

std::vector<float> DeviceImager::fetch(const DeviceGrey&, std::vector<double>&)
{
  return {};
}

std::vector<float> DeviceImager::fetchLevels(const DevicePicture&)
{
  return {};
}

SharedSpan<std::uint8_t> DeviceImager::maskOf(const DevicePicture&)
{
  return {};
}

std::shared_ptr<DeviceImager::Download> DeviceImager::beginDownload(std::shared_ptr<const DevicePicture>,
                                                                    std::shared_ptr<const DeviceLabelSlice>)
{
  return nullptr;
}

PictureCopy DeviceImager::wait(const std::shared_ptr<Download>&)
{
  return {};
}

DeviceBytes DeviceImager::bytesOf(std::shared_ptr<const DevicePicture>, int)
{
  return {};
}

DeviceBytes DeviceImager::upload(const std::vector<std::uint8_t>&)
{
  return {};
}

void giveBackAfter(DeviceBytes, std::uintptr_t) {}

struct GreyTexture::Registered
{
};

std::unique_ptr<GreyTexture> GreyTexture::of(unsigned, int, int)
{
  return nullptr;
}

GreyTexture::~GreyTexture() = default;

bool GreyTexture::fill(const std::uint8_t*, const GreyColours&)
{
  return false;
}

bool isOnGpu(const void*)
{
  return false;
}

void keepPicturesOnGpu() {}

int DeviceImager::imagesThatFit(double)
{
  return 1;
}

ChannelData formChannelsOnDevice(const ChannelPlan&, const ChannelPoints&, const Progress&)
{
  throw Error("the GPU cannot be used: " + cudaStatus().what + "; choose the CPU");
}

DeviceTimes DeviceImager::lastTimes()
{
  return {};
}

} // namespace sono
