#pragma once

#include "Cuda/DeviceMemory.cuh"
#include "Cuda/ImageJob.h"
#include "Cuda/SplatChunk.cuh"
#include "Kernel/SurfaceEcho.h"
#include "Kernel/SurfacePiece.h"
#include "Scene/StepWindows.h"
#include "Scene/SurfaceFace.h"

#include <vector>

namespace sono {

/// Neighbouring pieces of surfaces, as many as a warp has lanes at most, and a ball that holds them. They lie in a
/// brick.
struct SurfaceGroup
{
  Vec3f brickMm; ///< its centre
  Vec3f centreMm;
  float radiusMm;
  int first;
  int count;
};

/// Beams of a kind that may hear pieces, and what of.
struct PieceHearers
{
  SplatLaunch splat;
  int lines;
  BeamKind kind;
  SurfaceTable table;
  int media;
};

/// The smooth pieces of a scene's boundaries (SurfacePieces) that some beam may have heard so far, each fitted by a
/// warp. The others, most of them seen too slantingly, are left until one may.
class DevicePieces
{
public:
  /// Adds those that these beams may hear of the job's blocks. `voxels` are its tissues on the device. Waits.
  void prepare(const SurfaceJob& job, const std::uint8_t* voxels, const PieceHearers& hearers, cudaStream_t stream,
               Traffic& traffic);

  const SurfacePiece* pieces() const { return pieces_.data(); }
  const SurfaceGroup* groups() const { return groups_.data(); }
  int groupCount() const { return int(groups_.size()); }

private:
  void takeFaces(const SurfaceJob& job, const std::uint8_t* voxels, cudaStream_t stream, Traffic& traffic);
  int markHeard(const SurfaceJob& job, const PieceHearers& hearers, cudaStream_t stream, Traffic& traffic);
  void fit(const SurfaceJob& job, const std::uint8_t* voxels, int count, cudaStream_t stream, Traffic& traffic);
  void group(const SurfaceJob& job, cudaStream_t stream, Traffic& traffic);
  template<class IsWanted>
  int select(int count, const IsWanted& isWanted, DeviceArray<int>& to, cudaStream_t stream, Traffic& traffic);
  int bring(const int* count, cudaStream_t stream, Traffic& traffic);

  DeviceArray<float> weight_, strictness_;
  DeviceArray<stepfit::Window> windows_;
  std::uint64_t id_ = 0;             ///< of the scene's pieces
  std::vector<bool> blocks_;         ///< whose faces are here
  DeviceArray<SurfaceFace> faces_;   ///< of those
  DeviceArray<int> brickOfFace_;     ///< its number
  DeviceArray<std::uint8_t> state_;  ///< of each face, see FaceState
  DeviceArray<SurfacePiece> pieces_; ///< brick by brick
  DeviceArray<int> brickOfPiece_;    ///< ascending
  DeviceArray<SurfaceGroup> groups_;
  // For a while.
  DeviceArray<int> list_, count_;
  DeviceArray<std::uint8_t> scratch_;
};

} // namespace sono
