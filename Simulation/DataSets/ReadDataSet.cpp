#include "DataSets/DataSet.h"
#include "DataSets/DataSetSettings.h"
#include "DataSets/ReadDraw.h"
#include "DataSets/StrictJson.h"
#include "Labels/SmoothWarp.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace sono {

namespace {

namespace fs = std::filesystem;
using Json = StrictObject::Json;

constexpr double exactWhole = 9007199254740992.0; // 2^53

/// A file that the data set names, relative to it.
std::string pathBeside(const StrictObject& object, const std::string& key, const std::string& name)
{
  const fs::path path = fs::path(object.file()).parent_path() / name;
  object.require(key, fs::exists(path), "names '" + path.string() + "', which is not there; correct it");
  return path.string();
}

Split readSplit(StrictObject& object, const std::string& key)
{
  const std::string name = object.text(key);
  for (int i = 0; i < splitCount; ++i)
  {
    if (name == nameOf(Split(i)))
    {
      return Split(i);
    }
  }
  object.fail(key, R"(is no split; write "train", "validation" or "test")");
}

Vec3d readVector(StrictObject& object, const std::string& key)
{
  const Json& value = object.take(key);
  const bool isVector =
    value.is_array() && value.size() == 3 && value[0].is_number() && value[1].is_number() && value[2].is_number();
  object.require(key, isVector, "is not a vector; write three numbers in brackets");
  return { value[0].get<double>(), value[1].get<double>(), value[2].get<double>() };
}

DataSetView readView(StrictObject object)
{
  DataSetView view;
  view.name = object.text("name");
  view.window = object.textOr("window", "");
  if (object.has("pose"))
  {
    StrictObject pose = object.object("pose");
    ProbePose read{ readVector(pose, "positionMm"), readVector(pose, "axial"), readVector(pose, "lateral") };
    pose.refuseOthers();
    try
    {
      view.pose = read.orthonormalized();
    }
    catch (const Error& error)
    {
      object.fail("pose", std::string("is none: ") + error.what());
    }
  }
  object.refuseOthers();
  object.require("name", !(view.pose && !view.window.empty()), "has both a pose and a window; remove one of them");
  return view;
}

void readWarp(StrictObject& patient, DataSetPatient& read)
{
  StrictObject warp = patient.object("warp");
  read.warpAmplitudeMm = readDraw(warp, "amplitudeMm", { between(0, 50) });
  read.warpWavelengthMm = readDraw(warp, "wavelengthMm", { between(10, 2000) });
  warp.refuseOthers();
  patient.require("warp", read.warpWavelengthMm.least() >= SmoothWarp::leastWavelengths * read.warpAmplitudeMm.most(),
                  "could fold the body; let its shortest wavelength be at least 14 times its largest amplitude");
}

DataSetPatient readPatient(StrictObject object)
{
  DataSetPatient patient;
  patient.id = object.text("id");
  if (object.has("labels"))
  {
    patient.labels = pathBeside(object, "labels", object.text("labels"));
    object.require("bundled", !object.has("bundled"), "stands beside 'labels'; remove one of them");
    if (object.has("names"))
    {
      patient.names = pathBeside(object, "names", object.text("names"));
    }
  }
  else
  {
    object.require("bundled", object.text("bundled") == "thorax", R"(names no bundled anatomy; write "thorax")");
    patient.spacingMm = object.numberOr("spacingMm", between(0.5, 5.0), patient.spacingMm);
    if (object.has("drawn"))
    {
      patient.isDrawn = readValue(object, "drawn", { {}, false, true }) > 0.0;
    }
  }
  patient.licence = object.text("licence");
  patient.provenance = object.text("provenance");
  patient.copies = object.has("copies") ? int(object.whole("copies", 1, 1e6)) : 1;
  if (object.has("stretch"))
  {
    patient.stretch = readDraw(object, "stretch", { between(0.5, 2.0) });
  }
  if (object.has("extraFatMm"))
  {
    patient.extraFatMm = readDraw(object, "extraFatMm", { between(0, 50) });
  }
  if (object.has("warp"))
  {
    readWarp(object, patient);
  }
  if (object.has("mirror"))
  {
    patient.mirror = readDraw(object, "mirror", { {}, false, true });
  }
  if (object.has("split"))
  {
    patient.split = readSplit(object, "split");
  }
  for (const StrictObject& view : object.objects("views"))
  {
    patient.views.push_back(readView(view));
  }
  object.refuseOthers();
  return patient;
}

void readShares(StrictObject object, DataSet& set)
{
  double sum = 0.0;
  for (int i = 0; i < splitCount; ++i)
  {
    sum += set.splitShares[std::size_t(i)] = object.numberOr(nameOf(Split(i)), between(0, 1), 0.0);
  }
  object.require(nameOf(Split::Train), std::abs(sum - 1.0) < 1e-6, "and the other shares do not sum to 1; let them");
  object.refuseOthers();
}

void readGroup(StrictObject object, SettingsGroup group, DataSet& set)
{
  const DataSetSettings defaults = baseSettings(set);
  DataSetSettings::visit(defaults, group, [&](const auto& value, const Parameter& parameter) {
    if (isDrawable(parameter) && object.has(parameter.name))
    {
      using Value = std::decay_t<decltype(value)>;
      set.parameters.push_back(
        { group, parameter.name, readDraw(object, parameter.name, allowedOf<Value>(parameter)) });
    }
  });
  object.refuseOthers();
}

void readProbe(StrictObject object, const std::string& dataFolder, DataSet& set)
{
  const std::string preset = object.text("preset");
  const fs::path bundled = fs::path(dataFolder) / "probes" / (preset + ".json");
  const std::string path = fs::exists(bundled) ? bundled.string() : pathBeside(object, "preset", preset);
  set.probe = ProbeSettings(readProbePreset(path));
  readGroup(object, SettingsGroup::Probe, set);
}

/// Throws Error where a number that is drawn would leave its range.
void checkTissue(const StrictObject& object, const std::string& key, const DrawnTissue& drawn, const Tissue& tissue)
{
  for (const double end : { drawn.draw.least(), drawn.draw.most() })
  {
    Tissue changed = tissue;
    changed.*drawn.column.member = drawn.isFactor ? tissue.*drawn.column.member * end : end;
    try
    {
      checkRanges(changed);
    }
    catch (const Error& error)
    {
      object.fail(key, std::string("is out of range: ") + error.what());
    }
  }
}

void readTissue(StrictObject object, const std::string& name, DataSet& set)
{
  for (const TissueColumn& column : tissueColumns())
  {
    if (!object.has(column.name))
    {
      continue;
    }
    DrawnTissue drawn{ name, column, false, {} };
    const Json& value = object.take(column.name);
    drawn.isFactor = value.is_object() && value.contains("timesFrom");
    if (drawn.isFactor)
    {
      StrictObject range = object.object(column.name);
      drawn.draw = readRange(range, object, column.name, "timesFrom", "timesTo", { between(0, 1000) });
    }
    else
    {
      drawn.draw = readDraw(object, column.name, {});
    }
    for (const Tissue& tissue : set.tissues.tissues())
    {
      if (name == tissue.name || (name == "*" && tissue.name != couplingTissue))
      {
        checkTissue(object, column.name, drawn, tissue);
      }
    }
    set.drawnTissues.push_back(drawn);
  }
  object.refuseOthers();
}

void readTissues(StrictObject object, DataSet& set)
{
  for (const std::string& name : object.keys())
  {
    object.require(name, name == "*" || set.tissues.find(name), "is no tissue of the table; correct it");
    readTissue(object.object(name), name, set);
  }
}

void readJitter(StrictObject object, DataSet& set)
{
  std::size_t at = 0;
  const PoseJitter names;
  PoseJitter::visit(names, [&](const double& value, const char* name) {
    if (object.has(name))
    {
      const bool isPress = &value == &names.pressMm;
      set.jitter[at] = readDraw(object, name, { isPress ? between(0, 15) : between(-90, 90) });
    }
    ++at;
  });
  object.refuseOthers();
}

void readMasks(StrictObject& root, DataSet& set)
{
  for (StrictObject& object : root.objects("masks"))
  {
    set.masks.push_back({ object.text("name"), object.texts("labels"),
                          object.numberOr("leastVisiblePercent", between(0.0, 100.0), 0.0) });
    object.refuseOthers();
    for (std::size_t i = 0; i + 1 < set.masks.size(); ++i)
    {
      object.require("name", set.masks[i].name != set.masks.back().name, "is there twice; rename one");
    }
  }
  root.require("masks", set.masks.size() <= 255, "has more than 255 groups; remove some");
}

void readMitralLine(StrictObject object, DataSet& set)
{
  const auto group = [&](const char* key) {
    const std::string name = object.text(key);
    object.require(key,
                   std::any_of(set.masks.begin(), set.masks.end(), [&](const MaskGroup& g) { return g.name == name; }),
                   "is no group of 'masks'; correct it");
    return name;
  };
  set.mitralLine = MitralLineGroups{ group("ventricle"), group("atrium"), object.texts("valve") };
  object.require("atrium", set.mitralLine->atrium != set.mitralLine->ventricle,
                 "is the ventricle's group; name another");
  object.refuseOthers();
}

void readChannels(StrictObject& root, DataSet& set)
{
  std::string names;
  for (int i = 0; i < imageChannelCount; ++i)
  {
    names += (i == 0 ? "\"" : ", \"") + std::string(nameOf(ImageChannel(i))) + "\"";
  }
  for (const std::string& name : root.texts("channels"))
  {
    int channel = 0;
    while (channel < imageChannelCount && name != nameOf(ImageChannel(channel)))
    {
      ++channel;
    }
    root.require("channels", channel < imageChannelCount, "has '" + name + "', which is none; write of " + names);
    root.require("channels",
                 std::find(set.channels.begin(), set.channels.end(), ImageChannel(channel)) == set.channels.end(),
                 "has '" + name + "' twice; remove one");
    set.channels.push_back(ImageChannel(channel));
  }
}

void readPatients(StrictObject& root, DataSet& set)
{
  std::set<std::string> ids;
  for (const StrictObject& object : root.objects("patients"))
  {
    set.patients.push_back(readPatient(object));
    root.require("patients", ids.insert(set.patients.back().id).second,
                 "has the id '" + set.patients.back().id + "' twice; rename one");
  }
}

/// The settings at the ends of each parameter's range, the others at theirs: what contradicts is found now.
void checkTogether(const DataSet& set)
{
  const auto check = [&](std::size_t other, bool most) {
    DataSetSettings settings = baseSettings(set);
    for (std::size_t i = 0; i < set.parameters.size(); ++i)
    {
      const DrawnParameter& p = set.parameters[i];
      settings.set(p.group, p.name, (i == other) != most ? p.draw.most() : p.draw.least());
    }
    try
    {
      settings.image(set.pixelMm, Device::Cpu);
    }
    catch (const Error& error)
    {
      throw Error("'" + set.path + "': its settings do not go together: " + error.what());
    }
  };
  for (std::size_t other = 0; other < set.parameters.size(); ++other)
  {
    check(other, false);
    check(other, true);
  }
}

Json parse(const DataSet& set)
{
  std::vector<std::set<std::string>> keys; // of the objects that are open
  const auto refuseTwice = [&](int, Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::object_start)
    {
      keys.emplace_back();
    }
    else if (event == Json::parse_event_t::object_end)
    {
      keys.pop_back();
    }
    else if (event == Json::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second)
    {
      throw Error("'" + set.path + "': '" + parsed.get<std::string>() + "' is there twice; remove one.");
    }
    return true;
  };
  try
  {
    return Json::parse(set.text, refuseTwice);
  }
  catch (const Json::parse_error& error)
  {
    throw Error("'" + set.path + "' is not JSON (at byte " + std::to_string(error.byte) + "); correct it there.");
  }
}

} // namespace

DataSet readDataSet(const std::string& path, const std::string& dataFolder)
{
  std::ifstream stream(path, std::ios::binary);
  if (!stream || fs::is_directory(path))
  {
    throw Error("cannot read '" + path + "': no such file, or no permission to read it.");
  }
  DataSet set;
  set.path = path;
  set.text.assign(std::istreambuf_iterator<char>(stream), {});
  const Json json = parse(set);
  StrictObject root(path, "", json);
  root.textOr("$schema", ""); // for editors
  set.name = root.text("name");
  root.require("name",
               set.name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") ==
                 std::string::npos,
               "is part of file names; write letters, digits and underscores alone");
  set.description = root.textOr("description", "");
  set.seed = std::uint64_t(root.whole("seed", 0, exactWhole));
  set.exams = root.whole("exams", 1, 1e9);
  set.imagesPerExam = int(root.whole("imagesPerExam", 1, 1e6));
  set.pixelMm = root.numberOr("pixelMm", above(0), set.pixelMm);
  const std::string format = root.text("format");
  root.require("format", format == "nnU-Net" || format == "MONAI", R"(is none; write "nnU-Net" or "MONAI")");
  set.format = format == "MONAI" ? DataSetFormat::Monai : DataSetFormat::NnUNet;
  const auto table = [&](const char* key, const char* bundled) {
    return root.has(key) ? pathBeside(root, key, root.text(key)) : (fs::path(dataFolder) / bundled).string();
  };
  set.tissues = TissueTable::read(table("tissueTable", "tissues.csv"));
  set.labelTissues = table("labelTissues", "label_tissues.csv");
  readPatients(root, set);
  if (root.has("split"))
  {
    readShares(root.object("split"), set);
  }
  if (root.has("jitter"))
  {
    readJitter(root.object("jitter"), set);
  }
  readProbe(root.object("probe"), dataFolder, set);
  for (const SettingsGroup group : { SettingsGroup::Tracing, SettingsGroup::Echo, SettingsGroup::Display })
  {
    if (root.has(nameOf(group)))
    {
      readGroup(root.object(nameOf(group)), group, set);
    }
  }
  if (root.has("tissues"))
  {
    readTissues(root.object("tissues"), set);
  }
  readMasks(root, set);
  if (root.has("mitralLine"))
  {
    readMitralLine(root.object("mitralLine"), set);
  }
  if (root.has("channels"))
  {
    readChannels(root, set);
  }
  root.refuseOthers();
  checkTogether(set);
  return set;
}

} // namespace sono
