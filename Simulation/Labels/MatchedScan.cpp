#include "Labels/MatchedScan.h"

#include "Core/LargeMemory.h"
#include "Core/ParallelFor.h"
#include "Core/Rounding.h"
#include "Core/Simd.h"
#include "Labels/LabelRuns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <sstream>

namespace sono {

namespace {

constexpr float largestValue = 32767.0f;
constexpr float airAtMost = -200.0f; // HU: a scan that has less shows air as a CT does
constexpr float leastOfAir = 0.02f;  // what air is below 0 in a CT, of its largest value: metal has up to 32767 HU
constexpr float beyondHu = 1e5f;     // padding may have -32768, less 1024
constexpr float belowAir = -1500.0f; // HU: of a CT only padding, and noise in a few voxels
constexpr double mostBelowAir = 0.05;
constexpr double leastShare = 0.5; // of the labelled voxels that must lie within the scan

bool sameGrid(const GridPlacement& a, const GridPlacement& b)
{
  const Vec3d last(a.size - 1);
  const double within = 0.01 * std::min({ a.spacingMm.x, a.spacingMm.y, a.spacingMm.z });
  return a.size == b.size && glm::distance(a.worldFromIndex(Vec3d(0.0)), b.worldFromIndex(Vec3d(0.0))) < within &&
         glm::distance(a.worldFromIndex(last), b.worldFromIndex(last)) < within &&
         glm::distance(a.worldFromIndex({ last.x, 0.0, 0.0 }), b.worldFromIndex({ last.x, 0.0, 0.0 })) < within;
}

/// What visit(values) makes of a scan's values, of whichever type they are.
template<class Visit>
auto withValues(const IntensityView& scan, const Visit& visit)
{
  return scan.values ? visit(scan.values) : visit(scan.shorts.begin());
}

IntensityRange rangeOfScan(const IntensityView& scan)
{
  return withValues(scan, [&](const auto* values) { return rangeOf(values, scan.count); });
}

/// Whether values are those of a CT.
bool areHounsfieldUnits(const IntensityView& scan, const IntensityRange& range)
{
  if (range.low >= airAtMost || range.high > largestValue)
  {
    return false;
  }
  const auto isBelow = [&](float value) { return value < belowAir && value > range.low; };
  const auto below =
    range.low < belowAir
      ? withValues(scan, [&](const auto* values) { return std::count_if(values, values + scan.count, isBelow); })
      : std::ptrdiff_t(0);
  return double(below) <= mostBelowAir * double(scan.count);
}

/// From the scan's values to those that are kept.
struct ValueScale
{
  bool isCt;
  float factor;
  bool keepsShorts;   ///< values that are shorts stay as they are
  std::string notice; ///< as of MatchedScan

  explicit ValueScale(const IntensityView& scan)
  {
    const IntensityRange range = rangeOfScan(scan);
    isCt = scan.modality.empty() ? areHounsfieldUnits(scan, range) : scan.modality == "CT";
    const float most = std::max(std::fabs(range.low), std::fabs(range.high));
    const bool hasAir = scan.modality.empty() && range.low < airAtMost && range.low < -leastOfAir * range.high;
    if ((isCt || hasAir) && most > beyondHu)
    {
      std::ostringstream text;
      text << "The scan's values go from " << range.low << " to " << range.high
           << ", where a CT has Hounsfield units (air -1000, water 0, bone 1000) and an MR hardly anything below 0; "
              "divide them by what they were multiplied with, or choose the scan as the scanner has it.";
      throw Error(text.str());
    }
    if (scan.modality.empty() && !isCt)
    {
      std::ostringstream text;
      text << "The scan does not say whether it is a CT or an MR, and is taken for an MR, since its values go from "
           << range.low << " to " << range.high
           << "; to count as a CT, which also shows what lies outside of the labels, it needs Hounsfield units (air "
              "-1000, water 0, bone 1000).";
      notice = text.str();
    }
    factor = isCt || !(most > 0.0f) ? 1.0f : largestValue / most;
    keepsShorts = factor == 1.0f && most <= largestValue;
  }
  std::int16_t operator()(float value) const { return rounded(value, factor); }

  static std::int16_t rounded(float value, float factor)
  {
    return std::int16_t(roundedToInt(std::clamp(value * factor, -largestValue, largestValue)));
  }
};

SONO_SIMD_CLONES void roundAll(const float* values, std::size_t count, float factor, std::int16_t* to)
{
  for (std::size_t n = 0; n < count; ++n)
  {
    to[n] = ValueScale::rounded(values[n], factor);
  }
}

SONO_SIMD_CLONES void roundAll(const std::int16_t* values, std::size_t count, float factor, std::int16_t* to)
{
  for (std::size_t n = 0; n < count; ++n)
  {
    to[n] = ValueScale::rounded(float(values[n]), factor);
  }
}

/// Of values, those left out that are nothing.
struct ScanSums
{
  std::int64_t voxels = 0;
  std::int64_t sum = 0;
  std::int64_t squares = 0;

  void add(const ScanSums& other)
  {
    voxels += other.voxels;
    sum += other.sum;
    squares += other.squares;
  }
};

SONO_SIMD_CLONES ScanSums sumsOf(const std::int16_t* values, std::size_t count)
{
  ScanSums sums;
  for (std::size_t n = 0; n < count; ++n)
  {
    const bool isThere = values[n] != MatchedScan::nothing;
    const std::int32_t value = isThere ? values[n] : 0;
    sums.voxels += isThere ? 1 : 0;
    sums.sum += value;
    sums.squares += value * value; // below 2^30
  }
  return sums;
}

/// The scan's value at an index of its own, linear between voxels' centres; beyond the outermost ones theirs, for half
/// a voxel.
template<class Value>
float valueAt(const Value* values, const Vec3i& n, const Vec3d& index)
{
  const Vec3d at = glm::clamp(index, Vec3d(0.0), Vec3d(n - 1));
  const Vec3i low = glm::min(Vec3i(at), glm::max(n - 2, Vec3i(0)));
  const Vec3i high = glm::min(low + 1, n - 1);
  const Vec3f share(at - Vec3d(low));
  const auto row = [&](int j, int k) {
    const Value* of = values + std::size_t(n.x) * (std::size_t(j) + std::size_t(n.y) * k);
    const auto first = float(of[low.x]);
    return first + share.x * (float(of[high.x]) - first);
  };
  const float below = row(low.y, low.z) + share.y * (row(high.y, low.z) - row(low.y, low.z));
  const float above = row(low.y, high.z) + share.y * (row(high.y, high.z) - row(low.y, high.z));
  return below + share.z * (above - below);
}

/// Places of two frames of reference have nothing to do with each other, however close they are.
void requireSameWorld(const GridPlacement& labels, const GridPlacement& scan)
{
  const std::string& own = labels.frameOfReference;
  const std::string& other = scan.frameOfReference;
  if (!own.empty() && !other.empty() && own != other)
  {
    throw Error("The scan has another DICOM frame of reference (" + other + ") than the label map (" + own +
                "): places in one are not those in the other; connect the scan that was segmented, or register this "
                "one to it and save it as NIfTI or NRRD, which name no frame.");
  }
}

std::string placeOf(const GridPlacement& placement)
{
  Vec3d low(std::numeric_limits<double>::infinity());
  Vec3d high = -low;
  for (int corner = 0; corner < 8; ++corner)
  {
    const Vec3d end(corner & 1 ? placement.size.x : 0, corner & 2 ? placement.size.y : 0,
                    corner & 4 ? placement.size.z : 0);
    const Vec3d world = placement.worldFromIndex(end - 0.5);
    low = glm::min(low, world);
    high = glm::max(high, world);
  }
  std::ostringstream text;
  for (int axis = 0; axis < 3; ++axis)
  {
    text << (axis > 0 ? ", " : "") << "LPS"[axis] << ' ' << std::lround(low[axis]) << " to " << std::lround(high[axis]);
  }
  return text.str();
}

/// What a mean tells of a tissue, HU; empty where none is expected.
struct Expected
{
  double low;
  double high;
};

bool expects(const std::string& tissue, Expected& range)
{
  static const std::map<std::string, Expected> known{
    { "cortical_bone", { 80.0, 1e9 } }, { "lung", { -1e9, -350.0 } },         { "air", { -1e9, -250.0 } },
    { "fat", { -250.0, 40.0 } },        { "renal_sinus", { -250.0, 200.0 } }, { "soft_tissue", { -150.0, 600.0 } }
  };
  const auto found = known.find(tissue);
  range = found == known.end() ? Expected{ -40.0, 600.0 } : found->second;
  return tissue != "skin" && tissue != "gi_tract"; // thin, or full of gas
}

} // namespace

MatchedScan matchScan(const LabelVolume& labels, const IntensityView& scan, const Progress& progress)
{
  scan.placement.validate("the scan");
  if (scan.count != scan.placement.voxelCount())
  {
    throw Error("the scan has " + std::to_string(scan.count) + " values where its size says " +
                std::to_string(scan.placement.voxelCount()) + ": load it again.");
  }
  requireSameWorld(labels.placement, scan.placement);
  const ValueScale scale(scan);
  const GridPlacement& grid = labels.placement;
  const Vec3i n = grid.size;
  const std::size_t slice = std::size_t(n.x) * n.y;
  MatchedScan matched;
  matched.isCt = scale.isCt;
  matched.notice = scale.notice;
  const bool isSameGrid = sameGrid(grid, scan.placement);
  if (isSameGrid && !scan.values && scale.keepsShorts)
  {
    matched.values = scan.shorts;
    return matched;
  }
  auto found = largeVector<std::int16_t>(labels.voxels.size());
  if (isSameGrid)
  {
    withValues(scan, [&](const auto* values) {
      parallelFor(n.z, progress,
                  [&](int k) { roundAll(values + slice * k, slice, scale.factor, found.data() + slice * k); });
    });
    matched.values = SharedSpan<std::int16_t>(std::move(found));
    return matched;
  }
  std::mutex mutex;
  std::size_t labelled = 0;
  std::size_t reached = 0;
  const Vec3d first = scan.placement.indexFromWorld(grid.worldFromIndex(Vec3d(0.0)));
  Mat3d step;
  for (int axis = 0; axis < 3; ++axis)
  {
    Vec3d one(0.0);
    one[axis] = 1.0;
    step[axis] = scan.placement.indexFromWorld(grid.worldFromIndex(one)) - first;
  }
  const Vec3d end = Vec3d(scan.placement.size) - 0.5;
  withValues(scan, [&](const auto* values) {
    parallelFor(n.z, progress, [&](int k) {
      std::size_t labelledHere = 0;
      std::size_t reachedHere = 0;
      std::size_t at = slice * k;
      for (int j = 0; j < n.y; ++j)
      {
        for (int i = 0; i < n.x; ++i, ++at)
        {
          const Vec3d index = first + step * Vec3d(i, j, k);
          const bool isIn = glm::all(glm::greaterThanEqual(index, Vec3d(-0.5))) && glm::all(glm::lessThan(index, end));
          found[at] = isIn ? scale(valueAt(values, scan.placement.size, index)) : MatchedScan::nothing;
          labelledHere += labels.voxels[at] != 0 ? 1 : 0;
          reachedHere += isIn && labels.voxels[at] != 0 ? 1 : 0;
        }
      }
      const std::lock_guard<std::mutex> lock(mutex);
      labelled += labelledHere;
      reached += reachedHere;
    });
  });
  matched.values = SharedSpan<std::int16_t>(std::move(found));
  matched.reachedShare = labelled > 0 ? double(reached) / double(labelled) : 1.0;
  if (matched.reachedShare < leastShare)
  {
    throw Error("The scan is not of this label map: " + std::to_string(std::lround(100.0 * matched.reachedShare)) +
                " % of the labelled voxels lie in it (the scan lies at " + placeOf(scan.placement) +
                " mm, the label map at " + placeOf(grid) + " mm); connect the scan that was segmented.");
  }
  return matched;
}

std::vector<ScanOfLabel> scanOfLabels(const LabelVolume& labels, const MatchedScan& scan, const Progress& progress)
{
  const std::vector<int> indexOf = labels.indexOfId();
  std::mutex mutex;
  std::vector<ScanSums> all(labels.labels.size());
  const Vec3i n = labels.placement.size;
  const std::size_t slice = std::size_t(n.x) * n.y;
  parallelFor(n.z, progress, [&](int k) {
    std::vector<ScanSums> own(all.size());
    const std::int16_t* values = scan.values.begin() + slice * k;
    forRuns(labels.voxels.data() + slice * k, slice, [&](std::size_t begin, std::size_t end, std::uint16_t id) {
      own[std::size_t(indexOf[id])].add(sumsOf(values + begin, end - begin));
    });
    const std::lock_guard<std::mutex> lock(mutex); // whole numbers: in whatever order
    for (std::size_t l = 0; l < all.size(); ++l)
    {
      all[l].add(own[l]);
    }
  });
  std::vector<ScanOfLabel> result;
  for (const ScanSums& s : all)
  {
    ScanOfLabel label{ s.voxels, 0.0, 0.0 };
    if (s.voxels > 0)
    {
      label.mean = double(s.sum) / double(s.voxels);
      label.deviation = std::sqrt(std::max(0.0, double(s.squares) / double(s.voxels) - label.mean * label.mean));
    }
    result.push_back(label);
  }
  return result;
}

double meanOfTissue(const LabelVolume& labels, const std::vector<ScanOfLabel>& means, const std::string& tissue)
{
  double sum = 0.0;
  double voxels = 0.0;
  for (std::size_t l = 0; l < means.size(); ++l)
  {
    if (labels.labels[l].tissue == tissue)
    {
      sum += means[l].mean * double(means[l].voxels);
      voxels += double(means[l].voxels);
    }
  }
  return voxels > 0.0 ? sum / voxels : 0.0;
}

void requireSamePatient(const LabelVolume& labels, const MatchedScan& scan, const std::vector<ScanOfLabel>& means)
{
  if (!scan.isCt)
  {
    return;
  }
  std::int64_t telling = 0;
  std::int64_t off = 0;
  double furthest = 0.0;
  std::string sentence;
  for (std::size_t l = 0; l < labels.labels.size(); ++l)
  {
    const LabelInfo& label = labels.labels[l];
    Expected range{};
    if (label.id == 0 || means[l].voxels == 0 || !expects(label.tissue, range))
    {
      continue;
    }
    telling += means[l].voxels;
    const double distance = std::max(range.low - means[l].mean, means[l].mean - range.high);
    if (distance > 0.0)
    {
      off += means[l].voxels;
    }
    if (distance > furthest)
    {
      furthest = distance;
      sentence = "label " + std::to_string(label.id) + " ('" + label.name + "', " + label.tissue + ") has " +
                 std::to_string(std::lround(means[l].mean)) + " HU there";
    }
  }
  if (4 * off > telling)
  {
    throw Error("The CT does not show what the labels say, as one of another patient would not: " + sentence +
                ", and " + std::to_string(std::lround(100.0 * double(off) / double(telling))) +
                " % of the voxels are as wrong; connect the CT that was segmented, or correct the tissues.");
  }
}

} // namespace sono
