// Standard views: how many are found, how far their planes are off where the body's own landmarks say.
#include "Labels/AssignTissues.h"
#include "Labels/ReadLabelMap.h"
#include "Phantoms/ThoraxLandmarks.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Probe/StandardViews.h"
#include "Stage.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace sono {
namespace {

const std::string data = SONOVDB_DATA_DIR;

ProbeSettings probeOf(const std::string& preset)
{
  return readProbePreset(data + "/probes/" + preset + ".json");
}

/// Of a heart that was fitted into a thorax, as its file says.
HeartLandmarks fittedLandmarks(const std::filesystem::path& file)
{
  const auto all = nlohmann::json::parse(std::ifstream(file)).at("landmarks");
  const auto point = [&](const char* name) {
    const auto& at = all.at(name);
    return Vec3d(at[0].get<double>(), at[1].get<double>(), at[2].get<double>());
  };
  HeartLandmarks marks;
  marks.apexMm = point("LV_apex_endocardium");
  marks.mitral.centreMm = point("mitral_annulus_centre");
  marks.tricuspid = Annulus{ point("tricuspid_annulus_centre") };
  marks.aortic = Annulus{ point("aortic_valve_centre") };
  return marks;
}

class ViewFigures
{
public:
  void add(const std::string& body, LabelVolume volume, const HeartLandmarks& known)
  {
    const auto table = TissueTable::read(data + "/tissues.csv");
    assignTissues(volume, LabelTissueMap::read(data + "/label_tissues.csv"), table, "soft_tissue");
    const Scene scene(std::move(volume), table, "air");
    Stopwatch watch;
    const std::vector<StandardView> views = findStandardViews(scene, probeOf);
    slowestS_ = std::max(slowestS_, watch.lap());
    const std::vector<ViewPlan> plans = planHeartViews(known, scene.volume());
    for (std::size_t i = 0; i < plans.size(); ++i)
    {
      addView(body, views[i], plans[i]);
    }
    for (std::size_t i = plans.size(); i < views.size(); ++i)
    {
      std::fprintf(stderr, "%s: %s\n", body.c_str(), describe(views[i]).c_str());
    }
  }

  void print() const
  {
    const double percent = 100.0 / double(asked_);
    printFigure("views_asked", asked_, "views");
    printFigure("views_found_percent", percent * found_, "%", "at least 95");
    printFigure("views_within_percent", percent * within_, "%");
    printFigure("views_plane_error_mean_deg", sumDeg_ / found_, "deg");
    printFigure("views_plane_error_max_deg", mostDeg_, "deg", "at most 5");
    printFigure("views_mark_distance_max_mm", mostMm_, "mm", "at most 5");
    printFigure("views_search_s", slowestS_, "s");
  }

private:
  void addView(const std::string& body, const StandardView& view, const ViewPlan& known)
  {
    ++asked_;
    std::fprintf(stderr, "%s: %s", body.c_str(), describe(view).c_str());
    if (!view.refusal.empty())
    {
      std::fprintf(stderr, "\n");
      return;
    }
    const Vec3d normal = glm::cross(view.pose.axial, view.pose.lateral);
    const double deg = std::acos(std::min(1.0, std::abs(glm::dot(normal, known.normal)))) * 180.0 / 3.14159265358979;
    const double mm = std::abs(glm::dot(normal, known.markMm - view.pose.positionMm));
    std::fprintf(stderr, " Known: %.1f degrees and %.1f mm off.\n", deg, mm);
    ++found_;
    within_ += deg <= 5.0 && mm <= 5.0 ? 1 : 0;
    sumDeg_ += deg;
    mostDeg_ = std::max(mostDeg_, deg);
    mostMm_ = std::max(mostMm_, mm);
  }

  int asked_ = 0;
  int found_ = 0;
  int within_ = 0; // found, and no more than 5 degrees and 5 mm off
  double sumDeg_ = 0.0;
  double mostDeg_ = 0.0;
  double mostMm_ = 0.0;
  double slowestS_ = 0.0;
};

void measureViews()
{
  ViewFigures figures;
  for (const double spacingMm : { 1.0, 1.5, 2.0 })
  {
    char body[40];
    std::snprintf(body, sizeof body, "bundled thorax, %.1f mm", spacingMm);
    figures.add(body, makeThoraxPhantom(spacingMm), thoraxLandmarks(ThoraxBody(ThoraxParameters{})));
  }
  const std::filesystem::path fitted = std::filesystem::path(SONOVDB_SHARED_DATA_DIR) / "thorax_heart";
  if (std::filesystem::exists(fitted / "landmarks.json"))
  {
    figures.add("thorax_heart", readLabelMap((fitted / "thorax_heart.nii.gz").string()),
                fittedLandmarks(fitted / "landmarks.json"));
  }
  else
  {
    std::fprintf(stderr, "%s is not there\n", fitted.c_str());
  }
  figures.print();
}

const Stage stage("views", measureViews);

} // namespace
} // namespace sono
