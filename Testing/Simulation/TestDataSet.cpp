// What a data set's file may say, and what follows from it for each image.
#include "ErrorText.h"
#include "Folders.h"
#include "TemporaryFolder.h"

#include "DataSets/DataSetPlan.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <set>

using namespace sono;
using sono::testing::errorOf;
using sono::testing::expectContains;

namespace {

using Json = nlohmann::json;

Json parsed(const std::string& path)
{
  std::ifstream stream(path);
  return Json::parse(stream);
}

Json apical()
{
  return parsed(dataFile("datasets/apical.json"));
}

class DataSetFile : public ::testing::Test
{
protected:
  std::string write(const std::string& text)
  {
    std::ofstream(path_) << text;
    return path_;
  }
  DataSet read(const Json& json) { return readDataSet(write(json.dump()), dataFolder()); }
  std::string refusal(const Json& json)
  {
    return errorOf([&] { read(json); });
  }
  const sono::testing::TemporaryFolder folder_;
  const std::string path_ = folder_.file("set.json");
};

} // namespace

TEST_F(DataSetFile, PresetsAreRead)
{
  const DataSet set = readDataSet(dataFile("datasets/apical.json"), dataFolder());
  EXPECT_EQ(set.masks.size(), 5u);
  EXPECT_EQ(set.parameters.size(), 13u);
  EXPECT_EQ(readDataSet(dataFile("datasets/amadou2024.json"), dataFolder()).imagesPerExam, 10);
}

TEST_F(DataSetFile, EachMistakeIsNamedWithFileAndKey)
{
  const std::vector<std::pair<const char*, const char*>> cases{
    { R"({"sead": 1})", "'sead' means nothing" },
    { R"({"seed": null})", "'seed' is not a number" },
    { R"({"seed": "1"})", "'seed' is not a number" },
    { R"({"seed": 1.5})", "'seed' is not a whole number" },
    { R"({"exams": 0})", "'exams' is out of range" },
    { R"({"name": "a b"})", "'name' is part of file names" },
    { R"({"format": "COCO"})", "'format' is none" },
    { R"({"channels": []})", "'channels' is not a list of texts" },
    { R"({"channels": ["grey", "noise"]})", "'channels' has 'noise', which is none; write of \"grey\"" },
    { R"({"channels": ["beam", "beam"]})", "'channels' has 'beam' twice" },
    { R"({"pixelMm": 0})", "'pixelMm' is out of range" },
    { R"({"patients": []})", "'patients' is not a list" },
    { R"({"patients": [3]})", "'patients[0]' is not an object" },
    { R"({"masks": [{"name": "a", "labels": "b"}]})", "'masks[0].labels' is not a list of texts" },
    { R"({"masks": [{"name": "a", "labels": ["b"]}, {"name": "a", "labels": ["c"]}]})",
      "'masks[1].name' is there twice" },
    { R"({"split": {"train": 0.5}})", "'split.train' and the other shares do not sum to 1" },
    { R"({"jitter": {"tiltDeg": {"from": 4, "to": -4}}})", "'jitter.tiltDeg' is a range upside down" },
    { R"({"jitter": {"tiltDeg": {"from": 4}}})", "lacks 'jitter.tiltDeg.to'" },
    { R"({"jitter": {"tiltDeg": {"from": 1, "to": 2, "by": 3}}})", "'jitter.tiltDeg.by' means nothing" },
    { R"({"jitter": {"wobble": 4}})", "'jitter.wobble' means nothing" },
    { R"({"display": {"gainDb": "loud"}})", "'display.gainDb' is not a number" },
    { R"({"display": {"gainDb": {"from": 0, "to": 301}}})", "'display.gainDb.to' is out of range" },
    { R"({"gainDb": {"oneOf": []}})", "'gainDb' means nothing" },
    { R"({"display": {"gainDb": {"oneOf": []}}})", "'display.gainDb.oneOf' is not a list" },
    { R"({"display": {"addNoise": 1}})", "'display.addNoise' is no switch" },
    { R"({"display": {"noiseSeed": 1}})", "'display.noiseSeed' means nothing" },
    { R"({"display": {"rejectDb": 65}})", "its settings do not go together: rejectDb is 65" },
    { R"({"tracing": {"pathsPerLine": 1.5}})", "'tracing.pathsPerLine' is out of range; write a whole number" },
    { R"({"tracing": {"interfaceModel": "Burger"}})", "'tracing.interfaceModel' is no such choice" },
    { R"({"tracing": {"interfaceModel": {"from": "Acoustic", "to": "Acoustic"}}})",
      "'tracing.interfaceModel' has no range" },
    { R"({"tracing": {"timeBudgetS": 1}})", "'tracing.timeBudgetS' means nothing" },
    { R"({"echo": {"samplingMHz": 4}})", "its settings do not go together" },
    { R"({"probe": {"preset": "nowhere.json"}})", "'probe.preset' names" },
    { R"({"tissues": {"jelly": {}}})", "'tissues.jelly' is no tissue" },
    { R"({"jitter": {"pressMm": -1}})", "'jitter.pressMm' is out of range" },
    { R"({"mitralLine": {"ventricle": "LV", "atrium": "LV cavity", "valve": ["mitral valve"]}})",
      "'mitralLine.ventricle' is no group of 'masks'" },
    { R"({"tissues": {"blood": {"speed": 1}}})", "'tissues.blood.speed' means nothing" },
    { R"({"tissues": {"blood": {"mu0": 2}}})", "'tissues.blood.mu0' is out of range" },
    { R"({"tissues": {"blood": {"mu0": {"timesFrom": 2, "timesTo": 1}}}})",
      "'tissues.blood.mu0' is a range upside down" },
    { R"({"tissueTable": "nowhere.csv"})", "'tissueTable' names" },
    { R"({"$schema": 3})", "'$schema' is not a text" },
  };
  for (const auto& [patch, sentence] : cases)
  {
    Json json = apical();
    const Json changes = Json::parse(patch);
    for (const auto& entry : changes.items())
    {
      json[entry.key()] = entry.value(); // not a merge: these are whole values, and null is one
    }
    const std::string said = refusal(json);
    expectContains(said, sentence);
    expectContains(said, path_);
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 0) << said;
  }
  for (const char* key : { "name", "seed", "exams", "imagesPerExam", "patients", "probe", "masks", "format" })
  {
    Json json = apical();
    json.erase(key);
    expectContains(refusal(json), std::string("lacks '") + key + "'");
  }
}

TEST_F(DataSetFile, MistakesOfAPatientAreNamed)
{
  const auto with = [&](const char* patch) {
    Json json = apical();
    json["patients"][0].update(Json::parse(patch));
    return refusal(json);
  };
  expectContains(with(R"({"copies": 0})"), "'patients[0].copies' is out of range");
  expectContains(with(R"({"stretch": {"from": 2, "to": 1}})"), "'patients[0].stretch' is a range upside down");
  expectContains(with(R"({"extraFatMm": -1})"), "'patients[0].extraFatMm' is out of range");
  expectContains(with(R"({"mirror": 1})"), "'patients[0].mirror' is no switch");
  expectContains(with(R"({"mirror": {"from": false, "to": true}})"), "'patients[0].mirror' has no range");
  expectContains(with(R"({"warp": {"amplitudeMm": 3}})"), "lacks 'patients[0].warp.wavelengthMm'");
  expectContains(with(R"({"warp": {"amplitudeMm": 3, "wavelengthMm": 60, "seed": 1}})"),
                 "'patients[0].warp.seed' means nothing");
  expectContains(with(R"({"warp": {"amplitudeMm": {"from": 0, "to": 10}, "wavelengthMm": {"from": 139, "to": 200}}})"),
                 "'patients[0].warp' could fold the body");
  EXPECT_EQ(with(R"({"warp": {"amplitudeMm": {"from": 0, "to": 10}, "wavelengthMm": {"from": 140, "to": 200}}})"),
            "no error");
  expectContains(with(R"({"bundled": "abdomen"})"), "'patients[0].bundled' names no bundled anatomy");
  expectContains(with(R"({"labels": "nowhere.nii"})"), "'patients[0].labels' names");
  expectContains(with(R"({"split": "dev"})"), "'patients[0].split' is no split");
  expectContains(with(R"({"licence": ""})"), "'patients[0].licence' is not a text");
  expectContains(
    with(R"({"views": [{"name": "A", "pose": {"positionMm": [0, 0], "axial": [0,0,1], "lateral": [1,0,0]}}]})"),
    "'patients[0].views[0].pose.positionMm' is not a vector");
  expectContains(
    with(R"({"views": [{"name": "A", "pose": {"positionMm": [0,0,0], "axial": [0,0,1], "lateral": [0,0,2]}}]})"),
    "'patients[0].views[0].pose' is none");
  Json twice = apical();
  twice["patients"].push_back(twice["patients"][0]);
  expectContains(refusal(twice), "has the id 'thorax' twice");
}

TEST_F(DataSetFile, WhatIsNoJsonIsRefused)
{
  expectContains(errorOf([&] { readDataSet(write("{\"seed\": 1,"), dataFolder()); }), "is not JSON");
  expectContains(errorOf([&] { readDataSet(write("[]"), dataFolder()); }), "is not an object");
  expectContains(errorOf([&] { readDataSet(write(R"({"seed": 1, "seed": 2})"), dataFolder()); }),
                 "'seed' is there twice");
  expectContains(errorOf([&] { readDataSet(::testing::TempDir(), dataFolder()); }), "cannot read");
}

/// The schema, which editors read, names the keys that the reader knows, no more and no fewer.
TEST_F(DataSetFile, SchemaNamesTheParameters)
{
  const Json schema = parsed(dataFile("datasets/schema.json"));
  const DataSetSettings settings;
  for (const SettingsGroup group :
       { SettingsGroup::Probe, SettingsGroup::Tracing, SettingsGroup::Echo, SettingsGroup::Display })
  {
    std::set<std::string> known;
    DataSetSettings::visit(settings, group, [&](const auto&, const Parameter& parameter) {
      if (isDrawable(parameter))
      {
        known.insert(parameter.name);
      }
    });
    if (group == SettingsGroup::Probe)
    {
      known.insert("preset");
    }
    const auto& named = schema["properties"][nameOf(group)]["propertyNames"]["enum"];
    EXPECT_EQ(named.get<std::set<std::string>>(), known) << nameOf(group);
  }
  std::set<std::string> columns;
  for (const TissueColumn& column : tissueColumns())
  {
    columns.insert(column.name);
  }
  std::set<std::string> named;
  for (const auto& entry : schema["properties"]["tissues"]["additionalProperties"]["properties"].items())
  {
    named.insert(entry.key());
  }
  EXPECT_EQ(named, columns);
  Json unknown = apical();
  unknown["?"] = 1;
  const std::string said = refusal(unknown); // lists the keys that it knows
  for (const auto& entry : schema["properties"].items())
  {
    expectContains(said, entry.key());
  }
  Json stranger = apical();
  stranger["patients"][0]["?"] = 1;
  const std::string ofPatient = refusal(stranger);
  for (const auto& entry : schema["$defs"]["patient"]["properties"].items())
  {
    expectContains(ofPatient, entry.key() == "names" ? "" : entry.key()); // of a label map's
  }
}

TEST_F(DataSetFile, DrawsKeepToTheirRangesAndFillThem)
{
  DataSet set = read(apical());
  set.exams = 4000;
  const DataSetPlan plan(set);
  const double exams = double(set.exams);
  for (std::size_t p = 0; p < set.parameters.size(); ++p)
  {
    const DrawnParameter& parameter = set.parameters[p];
    std::map<double, int> values;
    double sum = 0.0;
    for (std::int64_t exam = 0; exam < set.exams; ++exam)
    {
      const double value = plan.image(exam * set.imagesPerExam).parameters[p];
      ASSERT_GE(value, parameter.draw.least());
      ASSERT_LE(value, parameter.draw.most());
      sum += value;
      ++values[value];
    }
    const double span = parameter.draw.most() - parameter.draw.least();
    if (parameter.draw.kind == Draw::Kind::Uniform)
    {
      const double middle = 0.5 * (parameter.draw.most() + parameter.draw.least());
      EXPECT_NEAR(sum / exams, middle, 5.0 * span / std::sqrt(12.0 * exams)) << parameter.name; // five sigma
    }
    else
    {
      for (const double value : parameter.draw.values)
      {
        EXPECT_NEAR(values[value], exams / double(parameter.draw.values.size()), 5.0 * std::sqrt(exams))
          << parameter.name;
      }
    }
  }
}

TEST_F(DataSetFile, WholeNumbersAreDrawnWithBothEnds)
{
  const Draw draw{ Draw::Kind::Uniform, { 3.0, 5.0 }, true };
  EXPECT_EQ(draw.at(0.0), 3.0);
  EXPECT_EQ(draw.at(0.34), 4.0);
  EXPECT_EQ(draw.at(0.999999), 5.0);
  EXPECT_EQ(always(7.0).at(0.5), 7.0);
}

TEST_F(DataSetFile, ImagesFollowFromTheirNumberAlone)
{
  const DataSetPlan plan(read(apical()));
  const DataSetPlan again(read(apical()));
  std::set<std::uint64_t> seeds;
  for (std::int64_t n = 199; n >= 0; n -= 7) // in another order
  {
    const PlannedImage a = plan.image(n);
    const PlannedImage b = again.image(n);
    EXPECT_EQ(a.parameters, b.parameters);
    EXPECT_EQ(a.pathSeed, b.pathSeed);
    EXPECT_EQ(plan.jitter(n, 3).tiltDeg, again.jitter(n, 3).tiltDeg);
    EXPECT_NE(plan.jitter(n, 3).tiltDeg, plan.jitter(n, 4).tiltDeg);
    seeds.insert(a.pathSeed);
    seeds.insert(a.noiseSeed);
    EXPECT_EQ(a.scattererSeed, plan.image(n / 10 * 10).scattererSeed); // of the exam
  }
  EXPECT_EQ(seeds.size(), 58u);
  Json other = apical();
  other["seed"] = 2;
  EXPECT_NE(DataSetPlan(read(other)).image(5).parameters, plan.image(5).parameters);
  // A parameter that is added draws nothing away from the others.
  Json more = apical();
  more["display"]["axialSmoothingMm"] = Json{ { "from", 0 }, { "to", 1 } };
  const DataSetPlan longer(read(more));
  EXPECT_EQ(longer.settings(longer.image(5)).display.gainDb, plan.settings(plan.image(5)).display.gainDb);
}

TEST_F(DataSetFile, WhatIsDrawnIsSet)
{
  Json json = apical();
  json["tracing"]["interfaceModel"] = "Amadou 2024";
  json["display"]["gainDb"] = 4.5;
  json["tissues"] =
    Json::parse(R"({"blood": {"mu0": 0.25}, "*": {"impedance_MRayl": {"timesFrom": 2, "timesTo": 2}}})");
  const DataSetPlan plan(read(json));
  const DataSetSettings settings = plan.settings(plan.image(0));
  EXPECT_EQ(settings.tracing.model, InterfaceModel::Amadou2024);
  EXPECT_EQ(settings.tracing.seed, plan.image(0).pathSeed);
  EXPECT_EQ(settings.display.gainDb, 4.5);
  EXPECT_EQ(settings.image(0.5, Device::Cpu).geometry.lineCount, 96);
  const TissueTable table = plan.tissues(0);
  EXPECT_EQ(table.find("blood")->scattererMean, 0.25);
  EXPECT_DOUBLE_EQ(table.find("blood")->impedanceMRayl, 2.0 * plan.set().tissues.find("blood")->impedanceMRayl);
  EXPECT_EQ(table.find("air")->impedanceMRayl, plan.set().tissues.find("air")->impedanceMRayl);
}

TEST_F(DataSetFile, PatientsStayInOneSplit)
{
  Json json = apical();
  json["exams"] = 1003;
  const std::string labels = folder_.file("map.nii");
  std::ofstream(labels) << "not read by a plan";
  Json patient = json["patients"][0];
  patient.erase("bundled");
  patient["labels"] = labels;
  patient["views"][0]["window"] = "heart";
  json["patients"] = Json::array();
  for (int n = 0; n < 20; ++n)
  {
    patient["id"] = "p" + std::to_string(n);
    patient["copies"] = 1 + n % 3;
    json["patients"].push_back(patient);
  }
  json["patients"][0]["split"] = "test";
  const DataSetPlan plan(read(json));
  std::map<int, std::set<Split>> splits;
  std::map<Split, std::int64_t> images;
  std::set<int> bodies;
  for (std::int64_t n = 0; n < plan.imageCount(); ++n)
  {
    const int body = plan.image(n).body;
    bodies.insert(body);
    splits[plan.bodies()[std::size_t(body)].patient].insert(plan.splitOf(n));
    ++images[plan.splitOf(n)];
  }
  EXPECT_EQ(bodies.size(), plan.bodies().size());
  for (const auto& [id, of] : splits)
  {
    EXPECT_EQ(of.size(), 1u) << id;
  }
  EXPECT_EQ(*splits[0].begin(), Split::Test);
  for (int split = 0; split < splitCount; ++split)
  {
    EXPECT_EQ(images[Split(split)], plan.imagesIn(Split(split)));
    EXPECT_GT(images[Split(split)], 0);
  }
}

/// Each copy of the bundled thorax is another body then, and a patient that is in one split.
TEST_F(DataSetFile, DrawnBodiesDiffer)
{
  const DataSetPlan plan(readDataSet(dataFile("datasets/apical_views.json"), dataFolder()));
  std::set<double> ventricles;
  for (const PlannedBody& body : plan.bodies())
  {
    ASSERT_TRUE(body.thoraxSeed);
    ventricles.insert(thoraxOf(body).leftVentricleMl);
  }
  EXPECT_EQ(ventricles.size(), plan.bodies().size());
  const DataSetPlan still(read(apical()));
  EXPECT_EQ(thoraxOf(still.bodies()[1]).leftVentricleMl, ThoraxParameters{}.leftVentricleMl);
  Json wrong = apical();
  wrong["patients"][0]["drawn"] = 1;
  expectContains(refusal(wrong), "'patients[0].drawn' is no switch");
}

/// As it draws them, whatever else is drawn.
TEST_F(DataSetFile, BodiesAreAugmentedByThemselves)
{
  Json json = apical();
  Json& patient = json["patients"][0];
  patient["copies"] = 400;
  const DataSetPlan plain(read(json));
  patient.update(Json::parse(R"({"mirror": {"oneOf": [true, false]}, "extraFatMm": {"from": 2, "to": 12},
                                 "warp": {"amplitudeMm": {"from": 0, "to": 8}, "wavelengthMm": 120}})"));
  const DataSetPlan plan(read(json));
  const DataSetPlan again(read(json));
  int mirrored = 0;
  std::set<std::uint64_t> seeds;
  for (std::size_t b = 0; b < plan.bodies().size(); ++b)
  {
    const BodyAugmentation& drawn = plan.bodies()[b].augmentation;
    EXPECT_EQ(drawn.warpAmplitudeMm, again.bodies()[b].augmentation.warpAmplitudeMm);
    EXPECT_EQ(drawn.stretch, plain.bodies()[b].augmentation.stretch);
    EXPECT_FALSE(plain.bodies()[b].augmentation.isMirrored);
    EXPECT_EQ(plain.bodies()[b].augmentation.extraFatMm, 0.0);
    EXPECT_TRUE(drawn.extraFatMm >= 2.0 && drawn.extraFatMm <= 12.0);
    EXPECT_EQ(drawn.warpWavelengthMm, 120.0);
    seeds.insert(drawn.warpSeed);
    mirrored += drawn.isMirrored ? 1 : 0;
  }
  EXPECT_EQ(seeds.size(), plan.bodies().size());
  EXPECT_NEAR(mirrored, 200, 50); // five sigma
}

TEST_F(DataSetFile, ProcessesShareEachImageOnce)
{
  Json json = apical();
  json["exams"] = 17;
  const DataSetPlan plan(read(json));
  for (int of = 1; of < 40; ++of)
  {
    std::int64_t next = 0;
    for (int rank = 0; rank < of; ++rank)
    {
      const PlannedRange range = plan.imagesOf({ rank, of });
      EXPECT_EQ(range.first, next);
      EXPECT_EQ(range.end % plan.set().imagesPerExam, 0);
      EXPECT_LE(range.end - range.first, (17 / of + 1) * 10);
      next = range.end;
    }
    EXPECT_EQ(next, plan.imageCount());
  }
  EXPECT_THROW(plan.imagesOf({ 2, 2 }), Error);
  EXPECT_THROW(plan.imagesOf({ 0, 0 }), Error);
}

TEST_F(DataSetFile, AMillionImagesArePlannedQuickly)
{
  Json json = apical();
  json["exams"] = 100000;
  const DataSetPlan plan(read(json));
  const auto begin = std::chrono::steady_clock::now();
  std::size_t letters = 0;
  double sum = 0.0;
  for (std::int64_t n = 0; n < 1000000; ++n)
  {
    const PlannedImage image = plan.image(n);
    sum += image.parameters.back() + plan.jitter(n, 0).tiltDeg;
    letters += plan.caseName(n).size();
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  RecordProperty("seconds", std::to_string(seconds));
  EXPECT_EQ(letters, 14000000u);
  EXPECT_NE(sum, 0.0);
  EXPECT_LT(seconds, 20.0); // a second on a quiet machine; this ends what is slower by orders
}
