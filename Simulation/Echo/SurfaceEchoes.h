#pragma once

#include "Core/ParallelFor.h"
#include "Echo/BeamModel.h"
#include "Echo/BrickWalk.h"
#include "Echo/FieldSight.h"
#include "Echo/RodRing.h"
#include "Echo/SurfaceRows.h"
#include "Echo/TargetPieces.h"
#include "Scene/Scene.h"
#include "Trace/Trace.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace sono {

/// How finely surfaces are cut.
enum class SurfaceDetail
{
  Full,
  Coarse ///< into pieces of several voxels and few points (Policy.h): on the CPU alone
};

/// Targets whose echoes are followed by the same: those that do not ring, or one that does.
struct TargetGroup
{
  TargetPieces pieces;
  RodRing ring;
  std::unique_ptr<FieldSight> sight; ///< null where the beam is no field's
};

/// Echoes of the boundaries between labels and of targets (Data/docs/physics.md section 10), weighted by the beam as
/// scatterers are. Boundaries become pieces once a scene (SurfacePieces), pieces become points of the size that the
/// wavelength wants while beams look at them. Echoes do not depend on which paths met what: the tracer's part is the
/// intensity in front of each piece.
class SurfaceEchoes
{
public:
  /// `targets` may be null. The scene must outlive this.
  SurfaceEchoes(const Scene& scene, const std::vector<TargetSurface>* targets, const EchoSettings& settings,
                const BeamModel& beams, SurfaceDetail detail = SurfaceDetail::Full);

  /// What a group of lines is added in; nothing is left in it.
  struct Room;
  static std::shared_ptr<Room> makeRoom();

  /// Adds to the sums of a group of lines, intensity included. `beams` are those of the scene, `intensities` and `sums`
  /// parallel to them. `brickDone` is called in each brick, and may throw Aborted.
  void add(std::vector<BeamReach> beams, const std::vector<SurfaceIntensity>& intensities, const YieldPoint& brickDone,
           Room& room, std::vector<LineSum>& sums) const;

  // What a device needs to do the same.
  const SurfacePieces& pieces() const { return pieces_; }
  const SurfaceRows& rows() const { return *rows_; }
  const std::vector<TargetGroup>& targets() const { return targets_; }
  const FieldSight* pieceSight() const { return pieceSight_.get(); } ///< null where the beam is no field's
  const PieceNets& nets() const { return nets_; }
  BrickGrid pieceGrid() const;
  float longestStepMm() const; ///< between pieces
  /// Beams of the scene as the pieces' bricks meet them.
  std::vector<BeamReach> seeingPieces(std::vector<BeamReach> beams) const;
  /// The same of the bricks of some targets.
  static std::vector<BeamReach> seeingTargets(std::vector<BeamReach> beams, const TargetGroup& targets);
  SurfaceTable pieceTable() const;
  SurfaceTable targetTable() const { return rows_->view(0.0); }

private:
  struct Group;
  struct MetBrick;

  /// Faces of the bricks that have been met become pieces where one of the lines may hear them.
  void findPieces(const Group& group, Room& room) const;
  /// Adds what these bricks echo.
  void addMet(Group& group, Room& room) const;
  void addTargets(const TargetGroup& targets, std::vector<BeamReach> beams, const YieldPoint& brickDone, Group& group,
                  Room& room) const;
  /// Pieces that one of the lines hears become points.
  void expand(Room& room) const;

  const SurfacePieces& pieces_;
  bool isCoarse_;
  std::uint64_t seed_;
  double blobMm_;
  std::shared_ptr<const SurfaceRows> rows_;
  std::vector<TargetGroup> targets_;
  std::unique_ptr<FieldSight> pieceSight_;
  PieceNets nets_{};
};

} // namespace sono
