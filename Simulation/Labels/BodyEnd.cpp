#include "Labels/BodyEnd.h"

#include "Core/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <functional>
#include <mutex>
#include <set>

namespace sono {
namespace {

constexpr double organMm = 200.0;
constexpr double leastOfSection = 0.2; // of the largest: more than a tip

bool endsIn(const std::set<std::string>& tissues, const LabelInfo& label)
{
  return tissues.count(label.tissue) != 0;
}

const std::set<std::string> insideABody{ "blood",       "cartilage",     "cortical_bone", "gallbladder_wall",
                                         "gi_tract",    "gland",         "kidney",        "liver",
                                         "lung",        "muscle",        "myocardium",    "nerve",
                                         "pericardium", "renal_capsule", "renal_medulla", "renal_sinus",
                                         "spleen",      "valve",         "vessel_wall" };
const std::set<std::string> ofATrunk{ "cortical_bone", "cartilage", "lung" };

/// Of each label by its index, its faces against 0, on every other row and slice; and the box of all labels.
struct Ends
{
  std::vector<std::size_t> faces;
  Vec3i low{ 1 << 30 };
  Vec3i high{ -1 };
  std::vector<std::size_t> sections; ///< voxels with labels, of each slice
};

Ends endsOf(const LabelVolume& volume)
{
  constexpr int every = 2;
  const Vec3i n = volume.placement.size;
  const std::vector<int> indexOf = volume.indexOfId();
  Ends all;
  all.faces.resize(volume.labels.size());
  all.sections.resize(std::size_t((n.z + every - 1) / every));
  std::mutex mutex;
  parallelFor(int(all.sections.size()), {}, [&](int slice) {
    Ends ends;
    ends.faces.resize(all.faces.size());
    std::size_t& section = all.sections[std::size_t(slice)];
    const int k = slice * every;
    for (int j = 0; j < n.y; j += every)
    {
      const std::uint16_t* row = volume.voxels.data() + std::size_t(n.x) * (std::size_t(j) + std::size_t(n.y) * k);
      const std::uint16_t* below = j > 0 ? row - n.x : row;
      for (int i = 0; i < n.x; ++i)
      {
        if (row[i] != 0)
        {
          ++section;
          ends.low = glm::min(ends.low, Vec3i(i, j, k));
          ends.high = glm::max(ends.high, Vec3i(i, j, k));
        }
        for (const std::uint16_t other : { i > 0 ? row[i - 1] : row[i], below[i] })
        {
          if ((row[i] == 0) != (other == 0))
          {
            ++ends.faces[std::size_t(indexOf[std::max(row[i], other)])];
          }
        }
      }
    }
    const std::lock_guard<std::mutex> lock(mutex); // whole numbers: in whatever order
    all.low = glm::min(all.low, ends.low);
    all.high = glm::max(all.high, ends.high);
    std::transform(all.faces.begin(), all.faces.end(), ends.faces.begin(), all.faces.begin(), std::plus<>());
  });
  return all;
}

/// Whether a stack of slices ends within the labels at either end, as a scan of a part of the body does.
bool isCutAtBothEnds(const Ends& ends)
{
  const double most = double(*std::max_element(ends.sections.begin(), ends.sections.end()));
  return double(std::min(ends.sections.front(), ends.sections.back())) > leastOfSection * most;
}

bool hasWord(const std::string& name, const std::string& word)
{
  std::string lower = name;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return lower.find(word) != std::string::npos;
}

} // namespace

BodyEnd bodyEnd(const LabelVolume& volume, const std::vector<std::string>& unmapped)
{
  const std::set<std::string> guessed(unmapped.begin(), unmapped.end());
  const auto isOf = [](const char* tissue) {
    return [tissue](const LabelInfo& label) { return label.tissue == tissue; };
  };
  const auto& labels = volume.labels;
  if (!volume.find(0) || volume.find(0)->tissue != "air" || std::any_of(labels.begin(), labels.end(), isOf("skin")))
  {
    return BodyEnd::Skin;
  }
  const Ends ends = endsOf(volume);
  std::size_t bare = 0;
  std::size_t closed = 0;
  bool isTrunk = false;
  std::size_t known = 0;
  for (std::size_t l = 0; l < labels.size(); ++l)
  {
    const LabelInfo& label = labels[l];
    const std::size_t faces = ends.faces[l];
    if (label.id == 0 || label.tissue == "air") // the airways'
    {
      continue;
    }
    const bool isGuess = guessed.count(label.name) != 0;
    known += isGuess ? 0 : 1;
    (isGuess || endsIn(insideABody, label) ? bare : closed) += faces;
    isTrunk = isTrunk || endsIn(ofATrunk, label);
  }
  if (bare <= closed)
  {
    return BodyEnd::Skin;
  }
  const Vec3d size = Vec3d(ends.high - ends.low + 1) * volume.placement.spacingMm;
  const bool isSmall = !isTrunk && glm::all(glm::lessThanEqual(size, Vec3d(organMm))) && !isCutAtBothEnds(ends);
  const bool touchesBorder = glm::any(glm::lessThanEqual(ends.low, Vec3i(0))) ||
                             glm::any(glm::greaterThanEqual(ends.high, volume.placement.size - 2));
  if (known == 0 && (labels.size() < 3 || touchesBorder || !isSmall))
  {
    return BodyEnd::Skin;
  }
  return isSmall ? BodyEnd::BareOrgan : BodyEnd::NoSkin;
}

BodyFill batheOrgan(LabelVolume& volume, BodyFillSettings settings, const Progress& progress)
{
  settings.wallMm = bathMm;
  const Ends ends = endsOf(volume);
  const Vec3d spacing = volume.placement.spacingMm;
  const Vec3i room = Vec3i(glm::ceil(1.25 * bathMm / spacing)) + 2; // 2: endsOf leaves rows out
  const Vec3i before = glm::max(room - ends.low, Vec3i(0));
  const Vec3i after = glm::max(room - (volume.placement.size - 1 - ends.high), Vec3i(0));
  LabelVolume wide;
  wide.placement = volume.placement;
  wide.placement.size += before + after;
  wide.placement.originMm = volume.placement.worldFromIndex(-Vec3d(before));
  wide.labels = volume.labels;
  wide.voxels.assign(wide.placement.voxelCount(), 0);
  const Vec3i n = volume.placement.size;
  const Vec3i m = wide.placement.size;
  for (int k = 0; k < n.z; ++k)
  {
    for (int j = 0; j < n.y; ++j)
    {
      const auto row =
        volume.voxels.begin() + std::ptrdiff_t(std::size_t(n.x) * (std::size_t(j) + std::size_t(n.y) * k));
      const std::size_t to = (std::size_t(k + before.z) * m.y + j + before.y) * m.x + before.x;
      std::copy(row, row + n.x, wide.voxels.begin() + std::ptrdiff_t(to));
    }
  }
  const BodyFill fill = fillBody(wide, settings, progress);
  volume = std::move(wide);
  return fill;
}

bool hasHeartWithoutChambers(const LabelVolume& volume)
{
  const auto isChamber = [](const LabelInfo& label) {
    return label.tissue == "blood" && !hasWord(label.name, "appendage") &&
           (hasWord(label.name, "ventric") || hasWord(label.name, "atri") || hasWord(label.name, "chamber") ||
            hasWord(label.name, "heart"));
  };
  const auto isHeart = [](const LabelInfo& label) {
    return label.tissue == "myocardium" && hasWord(label.name, "heart");
  };
  return std::any_of(volume.labels.begin(), volume.labels.end(), isHeart) &&
         std::none_of(volume.labels.begin(), volume.labels.end(), isChamber);
}

} // namespace sono
