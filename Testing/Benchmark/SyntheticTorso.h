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

/// What paths from a phased sector of 90 degrees and 160 mm depth can reach from the front of the torso's chest, whose
/// axis is y and whose plane is x, y: the half balls in front of its lines, which are turned by up to 45 degrees.
VoxelBox torsoFanBox(const Scene& scene);

} // namespace sono
