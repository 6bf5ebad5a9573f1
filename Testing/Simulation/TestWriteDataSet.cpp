// What a data set's folder holds, and what becomes of it when its writing was cut off.
#include "BallDataSet.h"
#include "ErrorText.h"
#include "Folders.h"

#include "DataSets/ImageWorkers.h"
#include "DataSets/WriteDataSet.h"
#include "Trace/ProbeContact.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <numeric>
#include <set>

using namespace sono;
using sono::testing::ballInSkin;
using sono::testing::errorOf;
using sono::testing::expectContains;
namespace fs = std::filesystem;

namespace {

using Json = nlohmann::json;
using Content = std::map<std::string, std::string>;

/// Not OpenEXR, but all that would be in it.
std::string plainBytes(const ChannelImage& image)
{
  std::string bytes = std::to_string(image.width) + " " + std::to_string(image.height);
  for (std::size_t i = 0; i < image.names.size(); ++i)
  {
    bytes += " " + image.names[i] + " ";
    bytes.append(reinterpret_cast<const char*>(image.values[i].data()), sizeof(float) * image.values[i].size());
  }
  return bytes;
}

const std::vector<float>& channel(const ChannelImage& image, const std::string& name)
{
  const auto at = std::find(image.names.begin(), image.names.end(), name);
  if (at == image.names.end())
  {
    throw Error("no channel " + name);
  }
  return image.values[std::size_t(at - image.names.begin())];
}

class DataSetFolder : public sono::testing::BallDataSet
{
protected:
  DataSetTally write(const std::string& folder, const DataSetShare& share = {}, const Progress& progress = {})
  {
    DataSetImager imager(plan(), Device::Cpu);
    return writeDataSet(imager, (root_ / folder).string(), share, progress, {}, 0, plainBytes);
  }
  Content content(const std::string& folder)
  {
    Content files;
    for (const auto& entry : fs::recursive_directory_iterator(root_ / folder))
    {
      if (entry.is_regular_file())
      {
        std::ifstream stream(entry.path(), std::ios::binary);
        files[fs::relative(entry.path(), root_ / folder).string()].assign(std::istreambuf_iterator<char>(stream), {});
      }
    }
    return files;
  }
};

} // namespace

TEST_F(DataSetFolder, IsWhatNnUNetTakes)
{
  const DataSetTally tally = write("out");
  EXPECT_EQ(tally.made, 12);
  EXPECT_EQ(tally.total, 12);
  const Content files = content("out");
  EXPECT_EQ(files.size(), 12u * 3u + 3u);
  const Json list = Json::parse(files.at("dataset.json"));
  EXPECT_EQ(list["labels"], Json::parse(R"({"background": 0, "none": 1, "cavity": 2})"));
  EXPECT_EQ(list["numTraining"], 6);
  EXPECT_EQ(list["file_ending"], ".png");
  const Json splits = Json::parse(files.at("splits_final.json"));
  ASSERT_EQ(splits[0]["train"].size(), 6u);
  for (const std::string name : splits[0]["train"])
  {
    EXPECT_EQ(files.count("imagesTr/" + name + "_0000.png"), 1u);
    EXPECT_EQ(files.count("labelsTr/" + name + ".png"), 1u);
  }
  EXPECT_EQ(files.count("imagesTs/ball_0000011_0000.png"), 1u);
  EXPECT_EQ(files.count("labelsTs/ball_0000011.png"), 1u);
  EXPECT_EQ(files.at("dataset_source.json"), json_.dump());
}

TEST_F(DataSetFolder, IsWhatMonaiTakes)
{
  json_["format"] = "MONAI";
  write("out");
  const Content files = content("out");
  const Json list = Json::parse(files.at("dataset.json"));
  EXPECT_EQ(list["training"].size(), 6u);
  EXPECT_EQ(list["validation"].size(), 0u);
  EXPECT_EQ(list["test"].size(), 6u);
  for (const char* split : { "training", "test" })
  {
    for (const Json& entry : list[split])
    {
      for (const char* part : { "image", "label", "info" })
      {
        EXPECT_EQ(files.count(entry[part]), 1u) << entry;
      }
    }
  }
  EXPECT_EQ(list["labels"]["2"], "cavity");
  EXPECT_EQ(list["licence"], Json::array({ "CC0-1.0" }));
}

/// The cavity is a ball of 20 mm in the middle of the fan, whose face is put onto the skin at 40 mm: the area that the
/// mask has of it is that of a circle, and the fan's depth and width leave the head's box where the geometry says.
TEST_F(DataSetFolder, SaysWhereTheProbeIsAndWhatItSees)
{
  const auto set = plan();
  DataSetImager imager(set, Device::Cpu);
  const DataSetImage image = imager.make(3);
  const Json info = Json::parse(image.info);
  EXPECT_NEAR(info["pose"]["positionMm"][1], -40.0, 2.5); // a voxel
  EXPECT_EQ(info["masks"]["none"]["inPatient"], false);
  EXPECT_EQ(info["masks"]["none"]["pixels"], 0);
  const double areaMm2 = 4.0 * double(info["masks"]["cavity"]["pixels"]);
  EXPECT_NEAR(areaMm2, 400.0 * M_PI, 0.12 * 400.0 * M_PI); // voxels of 2.5 mm, pixels of 2 mm, refraction none: 4 % rms
  EXPECT_EQ(info["display"]["gainDb"].get<double>(), set->settings(set->image(3)).display.gainDb);
  EXPECT_GT(info["masks"]["cavity"]["visiblePercent"], 99.0); // there is nothing but skin in front
  EXPECT_TRUE(info["masks"]["none"]["visiblePercent"].is_null());
  expectContains(info["noLandmarks"], "The label map has no left atrium, no right ventricle");
  EXPECT_FALSE(info.contains("landmarks"));
  EXPECT_EQ(info["flags"]["faceOnSkin"], true);
  EXPECT_DOUBLE_EQ(info["flags"]["shareInsideVolume"].get<double>(), 1.0);
  EXPECT_EQ(std::size_t(std::count(image.mask.begin(), image.mask.end(), 2)),
            info["masks"]["cavity"]["pixels"].get<std::size_t>());
}

/// Stretched by a half along each axis, a sphere has 2.25 times the area, at 1.5 times the distance.
TEST_F(DataSetFolder, StretchesThePatientAndThePoseAlike)
{
  json_["patients"][0]["stretch"] = 1.5;
  json_["probe"].update({ { "depthMm", 100 }, { "sectorDeg", 80 } }); // so that all of it is in the fan
  const DataSetImage image = DataSetImager(plan(), Device::Cpu).make(0);
  const Json info = Json::parse(image.info);
  EXPECT_NEAR(info["pose"]["positionMm"][1], -60.0, 3.75);
  EXPECT_NEAR(4.0 * double(info["masks"]["cavity"]["pixels"]), 900.0 * M_PI, 0.12 * 900.0 * M_PI);
}

TEST_F(DataSetFolder, GoesOnWhereItWasCutOff)
{
  write("whole");
  const Content whole = content("whole");
  int heard = 0;
  EXPECT_THROW(write("cut", {}, [&](double) { return ++heard < 40; }), Aborted);
  // Cut off between an image's files, and while one was written, by this process and by another.
  for (const char* name : { "imagesTr/ball_0000002_0000.png", "labelsTr/ball_0000002.png" })
  {
    fs::copy_file(root_ / "whole" / name, root_ / "cut" / name, fs::copy_options::overwrite_existing);
  }
  std::ofstream(root_ / "cut/imagesTr/ball_0000003_0000.png.123.part") << "half";
  std::ofstream(root_ / "cut/info/ball_0000011.json.99.part") << "half";
  std::ofstream(root_ / "cut/info/another.part") << "not ours";
  const DataSetTally first = write("cut", { 0, 2 });
  EXPECT_EQ(first.total, 6);
  EXPECT_FALSE(fs::exists(root_ / "cut/imagesTr/ball_0000003_0000.png.123.part"));
  EXPECT_TRUE(fs::exists(root_ / "cut/info/ball_0000011.json.99.part")); // of a process that may be at work
  EXPECT_EQ(write("cut", { 1, 2 }).total, 6);
  EXPECT_TRUE(fs::remove(root_ / "cut/info/another.part"));
  EXPECT_EQ(content("cut"), whole);
  EXPECT_EQ(write("cut").made, 0);
}

/// A body is prepared by one worker, as long as there are bodies for all; each of the last ones is shared alike.
TEST_F(DataSetFolder, WorkersShareBodies)
{
  const auto unitsOf = [&](const PlannedRange& images, int workers) {
    std::vector<std::pair<std::int64_t, std::int64_t>> units;
    for (const PlannedRange& unit : workUnits(*plan(), images, workers))
    {
      units.emplace_back(unit.first, unit.end);
    }
    return units;
  };
  using Units = std::vector<std::pair<std::int64_t, std::int64_t>>;
  EXPECT_EQ(unitsOf({ 0, 12 }, 1), (Units{ { 0, 6 }, { 6, 12 } }));
  EXPECT_EQ(unitsOf({ 0, 12 }, 3), (Units{ { 0, 6 }, { 6, 12 } }));
  EXPECT_EQ(unitsOf({ 0, 12 }, 4), (Units{ { 0, 2 }, { 2, 6 }, { 6, 8 }, { 8, 12 } }));
  EXPECT_EQ(unitsOf({ 4, 12 }, 8), (Units{ { 4, 6 }, { 6, 8 }, { 8, 10 }, { 10, 12 } }));
  json_["patients"].push_back(json_["patients"][0]);
  json_["patients"][2]["id"] = "third";
  json_["exams"] = 9;
  EXPECT_EQ(unitsOf({ 0, 18 }, 2), (Units{ { 0, 2 }, { 6, 12 }, { 12, 18 }, { 2, 6 } }));
}

TEST_F(DataSetFolder, WorkersComeToTheirNextBodiesInTurnAndEndTogether)
{
  for (int body = 2; body < 11; ++body)
  {
    json_["patients"].push_back(json_["patients"][0]);
    json_["patients"][std::size_t(body)]["id"] = std::to_string(body);
  }
  json_["exams"] = 44;                  // four of each body, two images each
  std::vector<std::int64_t> free(4, 0); // when a worker is
  std::multiset<std::int64_t> begun;
  std::vector<int> made(88, 0);
  for (const PlannedRange& unit : workUnits(*plan(), { 0, 88 }, 4))
  {
    auto& next = *std::min_element(free.begin(), free.end());
    begun.insert(next);
    next += unit.end - unit.first;
    std::for_each(made.begin() + unit.first, made.begin() + unit.end, [](int& count) { ++count; });
  }
  EXPECT_EQ(made, std::vector<int>(88, 1));
  EXPECT_EQ(free, std::vector<std::int64_t>(4, 22));
  for (const std::int64_t when : begun)
  {
    EXPECT_EQ(begun.count(when), when == 0 ? 4u : 1u) << when;
  }
}

/// Threads share the images: the folder is the same, an error is that of its image, and a stop leaves no half image.
TEST_F(DataSetFolder, IsTheSameByManyWorkers)
{
  write("one");
  const auto byThree = [&](const std::string& folder, const Progress& progress) {
    DataSetImager imager(plan(), Device::Cpu);
    std::int64_t heard = 0;
    const auto tell = [&](const DataSetTally& tally) { heard = tally.done; };
    const DataSetTally tally = writeDataSet(imager, (root_ / folder).string(), {}, progress, tell, 3);
    EXPECT_EQ(heard, tally.total);
    return tally;
  };
  EXPECT_EQ(byThree("three", {}).made, 12);
  EXPECT_EQ(content("three"), content("one"));
  for (const int workers : { 2, 5, 12 }) // as many as bodies, and more, which share them
  {
    DataSetImager imager(plan(), Device::Cpu);
    const std::string folder = "by" + std::to_string(workers);
    std::vector<std::int64_t> heard;
    writeDataSet(
      imager, (root_ / folder).string(), {}, {}, [&](const DataSetTally& tally) { heard.push_back(tally.done); },
      workers);
    std::vector<std::int64_t> inOrder(12);
    std::iota(inOrder.begin(), inOrder.end(), 1);
    EXPECT_EQ(heard, inOrder);
    EXPECT_EQ(content(folder), content("one"));
  }
  EXPECT_THROW(byThree("stopped", [](double done) { return done < 0.2; }), Aborted);
  EXPECT_LT(content("stopped").size(), content("one").size());
  EXPECT_EQ(byThree("stopped", {}).total, 12);
  EXPECT_EQ(content("stopped"), content("one"));
  json_["patients"][1]["views"][0]["pose"]["positionMm"] = { 0, -500, 0 };
  expectContains(errorOf([&] { byThree("bad", {}); }), "of patient 'other': none of 32 poses");
}

/// The channels say the same as the pictures, and as the JSON beside them.
TEST_F(DataSetFolder, HasChannelsWhereTheFileAsksForThem)
{
  json_["channels"] = { "grey", "mask", "label", "tissue", "error", "beam" };
  DataSetImager imager(plan(), Device::Cpu);
  const DataSetImage image = imager.make(3);
  const Json info = Json::parse(image.info);
  ASSERT_EQ(image.channels.names, (std::vector<std::string>{ "grey", "mask", "label", "tissue", "error" }));
  std::vector<std::string> tissues{ "" };
  const auto inOrder = nlohmann::ordered_json::parse(image.info);
  for (const auto& [name, numbers] : inOrder["tissues"].items())
  {
    tissues.push_back(name);
  }
  const std::map<std::string, std::string> expected{ { "left_ventricle_blood", "blood" }, { "skin", "skin" } };
  ASSERT_EQ(channel(image.channels, "error").size(), image.grey.size());
  double error = 0.0;
  for (std::size_t i = 0; i < image.grey.size(); ++i)
  {
    const float grey = channel(image.channels, "grey")[i];
    const int label = int(channel(image.channels, "label")[i]);
    const int tissue = int(channel(image.channels, "tissue")[i]);
    EXPECT_EQ(image.grey[i], image.grey[i] == 0 ? 0 : std::max(1L, std::lround(255.0f * grey)));
    EXPECT_EQ(float(image.mask[i]), channel(image.channels, "mask")[i]);
    EXPECT_EQ(image.mask[i], label == 7 ? 2 : 0);
    ASSERT_LT(tissue, int(tissues.size()));
    EXPECT_EQ(tissue > 0, image.grey[i] > 0);
    const std::string name = label > 0 ? info["labels"][std::to_string(label)] : "";
    if (expected.count(name) > 0)
    {
      EXPECT_EQ(tissues[std::size_t(tissue)], expected.at(name));
    }
    error = std::max(error, double(channel(image.channels, "error")[i]));
  }
  EXPECT_GT(error, 1.0); // of eight paths
  EXPECT_LE(error, 100.0);
  EXPECT_EQ(image.channels.numbers[0], std::make_pair(std::string("pixelMm"), 2.0));

  EXPECT_EQ(image.beam.height, 12);
  const double sampleMm = image.beam.numbers[0].second;
  EXPECT_NEAR(image.beam.width * sampleMm, 70.0, 2.0 * sampleMm);
  for (std::size_t i = 0; i < channel(image.beam, "envelope").size(); ++i)
  {
    const float re = channel(image.beam, "iq.re")[i];
    const float im = channel(image.beam, "iq.im")[i];
    ASSERT_FLOAT_EQ(channel(image.beam, "envelope")[i], std::hypot(re, im));
  }
  // Skin takes, so that less arrives the deeper it lies.
  const float* intensity = channel(image.beam, "intensity").data() + 6 * std::size_t(image.beam.width);
  EXPECT_LT(intensity[std::size_t(60.0 / sampleMm)], intensity[std::size_t(3.0 / sampleMm)]);
  EXPECT_LE(intensity[std::size_t(3.0 / sampleMm)], 1.0f);
}

TEST_F(DataSetFolder, TakesNamesInAnyEncoding)
{
  std::ofstream(root_ / "names.csv") << "label,name\n0,background\n7,left ventricle blood \xe9\n9,skin\n";
  json_["patients"][0]["names"] = "names.csv";
  json_["channels"] = { "label" };
  DataSetImager imager(plan(), Device::Cpu);
  EXPECT_EQ(Json::parse(imager.make(0).info)["labels"]["7"], "left ventricle blood \xef\xbf\xbd");
}

TEST_F(DataSetFolder, WritesChannelsAndGoesOnWithThem)
{
  const auto names = [](const Content& files, const std::string& folder) {
    return std::count_if(files.begin(), files.end(),
                         [&](const auto& file) { return file.first.rfind(folder + "/", 0) == 0; });
  };
  write("plain");
  json_["channels"] = { "error", "beam" };
  write("whole");
  const Content whole = content("whole");
  EXPECT_EQ(names(whole, "channels"), 12);
  EXPECT_EQ(names(whole, "beam"), 12);
  EXPECT_EQ(names(content("plain"), "beam"), 0);
  EXPECT_EQ(whole.at("imagesTr/ball_0000002_0000.png"), content("plain").at("imagesTr/ball_0000002_0000.png"));
  int heard = 0;
  EXPECT_THROW(write("cut", {}, [&](double) { return ++heard < 60; }), Aborted);
  std::ofstream(root_ / "cut/beam/ball_0000009.exr.12.part") << "half";
  std::ofstream(root_ / "cut/channels/ball_0000009.exr") << "of a process that was killed before its JSON";
  write("cut");
  EXPECT_EQ(content("cut"), whole);
  json_["channels"] = { "beam" };
  json_["format"] = "MONAI";
  write("monai");
  const Json first = Json::parse(content("monai").at("dataset.json"))["training"][0];
  EXPECT_EQ(content("monai").count(first["beam"]), 1u);
  EXPECT_FALSE(first.contains("channels"));
  DataSetImager imager(plan(), Device::Cpu);
  expectContains(errorOf([&] { writeDataSet(imager, (root_ / "none").string()); }),
                 "'channels' go into OpenEXR files, which this program cannot write");
}

TEST_F(DataSetFolder, KeepsDataSetsApart)
{
  write("out");
  json_["seed"] = 6;
  expectContains(errorOf([&] { write("out"); }), "holds images of another data set");
  DataSetImager imager(plan(), Device::Cpu);
  expectContains(errorOf([&] { writeDataSet(imager, ""); }), "no folder is named");
}

TEST_F(DataSetFolder, SaysWhichImageCannotBeMade)
{
  json_["patients"][0]["views"][0]["pose"]["positionMm"] = { 0, -500, 0 };
  const std::string said = errorOf([&] { write("out"); });
  expectContains(said, "image 0 of patient 'ball': none of 32 poses drawn for view 'top' stands on the skin");
  json_["masks"].erase(1);
  expectContains(errorOf([&] { write("out2"); }), "patient 'ball' has no label of any group of 'masks'");
}

/// Bone lies before one half of the ball: a hand that slides over it sees the cavity from the other half alone, and
/// without the demand from anywhere.
TEST_F(DataSetFolder, HoldsTheProbeWhereItSeesWhatIsAskedFor)
{
  LabelVolume volume = ballInSkin();
  for (std::size_t i = 0; i < volume.voxels.size(); ++i)
  {
    const Vec3i v(int(i % 40), int(i / 40 % 40), int(i / 1600));
    const Vec3d world = volume.placement.originMm + volume.placement.direction * (2.5 * Vec3d(v));
    const double r = glm::length(world);
    if (r > 24.0 && r < 32.0 && world.x > 2.0 && world.y < 0.0)
    {
      volume.voxels[i] = 11;
    }
  }
  volume.collectLabels();
  for (LabelInfo& label : volume.labels)
  {
    label.name = label.id == 7    ? "left_ventricle_blood"
                 : label.id == 9  ? "skin"
                 : label.id == 11 ? "rib"
                                  : "background";
  }
  writeLabelMap((root_ / "ball.nii.gz").string(), volume);
  json_["jitter"] = Json::parse(R"({"slideLateralMm": {"from": -16, "to": 16}})");
  json_["probe"]["lineCount"] = 48; // what a picture says of itself is to be exact
  json_["tracing"]["pathsPerLine"] = 64;
  json_["exams"] = 2;
  json_["imagesPerExam"] = 12;
  json_["patients"].erase(1);
  const auto seen = [&] {
    std::vector<double> percent;
    DataSetImager imager(plan(), Device::Cpu);
    for (int i = 0; i < 24; ++i)
    {
      const Json cavity = Json::parse(imager.make(i).info)["masks"]["cavity"];
      percent.push_back(double(cavity["visiblePercent"]));
    }
    return percent;
  };
  const auto hidden = [](double percent) { return percent < 70.0; };
  const std::vector<double> anywhere = seen();
  EXPECT_GT(std::count_if(anywhere.begin(), anywhere.end(), hidden), 6);
  json_["masks"][0]["leastVisiblePercent"] = 100; // of a group that the ball has not
  json_["masks"][1]["leastVisiblePercent"] = 80;
  const std::vector<double> demanded = seen();
  EXPECT_EQ(std::count_if(demanded.begin(), demanded.end(), hidden), 0);
  json_["masks"][1]["leastVisiblePercent"] = 101;
  expectContains(errorOf([&] { plan(); }), "'masks[1].leastVisiblePercent'");
}

TEST_F(DataSetFolder, LooksForViewsByNameAndForWindows)
{
  json_["patients"].erase(1);
  Json& patient = json_["patients"][0];
  patient.erase("labels");
  patient.update(Json::parse(R"({"bundled": "thorax", "spacingMm": 2, "views": [
    {"name": "Suprapubic"}, {"name": "A2C"}, {"name": "liver", "window": "liver"}]})"));
  json_["probe"]["depthMm"] = 150;
  json_["exams"] = 1;
  json_["imagesPerExam"] = 3;
  json_["masks"] = Json::parse(R"([{"name": "cavity", "labels": ["left ventricle blood"]},
    {"name": "liver", "labels": ["liver"]}])");
  DataSetImager imager(plan(), Device::Cpu);
  const auto infoOf = [&](int index) { return Json::parse(imager.make(index).info); };
  const Json first = infoOf(0);
  EXPECT_EQ(first["view"], "A2C"); // there is no bladder
  EXPECT_EQ(infoOf(1)["pose"], first["pose"]);
  EXPECT_GT(first["visibility"]["shownPercent"]["left ventricle"], 50.0);
  EXPECT_GT(first["visibility"]["score"], 0.1);
  EXPECT_LT(first["visibility"]["planeOffDeg"], 15.0);
  EXPECT_TRUE(first["landmarks"]["apex"]["inSector"]);
  EXPECT_FALSE(infoOf(2).contains("visibility")); // of a window
  EXPECT_GT(first["masks"]["cavity"]["pixels"], 200);
  EXPECT_GT(infoOf(2)["masks"]["liver"]["pixels"], 500);
  patient["views"] = Json::parse(R"([{"name": "A6C"}])");
  expectContains(errorOf([&] { DataSetImager(plan(), Device::Cpu).make(0); }),
                 "'A6C' is no standard view; choose one of A4C");
  patient["views"] = Json::parse(R"([{"name": "Suprapubic"}])");
  expectContains(errorOf([&] { DataSetImager(plan(), Device::Cpu).make(0); }), "none of its views is obtainable");
}

TEST(PoseOnSkin, FindsTheSurfaceFromBothSides)
{
  TissueTable table = TissueTable::read(dataFile("tissues.csv"));
  LabelVolume volume = ballInSkin();
  for (LabelInfo& label : volume.labels)
  {
    label.tissue = label.id == 7 ? "blood" : label.id == 9 ? "skin" : "air";
  }
  const Scene scene(std::move(volume), table, "air");
  for (const double from : { -90.0, -41.0, -39.0, -1.0 })
  {
    const auto pose = poseOnSkin(scene, { { 0.0, from, 0.0 }, { 0.0, 1.0, 0.0 }, { 1.0, 0.0, 0.0 } });
    ASSERT_TRUE(pose);
    EXPECT_NEAR(pose->positionMm.y, -40.0, 2.5);
  }
  EXPECT_FALSE(poseOnSkin(scene, { { 0.0, -120.0, 0.0 }, { 0.0, 1.0, 0.0 }, { 1.0, 0.0, 0.0 } }));
  EXPECT_FALSE(poseOnSkin(scene, { { 0.0, -60.0, 0.0 }, { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 } }));
}
