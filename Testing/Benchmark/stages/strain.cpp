// Speckle tracking on the bundled thorax's beating heart in its apical four-chamber view, against the strain that it
// has. With SONOVDB_REGISTERED, a folder that the stage `registered` has filled, the walls ride on displacements from
// there.
#include "ApicalImage.h"
#include "Folders.h"
#include "Labels/AssignTissues.h"
#include "Phantoms/ThoraxBody.h"
#include "Phantoms/ThoraxPhantom.h"
#include "Simulator.h"
#include "Stage.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace sono {
namespace {

const std::string data = dataFolder();

constexpr int phases = 24; // of a cycle
constexpr int frames = 9;  // of them, from the end of diastole to that of systole
constexpr int step = 6;    // RF samples between those that are compared
constexpr double halfKernelMm = 3.5;
constexpr double halfSearchMm = 3.5;
constexpr int halfKernelLines = 4;
constexpr int halfSearchLines = 4;

using Wall = std::vector<Vec3d>; // from base to apex, world mm

using Motion = std::shared_ptr<const TissueMotion>;
using MotionAt = std::function<Motion(const GridPlacement&, int frame)>;

ThoraxParameters bodyAt(int frame)
{
  ThoraxParameters parameters;
  parameters.phase = double(frame) / phases;
  return parameters;
}

Motion still(const GridPlacement& /*grid*/, int /*frame*/)
{
  return nullptr;
}

Motion known(const GridPlacement& grid, int frame)
{
  return std::make_shared<const TissueMotion>(grid, thoraxDisplacementMm(grid, bodyAt(frame)), thoraxMovingLabels());
}

template<class Value>
std::vector<Value> readAll(const std::string& fileName)
{
  std::ifstream file(fileName, std::ios::binary | std::ios::ate);
  std::vector<Value> values(file ? std::size_t(file.tellg()) / sizeof(Value) : 0);
  file.seekg(0);
  if (!file.read(reinterpret_cast<char*>(values.data()), std::streamsize(values.size() * sizeof(Value))))
  {
    throw Error(fileName + " cannot be read; run Testing/measure.sh registered");
  }
  return values;
}

Motion registered(const std::string& folder, const GridPlacement& grid, int frame)
{
  const auto ids = readAll<std::int32_t>(folder + "/moving_labels");
  return std::make_shared<const TissueMotion>(grid, readAll<Vec3f>(folder + "/displacement_" + std::to_string(frame)),
                                              std::set<int>(ids.begin(), ids.end()));
}

std::shared_ptr<const Scene> sceneAt(int frame, const MotionAt& motionAt)
{
  LabelVolume volume = makeThoraxPhantom(1.0, bodyAt(frame));
  const auto table = TissueTable::read(data + "/tissues.csv");
  assignTissues(volume, LabelTissueMap::read(data + "/label_tissues.csv"), table, "soft_tissue");
  const Motion motion = motionAt(volume.placement, frame);
  return std::make_shared<const Scene>(std::move(volume), table, "air", std::vector<std::uint8_t>{}, motion);
}

/// Along the middle of a wall in the image plane, by the shapes that draw it; `side` is -1 for the septum, 1 for the
/// free wall.
Wall wallAt(double side)
{
  const ProbePose pose = thoraxPhantomA4C();
  Wall wall;
  for (double depthMm = 98.0; depthMm >= 52.0; depthMm -= 2.0)
  {
    const double radiusMm = 27.0 * std::sqrt(1.0 - std::pow((depthMm - 87.0) / 59.0, 2));
    wall.push_back(pose.positionMm + depthMm * pose.axial + (5.0 + side * radiusMm) * pose.lateral);
  }
  return wall;
}

double lengthMm(const std::vector<Vec2d>& points)
{
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
  {
    sum += glm::distance(points[i], points[i - 1]);
  }
  return sum;
}

/// Lateral and axial, mm, in the image plane.
Vec2d inPlane(const Vec3d& world)
{
  const ProbePose pose = thoraxPhantomA4C().orthonormalized();
  const Vec3d q = world - pose.positionMm;
  return { glm::dot(q, pose.lateral), glm::dot(q, pose.axial) };
}

/// A frame by line and depth.
struct Frame
{
  int lines = 0;
  int depths = 0;
  double depthMm = 0.0; // between two
  double firstRad = 0.0;
  double lineRad = 0.0;
  std::vector<float> value;

  float at(int line, int depth) const { return value[std::size_t(line) * std::size_t(depths) + std::size_t(depth)]; }
  /// Line and depth, in their steps.
  Vec2d placeOf(const Vec2d& mm) const
  {
    return { (std::atan2(mm.x, mm.y) - firstRad) / lineRad, glm::length(mm) / depthMm };
  }
  Vec2d mmOf(const Vec2d& place) const
  {
    const double angle = firstRad + place.x * lineRad;
    return place.y * depthMm * Vec2d(std::sin(angle), std::cos(angle));
  }
};

Frame frameAt(int number, const MotionAt& motionAt)
{
  ImageInput input;
  input.settings = a4cWith(InterfaceModel::Acoustic);
  input.settings.tracing.pathsPerLine = 64;
  input.settings.setDevice(Device::Cpu);
  input.pose = thoraxPhantomA4C().orthonormalized();
  Simulator simulator(sceneAt(number, motionAt));
  const RfLines rf = simulator.rf(input).host();
  const std::vector<ScanLine> lines = a4cLines(input.settings);
  const auto angleOf = [&](const ScanLine& line) {
    return std::atan2(glm::dot(line.axis, input.pose.lateral), glm::dot(line.axis, input.pose.axial));
  };
  Frame frame;
  frame.lines = rf.lineCount;
  frame.depths = rf.sampleCount / step;
  frame.depthMm = rf.sampleMm * step;
  frame.firstRad = angleOf(lines.front());
  frame.lineRad = (angleOf(lines.back()) - frame.firstRad) / double(rf.lineCount - 1);
  const std::vector<float> envelope = rf.envelope();
  for (int l = 0; l < frame.lines; ++l)
  {
    for (int d = 0; d < frame.depths; ++d)
    {
      frame.value.push_back(std::sqrt(envelope[std::size_t(l) * std::size_t(rf.sampleCount) + std::size_t(d) * step]));
    }
  }
  return frame;
}

/// Normalised cross-correlation of the kernel around a place of one frame with that of another.
double likeness(const Frame& a, int lineA, int depthA, const Frame& b, int lineB, int depthB, int halfDepths)
{
  double sa = 0.0, sb = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
  int count = 0;
  for (int l = -halfKernelLines; l <= halfKernelLines; ++l)
  {
    for (int d = -halfDepths; d <= halfDepths; ++d)
    {
      const int la = lineA + l, lb = lineB + l, da = depthA + d, db = depthB + d;
      if (la < 0 || lb < 0 || la >= a.lines || lb >= b.lines || da < 0 || db < 0 || da >= a.depths || db >= b.depths)
      {
        continue;
      }
      const double x = double(a.at(la, da));
      const double y = double(b.at(lb, db));
      sa += x;
      sb += y;
      aa += x * x;
      bb += y * y;
      ab += x * y;
      ++count;
    }
  }
  const double n = std::max(count, 1);
  const double spread = (aa - sa * sa / n) * (bb - sb * sb / n);
  return spread > 0.0 ? (ab - sa * sb / n) / std::sqrt(spread) : -1.0;
}

double peak(double before, double at, double after)
{
  const double curve = before - 2.0 * at + after;
  return curve < 0.0 ? std::clamp(0.5 * (before - after) / curve, -0.5, 0.5) : 0.0;
}

/// Likeness of the kernel around a point to those around the places that it may have gone to, 0 where negative.
struct LikenessMap
{
  int halfDepths = 0;
  std::vector<double> value;

  /// Lines and depths that it went; 0 beyond the map.
  double at(int lines, int depths) const
  {
    const bool isThere = std::abs(lines) <= halfSearchLines && std::abs(depths) <= halfDepths;
    return isThere ? value[std::size_t((lines + halfSearchLines) * (2 * halfDepths + 1) + depths + halfDepths)] : 0.0;
  }
};

LikenessMap likenessMap(const Frame& a, const Frame& b, const Vec2d& place)
{
  const int line = int(std::lround(place.x));
  const int depth = int(std::lround(place.y));
  LikenessMap map;
  map.halfDepths = int(halfSearchMm / a.depthMm);
  for (int l = -halfSearchLines; l <= halfSearchLines; ++l)
  {
    for (int d = -map.halfDepths; d <= map.halfDepths; ++d)
    {
      map.value.push_back(
        std::max(0.0, likeness(a, line, depth, b, line + l, depth + d, int(halfKernelMm / a.depthMm))));
    }
  }
  return map;
}

/// A round of the search for a wall's steps, each about what the one before has found.
struct Round
{
  int neighbours; ///< to each side, whose maps are added to a point's
  int lines;      ///< to each side
  double mm;
  int degree; ///< of the polynomial along the wall that the steps then are
};
constexpr int all = 1000;
constexpr Round rounds[] = { { all, halfSearchLines, halfSearchMm, 0 },
                             { 8, 3, 1.5, 2 },
                             { 4, 2, 1.0, 2 },
                             { 2, 2, 0.7, 2 } };

struct Step
{
  Vec2d place; ///< lines and depths
  double likeness = 0.0;
};

/// Where the maps of a point and its neighbours, each shifted by how much further that is to go, have their common
/// peak.
Step commonPeak(const std::vector<LikenessMap>& maps, const std::vector<Vec2d>& centres, int point, const Round& round,
                double depthMm)
{
  const int first = std::max(0, point - round.neighbours);
  const int last = std::min(int(maps.size()) - 1, point + round.neighbours);
  const auto centreOf = [&](int n) {
    const Vec2d& centre = centres[std::size_t(n)];
    return std::pair(int(std::lround(centre.x)), int(std::lround(centre.y)));
  };
  const auto like = [&](int l, int d) {
    double sum = 0.0;
    for (int n = first; n <= last; ++n)
    {
      const auto [line, depth] = centreOf(n);
      sum += maps[std::size_t(n)].at(line + l, depth + d);
    }
    return sum / double(last - first + 1);
  };
  const int halfDepths = int(round.mm / depthMm);
  double best = -1.0;
  int bestLine = 0;
  int bestDepth = 0;
  for (int l = -round.lines; l <= round.lines; ++l)
  {
    for (int d = -halfDepths; d <= halfDepths; ++d)
    {
      const double here = like(l, d);
      if (here > best)
      {
        best = here;
        bestLine = l;
        bestDepth = d;
      }
    }
  }
  const auto [line, depth] = centreOf(point);
  return { { line + bestLine + peak(like(bestLine - 1, bestDepth), best, like(bestLine + 1, bestDepth)),
             depth + bestDepth + peak(like(bestLine, bestDepth - 1), best, like(bestLine, bestDepth + 1)) },
           best };
}

/// The points' steps as a polynomial along the wall, 2nd degree at most, weighted by how sure each is.
std::vector<Vec2d> smoothed(const std::vector<Step>& steps, int degree)
{
  glm::dmat3 normal(0.0);
  Vec3d right[2] = { Vec3d(0.0), Vec3d(0.0) };
  const auto basis = [&](std::size_t i) {
    const double s = 2.0 * double(i) / double(steps.size() - 1) - 1.0;
    return Vec3d(1.0, degree > 0 ? s : 0.0, degree > 1 ? s * s : 0.0);
  };
  for (int unused = degree + 1; unused < 3; ++unused)
  {
    normal[unused][unused] = 1.0;
  }
  for (std::size_t i = 0; i < steps.size(); ++i)
  {
    const double w = std::pow(steps[i].likeness, 4) + 1e-6;
    normal += w * glm::outerProduct(basis(i), basis(i));
    right[0] += w * steps[i].place.x * basis(i);
    right[1] += w * steps[i].place.y * basis(i);
  }
  const glm::dmat3 solve = glm::inverse(normal);
  std::vector<Vec2d> out;
  for (std::size_t i = 0; i < steps.size(); ++i)
  {
    out.push_back({ glm::dot(basis(i), solve * right[0]), glm::dot(basis(i), solve * right[1]) });
  }
  return out;
}

/// Moves points, mm, to where their speckle is in the next frame; gives their mean likeness.
double follow(const Frame& a, const Frame& b, std::vector<Vec2d>& points)
{
  std::vector<LikenessMap> maps;
  for (const Vec2d& point : points)
  {
    maps.push_back(likenessMap(a, b, a.placeOf(point)));
  }
  std::vector<Vec2d> moved(points.size(), Vec2d(0.0));
  double sum = 0.0;
  for (const Round& round : rounds)
  {
    std::vector<Step> steps;
    sum = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      steps.push_back(commonPeak(maps, moved, int(i), round, a.depthMm));
      sum += steps.back().likeness;
    }
    moved = smoothed(steps, round.degree);
  }
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    points[i] = a.mmOf(a.placeOf(points[i]) + moved[i]);
  }
  return sum / double(points.size());
}

struct Tracked
{
  double errorPoints = 0.0; ///< largest of the frames and walls, percent points of strain
  double endErrorPoints = 0.0;
  double trueEndPercent = 0.0;
  double likeness = 0.0; ///< mean
};

Tracked track(const std::vector<Frame>& cine)
{
  Tracked result;
  for (const double side : { -1.0, 1.0 })
  {
    const Wall wall = wallAt(side);
    std::vector<Vec2d> points;
    for (const Vec3d& p : wall)
    {
      points.push_back(inPlane(p));
    }
    const double lengthBefore = lengthMm(points);
    for (int f = 1; f < frames; ++f)
    {
      result.likeness += follow(cine[std::size_t(f - 1)], cine[std::size_t(f)], points) / double(2 * (frames - 1));
      const ThoraxBody body(bodyAt(f));
      std::vector<Vec2d> truly;
      for (const Vec3d& p : wall)
      {
        truly.push_back(inPlane(body.placeMm(p)));
      }
      const double measured = 100.0 * (lengthMm(points) / lengthBefore - 1.0);
      const double truth = 100.0 * (lengthMm(truly) / lengthBefore - 1.0);
      std::fprintf(stderr, "%s wall, frame %d: strain %.2f %%, known %.2f %%\n", side < 0.0 ? "septal" : "lateral", f,
                   measured, truth);
      result.errorPoints = std::max(result.errorPoints, std::abs(measured - truth));
      if (f == frames - 1)
      {
        result.endErrorPoints = std::max(result.endErrorPoints, std::abs(measured - truth));
        result.trueEndPercent += 0.5 * truth;
      }
    }
  }
  return result;
}

std::vector<Frame> cineOf(const MotionAt& motionAt)
{
  std::vector<Frame> cine;
  for (int f = 0; f < frames; ++f)
  {
    cine.push_back(frameAt(f, motionAt));
  }
  return cine;
}

void measureRegistered(const std::string& folder)
{
  const Tracked found =
    track(cineOf([&folder](const GridPlacement& grid, int frame) { return registered(folder, grid, frame); }));
  printFigure("strain_registered_error_points", found.errorPoints, "points", "at most 2");
  printFigure("strain_registered_end_error_points", found.endErrorPoints, "points");
  printFigure("strain_registered_correlation", found.likeness, "");
}

void measureStrain()
{
  if (const char* folder = std::getenv("SONOVDB_REGISTERED"))
  {
    return measureRegistered(folder);
  }
  const Tracked locked = track(cineOf(known));
  printFigure("strain_true_percent", locked.trueEndPercent, "%");
  printFigure("strain_error_percent_points", locked.errorPoints, "points", "at most 2");
  printFigure("strain_end_error_percent_points", locked.endErrorPoints, "points");
  printFigure("strain_correlation", locked.likeness, "");
  const Tracked standing = track(cineOf(still));
  printFigure("strain_unlocked_error_percent_points", standing.errorPoints, "points");
  printFigure("strain_unlocked_correlation", standing.likeness, "");
}

const Stage stage("strain", measureStrain);

} // namespace
} // namespace sono
