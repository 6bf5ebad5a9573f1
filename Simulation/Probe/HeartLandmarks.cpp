#include "Probe/HeartLandmarks.h"

#include "Core/Error.h"
#include "Labels/LabelWords.h"
#include "Probe/PlaneFit.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace sono {
namespace {

constexpr double finestCellMm = 1.0;
constexpr double meetMm[] = { 3.0, 5.0, 8.0 };
constexpr std::size_t fewestPlaces = 12;
constexpr std::size_t sectorCount = 24;
constexpr int fitRounds = 6;
constexpr double offPlaneMm = 4.0;
constexpr double apexCapMm = 4.0; // in which the apex's direction is averaged
constexpr double cutShare = 0.2;  // of a cavity's mean section that may lie on the box's faces

using Cells = std::vector<Vec3i>;

/// The parts of the heart on cells of at least 1 mm, in the box that holds them.
class PartGrid
{
public:
  explicit PartGrid(const LabelVolume& volume)
    : volume_(volume)
    , parts_(volume.labels)
    , factor_(glm::max(Vec3i(glm::floor(finestCellMm / volume.placement.spacingMm + 1e-9)), Vec3i(1)))
    , size_((volume.placement.size + factor_ - 1) / factor_)
    , cellMm_(volume.placement.spacingMm * Vec3d(factor_))
  {
    cells_.resize(std::size_t(HeartPart::InferiorVenaCava) + 1);
    const Vec3i n = volume.placement.size;
    for (int k = 0; k < size_.z; ++k)
    {
      for (int j = 0; j < size_.y; ++j)
      {
        const Vec3i v = voxelOf({ 0, j, k });
        const std::uint16_t* row = volume.voxels.data() + (std::size_t(v.z) * n.y + v.y) * n.x;
        for (int i = 0; i < size_.x; ++i)
        {
          const HeartPart part = parts_.of(row[std::min(i * factor_.x + factor_.x / 2, n.x - 1)]);
          if (part != HeartPart::None)
          {
            cells_[std::size_t(part)].emplace_back(i, j, k);
          }
        }
      }
    }
  }

  const HeartParts& parts() const { return parts_; }
  const Cells& cells(HeartPart part) const { return cells_[std::size_t(part)]; }
  bool isInside(const Vec3i& c) const
  {
    return glm::all(glm::greaterThanEqual(c, Vec3i(0))) && glm::all(glm::lessThan(c, size_));
  }
  HeartPart at(const Vec3i& c) const
  {
    const Vec3i n = volume_.placement.size;
    const Vec3i v = voxelOf(c);
    return parts_.of(volume_.voxels[(std::size_t(v.z) * n.y + v.y) * n.x + v.x]);
  }
  Vec3d worldMm(const Vec3i& c) const { return volume_.placement.worldFromIndex(Vec3d(voxelOf(c))); }

  Vec3d centroid(HeartPart part) const
  {
    Vec3d sum(0.0);
    for (const Vec3i& c : cells(part))
    {
      sum += worldMm(c);
    }
    return sum / double(cells(part).size());
  }

  /// Cells around one, within a distance.
  Cells ball(double radiusMm) const
  {
    Cells offsets;
    const Vec3i reach(glm::ceil(radiusMm / cellMm_));
    for (int k = -reach.z; k <= reach.z; ++k)
    {
      for (int j = -reach.y; j <= reach.y; ++j)
      {
        for (int i = -reach.x; i <= reach.x; ++i)
        {
          if (glm::length(cellMm_ * Vec3d(i, j, k)) <= radiusMm)
          {
            offsets.emplace_back(i, j, k);
          }
        }
      }
    }
    return offsets;
  }
  double coarsestMm() const { return std::max({ cellMm_.x, cellMm_.y, cellMm_.z }); }

  bool isCut(HeartPart part) const
  {
    Vec3d onFacesMm2(0.0);
    for (const Vec3i& c : cells(part))
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        const bool isOnFace = c[axis] == 0 || c[axis] == size_[axis] - 1;
        onFacesMm2[axis] += isOnFace && size_[axis] > 1 ? cellMm_.x * cellMm_.y * cellMm_.z / cellMm_[axis] : 0.0;
      }
    }
    const double volumeMm3 = double(cells(part).size()) * cellMm_.x * cellMm_.y * cellMm_.z;
    return onFacesMm2.x + onFacesMm2.y + onFacesMm2.z > cutShare * std::pow(volumeMm3, 2.0 / 3.0);
  }

private:
  Vec3i voxelOf(const Vec3i& c) const { return glm::min(c * factor_ + factor_ / 2, volume_.placement.size - 1); }

  const LabelVolume& volume_;
  HeartParts parts_;
  Vec3i factor_;
  Vec3i size_;
  Vec3d cellMm_;
  std::vector<Cells> cells_; // by part
};

/// Directions around a middle, in sectors.
struct Around
{
  Vec3d middleMm;
  Vec3d u;
  Vec3d v;

  std::size_t sector(const Vec3d& place) const
  {
    const Vec3d from = place - middleMm;
    const double turn = std::atan2(glm::dot(from, v), glm::dot(from, u)) / (2.0 * 3.14159265358979323846) + 0.5;
    return std::min(sectorCount - 1, std::size_t(turn * sectorCount));
  }
};

Around aroundOf(const Annulus& ring)
{
  const Vec3d helper = std::abs(ring.normal.x) < 0.8 ? Vec3d(1.0, 0.0, 0.0) : Vec3d(0.0, 1.0, 0.0);
  const Vec3d u = glm::normalize(glm::cross(ring.normal, helper));
  return { ring.centreMm, u, glm::cross(ring.normal, u) };
}

/// Moves a ring to the circle of least squares (Kasa 1976) through the means of each sector's places, so that an arc
/// without places pulls nowhere.
void fitCircle(const std::vector<Vec3d>& places, Annulus& ring)
{
  const Around around = aroundOf(ring);
  std::vector<Vec3d> sums(sectorCount, Vec3d(0.0));
  std::vector<int> counts(sectorCount, 0);
  for (const Vec3d& place : places)
  {
    const std::size_t sector = around.sector(place);
    sums[sector] += place - ring.centreMm;
    ++counts[sector];
  }
  Mat3d normal(0.0); // equations of x^2 + y^2 = 2 a x + 2 b y + c
  Vec3d right(0.0);
  double height = 0.0;
  int used = 0;
  for (std::size_t sector = 0; sector < sectorCount; ++sector)
  {
    if (counts[sector] > 0)
    {
      const Vec3d mean = sums[sector] / double(counts[sector]);
      const Vec3d row(glm::dot(mean, around.u), glm::dot(mean, around.v), 1.0);
      normal += glm::outerProduct(row, row);
      right += row * (row.x * row.x + row.y * row.y);
      height += glm::dot(mean, ring.normal);
      ++used;
    }
  }
  const bool isRound = used >= int(sectorCount) / 2; // of a short arc the middle, since its circle may be anywhere
  const Vec3d solution = isRound ? glm::inverse(normal) * right : 2.0 / used * normal[2];
  const double x = 0.5 * solution.x;
  const double y = 0.5 * solution.y;
  const double meanSquare = right.z / used - 2.0 * (x * normal[2].x + y * normal[2].y) / used + x * x + y * y;
  ring.centreMm += x * around.u + y * around.v + height / used * ring.normal;
  ring.radiusMm = std::sqrt(std::max(0.0, meanSquare));
}

/// The ring that fits places around it best, its normal away from `from`; those that are far from its plane, or from
/// its line, do not count.
Annulus fitRing(std::vector<Vec3d> places, const Vec3d& from)
{
  Annulus ring;
  ring.centreMm = fitPlane(places).middleMm;
  for (int round = 0; round < fitRounds; ++round)
  {
    ring.normal = fitPlane(places).normal();
    ring.normal *= glm::dot(ring.normal, ring.centreMm - from) < 0.0 ? -1.0 : 1.0;
    fitCircle(places, ring);
    std::vector<Vec3d> near;
    std::copy_if(places.begin(), places.end(), std::back_inserter(near), [&](const Vec3d& place) {
      const Vec3d away = place - ring.centreMm;
      return std::abs(glm::dot(away, ring.normal)) < offPlaneMm && glm::length(away) < 1.6 * ring.radiusMm;
    });
    if (near.size() < fewestPlaces)
    {
      break;
    }
    places = std::move(near);
  }
  return ring;
}

/// Of leaflets, which hang along the wall for a while, only where they begin: in each sector what is highest and
/// outermost, millimetre by millimetre.
std::vector<Vec3d> hinges(const std::vector<Vec3d>& places, const Annulus& ring, double cellMm)
{
  const Around around = aroundOf(ring);
  const auto reach = [&](const Vec3d& place) {
    const Vec3d from = place - ring.centreMm;
    const double up = glm::dot(from, ring.normal);
    return up + glm::length(from - up * ring.normal);
  };
  std::vector<double> top(sectorCount, -1e9);
  for (const Vec3d& place : places)
  {
    double& sector = top[around.sector(place)];
    sector = std::max(sector, reach(place));
  }
  std::vector<Vec3d> highest;
  std::copy_if(places.begin(), places.end(), std::back_inserter(highest),
               [&](const Vec3d& place) { return reach(place) > top[around.sector(place)] - cellMm; });
  return highest;
}

/// Places of `own` where two cavities meet (the valve stands for both): beside something else, or all.
struct Meeting
{
  std::vector<Vec3d> rim;
  std::vector<Vec3d> all;
};

void addMeeting(const PartGrid& grid, HeartPart own, HeartPart a, HeartPart b, HeartPart valve, double withinMm,
                Meeting& meeting)
{
  const double besideMm = 1.5 * grid.coarsestMm();
  const Cells around = grid.ball(std::max(withinMm, besideMm));
  const Cells beside = grid.ball(besideMm);
  for (const Vec3i& cell : grid.cells(own))
  {
    const auto partBeside = [&](const Vec3i& offset) {
      const Vec3i c = cell + offset;
      return grid.isInside(c) ? grid.at(c) : own;
    };
    bool hasA = own != b;
    bool hasB = own != a;
    for (const Vec3i& offset : around)
    {
      const HeartPart part = partBeside(offset);
      hasA = hasA || part == a || part == valve;
      hasB = hasB || part == b || part == valve;
    }
    if (hasA && hasB)
    {
      const bool hasOther = std::any_of(beside.begin(), beside.end(), [&](const Vec3i& offset) {
        const HeartPart part = partBeside(offset);
        return part != a && part != b && part != valve;
      });
      (hasOther ? meeting.rim : meeting.all).push_back(grid.worldMm(cell));
    }
  }
}

std::optional<Annulus> findAnnulus(const PartGrid& grid, HeartPart a, HeartPart b, HeartPart valve)
{
  if (grid.cells(b).empty() && grid.cells(valve).empty())
  {
    return std::nullopt;
  }
  const Vec3d ventricle = grid.centroid(a);
  Meeting ofValve;
  addMeeting(grid, valve, a, b, valve, meetMm[0], ofValve);
  if (ofValve.rim.size() >= fewestPlaces)
  {
    const Annulus ring = fitRing(ofValve.rim, ventricle);
    return fitRing(hinges(ofValve.rim, ring, grid.coarsestMm()), ventricle);
  }
  for (const double withinMm : meetMm)
  {
    Meeting meeting;
    addMeeting(grid, a, a, b, valve, withinMm, meeting);
    addMeeting(grid, b, a, b, valve, withinMm, meeting);
    const auto& places = meeting.rim.size() >= fewestPlaces ? meeting.rim : meeting.all;
    if (places.size() >= fewestPlaces)
    {
      return fitRing(places, ventricle);
    }
  }
  return std::nullopt;
}

Annulus requireAnnulus(const PartGrid& grid, HeartPart a, HeartPart b, HeartPart valve)
{
  const std::optional<Annulus> found = findAnnulus(grid, a, b, valve);
  if (!found)
  {
    throw Error(std::string("The ") + nameOf(a) + " and the " + nameOf(b) +
                " do not come within 8 mm of each other in the label map, so that the valve between them is not found; "
                "label the valve, or correct the chambers.");
  }
  return *found;
}

void requireChambers(const PartGrid& grid, const std::vector<LabelInfo>& labels)
{
  std::string missing;
  for (const HeartPart part : { HeartPart::LeftVentricle, HeartPart::LeftAtrium, HeartPart::RightVentricle })
  {
    missing += grid.cells(part).empty() ? (missing.empty() ? "no " : ", no ") + std::string(nameOf(part)) : "";
  }
  if (missing.empty())
  {
    return;
  }
  const auto heart = std::find_if(labels.begin(), labels.end(), [](const LabelInfo& label) {
    const auto words = wordsOfName(label.name);
    return std::find(words.begin(), words.end(), "heart") != words.end();
  });
  throw Error("The label map has " + missing + (heart == labels.end() ? "" : ", only a '" + heart->name + "'") +
              "; standard views of a heart are found by its chambers: take a segmentation with the four chambers' "
              "cavities as labels of their own.");
}

/// The farthest point from the base; its direction is that of the cavity's end, which trabeculae make rough.
Vec3d findApex(const PartGrid& grid, const Vec3d& baseMm)
{
  double farthestMm = 0.0;
  for (const Vec3i& cell : grid.cells(HeartPart::LeftVentricle))
  {
    farthestMm = std::max(farthestMm, glm::distance(grid.worldMm(cell), baseMm));
  }
  Vec3d sum(0.0);
  for (const Vec3i& cell : grid.cells(HeartPart::LeftVentricle))
  {
    const Vec3d from = grid.worldMm(cell) - baseMm;
    sum += glm::length(from) > farthestMm - apexCapMm ? from : Vec3d(0.0);
  }
  return baseMm + farthestMm * glm::normalize(sum);
}

} // namespace

Vec3d HeartLandmarks::septal() const
{
  return glm::normalize(across((tricuspid ? tricuspid->centreMm : rightVentricleMm) - apexMm));
}

HeartLandmarks findHeartLandmarks(const LabelVolume& volume)
{
  const PartGrid grid(volume);
  requireChambers(grid, volume.labels);
  if (grid.isCut(HeartPart::LeftVentricle))
  {
    throw Error("The label map's box cuts the left ventricle, so that its apex or its base may lie beyond it; take a "
                "label map with the whole heart.");
  }
  HeartLandmarks found;
  found.leftVentricleMm = grid.centroid(HeartPart::LeftVentricle);
  found.rightVentricleMm = grid.centroid(HeartPart::RightVentricle);
  found.leftAtriumMm = grid.centroid(HeartPart::LeftAtrium);
  found.mitral = requireAnnulus(grid, HeartPart::LeftVentricle, HeartPart::LeftAtrium, HeartPart::MitralValve);
  if (!grid.cells(HeartPart::RightAtrium).empty())
  {
    found.rightAtriumMm = grid.centroid(HeartPart::RightAtrium);
    found.tricuspid =
      requireAnnulus(grid, HeartPart::RightVentricle, HeartPart::RightAtrium, HeartPart::TricuspidValve);
  }
  found.aortic = findAnnulus(grid, HeartPart::LeftVentricle, HeartPart::Aorta, HeartPart::AorticValve);
  found.apexMm = findApex(grid, found.mitral.centreMm);
  return found;
}

} // namespace sono
