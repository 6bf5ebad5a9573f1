#pragma once

#include "Cuda/DeviceMemory.cuh"
#include "Cuda/ImageJob.h"

namespace sono {

/// The labels of an image's pixels on the device. Kept between jobs: a scene's label map.
class DeviceLabels
{
public:
  /// The labels of the rows' pixels, `width` a row, where the mask of an image is not 0. The mask repeats for each
  /// image, `rowsPerImage` rows high. `offsetMm` are the job's depth offsets where they lie on the device.
  DeviceArray<std::uint16_t> slice(const LabelJob& job, int width, int rowsPerImage, const std::uint8_t* mask,
                                   const float* offsetMm, cudaStream_t stream, Traffic& traffic);

private:
  std::uint64_t sceneId_ = 0;
  DeviceArray<std::uint16_t> voxels_;
  DeviceArray<LabelRow> rows_;
  DeviceArray<float> offsetMm_;
};

} // namespace sono
