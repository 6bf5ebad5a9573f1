#include "Probe/AcousticWindow.h"

#include "Core/Error.h"
#include "Core/ParallelFor.h"
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
constexpr double softDbPerCmMHz = 0.5;
constexpr double shadowDb = 12.0;
constexpr double lossScaleDb = 40.0; // for a factor of 10
constexpr double enoughInsidePercent = 65.0;
constexpr double deeper = 1.3; // than a preset says, by its depth knob
constexpr double beyondTarget = 1.15;
constexpr double depthStepMm = 10.0;
constexpr double contactMm = 6.0;
constexpr double handleMm = 70.0;
constexpr double handleRadiusMm = 10.0;
constexpr double apartMm = 40.0;
constexpr double apartLinearMm = 20.0;
constexpr double aimsApartMm = 60.0;
constexpr double worthTurning = 1.1; // how much more a plane must show than the usual one
constexpr double alongBody = 0.8;    // an oblique plane up to 53 degrees counts as one across
constexpr std::size_t mostAims = 6;
constexpr std::size_t targetSamples = 24;
constexpr std::size_t mostPlaces = 800; // that are looked at line by line
constexpr int lineCount = 49;
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
    , geometry_(probe.geometry)
    , toLocal_(grid.scene().rotationToLocal())
    , toWorld_(glm::transpose(toLocal_))
  {
    geometry_.kind = geometry_.isVolume() ? ScanKind::PhasedSector : geometry_.kind; // its middle plane
    geometry_.lineCount = lineCount;
    isLinear_ = geometry_.kind == ScanKind::Linear;
    geometry_.depthMm *= deeper;
    const double edgeMm = std::abs(planeFromBeam(geometry_, lineCount - 1.0, 0.0).x);
    halfFaceMm_ = std::max(edgeMm, 0.5 * probe.apertureMm);
    lookUpLosses(probe.centreFrequencyMHz);
    chooseAims();
    const std::size_t count = grid_.targetCentres().size();
    for (std::size_t i = 0; i < targetSamples && i < count; ++i)
    {
      samples_.push_back(grid_.targetCentres()[(2 * i + 1) * count / (2 * std::min(targetSamples, count))]);
    }
  }

  double apart() const { return isLinear_ ? apartLinearMm : apartMm; }

  /// The best view from a place by a handful of ways to the target; a score of 0 where no probe can stand so.
  Sight glance(const WindowGrid::SkinPlace& place) const
  {
    Sight best;
    for (const Vec3d& aim : aims_)
    {
      const Vec3d axis = glm::normalize(aim - place.localMm);
      if (!mayLook(axis, place.outward) || !hasRoom(place.localMm, axis))
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

  void lookUpLosses(double frequencyMHz)
  {
    const auto& tissues = grid_.scene().tissues();
    for (const Tissue& here : tissues)
    {
      lossOfStep_.push_back(here.attenuationDbPerCmMHz * frequencyMHz * grid_.stepMm() / 10.0);
      for (const Tissue& before : tissues)
      {
        const double sum = here.impedanceMRayl + before.impedanceMRayl;
        lossOfBoundary_.push_back(-10.0 * std::log10(4.0 * here.impedanceMRayl * before.impedanceMRayl / (sum * sum)));
      }
    }
    softLossOfMm_ = softDbPerCmMHz * frequencyMHz / 10.0;
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
    return -glm::dot(axis, outward) >= (isLinear_ ? cosineOfSteepestLinear : cosineOfSteepest) && away.y <= behind &&
           std::abs(away.z) <= steepFromEnds;
  }

  /// Whether hand and handle have air around them, which also keeps the probe out of airways.
  bool hasRoom(const Vec3d& place, const Vec3d& axis) const
  {
    const Vec3d helper = std::abs(axis.x) < 0.9 ? Vec3d(1.0, 0.0, 0.0) : Vec3d(0.0, 1.0, 0.0);
    const Vec3d across = handleRadiusMm * glm::normalize(glm::cross(axis, helper));
    const Vec3d over = glm::cross(axis, across);
    for (const Vec3d& offset : { Vec3d(0.0), across, -across, over, -over })
    {
      if (!grid_.isOpen(place + offset, -axis))
      {
        return false;
      }
    }
    for (double behindMm = 20.0; behindMm <= handleMm; behindMm += 10.0)
    {
      for (const Vec3d& offset : { across, -across, over, -over })
      {
        const Vec3d at = place - behindMm * axis + offset;
        if (grid_.isInside(at) && !grid_.isOuter(grid_.at(at)))
        {
          return false;
        }
      }
    }
    return true;
  }

  /// Whether an image can be turned about the axis so that it shows the point.
  bool reaches(const Vec3d& place, const Vec3d& axis, const Vec3d& point) const
  {
    const Vec3d way = point - place;
    const double axialMm = glm::dot(way, axis);
    const double lateralMm = glm::length(way - axialMm * axis);
    return axialMm > 0.0 && !std::isnan(beamFromPlane(geometry_, lateralMm, axialMm).x);
  }

  /// Walks through the grid: visit(r, cell, loss and what of it is beyond that of soft tissue, dB, one way) at each
  /// step within the box.
  template<class Visit>
  void walk(const Vec3d& from, const Vec3d& axis, double lengthMm, const Visit& visit) const
  {
    const std::size_t tissueCount = lossOfStep_.size();
    const double stepMm = grid_.stepMm();
    int last = -1;
    double lossDb = 0.0;
    double softDb = 0.0;
    for (double r = 0.5 * stepMm; r < lengthMm; r += stepMm)
    {
      const Vec3d at = from + r * axis;
      if (!grid_.isInside(at))
      {
        continue;
      }
      const std::size_t cell = grid_.at(at);
      const int tissue = grid_.tissue(cell);
      const bool isGel = last < 0 && grid_.isOuter(cell); // between the face and the skin
      if (!isGel)
      {
        lossDb += lossOfStep_[std::size_t(tissue)];
        softDb += softLossOfMm_ * stepMm;
        lossDb += last >= 0 ? lossOfBoundary_[std::size_t(last) * tissueCount + std::size_t(tissue)] : 0.0;
        last = tissue;
      }
      visit(r, cell, lossDb, std::max(0.0, lossDb - softDb));
    }
  }

  double amplitudeAt(const Vec3d& from, const Vec3d& to) const
  {
    double excess = 0.0;
    walk(from, glm::normalize(to - from), glm::distance(to, from),
         [&](double, std::size_t, double, double excessDb) { excess = excessDb; });
    return std::pow(10.0, -excess / 20.0);
  }

  /// Whether the face lies on skin: at five points along it, and at two across, at least five of the seven.
  bool touches(const Vec3d& place, const Vec3d& axis, const Vec3d& lateral) const
  {
    const Vec3d elevation = glm::cross(axis, lateral);
    int touching = 0;
    const auto check = [&](const Vec3d& face) {
      for (double r = -contactMm; r <= contactMm; r += grid_.stepMm())
      {
        const Vec3d at = face + r * axis;
        if (!grid_.isInside(at))
        {
          return;
        }
        const bool isBody = !grid_.isOuter(grid_.at(at));
        if (isBody)
        {
          const bool isTooDeep = r <= -contactMm; // the face would be pressed in
          touching += !isTooDeep && grid_.isCovered(at, -axis) ? 1 : 0;
          return;
        }
      }
    };
    for (int i = -2; i <= 2; ++i)
    {
      const double share = 0.5 * i;
      const Vec2f edge = planeFromBeam(geometry_, 0.5 * (1.0 + share) * (lineCount - 1), 0.0);
      check(place + double(edge.y) * axis + share * halfFaceMm_ * lateral);
    }
    check(place + 0.7 * contactMm * elevation);
    check(place - 0.7 * contactMm * elevation);
    return touching >= 5;
  }

  AcousticWindow show(const Vec3d& place, const Vec3d& axis, const Vec3d& lateral) const
  {
    AcousticWindow window;
    if (!touches(place, axis, lateral))
    {
      return window;
    }
    const auto lines = makeScanLines(geometry_, ProbePose{ place, axis, lateral });
    const double stepMm = grid_.stepMm();
    const auto bins = std::size_t(geometry_.depthMm / stepMm) + 1;
    std::vector<double> all(bins, 0.0);    // area by depth
    std::vector<double> inside(bins, 0.0); // of these within the box
    std::vector<double> clear(bins, 0.0);  // of these without shadow
    std::vector<double> areas(bins);       // of a step
    for (std::size_t bin = 0; bin < bins; ++bin)
    {
      const double r = (double(bin) + 0.5) * stepMm;
      const ScanLine& a = lines[lineCount / 2];
      const ScanLine& b = lines[lineCount / 2 + 1];
      areas[bin] = stepMm * glm::distance(a.originMm + r * a.axis, b.originMm + r * b.axis);
      all[bin] = areas[bin] * lineCount;
    }
    double seenMm2 = 0.0;
    double lossSum = 0.0;
    double farMm = 0.0;
    for (const ScanLine& line : lines)
    {
      walk(line.originMm, line.axis, geometry_.depthMm,
           [&](double r, std::size_t cell, double lossDb, double excessDb) {
             const auto bin = std::size_t(r / stepMm);
             inside[bin] += areas[bin];
             clear[bin] += excessDb < shadowDb ? areas[bin] : 0.0;
             if (grid_.isTarget(cell))
             {
               const double amplitude = std::pow(10.0, -excessDb / 20.0);
               seenMm2 += amplitude * areas[bin];
               lossSum += amplitude * areas[bin] * lossDb;
               farMm = excessDb < shadowDb ? std::max(farMm, r) : farMm;
             }
           });
    }
    if (seenMm2 <= 0.0)
    {
      return window;
    }
    const double leastMm = isLinear_ ? 20.0 : 40.0;
    const double reachMm = std::floor(geometry_.depthMm / depthStepMm) * depthStepMm;
    window.depthMm =
      std::clamp(std::ceil(farMm * beyondTarget / depthStepMm) * depthStepMm, leastMm, std::max(leastMm, reachMm));
    const auto until = std::min(bins, std::size_t(window.depthMm / stepMm));
    const auto sumOf = [&](const std::vector<double>& values) {
      double sum = 0.0;
      for (std::size_t bin = 0; bin < until; ++bin)
      {
        sum += values[bin];
      }
      return sum;
    };
    const double insideShare = sumOf(inside) / sumOf(all);
    const double clearShare = sumOf(clear) / std::max(sumOf(inside), 1e-9);
    const double seenShare = std::min(1.0, seenMm2 / grid_.targetAreaMm2());
    window.seenPercent = 100.0 * seenShare;
    window.insidePercent = 100.0 * insideShare;
    window.lossDb = lossSum / seenMm2;
    window.score = seenShare * insideShare * 0.5 * (1.0 + clearShare) * std::pow(10.0, -window.lossDb / lossScaleDb);
    return window;
  }

  const WindowGrid& grid_;
  ScanGeometry geometry_;
  bool isLinear_ = false;
  Mat3d toLocal_;
  Mat3d toWorld_;
  double halfFaceMm_ = 0.0;
  std::vector<double> lossOfStep_;     // dB, by tissue
  std::vector<double> lossOfBoundary_; // dB, from a tissue to another
  double softLossOfMm_ = 0.0;
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
