#include "Probe/AcousticWindow.h"

#include "Core/Error.h"
#include "Core/ParallelFor.h"
#include "Probe/ProbeOnSkin.h"
#include "Probe/WindowGrid.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace sono {
namespace {

constexpr double behind = 0.5;             // sine of 30 degrees
constexpr double steepFromEnds = 0.766;    // sine of 50 degrees
constexpr double cosineOfSteepest = 0.707; // of 45 degrees
constexpr double cosineOfSteepestLinear = 0.94;
constexpr double lossScaleDb = 40.0; // for a factor of 10
constexpr double enoughInsidePercent = 65.0;
constexpr double beyondTarget = 1.15;
constexpr double depthStepMm = 10.0;
constexpr double apartMm = 40.0;
constexpr double apartLinearMm = 20.0;
constexpr double aimsApartMm = 60.0;
constexpr double worthTurning = 1.1; // how much more a plane must show than the usual one
constexpr double alongBody = 0.8;    // an oblique plane up to 53 degrees counts as one across
constexpr std::size_t mostAims = 6;
constexpr std::size_t targetSamples = 24;
constexpr std::size_t mostPlaces = 800; // that are looked at line by line
constexpr int rollCount = 12;

/// A place and what to look at from there, local.
struct Sight
{
  Vec3d placeMm{ 0.0 };
  Vec3d axis{ 0.0 };
  double score = 0.0;
};

class WindowSearch
{
public:
  WindowSearch(const WindowGrid& grid, const ProbeSettings& probe)
    : grid_(grid)
    , probe_(grid, probe)
    , toLocal_(grid.scene().rotationToLocal())
    , toWorld_(glm::transpose(toLocal_))
  {
    chooseAims();
    const std::size_t count = grid_.targetCentres().size();
    for (std::size_t i = 0; i < targetSamples && i < count; ++i)
    {
      samples_.push_back(grid_.targetCentres()[(2 * i + 1) * count / (2 * std::min(targetSamples, count))]);
    }
  }

  double apart() const { return probe_.isLinear() ? apartLinearMm : apartMm; }

  /// The best view from a place by a handful of ways to the target; a score of 0 where no probe can stand so.
  Sight glance(const WindowGrid::SkinPlace& place) const
  {
    Sight best;
    for (const Vec3d& aim : aims_)
    {
      const Vec3d axis = glm::normalize(aim - place.localMm);
      if (!mayLook(axis, place.outward) || !probe_.hasRoom(place.localMm, axis))
      {
        continue;
      }
      double sum = 0.0;
      for (const Vec3d& sample : samples_)
      {
        sum += reaches(place.localMm, axis, sample) ? amplitudeAt(place.localMm, sample) : 0.0;
      }
      if (sum > best.score)
      {
        best = { place.localMm, axis, sum };
      }
    }
    return best;
  }

  /// The image that shows most, of those about the axis.
  AcousticWindow look(const Sight& sight) const
  {
    const Vec3d axial = toWorld_ * sight.axis;
    // From the front across the body; from a side along it.
    const Vec3d usual = std::abs(axial.x) > 0.8 ? Vec3d(0.0, 0.0, -1.0) : Vec3d(1.0, 0.0, 0.0);
    const Vec3d first = glm::normalize(usual - glm::dot(usual, axial) * axial);
    const Vec3d second = glm::cross(axial, first);
    const Vec3d place = grid_.entry(sight.placeMm, sight.axis);
    AcousticWindow best;
    AcousticWindow inUsualPlane;
    for (int i = 0; i < rollCount; ++i)
    {
      const double turn = i * 3.14159265358979323846 / rollCount;
      const Vec3d lateral = std::cos(turn) * first + std::sin(turn) * second;
      AcousticWindow window = show(place, sight.axis, toLocal_ * lateral);
      // The marker's side: the patient's left where the plane lies across the body, else the feet.
      const Vec3d elevation = glm::cross(axial, lateral);
      const double up = std::abs(lateral.z) < alongBody ? elevation.z : lateral.z;
      window.pose =
        ProbePose{ grid_.scene().worldFromLocal(place), axial, up > 0.0 ? -lateral : lateral }.orthonormalized();
      inUsualPlane = i == 0 ? window : inUsualPlane;
      best = shown(window) > shown(best) ? window : best;
    }
    return shown(best) > worthTurning * shown(inUsualPlane) ? best : inUsualPlane;
  }

private:
  /// What an image shows, and how much of it: one that lies in the volume for little more than a half is hardly one.
  static double shown(const AcousticWindow& window)
  {
    const double enough = std::min(1.0, window.insidePercent / enoughInsidePercent);
    return window.seenPercent * window.insidePercent * enough * enough;
  }

  /// The target's middle, or what of it is nearest to that; of a long one, others far from these.
  void chooseAims()
  {
    const auto& cells = grid_.targetCentres();
    const auto nearer = [&](const Vec3d& to) {
      return [to](const Vec3d& a, const Vec3d& b) { return glm::distance(a, to) < glm::distance(b, to); };
    };
    const Vec3d middle = grid_.targetMiddle();
    const bool isWithin = grid_.isTarget(grid_.at(middle));
    aims_.push_back(isWithin ? middle : *std::min_element(cells.begin(), cells.end(), nearer(middle)));
    std::vector<double> toAims(cells.size(), 1e9);
    while (aims_.size() < mostAims)
    {
      for (std::size_t i = 0; i < cells.size(); ++i)
      {
        toAims[i] = std::min(toAims[i], glm::distance(cells[i], aims_.back()));
      }
      const auto farthest = std::max_element(toAims.begin(), toAims.end());
      if (*farthest < aimsApartMm)
      {
        break;
      }
      aims_.push_back(cells[std::size_t(farthest - toAims.begin())]);
    }
  }

  bool mayLook(const Vec3d& axis, const Vec3d& outward) const
  {
    const Vec3d away = toWorld_ * -axis;
    return -glm::dot(axis, outward) >= (probe_.isLinear() ? cosineOfSteepestLinear : cosineOfSteepest) &&
           away.y <= behind && std::abs(away.z) <= steepFromEnds;
  }

  /// Whether an image can be turned about the axis so that it shows the point.
  bool reaches(const Vec3d& place, const Vec3d& axis, const Vec3d& point) const
  {
    const Vec3d way = point - place;
    const double axialMm = glm::dot(way, axis);
    const double lateralMm = glm::length(way - axialMm * axis);
    return axialMm > 0.0 && !std::isnan(beamFromPlane(probe_.geometry(), lateralMm, axialMm).x);
  }

  double amplitudeAt(const Vec3d& from, const Vec3d& to) const
  {
    double excess = 0.0;
    probe_.walk(from, glm::normalize(to - from), glm::distance(to, from),
                [&](double, const Vec3d&, std::size_t, double, double excessDb) { excess = excessDb; });
    return std::pow(10.0, -excess / 20.0);
  }

  AcousticWindow show(const Vec3d& place, const Vec3d& axis, const Vec3d& lateral) const
  {
    AcousticWindow window;
    if (!probe_.touches(place, axis, lateral))
    {
      return window;
    }
    const auto lines = makeScanLines(probe_.geometry(), ProbePose{ place, axis, lateral });
    const double stepMm = grid_.stepMm();
    const std::vector<double> areas = probe_.stepAreas(lines);
    const std::size_t bins = areas.size();
    std::vector<Vec2d> within(bins, Vec2d(0.0)); // area within the box, by depth, and of this without shadow
    double seenMm2 = 0.0;
    double lossSum = 0.0;
    double farMm = 0.0;
    for (const ScanLine& line : lines)
    {
      probe_.walk(line.originMm, line.axis, probe_.geometry().depthMm,
                  [&](double r, const Vec3d&, std::size_t cell, double lossDb, double excessDb) {
                    const auto bin = std::size_t(r / stepMm);
                    within[bin] += areas[bin] * Vec2d(1.0, excessDb < ProbeOnSkin::shadowDb ? 1.0 : 0.0);
                    if (grid_.isTarget(cell))
                    {
                      const double amplitude = std::pow(10.0, -excessDb / 20.0);
                      seenMm2 += amplitude * areas[bin];
                      lossSum += amplitude * areas[bin] * lossDb;
                      farMm = excessDb < ProbeOnSkin::shadowDb ? std::max(farMm, r) : farMm;
                    }
                  });
    }
    if (seenMm2 <= 0.0)
    {
      return window;
    }
    const double leastMm = probe_.isLinear() ? 20.0 : 40.0;
    const double reachMm = std::floor(probe_.geometry().depthMm / depthStepMm) * depthStepMm;
    window.depthMm =
      std::clamp(std::ceil(farMm * beyondTarget / depthStepMm) * depthStepMm, leastMm, std::max(leastMm, reachMm));
    const auto until = std::min(bins, std::size_t(window.depthMm / stepMm));
    double all = 0.0;
    Vec2d sum(0.0);
    for (std::size_t bin = 0; bin < until; ++bin)
    {
      all += areas[bin] * ProbeOnSkin::lineCount;
      sum += within[bin];
    }
    const double insideShare = sum.x / all;
    const double clearShare = sum.y / std::max(sum.x, 1e-9);
    const double seenShare = std::min(1.0, seenMm2 / grid_.targetAreaMm2());
    window.seenPercent = 100.0 * seenShare;
    window.insidePercent = 100.0 * insideShare;
    window.lossDb = lossSum / seenMm2;
    window.score = seenShare * insideShare * 0.5 * (1.0 + clearShare) * std::pow(10.0, -window.lossDb / lossScaleDb);
    return window;
  }

  const WindowGrid& grid_;
  ProbeOnSkin probe_;
  Mat3d toLocal_;
  Mat3d toWorld_;
  std::vector<Vec3d> aims_;
  std::vector<Vec3d> samples_; // of the target
};

bool isBetter(double a, double b)
{
  return a > b;
}

} // namespace

std::vector<AcousticWindow> findAcousticWindows(const Scene& scene, const WindowTarget& target,
                                                const ProbeSettings& probe, int count)
{
  const WindowGrid grid(scene, target);
  if (grid.targetCentres().empty())
  {
    throw Error("Of the " + target.name +
                " nothing lies within the label map's body; choose another target, or place the probe by hand.");
  }
  const WindowSearch search(grid, probe);
  const std::vector<WindowGrid::SkinPlace> places = grid.skinPlaces();
  std::vector<Sight> sights(places.size());
  parallelFor(int(places.size()), {}, [&](int i) { sights[std::size_t(i)] = search.glance(places[std::size_t(i)]); });
  std::stable_sort(sights.begin(), sights.end(),
                   [](const Sight& a, const Sight& b) { return isBetter(a.score, b.score); });
  const auto none = std::find_if(sights.begin(), sights.end(), [](const Sight& s) { return s.score <= 0.0; });
  sights.resize(std::min(std::size_t(none - sights.begin()), mostPlaces));

  std::vector<AcousticWindow> windows(sights.size());
  parallelFor(int(sights.size()), {}, [&](int i) { windows[std::size_t(i)] = search.look(sights[std::size_t(i)]); });
  std::stable_sort(windows.begin(), windows.end(),
                   [](const AcousticWindow& a, const AcousticWindow& b) { return isBetter(a.score, b.score); });
  std::vector<AcousticWindow> best;
  for (const AcousticWindow& window : windows)
  {
    const bool isNeighbour = std::any_of(best.begin(), best.end(), [&](const AcousticWindow& other) {
      return glm::distance(other.pose.positionMm, window.pose.positionMm) < search.apart();
    });
    if (window.score > 0.0 && !isNeighbour && best.size() < std::size_t(count))
    {
      best.push_back(window);
    }
  }
  if (best.empty())
  {
    throw Error("No place on the skin was found from which the " + target.name +
                " can be seen; where the label map is cut is no skin. Fill the body if the map has none, or place the "
                "probe by hand.");
  }
  return best;
}

std::string describe(const AcousticWindow& window, const WindowTarget& target)
{
  const Vec3d away = -window.pose.axial;
  std::string from;
  const auto add = [&](bool is, const char* where) {
    from += is ? (from.empty() ? "" : " and ") + std::string(where) : "";
  };
  add(away.y < -0.5, "the front");
  add(away.x < -0.4, "the right");
  add(away.x > 0.4, "the left");
  add(away.z > 0.35, "above");
  add(away.z < -0.35, "below");
  const auto whole = [](double value) { return std::to_string(std::lround(value)); };
  return "From " + (from.empty() ? "the side" : from) + ": shows " + whole(window.seenPercent) + " % of the " +
         target.name + "'s largest section, " + whole(window.lossDb) + " dB lost on the way, " +
         whole(window.insidePercent) + " % of the image inside the volume.";
}

} // namespace sono
