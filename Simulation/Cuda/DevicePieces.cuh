#pragma once

#include "Cuda/DeviceMemory.cuh"
#include "Cuda/ImageJob.h"
#include "Cuda/SplatChunk.cuh"
#include "Kernel/BeamRun.h"
#include "Kernel/SurfaceEcho.h"
#include "Kernel/SurfacePiece.h"
#include "Scene/StepWindows.h"
#include "Scene/SurfaceFace.h"

#include <memory>
#include <mutex>
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

/// Pieces brick by brick, and their groups. Stays as it is.
struct PieceList
{
  DeviceArray<SurfacePiece> pieces;
  DeviceArray<SurfaceGroup> groups;
};

/// The smooth pieces of a scene's boundaries (SurfacePieces) that some beam may have heard so far, each fitted by a
/// warp. The others, most of them seen too slantingly, are left until one may. All imagers of a device share those of a
/// scene: several threads may ask, one after the other.
class DevicePieces
{
public:
  /// Those of the scene's on the thread's device, which live as long as somebody holds them.
  static std::shared_ptr<DevicePieces> of(const SurfacePieces& pieces);
  ~DevicePieces();
  DevicePieces(const DevicePieces&) = delete;
  DevicePieces& operator=(const DevicePieces&) = delete;

  /// All so far, after those that these beams may hear of the job's blocks have been added. `voxels` are its tissues on
  /// the device. Waits for the event, after which they and the beams are there, and for the pieces, but for nothing
  /// else that the caller's stream was asked for.
  std::shared_ptr<const PieceList> heardBy(const SurfaceJob& job, const std::uint8_t* voxels,
                                           const PieceHearers& hearers, cudaEvent_t uploaded, Traffic& traffic);

private:
  explicit DevicePieces(int device);
  void takeFaces(const SurfaceJob& job, const std::uint8_t* voxels, Traffic& traffic);
  int markHeard(const SurfaceJob& job, const PieceHearers& hearers, Traffic& traffic);
  void fit(const SurfaceJob& job, const std::uint8_t* voxels, int count, Traffic& traffic);
  std::shared_ptr<const PieceList> inGroups(const SurfaceJob& job, const DeviceArray<SurfacePiece>& pieces,
                                            const DeviceArray<int>& brickOf, Traffic& traffic);
  template<class IsWanted>
  int select(int count, const IsWanted& isWanted, DeviceArray<int>& to, Traffic& traffic);
  int bring(const int* count, Traffic& traffic);

  int device_;
  DeviceLane* lane_;
  std::mutex mutex_;
  bool isWhole_ = false;            ///< false: what follows is to be forgotten
  std::vector<bool> blocks_;        ///< whose faces are here
  DeviceArray<SurfaceFace> faces_;  ///< of those
  DeviceArray<int> brickOfFace_;    ///< its number
  DeviceArray<std::uint8_t> state_; ///< of each face, see FaceState
  std::shared_ptr<const PieceList> list_;
  DeviceArray<int> brickOfPiece_; ///< of the list's, ascending
  // For a while.
  DeviceArray<int> selected_, count_;
  DeviceArray<BeamRun> runs_;
  DeviceArray<std::uint8_t> scratch_;
};

} // namespace sono
