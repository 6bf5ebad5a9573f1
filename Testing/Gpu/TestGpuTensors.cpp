// Images of a data set that stay on the GPU, against those that come to the host.
#include "BallDataSet.h"
#include "GpuOrSkip.h"
#include "NextImage.h"

#include "DataSets/ImageTensor.h"

#include <cuda_runtime.h>
#include <dlpack/dlpack.h>

#include <utility>
#include <vector>

using namespace sono;

namespace {

using GpuTensors = sono::testing::BallDataSet;

/// What another program finds in a tensor of so many bytes, after which it calls the deleter.
std::vector<std::uint8_t> taken(DLManagedTensor* managed, int height, int width)
{
  const DLTensor& tensor = managed->dl_tensor;
  EXPECT_EQ(tensor.device.device_type, kDLCUDA);
  EXPECT_EQ(tensor.ndim, 2);
  EXPECT_EQ(tensor.shape[0], height);
  EXPECT_EQ(tensor.shape[1], width);
  EXPECT_EQ(tensor.strides, nullptr);
  EXPECT_EQ(tensor.dtype.code, kDLUInt);
  EXPECT_EQ(tensor.dtype.bits, 8);
  std::vector<std::uint8_t> bytes(std::size_t(height) * std::size_t(width));
  int before = 0;
  cudaGetDevice(&before);
  cudaSetDevice(tensor.device.device_id); // a pool's memory is read by its own device
  EXPECT_EQ(cudaMemcpy(bytes.data(), tensor.data, bytes.size(), cudaMemcpyDeviceToHost), cudaSuccess);
  cudaSetDevice(before);
  managed->deleter(managed);
  return bytes;
}

void expectSameOnGpu(const DataSetImage& image)
{
  ASSERT_TRUE(image.greyOnGpu);
  ASSERT_TRUE(image.maskOnGpu);
  constexpr std::uintptr_t defaultStream = 1;
  EXPECT_EQ(taken(newTensor(*image.greyOnGpu, image.height, image.width, defaultStream), image.height, image.width),
            image.grey);
  EXPECT_EQ(taken(newTensor(*image.maskOnGpu, image.height, image.width, defaultStream), image.height, image.width),
            image.mask);
}

TEST_F(GpuTensors, AreTheImagesOfTheHost)
{
  SONO_GPU_OR_SKIP();
  DataSetImager imager(plan(), Device::Cuda);
  EXPECT_FALSE(imager.make(0).greyOnGpu);
  imager.keepOnGpu();
  expectSameOnGpu(imager.make(0));
  std::vector<DataSetImage> held; // while others are made
  ImageStream stream(imager, {});
  while (auto taken = sono::testing::next(stream))
  {
    held.push_back(std::move(taken->image));
  }
  EXPECT_EQ(held.size(), 12u);
  for (const DataSetImage& image : held)
  {
    expectSameOnGpu(image);
  }
}

} // namespace
