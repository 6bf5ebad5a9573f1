#include "Scene/SceneText.h"

#include "Scene/SceneFile.h"

#include <nlohmann/json.hpp>

namespace sono {

namespace {

using Json = nlohmann::json;

Json jsonOf(const Vec3d& v)
{
  return { v.x, v.y, v.z };
}
Json jsonOf(const Vec3i& v)
{
  return { v.x, v.y, v.z };
}

template<class Vec>
Vec vecOf(const Json& json)
{
  return { json.at(0), json.at(1), json.at(2) };
}

Json jsonOf(const GridPlacement& placement)
{
  return { { "size", jsonOf(placement.size) },
           { "originMm", jsonOf(placement.originMm) },
           { "spacingMm", jsonOf(placement.spacingMm) },
           { "directionColumns",
             { jsonOf(placement.direction[0]), jsonOf(placement.direction[1]), jsonOf(placement.direction[2]) } } };
}

GridPlacement placementOf(const Json& json)
{
  GridPlacement placement;
  placement.size = vecOf<Vec3i>(json.at("size"));
  placement.originMm = vecOf<Vec3d>(json.at("originMm"));
  placement.spacingMm = vecOf<Vec3d>(json.at("spacingMm"));
  for (int axis = 0; axis < 3; ++axis)
  {
    placement.direction[axis] = vecOf<Vec3d>(json.at("directionColumns").at(std::size_t(axis)));
  }
  return placement;
}

Json jsonOf(const Tissue& tissue)
{
  Json json = { { "name", tissue.name }, { "source", tissue.source } };
  for (const TissueColumn& column : tissueColumns())
  {
    json[column.name] = tissue.*column.member;
  }
  return json;
}

Tissue tissueOf(const Json& json)
{
  Tissue tissue;
  tissue.name = json.at("name");
  tissue.source = json.at("source");
  for (const TissueColumn& column : tissueColumns())
  {
    double& number = tissue.*column.member;
    // Files from before the second harmonic lack this one.
    number =
      column.member == &Tissue::nonlinearity ? json.value(column.name, number) : json.at(column.name).get<double>();
  }
  return tissue;
}

Json jsonOf(const LabelInfo& label, const VoxelBox& box)
{
  Json json = { { "id", label.id },
                { "name", label.name },
                { "tissue", label.tissue },
                { "first", jsonOf(box.first) },
                { "last", jsonOf(box.last) } };
  if (label.hasColor)
  {
    json["color"] = label.color;
  }
  if (label.guessed)
  {
    json["guessed"] = true;
  }
  if (!label.code.empty())
  {
    json["code"] = label.code;
  }
  return json;
}

LabelInfo labelOf(const Json& json)
{
  LabelInfo label;
  label.id = json.at("id").get<std::uint16_t>();
  label.name = json.at("name");
  label.tissue = json.at("tissue");
  label.hasColor = json.contains("color");
  if (label.hasColor)
  {
    label.color = json.at("color");
  }
  label.guessed = json.value("guessed", false);
  label.code = json.value("code", std::string());
  return label;
}

SceneText parse(const Json& json)
{
  SceneText text;
  text.placement = placementOf(json.at("placement"));
  text.outsideTissue = json.at("outsideTissue");
  text.bandMm = json.at("bandMm");
  text.smoothingMm = json.at("smoothingMm");
  for (const Json& label : json.at("labels"))
  {
    text.labels.push_back(labelOf(label));
    text.boxes.push_back({ vecOf<Vec3i>(label.at("first")), vecOf<Vec3i>(label.at("last")) });
  }
  for (const Json& tissue : json.at("tissues"))
  {
    text.tissues.add(tissueOf(tissue));
  }
  return text;
}

} // namespace

std::string sceneText(const Scene& scene)
{
  Json json = { { "sonovdb_format", sceneFileFormat }, { "placement", jsonOf(scene.placement()) } };
  const int outside = scene.outsideIndex();
  json["outsideTissue"] = outside < 0 ? "" : scene.tissues()[std::size_t(outside)].name;
  for (const LabelInfo& label : scene.volume().labels)
  {
    const SurfaceField& surface = scene.surface(label.id);
    json["labels"].push_back(jsonOf(label, surface.box));
    json["bandMm"] = surface.bandMm;
    json["smoothingMm"] = surface.smoothingMm;
  }
  for (const Tissue& tissue : scene.tissues())
  {
    json["tissues"].push_back(jsonOf(tissue));
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace); // names may be in another encoding
}

SceneText parseSceneText(const std::string& path, const std::string& text)
{
  try
  {
    const Json json = Json::parse(text);
    const int format = json.at("sonovdb_format");
    if (format < oldestSceneFileFormat)
    {
      throw Error("cannot read '" + path + "': SonoVDB 0.1 wrote it (format " + std::to_string(format) +
                  "), without the tissues' roughness and backscatter; write it again from its label map.");
    }
    if (format > sceneFileFormat)
    {
      throw Error("cannot read '" + path + "': a newer SonoVDB wrote it (format " + std::to_string(format) +
                  ", this one reads up to " + std::to_string(sceneFileFormat) + "); update SonoVDB.");
    }
    return parse(json);
  }
  catch (const Json::exception&)
  {
    throw Error("cannot read '" + path + "': its description of the scene is incomplete; write the scene again.");
  }
}

} // namespace sono
