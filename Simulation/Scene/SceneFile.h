#pragma once

#include "Scene/Scene.h"

#include <memory>
#include <string>

namespace sono {

/// Version of what a scene file holds; a reader refuses newer ones.
constexpr int sceneFileFormat = 3;

/// The oldest that is read: 2 has no scan's detail.
constexpr int oldestSceneFileFormat = 2;

/// Writes a scene, building first what it has not built yet. By the name's ending:
/// `.nvdb` NanoVDB: the grid "labels" (Int32, the label ids) and, for each label, "voxels_<id>" (mask, its voxels) and
/// "sdf_<id>" (Fp8, mm, negative inside). Beside them, as blind data of "labels" (NanoFile.h), a JSON text with the
/// format version, the placement in double precision, labels with names, colours and tissues, and the tissue table;
/// behind it the codes of a scan's detail, a byte a voxel, where there is one.
/// `.vdb` OpenVDB, for other programs: the same grids (sdf as floats) with label names and tissues as metadata of the
/// grids, and the JSON text as the file's metadata "sonovdb_scene". SonoVDB does not read it back.
/// Throws Error naming the file for another ending or when it cannot be written.
void writeScene(const std::string& path, const Scene& scene, const Progress& progress = {});

/// Reads a scene from `.nvdb`, with everything built but the tracer's cache. Throws Error naming the file when it is
/// missing, foreign, truncated, damaged, or of another format.
std::unique_ptr<Scene> readScene(const std::string& path, const Progress& progress = {});

/// A scene whose label grid and surfaces come from the folder `cacheFolder` if it holds those of the same voxels and
/// placement, and are else built and stored there as `<key>.nvdb`, a scene file. Names, tissues and colours are the
/// caller's, and so are a scan's detail and a motion: they are no part of the key, so editing the tissue table rebuilds
/// nothing. Files of the folder may be deleted at any time; a damaged one is rebuilt; of the whole folder what was not
/// used for longest goes when it is full (Core/KeptResults.h). Throws Error when the folder cannot be made or written
/// to.
std::unique_ptr<Scene> makeCachedScene(LabelVolume volume, const TissueTable& table, const std::string& outsideTissue,
                                       const std::string& cacheFolder, const Progress& progress = {},
                                       std::vector<std::uint8_t> detail = {},
                                       std::shared_ptr<const TissueMotion> motion = nullptr);

/// The key of a volume in the cache: 16 hexadecimal digits of its voxels, placement and the format's version.
std::string sceneCacheKey(const LabelVolume& volume);

} // namespace sono
