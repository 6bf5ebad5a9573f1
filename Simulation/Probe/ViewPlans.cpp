#include "Probe/ViewPlans.h"

#include "Core/Error.h"
#include "Probe/PlaneFit.h"
#include "Probe/WindowTarget.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sono {
namespace {

constexpr const char* phased = "phased_p4-2";
constexpr const char* curved = "curvilinear_c5-2";
const Vec3d backwards(0.0, 1.0, 0.0); // the chest's, of a probe beside the sternum
constexpr double degree = 3.14159265358979323846 / 180.0;
constexpr double besideMm = 30.0;     // of points that tell how a plane lies about an axis
constexpr double aroundMm = 81.0;     // the square root of 2 degrees in a radian
constexpr double aortaMm = 25.0;      // what of the aorta belongs to a view of the heart
constexpr double cavaMm = 70.0;       // what of the inferior vena cava is near the right atrium
constexpr double organReachMm = 60.0; // what of a long organ is near its middle

constexpr std::array<std::pair<const char*, const char*>, 9> heartViews{ {
  { "A4C", "apical four-chamber" },
  { "A2C", "apical two-chamber" },
  { "A3C", "apical three-chamber" },
  { "A5C", "apical five-chamber" },
  { "PLAX", "parasternal long axis" },
  { "PSAX base", "parasternal short axis at the mitral valve" },
  { "PSAX mid", "parasternal short axis at the papillary muscles" },
  { "PSAX apex", "parasternal short axis near the apex" },
  { "SC4C", "subcostal four-chamber" },
} };

/// About a unit axis, right-handed (Rodrigues).
Vec3d turnedAbout(const Vec3d& axis, const Vec3d& v, double radians)
{
  return std::cos(radians) * v + std::sin(radians) * glm::cross(axis, v) +
         (1.0 - std::cos(radians)) * glm::dot(axis, v) * axis;
}

class HeartPlanner
{
public:
  HeartPlanner(const HeartLandmarks& marks, const LabelVolume& volume)
    : marks_(marks)
    , parts_(volume.labels)
    , volume_(volume)
    , axis_(marks.longAxis())
    , septal_(marks.septal())
  {
    // Across the axis, from the anterior wall and the septum towards the inferolateral wall: as from beside the
    // sternum.
    const Vec3d outflow = marks.aortic ? marks.across(marks.aortic->centreMm - marks.mitral.centreMm) : Vec3d(0.0);
    aorticTurn_ = marks.aortic ? std::atan2(glm::dot(glm::cross(septal_, outflow), axis_), glm::dot(septal_, outflow))
                               : 60.0 * degree;
    inferolateral_ = -turnedAbout(axis_, septal_, aorticTurn_);
  }

  ViewPlan plan(const std::string& name, const std::string& title) const
  {
    ViewPlan view;
    view.name = name;
    view.title = title;
    view.preset = phased;
    view.markMm = marks_.apexMm;
    view.mostOffDeg = 6.0;
    view.mostOffMm = 6.0;
    view.rightward = -septal_;
    const bool isShortAxis = name.compare(0, 4, "PSAX") == 0;
    if (isShortAxis)
    {
      planShortAxis(view);
    }
    else
    {
      planLongAxis(view);
    }
    if (!view.refusal.empty())
    {
      return view;
    }
    const PlaneFit fit = fitPlane(view.points);
    view.middleMm = fit.middleMm;
    view.normal = fit.normal();
    view.points = pointsAround(view.markMm, fit);
    const bool isParasternal = isShortAxis || name == "PLAX";
    if (!isParasternal && name != "SC4C" && view.demands.size() > 1)
    {
      // As sonographers keep it: the left ventricle near the middle, the other chambers beside and below.
      view.demands.front().pull = 3.0 * double(view.demands.size() - 1);
    }
    view.look = isParasternal    ? glm::normalize(inferolateral_ + backwards)
                : name == "SC4C" ? glm::normalize(0.5 * axis_ - septal_)
                                 : axis_;
    view.lookDeg = isParasternal ? 55.0 : name == "SC4C" ? 33.0 : 40.0; // subcostal: at least 30 to the long axis
    return view;
  }

private:
  /// Of least squares through them and a place on the skin is a plane whose turn from theirs and whose distance from
  /// the mark weigh alike, degree by millimetre.
  static std::vector<Vec3d> pointsAround(const Vec3d& markMm, const PlaneFit& plane)
  {
    const Vec3d u = aroundMm * plane.axes[1];
    const Vec3d v = aroundMm * plane.axes[2];
    return { markMm + u, markMm - u, markMm + v, markMm - v };
  }

  void planShortAxis(ViewPlan& view) const
  {
    const double level = view.name == "PSAX base" ? 0.85 : view.name == "PSAX mid" ? 0.55 : 0.25;
    view.markMm = marks_.apexMm + level * marks_.lengthMm() * axis_;
    const Vec3d other = glm::cross(axis_, septal_);
    for (const Vec3d& direction : { septal_, -septal_, other, -other })
    {
      view.points.push_back(view.markMm + besideMm * direction);
    }
    view.mostOffDeg = 5.0; // of a slice across, what lies beside it looks much the same: nothing else would tell
    view.mostOffMm = 5.0;
    demand(view, HeartPart::LeftVentricle, 50.0);
    demand(view, HeartPart::LeftWall, 40.0);
  }

  void planLongAxis(ViewPlan& view) const
  {
    const std::string& name = view.name;
    const bool hasRight = name == "A4C" || name == "SC4C";
    const bool hasAorta = name == "A3C" || name == "A5C" || name == "PLAX";
    refuseWithout(view, hasRight, marks_.tricuspid.has_value(), HeartPart::RightAtrium);
    refuseWithout(view, hasAorta, marks_.aortic.has_value(), HeartPart::Aorta);
    if (!view.refusal.empty())
    {
      return;
    }
    view.points = { marks_.apexMm, marks_.mitral.centreMm };
    const bool isParasternal = name == "PLAX";
    demand(view, HeartPart::LeftVentricle, isParasternal ? 30.0 : 50.0);
    if (hasRight)
    {
      view.points.push_back(marks_.tricuspid->centreMm);
      demand(view, HeartPart::RightVentricle, 40.0);
      demand(view, HeartPart::RightAtrium, 40.0);
    }
    if (hasAorta)
    {
      view.points.push_back(marks_.aortic->centreMm);
      demand(view, HeartPart::Aorta, 30.0, marks_.aortic->centreMm, aortaMm);
      view.rightward = -inferolateral_;
    }
    if (name == "A5C")
    {
      view.points[1] = marks_.aortic->centreMm - besideMm * septal_;
      view.rightward = -septal_;
      demand(view, HeartPart::RightVentricle, 20.0);
      return;
    }
    demand(view, HeartPart::LeftAtrium, 40.0);
    if (name == "A2C")
    {
      const double sign = aorticTurn_ < 0.0 ? -1.0 : 1.0;
      const Vec3d anterior =
        turnedAbout(axis_, septal_, marks_.aortic ? 0.5 * (aorticTurn_ + sign * 180.0 * degree) : 120.0 * degree);
      view.points.push_back(marks_.mitral.centreMm + besideMm * anterior);
      view.rightward = anterior;
    }
    if (name == "SC4C")
    {
      view.mostOffDeg = 20.0;
      view.mostOffMm = 15.0;
    }
    if (isParasternal)
    {
      view.rightward = axis_; // the aorta at the right, the apex at the left
    }
  }

  void refuseWithout(ViewPlan& view, bool isNeeded, bool isThere, HeartPart part) const
  {
    if (isNeeded && !isThere)
    {
      view.refusal =
        "It needs the " + std::string(nameOf(part)) + ", which " +
        (parts_.has(part) ? "does not meet its ventricle in the label map." : "the label map does not have.");
    }
  }

  void demand(ViewPlan& view, HeartPart part, double leastPercent, const Vec3d& nearMm = Vec3d(0.0),
              double withinMm = 1e9) const
  {
    ViewDemand demand;
    demand.structure = nameOf(part);
    for (const LabelInfo& label : volume_.labels)
    {
      if (parts_.of(std::uint16_t(label.id)) == part)
      {
        demand.labels.push_back(label.id);
      }
    }
    demand.leastPercent = leastPercent;
    demand.nearMm = nearMm;
    demand.withinMm = withinMm;
    if (!demand.labels.empty()) // a map of cavities alone has no wall to show
    {
      view.demands.push_back(demand);
    }
  }

  const HeartLandmarks& marks_;
  HeartParts parts_;
  const LabelVolume& volume_;
  Vec3d axis_;
  Vec3d septal_;
  Vec3d inferolateral_{ 0.0 };
  double aorticTurn_ = 0.0; // about the axis, from the septum to the aorta
};

/// The middles of an organ's voxels: every other one along each axis is enough.
std::vector<Vec3d> placesOf(const LabelVolume& volume, const std::vector<int>& labels)
{
  std::vector<char> wanted(65536, 0);
  for (const int id : labels)
  {
    wanted[std::size_t(id)] = 1;
  }
  std::vector<Vec3d> places;
  const Vec3i n = volume.placement.size;
  for (int k = 0; k < n.z; k += 2)
  {
    for (int j = 0; j < n.y; j += 2)
    {
      for (int i = 0; i < n.x; i += 2)
      {
        if (wanted[volume.voxels[(std::size_t(k) * n.y + j) * n.x + i]])
        {
          places.push_back(volume.placement.worldFromIndex(Vec3d(i, j, k)));
        }
      }
    }
  }
  return places;
}

struct OrganView
{
  const char* name;
  const char* title;
  const char* organ;  ///< along whose long axis it is
  const char* beside; ///< what else it shows; empty: nothing
  Vec3d look;
};

const std::array<OrganView, 4> organViews{ {
  { "IVC", "subcostal inferior vena cava", "inferior vena cava", "", Vec3d(0.0, 0.9, 0.3) },
  { "RUQ", "right upper quadrant: liver and kidney", "right kidney", "liver", Vec3d(0.9, 0.5, 0.0) },
  { "LUQ", "left upper quadrant: spleen and kidney", "left kidney", "spleen", Vec3d(-0.9, -0.2, 0.0) },
  { "Suprapubic", "suprapubic: bladder", "bladder", "", Vec3d(0.0, 0.9, -0.3) },
} };

/// What a label map has of a structure; a refusal where it has nothing.
void demandOrgan(ViewPlan& view, const Scene& scene, const std::string& structure, double leastPercent)
{
  try
  {
    ViewDemand demand;
    demand.structure = structure;
    demand.labels = windowTarget(scene, structure).labels;
    demand.leastPercent = leastPercent;
    view.demands.push_back(demand);
  }
  catch (const Error&)
  {
    view.refusal = "It needs the " + structure + ", which the label map does not have.";
  }
}

/// Sum of the ways from a point to an organ's places that are near.
Vec3d wayTo(const std::vector<Vec3d>& places, const Vec3d& fromMm)
{
  Vec3d sum(0.0);
  for (const Vec3d& place : places)
  {
    const Vec3d way = place - fromMm;
    sum += glm::length(way) < organReachMm ? way : Vec3d(0.0);
  }
  return sum;
}

/// Along the organ's long axis, and to what it shows beside it, else along the look.
ViewPlan planOrganView(const OrganView& organ, const Scene& scene)
{
  ViewPlan view;
  view.name = organ.name;
  view.title = organ.title;
  view.preset = curved;
  view.look = glm::normalize(organ.look);
  view.lookDeg = 50.0;
  demandOrgan(view, scene, organ.organ, 50.0);
  const std::string besides = organ.beside;
  if (view.refusal.empty() && !besides.empty())
  {
    demandOrgan(view, scene, besides, 20.0);
  }
  if (!view.refusal.empty())
  {
    return view;
  }
  std::vector<Vec3d> places = placesOf(scene.volume(), view.demands[0].labels);
  double reachMm = organReachMm;
  if (view.name == "IVC") // its upper end, where the liver's veins join it
  {
    reachMm = cavaMm;
    const auto lower = [](const Vec3d& a, const Vec3d& b) { return a.z < b.z; };
    const double leastZ = std::max_element(places.begin(), places.end(), lower)->z - cavaMm;
    places.erase(std::remove_if(places.begin(), places.end(), [&](const Vec3d& place) { return place.z < leastZ; }),
                 places.end());
  }
  const PlaneFit fit = fitPlane(places);
  const Vec3d along = fit.axes[2];
  const Vec3d beside =
    besides.empty() ? view.look : wayTo(placesOf(scene.volume(), view.demands[1].labels), fit.middleMm);
  const Vec3d across = glm::cross(along, beside);
  if (glm::length(across) == 0.0)
  {
    view.refusal = "The " + besides + " is not beside the " + organ.organ + " in the label map.";
    return view;
  }
  view.middleMm = fit.middleMm;
  view.markMm = fit.middleMm;
  view.normal = glm::normalize(across);
  view.points = { fit.middleMm, fit.middleMm + besideMm * along, fit.middleMm - besideMm * along };
  view.rightward = Vec3d(0.0, 0.0, -1.0); // the head at the image's left
  view.mostOffDeg = 25.0;
  view.mostOffMm = 10.0;
  for (ViewDemand& demand : view.demands)
  {
    demand.nearMm = fit.middleMm;
    demand.withinMm = reachMm;
  }
  return view;
}

} // namespace

std::vector<ViewPlan> planHeartViews(const HeartLandmarks& landmarks, const LabelVolume& volume)
{
  const HeartPlanner planner(landmarks, volume);
  std::vector<ViewPlan> plans;
  for (const auto& [name, title] : heartViews)
  {
    plans.push_back(planner.plan(name, title));
  }
  return plans;
}

std::vector<ViewPlan> planStandardViews(const Scene& scene)
{
  std::vector<ViewPlan> plans;
  try
  {
    plans = planHeartViews(findHeartLandmarks(scene.volume()), scene.volume());
  }
  catch (const Error& error)
  {
    for (const auto& [name, title] : heartViews)
    {
      ViewPlan view;
      view.name = name;
      view.title = title;
      view.refusal = error.what();
      plans.push_back(view);
    }
  }
  for (const OrganView& organ : organViews)
  {
    plans.push_back(planOrganView(organ, scene));
  }
  return plans;
}

} // namespace sono
