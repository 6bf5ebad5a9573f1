#include "Core/Progress.h"
#include "Probe/ArrayAperture.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <type_traits>

namespace sono {

namespace {

using Json = nlohmann::json;

/// The keys of one preset file, taken one by one; what is left at the end is a mistake.
class PresetReader
{
public:
  PresetReader(const std::string& path, const Json& json)
    : path_(path)
    , json_(json)
  {
  }

  std::string text(const std::string& key)
  {
    const Json& value = take(key);
    if (!value.is_string() || value.get<std::string>().empty())
    {
      throw Error("'" + path_ + "': '" + key + "' is not a text; write one in quotes.");
    }
    return value.get<std::string>();
  }

  double number(const std::string& key)
  {
    const Json& entry = take(key);
    const bool sourced = entry.is_object() && entry.contains("value") && entry["value"].is_number() &&
                         entry.contains("source") && entry["source"].is_string() &&
                         !entry["source"].get<std::string>().empty();
    if (!sourced)
    {
      throw Error("'" + path_ + "': '" + key + "' is not of the form {\"value\": number, \"source\": \"text\"}.");
    }
    return entry["value"].get<double>();
  }

  template<class Value>
  Value inRange(const std::string& key, const Range& range)
  {
    const double value = number(key);
    const bool isWhole = std::is_same_v<Value, int>;
    require(key, range.contains(value) && (!isWhole || value == std::floor(value)),
            (isWhole ? "a whole number " : "a number ") + range.text());
    return Value(value);
  }

  const std::string& path() const { return path_; }

  double positive(const std::string& key)
  {
    const double value = number(key);
    require(key, std::isfinite(value) && value > 0.0, "a number above 0");
    return value;
  }

  int count(const std::string& key, int maximum)
  {
    const double value = number(key);
    const bool ok = value >= 1.0 && value <= maximum && value == std::floor(value);
    require(key, ok, "a whole number from 1 to " + std::to_string(maximum));
    return int(value);
  }

  void require(const std::string& key, bool ok, const std::string& range) const
  {
    if (!ok)
    {
      throw Error("'" + path_ + "': '" + key + "' is out of range; write " + range + ".");
    }
  }

  void refuseOthers() const
  {
    for (const auto& entry : json_.items())
    {
      if (taken_.count(entry.key()) == 0)
      {
        throw Error("'" + path_ + "': '" + entry.key() +
                    "' means nothing for this kind of probe; remove or correct it.");
      }
    }
  }

private:
  const Json& take(const std::string& key)
  {
    if (!json_.contains(key))
    {
      throw Error("'" + path_ + "' lacks '" + key + "'; add it.");
    }
    taken_.insert(key);
    return json_[key];
  }

  std::string path_;
  const Json& json_;
  std::set<std::string> taken_;
};

Json parseFile(const std::string& path)
{
  std::ifstream stream(path);
  if (!stream)
  {
    throw Error("cannot read '" + path + "': no such file, or no permission to read it.");
  }
  const Json json = Json::parse(stream, nullptr, false);
  if (!json.is_object())
  {
    throw Error("'" + path + "' is not a JSON object; compare it with the bundled presets.");
  }
  return json;
}

/// Preset files call two numbers otherwise.
std::string keyOf(const Parameter& parameter)
{
  const std::string name = parameter.name;
  return name == "lineCount" ? "numberOfLines" : name == "elevationLineCount" ? "numberOfElevations" : name;
}

ScanGeometry readGeometry(PresetReader& reader)
{
  const std::string name = reader.text("scan");
  std::string names;
  int found = -1;
  for (const ScanKindTraits& traits : scanKinds())
  {
    names += (names.empty() ? "\"" : ", \"") + std::string(traits.presetName) + "\"";
    if (name == traits.presetName)
    {
      found = int(&traits - scanKinds().data());
    }
  }
  reader.require("scan", found >= 0, "one of " + names);
  ScanGeometry geometry;
  geometry.kind = ScanKind(found);
  ScanGeometry::visitLayout(geometry, [&](auto& value, const Parameter& parameter) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (!std::is_same_v<Value, ScanKind>)
    {
      if (geometry.uses(parameter))
      {
        value = reader.inRange<Value>(keyOf(parameter), geometry.rangeOf(parameter));
      }
    }
  });
  try
  {
    geometry.validate(); // what depends on the kind
  }
  catch (const Error& error)
  {
    throw Error("'" + reader.path() + "': " + error.what());
  }
  return geometry;
}

} // namespace

ProbePreset readProbePreset(const std::string& path)
{
  const Json json = parseFile(path);
  PresetReader reader(path, json);
  ProbePreset preset;
  preset.name = reader.text("name");
  preset.geometry = readGeometry(reader);
  ProbeSettings::visitPulse(preset, [&](double& value, const Parameter& parameter) {
    value = reader.inRange<double>(parameter.name, parameter.range);
  });
  preset.elementCount = reader.count("elementCount", 65536);
  preset.elementWidthMm = reader.positive("elementWidthMm");
  preset.elementHeightMm = reader.positive("elementHeightMm");
  preset.kerfMm = reader.number("kerfMm");
  reader.require("kerfMm", std::isfinite(preset.kerfMm) && preset.kerfMm >= 0.0, "a number of at least 0");
  preset.elevationFocusMm = reader.positive("elevationFocusMm");
  preset.transmitFocusMm = reader.positive("transmitFocusMm");
  reader.refuseOthers();
  const ArrayAperture active = apertureOf(preset);
  preset.apertureMm = active.widthMm();
  preset.elevationApertureMm = active.elevationWidthMm();
  return preset;
}

} // namespace sono
