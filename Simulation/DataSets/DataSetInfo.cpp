#include "DataSets/DataSetInfo.h"

#include "Core/Version.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <type_traits>

namespace sono {

namespace {

using Json = nlohmann::ordered_json;

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

/// What the view shows from where it was found, before the probe was jittered.
Json visibilityOf(const StandardView& view)
{
  Json json = { { "score", view.score },
                { "planeOffDeg", view.planeOffDeg },
                { "markOffMm", view.markOffMm },
                { "insidePercent", view.insidePercent } };
  for (const ShownStructure& shown : view.shown)
  {
    json["shownPercent"][shown.structure] = shown.percent;
  }
  json["shadow"] = view.shadow;
  json["shadowDb"] = view.shadowDb;
  return json;
}

Json pointOf(const ImagePoint& point)
{
  return { { "worldMm", vectorOf(point.worldMm) }, { "column", point.column },     { "row", point.row },
           { "offPlaneMm", point.offPlaneMm },     { "inSector", point.inSector }, { "inShadow", point.inShadow } };
}

Json landmarksOf(const std::vector<ImageLandmark>& landmarks)
{
  Json json;
  for (const ImageLandmark& landmark : landmarks)
  {
    Json& entry = json[landmark.name];
    entry = pointOf(landmark.point);
    if (landmark.ring)
    {
      entry["normal"] = vectorOf(landmark.ring->normal);
      entry["radiusMm"] = landmark.ring->radiusMm;
      entry["hinges"] = Json::array();
      for (const ImagePoint& hinge : landmark.hinges)
      {
        entry["hinges"].push_back(pointOf(hinge));
      }
    }
  }
  return json;
}

Json groupOf(std::size_t value, const GroupFacts& group)
{
  Json json = { { "value", value }, { "pixels", group.pixels }, { "inPatient", group.isThere } };
  json["visiblePercent"] = group.pixels > 0 ? Json(100.0 * group.visibleShare) : Json();
  return json;
}

} // namespace

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
  if (facts.found)
  {
    json["visibility"] = visibilityOf(*facts.found);
  }
  json["pose"] = { { "positionMm", vectorOf(facts.pose.positionMm) },
                   { "axial", vectorOf(facts.pose.axial) },
                   { "lateral", vectorOf(facts.pose.lateral) } };
  PoseJitter::visit(facts.jitter, [&](double value, const char* name) { json["jitter"][name] = value; });
  json["flags"] = { { "faceOnSkin", facts.flags.faceOnSkin },
                    { "shareInsideVolume", facts.flags.shareInsideVolume },
                    { "shareShadowed", facts.flags.shareShadowed } };
  for (std::size_t group = 0; group < set.masks.size(); ++group)
  {
    json["masks"][set.masks[group].name] = groupOf(group + 1, facts.groups[group]);
  }
  if (facts.noLandmarks.empty())
  {
    json["landmarks"] = landmarksOf(facts.landmarks);
  }
  else
  {
    json["noLandmarks"] = facts.noLandmarks;
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
  if (std::find(set.channels.begin(), set.channels.end(), ImageChannel::Label) != set.channels.end())
  {
    for (const LabelInfo& label : scene.volume().labels)
    {
      json["labels"][std::to_string(label.id)] = label.name;
    }
  }
  json["software"] = { { "name", "SonoVDB" }, { "version", version() }, { "device", facts.onGpu ? "GPU" : "CPU" } };
  // A label map's names may be in any encoding.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace sono
