#include "DataSets/DataSetInfo.h"

#include "Core/Version.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <type_traits>

namespace sono {

namespace {

using Json = nlohmann::ordered_json;

constexpr double softTissueDbPerCmMHz = 0.5;
constexpr double shadowDb = 20.0;

Json vectorOf(const Vec3d& v)
{
  return Json::array({ v.x, v.y, v.z });
}

Json settingsOf(const DataSetSettings& settings, SettingsGroup group)
{
  Json json;
  DataSetSettings::visit(settings, group, [&](const auto& value, const Parameter& parameter) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_enum_v<Value>)
    {
      json[parameter.name] = parameter.choices[std::size_t(value)];
    }
    else
    {
      json[parameter.name] = value;
    }
  });
  json.erase("device");
  return json;
}

Json tissuesOf(const Scene& scene)
{
  Json json;
  for (const Tissue& tissue : scene.tissues())
  {
    for (const TissueColumn& column : tissueColumns())
    {
      json[tissue.name][column.name] = tissue.*column.member;
    }
  }
  return json;
}

} // namespace

double shareShadowed(const std::vector<ScanLine>& lines, const ImageSettings& settings, const TracedLines& traced)
{
  double all = 0.0;
  double shadowed = 0.0;
  const int bins = std::min(traced.binCount, int(settings.geometry.rangeMm() / traced.binMm));
  for (std::size_t line = 0; line + 1 < lines.size(); ++line)
  {
    for (int bin = 0; bin < bins; ++bin)
    {
      const double r = (bin + 0.5) * traced.binMm;
      // Echoes go there and back.
      const double db = -2.0 * softTissueDbPerCmMHz * settings.tracing.frequencyMHz * r / 10.0 - shadowDb;
      const double area =
        glm::distance(lines[line].originMm + r * lines[line].axis, lines[line + 1].originMm + r * lines[line + 1].axis);
      all += area;
      const double intensity = traced.intensity[line * std::size_t(traced.binCount) + std::size_t(bin)];
      shadowed += intensity < std::pow(10.0, db / 20.0) ? area : 0.0;
    }
  }
  return all > 0.0 ? shadowed / all : 0.0;
}

std::string describeImage(const DataSetPlan& plan, const Scene& scene, const DataSetFacts& facts)
{
  const DataSet& set = plan.set();
  const PlannedImage& image = facts.image;
  const PlannedBody& body = plan.bodies()[std::size_t(image.body)];
  const DataSetPatient& patient = plan.patientOf(image.body);
  Json json;
  json["case"] = plan.caseName(image.index);
  json["dataSet"] = set.name;
  json["seed"] = set.seed;
  json["index"] = image.index;
  json["exam"] = image.exam;
  json["split"] = nameOf(body.split);
  json["patient"] = { { "id", patient.id },
                      { "copy", body.copy },
                      { "stretch", vectorOf(body.augmentation.stretch) },
                      { "extraFatMm", body.augmentation.extraFatMm },
                      { "warp",
                        { { "amplitudeMm", body.augmentation.warpAmplitudeMm },
                          { "wavelengthMm", body.augmentation.warpWavelengthMm },
                          { "seed", body.augmentation.warpSeed } } },
                      { "mirror", body.augmentation.isMirrored },
                      { "licence", patient.licence },
                      { "provenance", patient.provenance } };
  if (body.thoraxSeed)
  {
    const ThoraxParameters thorax = thoraxOf(body);
    ThoraxParameters::visit(
      thorax, [&](double value, const Parameter& parameter) { json["patient"]["thorax"][parameter.name] = value; });
  }
  json["view"] = patient.views[std::size_t(image.view)].name;
  json["pose"] = { { "positionMm", vectorOf(facts.pose.positionMm) },
                   { "axial", vectorOf(facts.pose.axial) },
                   { "lateral", vectorOf(facts.pose.lateral) } };
  PoseJitter::visit(facts.jitter, [&](double value, const char* name) { json["jitter"][name] = value; });
  json["flags"] = { { "faceOnSkin", facts.flags.faceOnSkin },
                    { "shareInsideVolume", facts.flags.shareInsideVolume },
                    { "shareShadowed", facts.flags.shareShadowed } };
  for (std::size_t group = 0; group < set.masks.size(); ++group)
  {
    json["masks"][set.masks[group].name] = { { "value", group + 1 },
                                             { "pixels", facts.groupPixels[group] },
                                             { "inPatient", bool(facts.groupIsThere[group]) } };
  }
  json["image"] = { { "width", facts.width },
                    { "height", facts.height },
                    { "pixelMm", set.pixelMm },
                    { "lateralMinMm", facts.lateralMinMm },
                    { "axialMinMm", facts.axialMinMm } };
  for (const SettingsGroup group :
       { SettingsGroup::Probe, SettingsGroup::Tracing, SettingsGroup::Echo, SettingsGroup::Display })
  {
    json[nameOf(group)] = settingsOf(facts.settings, group);
  }
  json["tissues"] = tissuesOf(scene);
  json["software"] = { { "name", "SonoVDB" }, { "version", version() }, { "device", facts.onGpu ? "GPU" : "CPU" } };
  return json.dump(1) + "\n";
}

} // namespace sono
