#pragma once

#include "Core/Progress.h"
#include "Labels/LabelVolume.h"
#include "Labels/TissueTable.h"
#include "Scene/FibreField.h"
#include "Scene/RegionOnDemand.h"
#include "Scene/SurfaceField.h"
#include "Scene/SurfacePieces.h"
#include "Scene/TissueMotion.h"
#include "Scene/VoxelBox.h"

#include <array>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace sono {

/// The anatomy as the simulator sees it: the label map's voxels, the tissues of its labels, and, built on first need
/// and kept, the label grid and one narrow-band signed distance field per label (to show, to write, to check against),
/// and the region of dense cells that the tracer reads (TraceRegion).
/// Immutable to its users; the lazy parts are guarded, so several filters may share one Scene, and an observer of their
/// progress may use it, too.
///
/// "Local" coordinates are millimetres along the grid's own axes with 0 at the outer corner of voxel (0,0,0):
/// voxel (i,j,k) fills [i, i+1) x spacing.
class Scene
{
public:
  /// Every label needs a tissue of `table` (see assignTissues); `outsideTissue` names the tissue that counts as
  /// acoustic coupling between the transducer and the body (usually "air"). `detail` holds the codes of scanDetail, one
  /// a voxel; empty: none. The scatterers of the labels that `motion` moves ride on it; null: everything stands still.
  /// Throws Error for an empty volume, a label without tissue, more than 255 different tissues in use, or a detail of
  /// another size.
  Scene(LabelVolume volume, const TissueTable& table, std::string outsideTissue, std::vector<std::uint8_t> detail = {},
        std::shared_ptr<const TissueMotion> motion = nullptr);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// Of this scene alone, in this process.
  std::uint64_t id() const { return id_; }
  /// The same of its voxels and fibres, whatever the numbers of its tissues.
  std::uint64_t anatomyId() const { return anatomyId_; }
  const LabelVolume& volume() const { return volume_; }
  const GridPlacement& placement() const { return volume_.placement; }
  /// The tissues in use, in the order of the 8-bit tissue indices.
  const std::vector<Tissue>& tissues() const { return tissues_; }
  int outsideIndex() const { return outsideIndex_; }
  /// Tissue index of each label id (65536 entries; 0 where the id does not occur).
  const std::vector<std::uint8_t>& tissueOfLabel() const { return tissueOfLabel_; }
  /// One tissue index a voxel, i fastest.
  const std::vector<std::uint8_t>& tissueVoxels() const { return tissueVoxels_; }
  /// The backscatter's level within each tissue, as a scan has it (see scanDetail), one code a voxel; empty: none.
  const std::vector<std::uint8_t>& detail() const { return detail_; }
  /// The same for the scatterers that stand still: silent in what moves.
  const std::vector<std::uint8_t>& stillDetail() const { return motion_ ? stillDetail_ : detail_; }
  /// Of the amplitudes of what stands still at a voxel, by its number in tissueVoxels(); 1 where there is no detail.
  float detailAt(std::size_t voxel) const { return stillCodes_ ? detailFactors_[stillCodes_[voxel]] : 1.0f; }
  /// Null: everything stands still.
  const std::shared_ptr<const TissueMotion>& motion() const { return motion_; }

  Vec3d localFromWorld(const Vec3d& world) const;
  Vec3d worldFromLocal(const Vec3d& local) const;
  Mat3d rotationToLocal() const; ///< world vectors to local ones

  /// The label grid and one label's signed distance (mm, negative inside) as NanoVDB grids, built on first need.
  const LabelGrid& labelGrid(const Progress& progress = {}) const;
  const SurfaceField& surface(int labelId, const Progress& progress = {}) const;
  /// Builds what is missing of the label grid and all surfaces, several labels at a time.
  void buildAll(const Progress& progress = {}) const;
  /// Takes over what was built earlier from the same voxels (a scene file, a cache); a surface of a label that does not
  /// occur is dropped.
  void adopt(LabelGrid labels, std::vector<SurfaceField> surfaces);

  /// The same anatomy with other numbers of its tissues; what was built of its voxels stays. The scene has another id()
  /// then. Nobody else may use it meanwhile. Throws Error where the table lacks one of its tissues.
  void setTissues(const TissueTable& table);

  /// The fibres of the tissues that have a fibreAnisotropyDb, built on first need; null where none has. Blood is the
  /// tissue of that name.
  const FibreField* fibres() const;
  /// The boundaries as smooth pieces, made where they are asked for and kept.
  const SurfacePieces& surfacePieces() const;

  /// From now on whoever wants a box within this one gets the tracer's cache of this one, so that poses share it. What
  /// `known`, a region of another scene with the same voxels, has baked by then is copied while that exists. Nobody
  /// else may use the scene meanwhile. Throws Error where the box is beside the volume.
  void shareRegion(const VoxelBox& box, std::weak_ptr<const RegionOnDemand> known = {});
  /// Whether a box lies within that one.
  bool sharesRegion(const VoxelBox& box) const;

  /// The tracer's cache for the box (clipped to the volume), kept until another box is asked for.
  std::shared_ptr<const RegionOnDemand> regionOnDemand(const VoxelBox& box, const Progress& progress = {}) const;

  /// For interactive use, while a probe is moved: the cache of a box around this one whose faces lie at multiples of
  /// 512 voxels or at the volume's end. A volume up to that size is one box, so that all poses share it; of a longer
  /// one it takes what is near. Kept beside the other.
  std::shared_ptr<const RegionOnDemand> interactiveRegion(const VoxelBox& box, const Progress& progress = {}) const;
  /// Begins to build that in the background, where it is not there yet; with all of its records if wanted, else with
  /// those that the last `regionOnDemand` has baked and those beside them, until somebody asks for it. The build of
  /// another one that nobody waits for is cancelled.
  void beginInteractiveRegion(const VoxelBox& box, bool allRecords) const;
  /// Whether there is such a cache, or one in the making.
  bool hasInteractiveRegion() const;

private:
  using SharedRegion = std::shared_ptr<const RegionOnDemand>;

  VoxelBox clipped(const VoxelBox& box) const;
  struct Making;
  std::shared_ptr<const Making> makingInteractive(const VoxelBox& box, bool allRecords) const;
  struct Foreseeing;
  void foresee(std::shared_ptr<const Making> making) const;
  SharedRegion finishedInteractive() const; ///< null where it is still being made
  template<class Find, class Make, class Keep>
  auto findOrMake(const void* thing, const Find& find, const Make& make, const Keep& keep) const;
  const std::vector<VoxelBox>& boxes() const;
  const SurfaceField& surfaceAt(std::size_t label, const Progress& progress) const;

  std::uint64_t id_;
  std::uint64_t anatomyId_;
  LabelVolume volume_;
  std::vector<Tissue> tissues_;
  std::vector<std::uint8_t> tissueOfLabel_;
  std::vector<std::uint8_t> tissueVoxels_;
  std::vector<std::uint8_t> detail_;
  std::array<float, 256> detailFactors_;
  std::shared_ptr<const TissueMotion> motion_;
  std::vector<std::uint8_t> stillDetail_; // only of a scene with motion
  const std::uint8_t* stillCodes_ = nullptr;
  int outsideIndex_ = -1;
  VoxelBox sharedBox_{}; // empty: none
  std::weak_ptr<const RegionOnDemand> known_;

  mutable std::mutex mutex_; // for what follows; not held while any of it is made
  mutable std::condition_variable made_;
  mutable std::set<const void*> making_; // which of these somebody makes
  mutable std::unique_ptr<LabelGrid> labelGrid_;
  mutable std::unique_ptr<std::vector<VoxelBox>> boxes_;        // parallel to volume_.labels
  mutable std::vector<std::unique_ptr<SurfaceField>> surfaces_; // parallel to volume_.labels
  mutable std::unique_ptr<FibreField> fibres_;
  mutable std::unique_ptr<SurfacePieces> pieces_;
  mutable SharedRegion region_;
  mutable std::shared_ptr<const Making> interactive_; // their ends are waited for and need the rest
  mutable std::unique_ptr<Foreseeing> foreseeing_;
};

} // namespace sono
