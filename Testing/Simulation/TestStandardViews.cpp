#include "Probe/StandardViews.h"

#include "Folders.h"
#include "Labels/AssignTissues.h"
#include "Phantoms/ThoraxLandmarks.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Probe/PlaneFit.h"
#include "TestScenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace {

using namespace sono;
using namespace sono::test;

const std::string data = dataFolder();

ProbeSettings probeOf(const std::string& preset)
{
  return readProbePreset(data + "/probes/" + preset + ".json");
}

const StandardView& viewOf(const std::vector<StandardView>& views, const std::string& name)
{
  return *std::find_if(views.begin(), views.end(), [&](const StandardView& view) { return view.name == name; });
}

double degreesBetween(const Vec3d& a, const Vec3d& b)
{
  return std::acos(std::min(1.0, std::abs(glm::dot(glm::normalize(a), glm::normalize(b))))) * 57.29577951308232;
}

std::unique_ptr<Scene> sceneOf(LabelVolume volume)
{
  const auto table = TissueTable::read(data + "/tissues.csv");
  assignTissues(volume, LabelTissueMap::read(data + "/label_tissues.csv"), table, "soft_tissue");
  return std::make_unique<Scene>(std::move(volume), table, "air");
}

/// Planes that can be told by hand: the long axis along z, the tricuspid annulus at -x, the aorta at -y.
TEST(ViewPlans, OfLandmarksOnTheAxes)
{
  HeartLandmarks marks;
  marks.apexMm = Vec3d(0.0);
  marks.mitral.centreMm = Vec3d(0.0, 0.0, 90.0);
  marks.rightVentricleMm = Vec3d(-35.0, 0.0, 50.0);
  LabelVolume volume;
  const auto normalOf = [&](const std::string& name) {
    const auto plans = planHeartViews(marks, volume);
    const auto plan = std::find_if(plans.begin(), plans.end(), [&](const ViewPlan& p) { return p.name == name; });
    EXPECT_EQ(plan->refusal, "") << name;
    return plan->normal;
  };
  EXPECT_LT(degreesBetween(normalOf("A2C"), Vec3d(std::sqrt(3.0) / 2.0, 0.5, 0.0)), 1e-4); // 60 degrees from A4C
  for (const ViewPlan& plan : planHeartViews(marks, volume))
  {
    const std::set<std::string> without{ "A4C", "SC4C", "A3C", "A5C", "PLAX" };
    EXPECT_EQ(!plan.refusal.empty(), without.count(plan.name) == 1) << plan.name;
  }
  marks.tricuspid = Annulus{ Vec3d(-45.0, 0.0, 85.0), Vec3d(0.0, 0.0, 1.0), 18.0 };
  marks.aortic = Annulus{ Vec3d(0.0, -25.0, 90.0), Vec3d(0.0, 0.0, 1.0), 11.0 };
  EXPECT_LT(degreesBetween(normalOf("A4C"), Vec3d(0.0, 1.0, 0.0)), 1e-4);
  EXPECT_LT(degreesBetween(normalOf("SC4C"), Vec3d(0.0, 1.0, 0.0)), 1e-4);
  EXPECT_LT(degreesBetween(normalOf("A3C"), Vec3d(1.0, 0.0, 0.0)), 1e-4);
  EXPECT_LT(degreesBetween(normalOf("PLAX"), Vec3d(1.0, 0.0, 0.0)), 1e-4);
  EXPECT_LT(degreesBetween(normalOf("A2C"), Vec3d(1.0, 1.0, 0.0)), 1e-4); // between them, not through the septum
  EXPECT_LT(degreesBetween(normalOf("A5C"), Vec3d(0.0, 90.0, 25.0)), 1e-4);
  for (const char* name : { "PSAX base", "PSAX mid", "PSAX apex" })
  {
    EXPECT_LT(degreesBetween(normalOf(name), Vec3d(0.0, 0.0, 1.0)), 1e-4) << name;
  }
}

/// Of all planes through a place the one with the least sum of its angle's square, in degrees, and of its distance's
/// from the mark, in millimetres: closed form for small angles.
TEST(ViewPlans, ADegreeOffWeighsAsAMillimetre)
{
  HeartLandmarks marks;
  marks.mitral.centreMm = Vec3d(0.0, 0.0, 90.0);
  marks.tricuspid = Annulus{ Vec3d(-45.0, 0.0, 85.0), Vec3d(0.0, 0.0, 1.0), 18.0 };
  const ViewPlan a4c = planHeartViews(marks, LabelVolume()).front();
  ASSERT_EQ(a4c.name, "A4C");
  const double degree = 1.0 / 57.29577951308232;
  for (const double alongMm : { 20.0, 60.0, 120.0 })
  {
    const double asideMm = 3.0;
    const Vec3d place(0.0, asideMm, -alongMm);
    const PlaneFit fit = fitPlaneThrough(place, a4c.points, std::vector<double>(a4c.points.size(), 1.0));
    const double turn = asideMm * alongMm / (1.0 / (degree * degree) + alongMm * alongMm);
    EXPECT_NEAR(degreesBetween(fit.normal(), Vec3d(0.0, 1.0, 0.0)), turn / degree, 0.01);
    EXPECT_NEAR(std::abs(glm::dot(fit.normal(), place)), asideMm - turn * alongMm, 0.01);
  }
}

/// The plane of a view by the numbers that draw a thorax, in the world.
struct KnownPlane
{
  const char* name;
  Vec3d normal;
  Vec3d markMm;
};

std::vector<KnownPlane> knownPlanes(const HeartLandmarks& drawn)
{
  const Vec3d apex = drawn.apexMm;
  const Vec3d longAxis = drawn.mitral.centreMm - apex;
  const Vec3d toAorta = drawn.aortic->centreMm - apex;
  const Vec3d toTricuspid = drawn.tricuspid->centreMm - apex;
  const auto across = [&](const Vec3d& v) {
    return v - glm::dot(v, longAxis) / glm::dot(longAxis, longAxis) * longAxis;
  };
  const Vec3d fourChambers = glm::cross(longAxis, toTricuspid);
  const Vec3d outflow = glm::cross(longAxis, toAorta);
  return {
    { "A4C", fourChambers, apex },
    { "A3C", outflow, apex },
    { "A5C", glm::cross(across(toTricuspid), toAorta), apex },
    { "A2C", glm::cross(longAxis, glm::normalize(across(toTricuspid)) - glm::normalize(across(toAorta))), apex },
    { "PSAX apex", longAxis, apex + 0.25 * longAxis },
    { "PLAX", outflow, apex },
    { "PSAX mid", longAxis, apex + 0.55 * longAxis },
    { "PSAX base", longAxis, apex + 0.85 * longAxis },
    { "SC4C", fourChambers, apex },
  };
}

void expectNear(const StandardView& view, const KnownPlane& plane)
{
  EXPECT_EQ(view.refusal, "") << plane.name;
  const Vec3d normal = glm::cross(view.pose.axial, view.pose.lateral);
  EXPECT_LT(degreesBetween(normal, plane.normal), 5.0) << plane.name;
  EXPECT_LT(std::abs(glm::dot(normal, plane.markMm - view.pose.positionMm)), 5.0) << plane.name;
}

/// What was found is held against where the valves were drawn, not against landmarks that were found.
TEST(StandardViews, OfTheBundledThorax)
{
  const auto scene = sceneOf(makeThoraxPhantom(2.0));
  const auto views = findStandardViews(*scene, probeOf);
  const ProbePose frame = thoraxPhantomA4C();
  const std::vector<KnownPlane> known = knownPlanes(thoraxLandmarks(ThoraxBody(ThoraxParameters{})));
  for (std::size_t i = 0; i < 5; ++i) // the apical ones, and across the apex
  {
    expectNear(viewOf(views, known[i].name), known[i]);
  }
  for (const StandardView& view : views)
  {
    if (!view.refusal.empty())
    {
      EXPECT_NE(describe(view).find("not obtainable from this patient. "), std::string::npos);
      continue;
    }
    // The face lies on the skin, and what is demanded is seen.
    const Vec3d index = scene->placement().indexFromWorld(view.pose.positionMm);
    const Vec3i v(glm::round(index));
    const Vec3i n = scene->placement().size;
    EXPECT_EQ(scene->tissues()[scene->tissueVoxels()[(std::size_t(v.z) * n.y + v.y) * n.x + v.x]].name, "skin")
      << view.name;
    EXPECT_GT(view.score, 0.0) << view.name;
    EXPECT_GE(view.shown.front().percent, 30.0) << view.name;
  }
  // The bundled apical window: the known pose is one of the four-chamber view.
  const StandardView& a4c = viewOf(views, "A4C");
  EXPECT_LT(glm::distance(a4c.pose.positionMm, frame.positionMm), 25.0);
  EXPECT_GT(glm::dot(a4c.pose.lateral, frame.lateral), 0.9);
  EXPECT_NE(viewOf(views, "IVC").refusal.find("inferior vena cava, which the label map does not have"),
            std::string::npos);
  EXPECT_NE(viewOf(views, "PSAX base").refusal, ""); // its left lung reaches to the sternum
  EXPECT_EQ(viewOf(views, "PSAX base").shadow, "lung");
}

/// The same body on its left side, whose lung gives the parasternal windows free.
TEST(StandardViews, AllOfABodyOnItsLeftSide)
{
  ThoraxParameters parameters;
  parameters.leftLateral = 1.0;
  const auto scene = sceneOf(makeThoraxPhantom(2.0, parameters));
  const auto views = findStandardViews(*scene, probeOf);
  for (const KnownPlane& plane : knownPlanes(thoraxLandmarks(ThoraxBody(parameters))))
  {
    expectNear(viewOf(views, plane.name), plane);
  }
}

/// A kidney and a liver in a body of soft tissue, behind bone or not: closed forms of what is shown.
TEST(StandardViews, SaysWhatIsInTheWay)
{
  for (const bool isBehindBone : { false, true })
  {
    LabelVolume volume;
    volume.placement.size = Vec3i(100, 100, 100);
    volume.placement.spacingMm = Vec3d(2.0);
    volume.placement.originMm = Vec3d(-99.0);
    for (int n = 0; n < 1000000; ++n)
    {
      const Vec3d p = volume.placement.worldFromIndex(Vec3d(n % 100, n / 100 % 100, n / 10000));
      const double r = glm::length(Vec3d(p.x, p.y, 0.7 * p.z)) / 70.0;
      const bool isKidney = glm::length((p - Vec3d(-25.0, 10.0, 0.0)) / Vec3d(14.0, 14.0, 28.0)) < 1.0;
      const bool isLiver = glm::length((p - Vec3d(-42.0, -8.0, 15.0)) / Vec3d(16.0, 20.0, 35.0)) < 1.0;
      const bool isBone = isBehindBone && r > 0.8 && r < 0.95;
      volume.voxels.push_back(r > 1.0 ? 0 : isBone ? 4 : isKidney ? 2 : isLiver ? 3 : 1);
    }
    volume.collectLabels();
    const char* names[] = { "background", "soft tissue", "kidney_right", "liver", "bone" };
    for (LabelInfo& label : volume.labels)
    {
      label.name = names[label.id];
    }
    const auto views = findStandardViews(*sceneOf(std::move(volume)), probeOf);
    const StandardView& view = viewOf(views, "RUQ");
    if (isBehindBone)
    {
      EXPECT_NE(view.refusal.find("behind cortical bone"), std::string::npos) << view.refusal;
      continue;
    }
    EXPECT_EQ(view.refusal, "");
    EXPECT_GT(view.shown[0].percent, 95.0); // nothing is in the way
    EXPECT_EQ(view.shadow, "");
    EXPECT_LT(view.pose.positionMm.x, -40.0); // from the right
    EXPECT_GT(-view.pose.lateral.z, 0.8);     // the feet at the image's right
    // The plane holds the kidney's long axis.
    const Vec3d normal = glm::cross(view.pose.axial, view.pose.lateral);
    EXPECT_LT(90.0 - degreesBetween(normal, Vec3d(0.0, 0.0, 1.0)), 5.0);
    EXPECT_LT(std::abs(glm::dot(normal, Vec3d(-25.0, 10.0, 0.0) - view.pose.positionMm)), 3.0);
    EXPECT_NE(viewOf(views, "A4C").refusal.find("no left ventricle"), std::string::npos);
    EXPECT_NE(viewOf(views, "LUQ").refusal.find("left kidney"), std::string::npos);
  }
}

TEST(StandardViews, TheSameAtEachCall)
{
  const auto scene = sceneOf(makeThoraxPhantom(3.0));
  const auto first = findStandardViews(*scene, probeOf);
  const auto again = findStandardViews(*scene, probeOf);
  ASSERT_EQ(first.size(), again.size());
  for (std::size_t i = 0; i < first.size(); ++i)
  {
    EXPECT_EQ(first[i].pose.positionMm, again[i].pose.positionMm);
    EXPECT_EQ(describe(first[i]), describe(again[i]));
  }
}

TEST(StandardViews, StopsWhenAsked)
{
  const auto scene = sceneOf(makeThoraxPhantom(4.0));
  EXPECT_THROW(findStandardViews(*scene, probeOf, [](double fraction) { return fraction < 0.3; }), Aborted);
}

} // namespace
