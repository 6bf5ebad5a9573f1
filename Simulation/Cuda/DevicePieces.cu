#include "Cuda/DevicePieces.cuh"

#include "Scene/FitPiece.h"

#include <new>

namespace sono {

namespace {

using namespace stepfit;

__global__ void __launch_bounds__(lanes) fitFaces(const std::uint8_t* tissues, Vec3i size, Vec3f spacingMm,
                                                  const Window* windows, const SurfaceFace* faces, SurfacePiece* pieces)
{
  __shared__ alignas(StepMap) unsigned char memory[sizeof(StepMap)];
  StepMap& map = *new (memory) StepMap(tissues, size, windows); // by each lane, the same
  const SurfacePiece piece = fitPiece(map, spacingMm, faces[blockIdx.x]);
  if (lane() == 0)
  {
    pieces[blockIdx.x] = piece;
  }
}

} // namespace

std::vector<SurfacePiece> DevicePieces::fit(const VoxelJob& voxels, const std::vector<SurfaceFace>& faces,
                                            cudaStream_t stream, Traffic& traffic)
{
  if (windows_.size() == 0)
  {
    const WindowTables& tables = windowTables();
    weight_.upload(tables.weight, stream, traffic);
    strictness_.upload(tables.strictness, stream, traffic);
    windows_.upload(tables.windows(weight_.data(), strictness_.data()), stream, traffic);
  }
  std::vector<SurfacePiece> pieces(faces.size());
  if (faces.empty())
  {
    return pieces;
  }
  if (sceneId_ != voxels.sceneId)
  {
    sceneId_ = 0; // stays so when the upload fails
    voxels_.upload(*voxels.tissues, stream, traffic);
    sceneId_ = voxels.sceneId;
  }
  DeviceArray<SurfaceFace> given;
  DeviceArray<SurfacePiece> made;
  given.upload(faces, stream, traffic);
  made.resize(faces.size());
  fitFaces<<<unsigned(faces.size()), lanes, 0, stream>>>(voxels_.data(), voxels.size, voxels.spacing, windows_.data(),
                                                         given.data(), made.data());
  check(cudaGetLastError(), "fitting surfaces");
  download(made.data(), made.size(), pieces.data(), stream, traffic);
  check(cudaStreamSynchronize(stream), "fitting surfaces");
  return pieces;
}

} // namespace sono
