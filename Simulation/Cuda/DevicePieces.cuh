#pragma once

#include "Cuda/DeviceMemory.cuh"
#include "Cuda/ImageJob.h"
#include "Kernel/SurfacePiece.h"
#include "Scene/StepWindows.h"

#include <vector>

namespace sono {

/// Fits smooth pieces to faces (SurfacePieces), a warp a face. Kept: the windows' weights, and the last voxels.
class DevicePieces
{
public:
  /// Waits for the result.
  std::vector<SurfacePiece> fit(const VoxelJob& voxels, const std::vector<SurfaceFace>& faces, cudaStream_t stream,
                                Traffic& traffic);

private:
  DeviceArray<float> weight_, strictness_;
  DeviceArray<stepfit::Window> windows_;
  std::uint64_t sceneId_ = 0;
  DeviceArray<std::uint8_t> voxels_;
};

} // namespace sono
