#include "Scene/ScanDetail.h"

#include "Core/LargeMemory.h"
#include "Core/ParallelFor.h"
#include "Core/Rounding.h"
#include "Core/Simd.h"
#include "Kernel/DetailCode.h"
#include "Labels/LabelRuns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

namespace sono {

namespace {

constexpr double mostDb = 10.0;
constexpr double contrastHu = 90.0; // of blood: without a contrast agent it has 30 to 60
constexpr double leastOfMean = 0.5; // that an MR's values count as spread, however even they are

/// Of the levels 10^(L/10), in whole units so that their sum does not depend on its order.
constexpr double powerUnit = 1048576.0;

/// Of an MR's values, which have no unit, what counts as 100 HU of a CT: their standard deviation over all labels.
/// That of a label alone would turn an even organ's noise up and a structured one's structure down.
double spreadOf(const std::vector<ScanOfLabel>& means)
{
  double voxels = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (const ScanOfLabel& label : means)
  {
    voxels += double(label.voxels);
    sum += double(label.voxels) * label.mean;
    squares += double(label.voxels) * (label.deviation * label.deviation + label.mean * label.mean);
  }
  const double mean = voxels > 0.0 ? sum / voxels : 0.0;
  const double variance = voxels > 0.0 ? std::max(0.0, squares / voxels - mean * mean) : 0.0;
  return std::max(std::sqrt(variance), leastOfMean * std::abs(mean));
}

/// dB a unit of the scan, of each label.
std::vector<float> slopes(const LabelVolume& labels, const MatchedScan& scan, const std::vector<ScanOfLabel>& means,
                          const std::string& outsideTissue, const ScanDetailSettings& settings)
{
  const bool falls =
    settings.direction == DetailDirection::Falls || (settings.direction == DetailDirection::Automatic && scan.isCt &&
                                                     meanOfTissue(labels, means, "blood") > contrastHu);
  const double unit = scan.isCt ? 100.0 : spreadOf(means);
  const double slope = unit > 0.0 ? (falls ? -1.0 : 1.0) * settings.detailDbPer100Hu / unit : 0.0;
  std::vector<float> result;
  for (std::size_t l = 0; l < means.size(); ++l)
  {
    result.push_back(labels.labels[l].tissue == outsideTissue ? 0.0f : float(slope));
  }
  return result;
}

/// Adds `weight` times the values of a row that lie in the same label, and the weights.
SONO_SIMD_CLONES void addNeighbours(int weight, const std::uint16_t* own, const std::uint16_t* labels,
                                    const std::int16_t* values, int count, int* sums, int* weights)
{
  for (int i = 0; i < count; ++i)
  {
    const bool counts = labels[i] == own[i] && values[i] != MatchedScan::nothing;
    const int here = counts ? weight : 0;
    sums[i] += here * values[i];
    weights[i] += here;
  }
}

/// Smooths rows of values over voxels of the same label.
class LabelSmoother
{
public:
  LabelSmoother(const LabelVolume& labels, const MatchedScan& scan)
    : size_(labels.placement.size)
    , labels_(labels.voxels.data())
    , values_(scan.values.begin())
    , sums_(std::size_t(size_.x))
    , weights_(std::size_t(size_.x))
  {
  }

  void smoothRow(int j, int k)
  {
    std::fill(sums_.begin(), sums_.end(), 0);
    std::fill(weights_.begin(), weights_.end(), 0);
    const std::uint16_t* own = labels_ + rowAt(j, k);
    for (int dk = k > 0 ? -1 : 0; dk <= (k + 1 < size_.z ? 1 : 0); ++dk)
    {
      for (int dj = j > 0 ? -1 : 0; dj <= (j + 1 < size_.y ? 1 : 0); ++dj)
      {
        const std::size_t row = rowAt(j + dj, k + dk);
        for (int di = -1; di <= 1; ++di)
        {
          const int first = std::max(0, -di);
          const int count = size_.x - std::abs(di);
          addNeighbours((2 - std::abs(dk)) * (2 - std::abs(dj)) * (2 - std::abs(di)), own + first,
                        labels_ + row + first + di, values_ + row + first + di, count, sums_.data() + first,
                        weights_.data() + first);
        }
      }
    }
  }
  /// Of the row: sums of values and their weights, above 0 at a voxel that the scan reaches.
  const int* sums() const { return sums_.data(); }
  const int* weights() const { return weights_.data(); }

private:
  std::size_t rowAt(int j, int k) const { return std::size_t(size_.x) * (std::size_t(j) + std::size_t(size_.y) * k); }

  Vec3i size_;
  const std::uint16_t* labels_;
  const std::int16_t* values_;
  std::vector<int> sums_;
  std::vector<int> weights_;
};

/// The codes of a row's part in one label, where the scan reaches.
SONO_SIMD_CLONES void codeRun(const int* sums, const int* weights, const std::int16_t* values, int count, float slope,
                              float mean, std::uint8_t* codes)
{
  constexpr float most = mostDb / detailStepDb;
  for (int i = 0; i < count; ++i)
  {
    const float smoothed = float(sums[i]) / float(std::max(weights[i], 1));
    const float steps = std::clamp(slope * (smoothed - mean) / detailStepDb, -most, most);
    codes[i] = std::uint8_t(values[i] == MatchedScan::nothing ? detailNone : detailNone + roundedToInt(steps));
  }
}

SONO_SIMD_CLONES void shiftRun(int offset, const std::int16_t* values, std::size_t count, std::uint8_t* codes)
{
  for (std::size_t i = 0; i < count; ++i)
  {
    const int shifted = std::clamp(int(codes[i]) + offset, detailSilent + 1, 255);
    codes[i] = std::uint8_t(values[i] == MatchedScan::nothing ? int(codes[i]) : shifted);
  }
}

} // namespace

std::vector<std::uint8_t> scanDetail(const LabelVolume& labels, const MatchedScan& scan,
                                     const std::vector<ScanOfLabel>& means, const std::string& outsideTissue,
                                     const ScanDetailSettings& settings, const Progress& progress)
{
  requireInRange(settings);
  const std::size_t count = labels.labels.size();
  const std::vector<float> slope = slopes(labels, scan, means, outsideTissue, settings);
  const std::vector<int> indexOf = labels.indexOfId();
  std::array<std::int64_t, 256> powerOf{};
  for (int code = 0; code < 256; ++code)
  {
    powerOf[std::size_t(code)] = std::llround(powerUnit * std::pow(10.0, 0.1 * detailStepDb * (code - detailNone)));
  }
  const Vec3i n = labels.placement.size;
  const std::size_t slice = std::size_t(n.x) * n.y;
  auto codes = largeVector(labels.voxels.size(), std::uint8_t(detailNone));
  std::vector<std::int64_t> power(count, 0);
  std::mutex mutex;
  parallelFor(n.z, partOf(progress, 0.0, 0.85), [&](int k) {
    std::vector<std::int64_t> own(count, 0);
    LabelSmoother smoother(labels, scan);
    for (int j = 0; j < n.y; ++j)
    {
      const std::size_t row = slice * k + std::size_t(n.x) * j;
      bool smoothed = false;
      forRuns(labels.voxels.data() + row, std::size_t(n.x), [&](std::size_t begin, std::size_t end, std::uint16_t id) {
        const std::size_t l = std::size_t(indexOf[id]);
        if (slope[l] == 0.0f)
        {
          return;
        }
        if (!smoothed)
        {
          smoother.smoothRow(j, k);
          smoothed = true;
        }
        std::uint8_t* const run = codes.data() + row + begin;
        const std::int16_t* const values = scan.values.begin() + row + begin;
        codeRun(smoother.sums() + begin, smoother.weights() + begin, values, int(end - begin), slope[l],
                float(means[l].mean), run);
        for (std::size_t i = 0; i < end - begin; ++i)
        {
          own[l] += values[i] == MatchedScan::nothing ? 0 : powerOf[run[i]];
        }
      });
    }
    const std::lock_guard<std::mutex> lock(mutex);
    std::transform(own.begin(), own.end(), power.begin(), power.begin(), std::plus<>());
  });
  std::vector<int> offset(count, 0);
  for (std::size_t l = 0; l < count; ++l)
  {
    if (slope[l] != 0.0f && means[l].voxels > 0)
    {
      const double mean = double(power[l]) / powerUnit / double(means[l].voxels);
      offset[l] = int(std::lround(-10.0 * std::log10(mean) / detailStepDb));
    }
  }
  parallelFor(n.z, partOf(progress, 0.85, 1.0), [&](int k) {
    forRuns(labels.voxels.data() + slice * k, slice, [&](std::size_t begin, std::size_t end, std::uint16_t id) {
      const int by = offset[std::size_t(indexOf[id])];
      if (by != 0)
      {
        const std::size_t at = slice * k + begin;
        shiftRun(by, scan.values.begin() + at, end - begin, codes.data() + at);
      }
    });
  });
  return codes;
}

std::vector<std::uint8_t> detailOnLargerGrid(const std::vector<std::uint8_t>& codes, const GridPlacement& own,
                                             const GridPlacement& larger)
{
  const Vec3i before(glm::round(larger.indexFromWorld(own.worldFromIndex(Vec3d(0.0)))));
  const Vec3i n = own.size;
  const Vec3i m = larger.size;
  std::vector<std::uint8_t> wide(larger.voxelCount(), std::uint8_t(detailNone));
  for (int k = 0; k < n.z; ++k)
  {
    for (int j = 0; j < n.y; ++j)
    {
      const auto row = codes.begin() + std::ptrdiff_t(n.x) * (std::ptrdiff_t(j) + std::ptrdiff_t(n.y) * k);
      const auto to = std::ptrdiff_t(m.x) * (std::ptrdiff_t(j + before.y) + std::ptrdiff_t(m.y) * (k + before.z));
      std::copy(row, row + n.x, wide.begin() + to + before.x);
    }
  }
  return wide;
}

} // namespace sono
