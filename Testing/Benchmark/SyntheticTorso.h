#pragma once

#include "Labels/LabelVolume.h"
#include "Scene/Scene.h"

#include <memory>
#include <string>

namespace sono {

/// A torso of 400 x 400 x 300 mm made of shells (skin, fat, muscle, lungs, heart wall), tubes (ribs, vessels, spine)
/// and blobs (organs, lesions) in `size` voxels with the labels 1 to `labelCount` (10 to 200) and 0 outside, for
/// timing only. The first ten labels are always the same; the others are ribs, vessels and blobs in turn.
LabelVolume makeSyntheticTorso(const Vec3i& size, int labelCount);

/// The torso as a scene: all tissues of the repository's table in turn, 0 being air. With a folder, through the cache.
std::unique_ptr<Scene> makeTorsoScene(LabelVolume volume, const std::string& cacheFolder = {});

} // namespace sono
