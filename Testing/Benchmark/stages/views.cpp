// Standard views of drawn bodies: how many are found, how far their planes are off where the bodies' own landmarks say.
#include "Folders.h"
#include "Labels/AssignTissues.h"
#include "Labels/ReadLabelMap.h"
#include "Phantoms/DrawThorax.h"
#include "Phantoms/ThoraxLandmarks.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Probe/StandardViews.h"
#include "Stage.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace sono {
namespace {

const std::string data = dataFolder();
constexpr int drawnBodies = 200;
constexpr int supineBodies = 10; // the first of them, on their backs
constexpr double mostDeg = 5.0;  // a view may be off
constexpr double mostMm = 5.0;

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

/// What was measured of one kind of thing, in the order of the bodies.
class Sample
{
public:
  void add(double value) { values_.push_back(value); }
  double max() const { return values_.empty() ? 0.0 : *std::max_element(values_.begin(), values_.end()); }
  double mean() const
  {
    return values_.empty() ? 0.0 : std::accumulate(values_.begin(), values_.end(), 0.0) / double(values_.size());
  }
  double percentile(double percent) const
  {
    std::vector<double> sorted = values_;
    std::sort(sorted.begin(), sorted.end());
    return sorted.empty() ? 0.0 : sorted[std::size_t(std::ceil(0.01 * percent * double(sorted.size()))) - 1];
  }

private:
  std::vector<double> values_;
};

/// How often a view was found.
struct ViewCount
{
  std::string name;
  int asked = 0;
  int found = 0;
  int within = 0; ///< found, and no more than 5 degrees and 5 mm off
};

class ViewFigures
{
public:
  void add(const std::string& body, LabelVolume volume, const HeartLandmarks& known)
  {
    const auto table = TissueTable::read(data + "/tissues.csv");
    assignTissues(volume, LabelTissueMap::read(data + "/label_tissues.csv"), table, "soft_tissue");
    addLandmarks(body, findHeartLandmarks(volume), known);
    const Scene scene(std::move(volume), table, "air");
    Stopwatch watch;
    const std::vector<StandardView> views = findStandardViews(scene, probeOf);
    searchS_.add(watch.lap());
    std::vector<ViewPlan> plans = planHeartViews(known, scene.volume());
    const std::size_t cava =
      plans.size(); // the next one in their order; its plane is known by the vessel's voxels alone
    plans.push_back(planStandardViews(scene)[cava]);
    for (std::size_t i = 0; i < plans.size(); ++i)
    {
      if (plans[i].refusal.empty())
      {
        addView(body, views[i], plans[i]);
      }
    }
  }

  double foundPercent() const { return percentOf(&ViewCount::found); }

  void print() const
  {
    printFigure("views_asked", sumOf(&ViewCount::asked), "views");
    printFigure("views_found_percent", foundPercent(), "%", "at least 95");
    printFigure("views_within_percent", percentOf(&ViewCount::within), "%", "at least 95");
    for (const ViewCount& count : counts_)
    {
      std::string name = "view_within_" + count.name + "_percent";
      std::replace(name.begin(), name.end(), ' ', '_');
      printFigure(name, 100.0 * count.within / count.asked, "%", "at least 95");
    }
    printFigure("views_plane_error_mean_deg", planeDeg_.mean(), "deg");
    printFigure("views_plane_error_95_deg", planeDeg_.percentile(95.0), "deg");
    printFigure("views_plane_error_max_deg", planeDeg_.max(), "deg", "at most 5");
    printFigure("views_mark_distance_95_mm", markMm_.percentile(95.0), "mm");
    printFigure("views_mark_distance_max_mm", markMm_.max(), "mm", "at most 5");
    printFigure("landmark_apex_error_mean_mm", apexMm_.mean(), "mm");
    printFigure("landmark_apex_error_max_mm", apexMm_.max(), "mm");
    printFigure("landmark_annulus_error_mean_mm", annulusMm_.mean(), "mm");
    printFigure("landmark_annulus_error_max_mm", annulusMm_.max(), "mm");
    printFigure("views_search_mean_s", searchS_.mean(), "s");
    printFigure("views_search_max_s", searchS_.max(), "s");
  }

private:
  int sumOf(int ViewCount::*of) const
  {
    return std::accumulate(counts_.begin(), counts_.end(), 0,
                           [of](int before, const ViewCount& count) { return before + count.*of; });
  }
  double percentOf(int ViewCount::*of) const { return 100.0 * sumOf(of) / sumOf(&ViewCount::asked); }

  void addLandmarks(const std::string& body, const HeartLandmarks& found, const HeartLandmarks& known)
  {
    const double apex = glm::distance(found.apexMm, known.apexMm);
    const double mitral = glm::distance(found.mitral.centreMm, known.mitral.centreMm);
    const double tricuspid = glm::distance(found.tricuspid->centreMm, known.tricuspid->centreMm);
    const double aortic = glm::distance(found.aortic->centreMm, known.aortic->centreMm);
    apexMm_.add(apex);
    annulusMm_.add(mitral);
    annulusMm_.add(tricuspid);
    annulusMm_.add(aortic);
    std::fprintf(stderr, "%s: apex %.1f, mitral %.1f, tricuspid %.1f, aortic annulus %.1f mm off.\n", body.c_str(),
                 apex, mitral, tricuspid, aortic);
  }

  void addView(const std::string& body, const StandardView& view, const ViewPlan& known)
  {
    ViewCount& count = countOf(view.name);
    ++count.asked;
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
    ++count.found;
    count.within += deg <= mostDeg && mm <= mostMm ? 1 : 0;
    planeDeg_.add(deg);
    markMm_.add(mm);
  }

  ViewCount& countOf(const std::string& name)
  {
    const auto at =
      std::find_if(counts_.begin(), counts_.end(), [&](const ViewCount& count) { return count.name == name; });
    return at != counts_.end() ? *at : counts_.emplace_back(ViewCount{ name });
  }

  std::vector<ViewCount> counts_;
  Sample planeDeg_;
  Sample markMm_;
  Sample apexMm_;
  Sample annulusMm_; // of all three annuli
  Sample searchS_;
};

void addDrawn(int seed, const ThoraxParameters& parameters, double spacingMm, ViewFigures& figures)
{
  char body[60];
  std::snprintf(body, sizeof body, "seed %d, %.1f left lateral, %.1f mm", seed, parameters.leftLateral, spacingMm);
  figures.add(body, makeThoraxPhantom(spacingMm, parameters), thoraxLandmarks(ThoraxBody(parameters)));
}

void measureViews()
{
  ViewFigures supine;
  for (int seed = 1; seed <= supineBodies; ++seed)
  {
    ThoraxParameters parameters = drawThoraxParameters(std::uint64_t(seed));
    parameters.leftLateral = 0.0;
    addDrawn(seed, parameters, 2.0, supine);
  }
  ViewFigures figures;
  for (int seed = 1; seed <= drawnBodies; ++seed)
  {
    const double spacingMm = seed % 20 == 0 ? 1.0 : seed % 20 == 10 ? 1.5 : 2.0; // mostly the quickest that is valid
    addDrawn(seed, drawThoraxParameters(std::uint64_t(seed)), spacingMm, figures);
  }
  const std::filesystem::path fitted = std::filesystem::path(sharedDataFolder()) / "thorax_heart";
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
  printFigure("views_supine_found_percent", supine.foundPercent(), "%");
}

const Stage stage("views", measureViews);

} // namespace
} // namespace sono
