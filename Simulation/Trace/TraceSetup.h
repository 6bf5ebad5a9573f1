#pragma once

#include "Kernel/CellSpace.h"
#include "Kernel/TraceView.h"
#include "Trace/PathBatches.h"
#include "Trace/Trace.h"

#include <memory>
#include <vector>

namespace sono {

template<class Targets>
struct NanoSpace;

/// Which of the region's records are baked beforehand.
enum class Records
{
  All,     ///< that paths may meet, for whoever takes the region elsewhere
  OnDemand ///< none: space() bakes those that paths meet
};

/// What the lines' fan, from wherever its paths start, can reach of the scene, in voxels.
VoxelBox fanBox(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings);

/// Balls that together hold all that its paths can reach, one for the lines that start near to one another, so much
/// larger than need be.
std::vector<LocalBall> fanReach(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                                double besideMm = 0.0);

/// Everything that tracing needs, made once from the scene and the settings and held while paths run.
struct TraceSetup
{
  TraceSetup(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
             const std::vector<TargetSurface>& targets, const Progress& progress, Records records = Records::All);

  /// For settings that differ from the constructor's in their frequency alone, or in what of it is wanted, of the same
  /// scene and targets: where paths may go stays.
  void tune(const Scene& scene, const TraceSettings& settings, const std::vector<TargetSurface>& targets);

  CellSpace<EmbreeTargets, CellsOnDemand> space() const
  {
    return { cells->view(), { targets.get(), !targets->empty() } };
  }
  NanoSpace<EmbreeTargets> nanoSpace() const;
  Vec3d worldFromRegion(const Vec3f& p) const { return toWorld * Vec3d(p) + cornerWorldMm; }

  std::shared_ptr<const RegionOnDemand> cells;
  std::shared_ptr<const TraceRegion> region; ///< of the cells
  std::unique_ptr<TargetScene> targets;
  const LabelGrid* labels = nullptr; ///< for the NanoVDB march only
  const std::uint8_t* tissueOfLabel = nullptr;
  std::vector<TraceMedium> media;
  TraceView view;
  std::vector<TraceLine> lines;
  Mat3d toWorld;
  Vec3d cornerWorldMm;
  int paths;
  std::uint64_t seed;
  double frequencyMHz;
};

} // namespace sono
