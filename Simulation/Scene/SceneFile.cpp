#include "Scene/SceneFile.h"

#include "Core/Hash64.h"
#include "Core/KeptResults.h"
#include "Core/ParallelFor.h"
#include "Scene/LabelMask.h"
#include "Scene/NanoConvert.h"
#include "Scene/NanoFile.h"
#include "Scene/NanoGridStorage.h"
#include "Scene/OpenGrids.h"
#include "Scene/SceneText.h"

#include <openvdb/io/File.h>

#include <algorithm>
#include <filesystem>

namespace sono {

namespace {

namespace fs = std::filesystem;

std::vector<NanoGrid> buildMasks(const Scene& scene)
{
  const auto& labels = scene.volume().labels;
  std::vector<NanoGrid> masks(labels.size());
  parallelFor(int(labels.size()), {}, [&](int n) {
    const int id = labels[std::size_t(n)].id;
    masks[std::size_t(n)] = buildLabelMask(scene.volume(), id, scene.surface(id).box);
  });
  return masks;
}

void writeNanoScene(const std::string& path, const Scene& scene, const std::vector<std::uint8_t>& detail)
{
  const std::vector<NanoGrid> masks = buildMasks(scene);
  std::vector<const NanoGrid*> grids{ &scene.labelGrid().grid };
  for (std::size_t n = 0; n < masks.size(); ++n)
  {
    grids.push_back(&masks[n]);
    grids.push_back(&scene.surface(scene.volume().labels[n].id).sdf);
  }
  writeNanoFile(path, grids, sceneText(scene), detail);
}

openvdb::GridBase::Ptr describedGrid(const NanoGrid& grid, const LabelInfo* label)
{
  const auto open = openFromNano(grid);
  if (label)
  {
    open->insertMeta("label_id", openvdb::Int32Metadata(label->id));
    open->insertMeta("label_name", openvdb::StringMetadata(label->name));
    open->insertMeta("tissue", openvdb::StringMetadata(label->tissue));
  }
  return open;
}

void writeOpenScene(const std::string& path, const Scene& scene)
{
  const std::vector<NanoGrid> masks = buildMasks(scene);
  openvdb::GridPtrVec grids{ describedGrid(scene.labelGrid().grid, nullptr) };
  for (std::size_t n = 0; n < masks.size(); ++n)
  {
    const LabelInfo& label = scene.volume().labels[n];
    grids.push_back(describedGrid(masks[n], &label));
    grids.push_back(describedGrid(scene.surface(label.id).sdf, &label));
  }
  openvdb::MetaMap meta;
  meta.insertMeta("sonovdb_scene", openvdb::StringMetadata(sceneText(scene)));
  try
  {
    openvdb::io::File file(path);
    file.write(grids, meta);
    file.close();
  }
  catch (const openvdb::Exception&)
  {
    throw Error("cannot write '" + path + "': the folder is missing or protected, or the disk is full.");
  }
}

[[noreturn]] void refuseGrids(const std::string& path)
{
  throw Error("cannot read '" + path + "': its grids are not those its description names; write the scene again.");
}

/// The fields of a file, each of the type and label that its name says.
struct SceneGrids
{
  LabelGrid labels;
  std::vector<SurfaceField> surfaces;
};

SceneGrids takeGrids(const std::string& path, NanoFile& file, const SceneText& text)
{
  SceneGrids grids;
  const auto take = [&](const std::string& name, nanovdb::GridType type) {
    const auto at = std::find(file.names.begin(), file.names.end(), name);
    NanoGrid* grid = at == file.names.end() ? nullptr : &file.grids[std::size_t(at - file.names.begin())];
    if (!grid || grid->storage->handle.gridType() != type)
    {
      refuseGrids(path);
    }
    return std::move(*grid);
  };
  grids.labels.grid = take("labels", nanovdb::GridType::Int32);
  for (std::size_t n = 0; n < text.labels.size(); ++n)
  {
    SurfaceField field;
    field.labelId = text.labels[n].id;
    field.box = text.boxes[n];
    field.bandMm = text.bandMm;
    field.smoothingMm = text.smoothingMm;
    field.sdf = take("sdf_" + std::to_string(field.labelId), nanovdb::GridType::Fp8);
    grids.surfaces.push_back(std::move(field));
  }
  return grids;
}

std::string endingOf(const std::string& path)
{
  return fs::path(path).extension().string();
}

} // namespace

void writeScene(const std::string& path, const Scene& scene, const Progress& progress)
{
  const std::string ending = endingOf(path);
  if (ending != ".nvdb" && ending != ".vdb")
  {
    throw Error("cannot write '" + path + "': the name of a scene file must end in .nvdb or .vdb.");
  }
  scene.buildAll(partOf(progress, 0.0, 0.7));
  ending == ".nvdb" ? writeNanoScene(path, scene, scene.detail()) : writeOpenScene(path, scene);
  report(progress, 1.0);
}

std::unique_ptr<Scene> readScene(const std::string& path, const Progress& progress)
{
  NanoFile file = readNanoFile(path);
  report(progress, 0.5);
  SceneText text = parseSceneText(path, file.text);
  SceneGrids grids = takeGrids(path, file, text);
  LabelVolume volume;
  volume.placement = text.placement;
  volume.placement.validate(path);
  volume.labels = std::move(text.labels);
  volume.voxels = voxelsOf(grids.labels, volume.placement.size);
  if (!file.bytes.empty() && file.bytes.size() != volume.voxels.size())
  {
    refuseGrids(path);
  }
  auto scene = std::make_unique<Scene>(std::move(volume), text.tissues, text.outsideTissue, std::move(file.bytes));
  scene->adopt(std::move(grids.labels), std::move(grids.surfaces));
  report(progress, 1.0);
  return scene;
}

std::string sceneCacheKey(const LabelVolume& volume)
{
  const GridPlacement& placement = volume.placement;
  const Vec3i n = placement.size;
  std::vector<std::uint64_t> slices(std::size_t(n.z));
  const std::size_t slice = std::size_t(n.x) * n.y;
  parallelFor(n.z, {}, [&](int k) {
    slices[std::size_t(k)] = hash64(volume.voxels.data() + slice * k, slice * sizeof(volume.voxels[0]));
  });
  std::vector<double> numbers{ double(sceneFileFormat), double(n.x), double(n.y), double(n.z) };
  for (int a = 0; a < 3; ++a)
  {
    numbers.insert(numbers.end(), { placement.originMm[a], placement.spacingMm[a], placement.direction[a].x,
                                    placement.direction[a].y, placement.direction[a].z });
  }
  const std::uint64_t ofVoxels = hash64(slices.data(), slices.size() * sizeof(slices[0]));
  return hashDigits(hash64(numbers.data(), numbers.size() * sizeof(numbers[0]), ofVoxels));
}

std::unique_ptr<Scene> makeCachedScene(LabelVolume volume, const TissueTable& table, const std::string& outsideTissue,
                                       const std::string& cacheFolder, const Progress& progress,
                                       std::vector<std::uint8_t> detail, std::shared_ptr<const TissueMotion> motion)
{
  std::error_code error;
  fs::create_directories(cacheFolder, error);
  if (!fs::is_directory(cacheFolder, error))
  {
    throw Error("cannot use '" + cacheFolder + "' as a cache: it is no folder and none can be made; choose another.");
  }
  auto scene = std::make_unique<Scene>(std::move(volume), table, outsideTissue, std::move(detail), std::move(motion));
  const std::string path = (fs::path(cacheFolder) / (sceneCacheKey(scene->volume()) + ".nvdb")).string();
  if (fs::exists(path, error))
  {
    try
    {
      NanoFile file = readNanoFile(path);
      SceneGrids grids = takeGrids(path, file, parseSceneText(path, file.text));
      scene->adopt(std::move(grids.labels), std::move(grids.surfaces));
      markUsed(path);
      report(progress, 1.0);
      return scene;
    }
    catch (const Error&)
    {
      // A damaged file is as good as none: it is written anew below.
    }
  }
  scene->buildAll(partOf(progress, 0.0, 0.7));
  writeNanoScene(path, *scene, {});
  trimCacheFolder(cacheFolder);
  report(progress, 1.0);
  return scene;
}

} // namespace sono
