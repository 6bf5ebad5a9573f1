// Preprocessing: 512x512x300 with 40 labels, whole and for one fan, all cores; accuracy of the baked surfaces.
#include "Stage.h"
#include "SurfaceAccuracy.h"
#include "SyntheticTorso.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

namespace sono {
namespace {

const Vec3i size(512, 512, 300);
constexpr int labelCount = 40;

/// The first and the second load of a volume through the cache.
void measureCache(const LabelVolume& volume)
{
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "sonovdb_measure_scene_cache";
  std::filesystem::remove_all(folder);
  std::vector<double> seconds;
  for (int load = 0; load < 2; ++load)
  {
    LabelVolume copy = volume;
    Stopwatch watch;
    makeTorsoScene(std::move(copy), folder.string());
    seconds.push_back(watch.lap());
  }
  std::filesystem::remove_all(folder);
  printFigure("scene_first_load_s", seconds[0], "s");
  printFigure("scene_second_load_s", seconds[1], "s");
}

void measureScene()
{
  LabelVolume volume = makeSyntheticTorso(size, labelCount);
  const double before = peakMegabytes();

  // The fan first, so that it finds nothing built.
  {
    Stopwatch watch;
    const auto scene = makeTorsoScene(volume);
    const double constructed = watch.lap();
    const auto region = scene->regionOnDemand(torsoFanBox(*scene));
    region->bakeAll();
    const double seconds = watch.lap();
    const Vec3i n = region->region().box.size();
    printFigure("scene_roi_s", constructed + seconds, "s");
    printFigure("scene_roi_share", double(n.x) * n.y * n.z / double(volume.voxels.size()), "1");
    printFigure("scene_roi_mb", double(region->region().bytes()) / 1e6, "MB");
  }

  Stopwatch watch;
  const auto scene = makeTorsoScene(std::move(volume));
  const double constructed = watch.lap();
  const std::size_t labelBytes = scene->labelGrid().grid.bytes();
  const double labels = watch.lap();
  scene->buildAll();
  const double surfaces = watch.lap();
  std::size_t surfaceBytes = 0;
  for (const LabelInfo& label : scene->volume().labels)
  {
    surfaceBytes += scene->surface(label.id).sdf.bytes();
  }
  watch.lap();
  const auto region = scene->regionOnDemand({ Vec3i(0), size });
  region->bakeAll();
  const double records = watch.lap();

  printFigure("scene_build_s", constructed + labels + surfaces + records, "s");
  printFigure("scene_build_peak_mb", peakMegabytes(), "MB");
  printFigure("scene_input_peak_mb", before, "MB");
  printFigure("scene_construct_s", constructed, "s");
  printFigure("scene_label_grid_s", labels, "s");
  printFigure("scene_surfaces_s", surfaces, "s");
  printFigure("scene_records_s", records, "s");
  printFigure("scene_label_grid_mb", double(labelBytes) / 1e6, "MB");
  printFigure("scene_surface_mb_per_label", double(surfaceBytes) / 1e6 / double(scene->volume().labels.size()), "MB");
  printFigure("scene_records_mb", double(region->region().bytes()) / 1e6, "MB");

  measureCache(scene->volume());

  const SurfaceAccuracy worst = worstSurfaceAccuracy();
  printFigure("surface_offset_voxel", worst.offsetVoxel, "voxel");
  printFigure("normal_error_mean_deg", worst.normalMeanDeg, "deg");
  printFigure("normal_error_p95_deg", worst.normalP95Deg, "deg");
}

const Stage stage("scene", measureScene);

} // namespace
} // namespace sono
