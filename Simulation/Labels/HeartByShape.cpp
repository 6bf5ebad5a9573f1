#include "Labels/HeartByShape.h"

#include "Core/ParallelFor.h"
#include "Labels/LabelCode.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <mutex>
#include <set>
#include <vector>

namespace sono {
namespace {

constexpr double enclosed = 0.6;
constexpr double touching = 0.02;
constexpr double gapMm = 4.0; // or a voxel, across which labels touch: a valve that has no label
constexpr double leastMl = 4.0;
constexpr double mostMl = 600.0;
constexpr double leastOfCavity = 0.1;
constexpr double mostOfCavity = 10.0;
constexpr double thinnestMm = 2.0;
constexpr double thickestMm = 30.0;
constexpr double ofStairs = 1.5; // area of a ball's voxel faces, of its surface
constexpr std::size_t mostLabels = 64;

/// Of labels that fillBody and fillFromCt add.
const std::set<std::string> fillNames{ "skin", "soft_tissue", "fat", "muscle", "lung", "bone", "gas" };

/// Pairs of labels by their indices.
using Pairs = std::vector<std::size_t>;

void addTo(Pairs& sums, const Pairs& more)
{
  std::transform(sums.begin(), sums.end(), more.begin(), sums.begin(), std::plus<>());
}

/// How many voxels each label has and how many voxel faces two of them share, by the axis that a face lies across.
struct Counts
{
  std::size_t labels;
  Pairs voxels = Pairs(labels);
  std::array<Pairs, 3> touching = { Pairs(labels * labels), Pairs(labels* labels), Pairs(labels* labels) };
  std::array<Pairs, 3> acrossGap = touching; ///< with nothing but 0 in between

  void add(const Counts& other)
  {
    addTo(voxels, other.voxels);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      addTo(touching[axis], other.touching[axis]);
      addTo(acrossGap[axis], other.acrossGap[axis]);
    }
  }
};

/// A voxel and its faces towards lower indices.
void countVoxel(const LabelVolume& volume, const std::vector<int>& indexOf, const Vec3i& place, Counts& counts)
{
  const Vec3i n = volume.placement.size;
  const std::size_t step[3] = { 1, std::size_t(n.x), std::size_t(n.x) * n.y };
  const std::size_t at = std::size_t(place.x) + step[1] * std::size_t(place.y) + step[2] * std::size_t(place.z);
  const std::uint16_t id = volume.voxels[at];
  const auto here = std::size_t(indexOf[id]);
  ++counts.voxels[here];
  for (int axis = 0; axis < 3; ++axis)
  {
    if (place[axis] == 0 || volume.voxels[at - step[axis]] == id)
    {
      continue;
    }
    const std::uint16_t before = volume.voxels[at - step[axis]];
    ++counts.touching[std::size_t(axis)][here * counts.labels + std::size_t(indexOf[before])];
    const int most = std::min(place[axis], 1 + std::max(1, int(gapMm / volume.placement.spacingMm[axis])));
    for (int back = 2; id != 0 && before == 0 && back <= most; ++back)
    {
      const std::uint16_t other = volume.voxels[at - std::size_t(back) * step[axis]];
      if (other != 0)
      {
        counts.acrossGap[std::size_t(axis)][here * counts.labels + std::size_t(indexOf[other])] += other != id ? 1 : 0;
        break;
      }
    }
  }
}

/// How the labels of a map lie beside each other, by their indices.
class Contacts
{
public:
  explicit Contacts(const LabelVolume& volume)
    : counts_{ volume.labels.size() }
    , spacingMm_(volume.placement.spacingMm)
  {
    const std::vector<int> indexOf = volume.indexOfId();
    const Vec3i n = volume.placement.size;
    std::mutex mutex;
    parallelFor(n.z, {}, [&](int k) {
      Counts own{ counts_.labels };
      for (int j = 0; j < n.y; ++j)
      {
        for (int i = 0; i < n.x; ++i)
        {
          countVoxel(volume, indexOf, { i, j, k }, own);
        }
      }
      const std::lock_guard<std::mutex> lock(mutex); // whole numbers: in whatever order
      counts_.add(own);
    });
  }

  double volumeMm3(std::size_t a) const
  {
    return spacingMm_.x * spacingMm_.y * spacingMm_.z * double(counts_.voxels[a]);
  }
  double areaMm2(std::size_t a) const
  {
    double area = 0.0;
    for (std::size_t b = 0; b < counts_.labels; ++b)
    {
      area += areaOf(counts_.touching, a, b);
    }
    return area;
  }
  /// Of a's faces but those on the volume's border, the share that is beside b.
  double share(std::size_t a, std::size_t b) const
  {
    return areaOf(counts_.touching, a, b) / std::max(areaMm2(a), 1e-9);
  }
  /// The share that is beside b, or across a gap from it.
  double nearShare(std::size_t a, std::size_t b) const
  {
    return share(a, b) + areaOf(counts_.acrossGap, a, b) / std::max(areaMm2(a), 1e-9);
  }

private:
  double areaOf(const std::array<Pairs, 3>& faces, std::size_t a, std::size_t b) const
  {
    double area = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const double faceMm2 = spacingMm_[int((axis + 1) % 3)] * spacingMm_[int((axis + 2) % 3)];
      area += faceMm2 * double(faces[axis][a * counts_.labels + b] + faces[axis][b * counts_.labels + a]);
    }
    return area;
  }

  Counts counts_;
  Vec3d spacingMm_;
};

/// Whether b lies around a as a heart's wall around a chamber.
bool isWallOf(const Contacts& contacts, std::size_t b, std::size_t a)
{
  const double cavityMl = 1e-3 * contacts.volumeMm3(a);
  const double wallMm = 2.0 * ofStairs * contacts.volumeMm3(b) / std::max(contacts.areaMm2(b), 1e-9);
  const double ratio = contacts.volumeMm3(b) / contacts.volumeMm3(a);
  return contacts.share(a, b) >= enclosed && cavityMl >= leastMl && cavityMl <= mostMl && ratio >= leastOfCavity &&
         ratio <= mostOfCavity && wallMm >= thinnestMm && wallMm <= thickestMm;
}

/// Indices of the labels whose names tell nothing; empty where another one has a name.
std::vector<std::size_t> namelessLabels(const LabelVolume& volume)
{
  std::vector<std::size_t> nameless;
  for (std::size_t l = 0; l < volume.labels.size(); ++l)
  {
    const LabelInfo& label = volume.labels[l];
    const bool isFill = fillNames.count(label.name) != 0;
    if (label.id != 0 && saysNothing(label.name) && label.code.empty())
    {
      nameless.push_back(l);
    }
    else if (label.id != 0 && !isFill)
    {
      return {};
    }
  }
  return nameless;
}

enum class Part
{
  Unknown,
  Wall,
  Chamber
};

/// Of each of the labels.
std::vector<Part> partsOf(const Contacts& contacts, const std::vector<std::size_t>& labels)
{
  const auto hasWallIn = [&](std::size_t cavity, std::size_t wall) {
    return cavity != wall && isWallOf(contacts, wall, cavity);
  };
  const auto liesAround = [&](std::size_t wall) {
    return std::any_of(labels.begin(), labels.end(), [&](std::size_t a) { return hasWallIn(a, wall); });
  };
  std::vector<Part> parts(labels.size(), Part::Unknown);
  for (std::size_t n = 0; n < labels.size(); ++n)
  {
    for (std::size_t m = 0; m < labels.size(); ++m)
    {
      if (hasWallIn(labels[n], labels[m]) && !liesAround(labels[n]))
      {
        parts[n] = Part::Chamber;
        parts[m] = Part::Wall;
      }
    }
  }
  for (bool grows = true; grows;)
  {
    grows = false;
    for (std::size_t n = 0; n < labels.size(); ++n)
    {
      for (std::size_t m = 0; m < labels.size() && parts[n] == Part::Unknown && !liesAround(labels[n]); ++m)
      {
        if (parts[m] != Part::Unknown && contacts.nearShare(labels[n], labels[m]) > touching)
        {
          parts[n] = Part::Chamber;
          grows = true;
        }
      }
    }
  }
  return parts;
}

std::string listOf(const std::vector<std::string>& names)
{
  std::string list;
  for (std::size_t n = 0; n < names.size(); ++n)
  {
    list += (n == 0 ? "" : n + 1 == names.size() ? " and " : ", ") + names[n];
  }
  return list;
}

} // namespace

std::string guessHeart(LabelVolume& volume)
{
  const std::vector<std::size_t> nameless = namelessLabels(volume);
  if (nameless.size() < 2 || nameless.size() > mostLabels)
  {
    return {};
  }
  const std::vector<Part> parts = partsOf(Contacts(volume), nameless);
  std::vector<std::string> walls;
  std::vector<std::string> chambers;
  for (std::size_t n = 0; n < nameless.size(); ++n)
  {
    LabelInfo& label = volume.labels[nameless[n]];
    if (parts[n] == Part::Unknown)
    {
      continue;
    }
    (parts[n] == Part::Wall ? walls : chambers).push_back(label.name);
    if (label.tissue.empty())
    {
      label.tissue = parts[n] == Part::Wall ? "myocardium" : "blood";
      label.guessed = true;
    }
  }
  if (walls.empty())
  {
    return {};
  }
  return "The labels have no names, but a heart's shapes: " + listOf(walls) + (walls.size() > 1 ? " lie" : " lies") +
         " around a chamber as its wall does, so that " + listOf(chambers) + (chambers.size() > 1 ? " are" : " is") +
         " taken for blood.";
}

} // namespace sono
