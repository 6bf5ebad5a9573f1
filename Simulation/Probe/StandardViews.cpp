#include "Probe/StandardViews.h"

#include "Core/Error.h"
#include "Core/ParallelFor.h"
#include "Probe/BestApart.h"
#include "Probe/PlaneFit.h"
#include "Probe/ProbeOnSkin.h"
#include "Probe/ViewStructures.h"
#include "Probe/WindowTarget.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace sono {
namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;
constexpr double steepestDeg = 55.0;
constexpr double offDeg = 4.0; // a score falls to 61 % of it
constexpr double offMm = 4.0;
constexpr double rockStepDeg = 8.0;
constexpr int mostRocks = 3;       // to each side
constexpr double rockedDeg = 18.0; // what is to be shown belongs into the image's middle
constexpr std::size_t mostRefined = 10;
constexpr double refinedApartMm = 16.0;
constexpr double atFirst = 2.0; // times as far off the plane may a place be that is moved then
constexpr double firstMoveMm = 6.0;
constexpr double lastMoveMm = 1.5;
constexpr double degreesOfMm = 2.0; // rocked, for a step of a place
constexpr double smallestSectionMm2 = 60.0;
constexpr double depthStepMm = 10.0;
constexpr double beyondMm = 10.0;
constexpr double leastDepthMm = 60.0;
constexpr double leastShadowDb = 3.0; // that is worth a word
constexpr double lossScaleDb = 40.0;  // for a factor of 10
constexpr double dimDb = 10.0;        // loss beyond soft tissue's from which on less is shown; a rib's is 14
constexpr double goneDb = 16.0;

/// Where a probe is tried: local.
struct Trial
{
  WindowGrid::SkinPlace place;
  double rockDeg = 0.0;
};

/// What became of it. The higher the stage, the nearer it came.
struct Outcome
{
  enum Stage
  {
    OffPlane, ///< no plane through the place is near the ideal one
    OffLook,  ///< it would look from another side, or too steeply
    OffSkin,  ///< the face does not lie on skin, or there is no room for the hand
    Shown
  };
  Stage stage = OffPlane;
  StandardView view;
  ProbePose local; ///< the view's pose, in local coordinates
};

class ViewSearch
{
public:
  ViewSearch(const ProbeOnSkin& probe, const ViewPlan& plan)
    : probe_(probe)
    , plan_(plan)
    , grid_(probe.grid())
    , structures_(grid_.scene(), plan)
    , ideal_(idealSection(grid_.scene(), plan, structures_))
    , toLocal_(grid_.scene().rotationToLocal())
    , normal_(toLocal_ * plan.normal)
    , look_(toLocal_ * plan.look)
    , mark_(grid_.scene().localFromWorld(plan.markMm))
    , weights_(plan.points.size(), 1.0)
  {
    for (const Vec3d& point : plan.points)
    {
      points_.push_back(grid_.scene().localFromWorld(point));
    }
  }

  /// A structure that the ideal plane does not meet; empty where it meets all.
  std::string notMet() const
  {
    for (std::size_t i = 0; i < structures_.count(); ++i)
    {
      if (ideal_.areaMm2[i] < smallestSectionMm2)
      {
        return plan_.demands[i].structure;
      }
    }
    return {};
  }

  /// The plane through a place on the skin, however it is rocked there.
  struct Approach
  {
    Vec3d normal;
    Vec3d straight; ///< to the structures' middle
    double planeOffDeg, markOffMm, lookOffDeg;
  };

  Approach approachFrom(const Vec3d& localMm) const
  {
    const PlaneFit fit = fitPlaneThrough(localMm, points_, weights_);
    const Vec3d normal = glm::dot(fit.normal(), normal_) < 0.0 ? -fit.normal() : fit.normal();
    const Vec3d way = ideal_.middle - localMm;
    const Vec3d straight = glm::normalize(way - glm::dot(way, normal) * normal);
    const auto offDeg = [](const Vec3d& u, const Vec3d& v) {
      return std::acos(std::min(1.0, glm::dot(u, v))) / degree;
    };
    return { normal, straight, offDeg(normal, normal_), std::abs(glm::dot(normal, mark_ - localMm)),
             offDeg(straight, look_) };
  }

  /// What a view can come to there.
  double mostScoreOf(const Approach& approach, double rockDeg) const
  {
    const double off = std::pow(approach.planeOffDeg / offDeg, 2.0) + std::pow(approach.markOffMm / offMm, 2.0);
    const double look = std::pow(2.0 * approach.lookOffDeg / plan_.lookDeg, 2.0) + std::pow(rockDeg / rockedDeg, 2.0);
    return std::exp(-0.5 * off) * std::exp(-0.5 * look);
  }

  /// However a probe is rocked there: how far it comes at most, if not to Shown, then in the end.
  Outcome atMost(const Approach& approach) const
  {
    Outcome outcome;
    outcome.view.planeOffDeg = approach.planeOffDeg;
    outcome.view.markOffMm = approach.markOffMm;
    if (approach.planeOffDeg <= atFirst * plan_.mostOffDeg && approach.markOffMm <= atFirst * plan_.mostOffMm)
    {
      outcome.stage = approach.lookOffDeg > plan_.lookDeg ? Outcome::OffLook : Outcome::Shown;
    }
    return outcome;
  }

  /// What becomes of a trial; of one that cannot be better than `best`, only that it is not.
  Outcome tryAt(const Trial& trial, const Approach& approach, const Outcome& best) const
  {
    Outcome outcome = atMost(approach);
    StandardView& view = outcome.view;
    const Vec3d aside = glm::cross(approach.normal, approach.straight);
    const double rock = trial.rockDeg * degree;
    const Vec3d axis = std::cos(rock) * approach.straight + std::sin(rock) * aside;
    const bool isSteep = -glm::dot(axis, trial.place.outward) < std::cos(steepestDeg * degree);
    if (outcome.stage != Outcome::Shown || isSteep)
    {
      outcome.stage = std::min(outcome.stage, Outcome::OffLook);
      return outcome;
    }
    outcome.stage = Outcome::OffSkin;
    const double mostScore = mostScoreOf(approach, trial.rockDeg);
    if (best.stage == Outcome::Shown && mostScore <= best.view.score)
    {
      return outcome;
    }
    const Vec3d place = grid_.entry(trial.place.localMm, axis);
    const Vec3d across = glm::cross(axis, approach.normal);
    const Vec3d lateral = glm::dot(glm::transpose(toLocal_) * across, plan_.rightward) < 0.0 ? -across : across;
    if (!probe_.hasRoom(place, axis) || !probe_.touches(place, axis, lateral))
    {
      return outcome;
    }
    outcome.stage = Outcome::Shown;
    const Mat3d toWorld = glm::transpose(toLocal_);
    view.pose = ProbePose{ grid_.scene().worldFromLocal(place), toWorld * axis, toWorld * lateral }.orthonormalized();
    outcome.local = ProbePose{ place, axis, lateral };
    view.score = mostScore;
    show(outcome.local, view);
    return outcome;
  }

  /// The best of a place, however the probe is rocked; `trial` becomes that.
  Outcome tryRocked(Trial& trial) const
  {
    const Approach approach = approachFrom(trial.place.localMm);
    Outcome best;
    for (int rock = 0; rock <= 2 * mostRocks; ++rock)
    {
      const Trial rocked{ trial.place, (rock % 2 == 0 ? -1.0 : 1.0) * double((rock + 1) / 2) * rockStepDeg };
      const Outcome outcome = tryAt(rocked, approach, best);
      if (rock == 0 || isFurther(outcome, best))
      {
        trial = rocked;
        best = outcome;
      }
    }
    return best;
  }

  /// The best trial, by how far it came and then by its score, moved as long as that helps.
  Outcome refine(Trial trial, Outcome best) const
  {
    for (double moveMm = firstMoveMm; moveMm >= lastMoveMm;)
    {
      const Vec3d out = trial.place.outward;
      const Vec3d u = glm::normalize(glm::cross(out, std::abs(out.x) < 0.8 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)));
      const Vec3d v = glm::cross(out, u);
      std::vector<Trial> moved(6, trial);
      const Vec3d offsets[] = { u, -u, v, -v };
      for (std::size_t i = 0; i < 4; ++i)
      {
        moved[i].place.localMm = grid_.entry(trial.place.localMm + moveMm * offsets[i], -out);
        moved[i].place.outward = grid_.outwardNormal(moved[i].place.localMm);
      }
      moved[4].rockDeg += degreesOfMm * moveMm;
      moved[5].rockDeg -= degreesOfMm * moveMm;
      bool isBetter = false;
      for (const Trial& other : moved)
      {
        const bool isPlace = other.place.outward != Vec3d(0.0) &&
                             grid_.isCovered(other.place.localMm, other.place.outward) &&
                             std::abs(other.rockDeg) <= mostRocks * rockStepDeg;
        const Outcome outcome = isPlace ? tryAt(other, approachFrom(other.place.localMm), best) : Outcome();
        if (isFurther(outcome, best))
        {
          best = outcome;
          trial = other;
          isBetter = true;
        }
      }
      moveMm *= isBetter ? 1.0 : 0.5;
    }
    return best;
  }

  /// What takes most from what a view is to show.
  void sayShadow(const ProbePose& pose, StandardView& view) const
  {
    const auto lines = makeScanLines(probe_.geometry(), pose);
    const std::vector<double> areas = probe_.stepAreas(lines);
    double met = 0.0;                                                        // mm^2
    std::vector<double> excessOfTissue(grid_.scene().tissues().size(), 0.0); // dB mm^2
    std::vector<double> own(excessOfTissue.size());                          // dB until here
    for (const ScanLine& line : lines)
    {
      std::fill(own.begin(), own.end(), 0.0);
      double before = 0.0;
      probe_.walk(line.originMm, line.axis, probe_.geometry().depthMm,
                  [&](double r, const Vec3d& at, std::size_t cell, double, double excessDb) {
                    own[std::size_t(grid_.tissue(cell))] += excessDb - before;
                    before = excessDb;
                    if (structures_.at(at) >= 0)
                    {
                      const double area = areas[std::min(areas.size() - 1, std::size_t(r / grid_.stepMm()))];
                      met += area;
                      for (std::size_t i = 0; i < own.size(); ++i)
                      {
                        excessOfTissue[i] += own[i] * area;
                      }
                    }
                  });
    }
    const auto most = std::max_element(excessOfTissue.begin(), excessOfTissue.end());
    const double db = met > 0.0 ? *most / met : 0.0;
    if (db >= leastShadowDb)
    {
      view.shadow = grid_.scene().tissues()[std::size_t(most - excessOfTissue.begin())].name;
      std::replace(view.shadow.begin(), view.shadow.end(), '_', ' ');
      view.shadowDb = db;
    }
  }

  static bool isFurther(const Outcome& a, const Outcome& b)
  {
    return a.stage != b.stage ? a.stage > b.stage : a.view.score > b.view.score;
  }

private:
  void show(const ProbePose& pose, StandardView& view) const
  {
    const auto lines = makeScanLines(probe_.geometry(), pose);
    const std::vector<double> areas = probe_.stepAreas(lines);
    const double stepMm = grid_.stepMm();
    std::vector<double> seen(structures_.count(), 0.0);
    double seenExcess = 0.0;                      // dB mm^2
    std::vector<int> inside(areas.size() + 1, 0); // lines more than a step before
    double farMm = 0.0;
    for (const ScanLine& line : lines)
    {
      const auto [first, end] = probe_.stepsInside(line.originMm, line.axis, probe_.geometry().depthMm);
      ++inside[std::min(areas.size(), std::size_t(first))];
      --inside[std::min(areas.size(), std::size_t(end))];
      // Beyond the structures nothing is lost that counts.
      const Vec2d range =
        WindowGrid::rangeWithin(line.originMm, line.axis, structures_.boxLowMm(), structures_.boxHighMm());
      if (range.y < range.x)
      {
        continue;
      }
      probe_.walk(line.originMm, line.axis, std::min(probe_.geometry().depthMm, range.y + stepMm),
                  [&](double r, const Vec3d& at, std::size_t, double, double excessDb) {
                    const int demand = structures_.at(at);
                    if (demand < 0)
                    {
                      return;
                    }
                    const auto bin = std::min(areas.size() - 1, std::size_t(r / stepMm));
                    const double clear = std::clamp((goneDb - excessDb) / (goneDb - dimDb), 0.0, 1.0);
                    seen[std::size_t(demand)] += clear * areas[bin];
                    seenExcess += clear * areas[bin] * excessDb;
                    farMm = std::max(farMm, r);
                  });
    }
    const double reachMm = std::floor(probe_.geometry().depthMm / depthStepMm) * depthStepMm;
    view.depthMm = std::clamp(std::ceil((farMm + beyondMm) / depthStepMm) * depthStepMm, leastDepthMm, reachMm);
    rate(seen, view);
    const double seenMm2 = std::accumulate(seen.begin(), seen.end(), 0.0);
    view.score *= std::pow(10.0, -seenExcess / std::max(1e-9, seenMm2) / lossScaleDb);
    double all = 0.0;
    double within = 0.0;
    int linesInside = 0;
    for (std::size_t bin = 0; bin < areas.size() && double(bin) * stepMm < view.depthMm; ++bin)
    {
      all += areas[bin] * ProbeOnSkin::lineCount;
      linesInside += inside[bin];
      within += areas[bin] * linesInside;
    }
    view.insidePercent = 100.0 * within / all;
    view.score *= within / all;
  }

  void rate(const std::vector<double>& seen, StandardView& view) const
  {
    double sum = 0.0;
    double worst = 1.0;
    for (std::size_t i = 0; i < seen.size(); ++i)
    {
      const ViewDemand& demand = plan_.demands[i];
      const double share = std::min(1.0, seen[i] / ideal_.areaMm2[i]);
      view.shown.push_back({ demand.structure, 100.0 * share });
      sum += share / double(seen.size());
      worst = std::min(worst, 100.0 * share / demand.leastPercent);
    }
    view.score *= sum * worst;
  }

  const ProbeOnSkin& probe_;
  const ViewPlan& plan_;
  const WindowGrid& grid_;
  ViewStructures structures_;
  IdealSection ideal_;
  Mat3d toLocal_;
  Vec3d normal_, look_, mark_;
  std::vector<Vec3d> points_;
  std::vector<double> weights_;
};

std::string whole(double value)
{
  return std::to_string(std::lround(value));
}

std::string shares(const StandardView& view)
{
  std::string text;
  for (const ShownStructure& shown : view.shown)
  {
    text += (text.empty() ? "" : ", ") + whole(shown.percent) + " % of the " + shown.structure;
  }
  return text;
}

/// Why the best that there is will not do; empty where it does.
std::string refusalOf(const Outcome& best, const ViewPlan& plan)
{
  switch (best.stage)
  {
    case Outcome::OffPlane:
      return "No skin in the label map lies near its plane.";
    case Outcome::OffLook:
      return "Where its plane meets the skin, a probe would have to look from another side or too steeply.";
    case Outcome::OffSkin:
      return "Where its plane meets the skin, the probe's face does not lie on it.";
    case Outcome::Shown:
      break;
  }
  if (best.view.planeOffDeg > plan.mostOffDeg || best.view.markOffMm > plan.mostOffMm)
  {
    return "The best plane through the skin is " + whole(best.view.planeOffDeg) + " degrees and " +
           whole(best.view.markOffMm) + " mm off.";
  }
  for (std::size_t i = 0; i < plan.demands.size(); ++i)
  {
    const ShownStructure& shown = best.view.shown[i];
    if (shown.percent < plan.demands[i].leastPercent)
    {
      return "The best place shows " + whole(shown.percent) + " % of the " + shown.structure +
             (best.view.shadow.empty()
                ? std::string("; the rest lies beside its plane or beyond its image.")
                : ", behind " + best.view.shadow + " that takes " + whole(best.view.shadowDb) + " dB.");
    }
  }
  return {};
}

StandardView findView(const ProbeOnSkin& probe, const ViewPlan& plan, const std::vector<WindowGrid::SkinPlace>& places)
{
  const ViewSearch search(probe, plan);
  const std::string notMet = search.notMet();
  if (!notMet.empty())
  {
    StandardView view;
    view.refusal = "Its plane does not meet the " + notMet + ".";
    return view;
  }
  // To look along all lines of a view takes long: only where a place may become one of the best.
  std::vector<Trial> trials(places.size());
  std::vector<Outcome> outcomes(places.size());
  std::vector<char> isKnown(places.size());
  parallelFor(int(places.size()), {}, [&](int i) {
    const std::size_t at = std::size_t(i);
    const ViewSearch::Approach approach = search.approachFrom(places[at].localMm);
    trials[at].place = places[at];
    outcomes[at] = search.atMost(approach);
    isKnown[at] = outcomes[at].stage == Outcome::Shown ? 0 : 1;
    outcomes[at].view.score = isKnown[at] ? 0.0 : search.mostScoreOf(approach, 0.0);
  });
  const auto learn = [&](const std::vector<std::size_t>& some) {
    parallelFor(int(some.size()), {}, [&](int i) {
      const std::size_t at = some[std::size_t(i)];
      outcomes[at] = search.tryRocked(trials[at]);
      isKnown[at] = 1;
    });
  };
  const std::vector<std::size_t> starts = bestApart(
    places.size(), mostRefined,
    [&](std::size_t a, std::size_t b) { return ViewSearch::isFurther(outcomes[a], outcomes[b]); },
    [&](std::size_t a, std::size_t b) { return glm::distance(places[a].localMm, places[b].localMm) < refinedApartMm; },
    [&](std::size_t at) { return isKnown[at] != 0; }, learn);
  std::vector<Outcome> refined(starts.size());
  parallelFor(int(starts.size()), {}, [&](int i) {
    const std::size_t at = starts[std::size_t(i)];
    refined[std::size_t(i)] = search.refine(trials[at], outcomes[at]);
  });
  StandardView best;
  best.refusal = refusalOf(Outcome(), plan);
  Outcome::Stage stage = Outcome::OffPlane;
  for (Outcome& outcome : refined)
  {
    if (outcome.stage == Outcome::Shown)
    {
      search.sayShadow(outcome.local, outcome.view);
    }
    outcome.view.refusal = refusalOf(outcome, plan);
    const bool isBetter = outcome.view.refusal.empty() != best.refusal.empty() ? outcome.view.refusal.empty()
                          : outcome.stage != stage                             ? outcome.stage > stage
                                                                               : outcome.view.score > best.score;
    if (isBetter)
    {
      best = outcome.view;
      stage = outcome.stage;
    }
  }
  return best;
}

} // namespace

std::vector<StandardView> findStandardViews(const Scene& scene, const ProbeByPreset& probeOf, const Progress& progress,
                                            const std::set<std::string>& names)
{
  const WindowGrid grid(scene, WindowTarget());
  const std::vector<WindowGrid::SkinPlace> places = grid.skinPlaces();
  const std::vector<ViewPlan> plans = planStandardViews(scene);
  std::vector<StandardView> views;
  for (std::size_t i = 0; i < plans.size(); ++i)
  {
    report(progress, double(i) / double(plans.size()));
    const ViewPlan& plan = plans[i];
    StandardView view;
    view.refusal = names.empty() || names.count(plan.name) == 1 ? plan.refusal : "It was not looked for.";
    if (view.refusal.empty())
    {
      view = findView(ProbeOnSkin(grid, probeOf(plan.preset)), plan, places);
    }
    view.name = plan.name;
    view.title = plan.title;
    view.preset = plan.preset;
    views.push_back(view);
  }
  return views;
}

std::string describe(const StandardView& view)
{
  const std::string name = view.name + ", " + view.title + ": ";
  if (!view.refusal.empty())
  {
    return name + "not obtainable from this patient. " + view.refusal;
  }
  return name + "shows " + shares(view) + "; " + whole(view.planeOffDeg) + " degrees and " + whole(view.markOffMm) +
         " mm off the ideal plane" +
         (view.shadow.empty() ? "." : ", " + whole(view.shadowDb) + " dB lost in " + view.shadow + ".");
}

} // namespace sono
