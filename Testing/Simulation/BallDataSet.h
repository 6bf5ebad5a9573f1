#pragma once

#include "Folders.h"
#include "TemporaryFolder.h"

#include "DataSets/DataSetPlan.h"
#include "Labels/ReadLabelMap.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>

namespace sono::testing {

/// A head of skin around a ball of blood, in air, 40 voxels of 2.5 mm, turned against the world.
inline LabelVolume ballInSkin()
{
  LabelVolume volume;
  volume.placement.size = Vec3i(40);
  volume.placement.spacingMm = Vec3d(2.5);
  volume.placement.direction = { { 0.0, 1.0, 0.0 }, { -1.0, 0.0, 0.0 }, { 0.0, 0.0, 1.0 } };
  volume.placement.originMm = volume.placement.direction * Vec3d(-48.75);
  volume.voxels.resize(volume.placement.voxelCount());
  for (std::size_t i = 0; i < volume.voxels.size(); ++i)
  {
    const double r = glm::length(2.5 * (Vec3d(double(i % 40), double(i / 40 % 40), double(i / 1600)) - 19.5));
    volume.voxels[i] = r < 20.0 ? 7 : r < 40.0 ? 9 : 0;
  }
  volume.collectLabels();
  for (LabelInfo& label : volume.labels)
  {
    label.name = label.id == 7 ? "left_ventricle_blood" : label.id == 9 ? "skin" : "background";
  }
  return volume;
}

/// A data set of twelve small images of that ball: two patients, one to train with and one to test with, of three exams
/// of two images each.
class BallDataSet : public ::testing::Test
{
protected:
  using Json = nlohmann::json;

  void SetUp() override
  {
    writeLabelMap((root_ / "ball.nii.gz").string(), ballInSkin());
    json_ = Json::parse(R"({
      "name": "ball", "seed": 5, "exams": 6, "imagesPerExam": 2, "pixelMm": 2, "format": "nnU-Net",
      "patients": [{"id": "ball", "labels": "ball.nii.gz", "licence": "CC0-1.0", "provenance": "a test",
                    "views": [{"name": "top", "pose": {"positionMm": [0, -60, 0], "axial": [0, 1, 0], "lateral": [1, 0, 0]}}]}],
      "probe": {"preset": "phased_p4-2", "lineCount": 12, "depthMm": 70, "sectorDeg": 60},
      "tracing": {"pathsPerLine": 8}, "echo": {"samplingMHz": 10},
      "display": {"gainDb": {"from": -3, "to": 3}},
      "masks": [{"name": "none", "labels": ["liver"]}, {"name": "cavity", "labels": ["ventricle left"]}]})");
    json_["patients"].push_back(json_["patients"][0]);
    json_["patients"][1]["id"] = "other";
    json_["patients"][1]["split"] = "test";
    json_["patients"][0]["split"] = "train";
  }

  /// Of what `json_` is now.
  std::shared_ptr<const DataSetPlan> plan()
  {
    std::ofstream(root_ / "set.json") << json_.dump();
    return std::make_shared<const DataSetPlan>(readDataSet((root_ / "set.json").string(), dataFolder()));
  }

  const TemporaryFolder folder_;
  const std::filesystem::path root_ = folder_.path();
  Json json_;
};

} // namespace sono::testing
