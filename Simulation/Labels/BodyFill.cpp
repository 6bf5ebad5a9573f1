#include "Labels/BodyFill.h"

#include "Core/ParallelFor.h"
#include "Labels/BodyDepth.h"
#include "Labels/FreeLabels.h"
#include "Labels/LabelWords.h"

#include <algorithm>
#include <atomic>
#include <string>
#include <utility>
#include <vector>

namespace sono {

namespace {

/// Blocks that hold labels of these ids for the most part: a speck of one voxel does not count.
std::vector<char> blocksOf(const LabelVolume& volume, const std::vector<char>& isWanted)
{
  const CoarseGrid grid(volume.placement);
  std::vector<char> blocks(grid.count());
  const Vec3i n = volume.placement.size;
  parallelFor(grid.size.z, {}, [&](int ck) {
    std::vector<int> balance(std::size_t(grid.size.x) * grid.size.y, 0);
    for (int k = ck * grid.factor.z; k < std::min(n.z, (ck + 1) * grid.factor.z); ++k)
    {
      for (int j = 0; j < n.y; ++j)
      {
        const std::uint16_t* row = volume.voxels.data() + std::size_t(n.x) * (std::size_t(j) + std::size_t(n.y) * k);
        int* to = balance.data() + std::size_t(j / grid.factor.y) * grid.size.x;
        for (int i = 0; i < n.x; ++i)
        {
          to[i / grid.factor.x] += isWanted[row[i]] ? 1 : -1;
        }
      }
    }
    std::transform(balance.begin(), balance.end(), blocks.begin() + std::ptrdiff_t(balance.size()) * ck,
                   [](int b) { return b > 0 ? 1 : 0; });
  });
  return blocks;
}

std::vector<char> labelledBlocks(const LabelVolume& volume)
{
  std::vector<char> isLabelled(65536, 1);
  isLabelled[0] = 0;
  return blocksOf(volume, isLabelled);
}

/// Where the thyroid is; empty where it has no label.
std::vector<char> thyroidBlocks(const LabelVolume& volume)
{
  std::vector<char> isThyroid(65536, 0);
  bool isThere = false;
  for (const LabelInfo& label : volume.labels)
  {
    const std::vector<std::string> words = wordsOfName(label.name);
    const auto has = [&](const char* word) { return std::find(words.begin(), words.end(), word) != words.end(); };
    isThyroid[std::size_t(label.id)] = has("thyroid") && !has("cartilage") ? 1 : 0;
    isThere = isThere || isThyroid[std::size_t(label.id)];
  }
  return isThere ? blocksOf(volume, isThyroid) : std::vector<char>();
}

} // namespace

BodyFill fillBody(LabelVolume& volume, const BodyFillSettings& settings, const Progress& progress)
{
  requireInRange(settings);
  volume.collectLabels();
  if (volume.labels.empty() || volume.labels.back().id == 0)
  {
    throw Error("body fill: the label map holds nothing but 0; choose a segmentation.");
  }
  const std::vector<int> ids = freeLabelIds(volume, 2);
  BodyFill fill;
  fill.skinId = ids[0];
  fill.softTissueId = ids[1];

  const BodyDepth depth(volume.placement, labelledBlocks(volume),
                        { settings.closingMm, settings.wallMm, thyroidBlocks(volume) });
  report(progress, 0.5);

  const Vec3i n = volume.placement.size;
  std::atomic<std::size_t> skin{ 0 };
  std::atomic<std::size_t> soft{ 0 };
  const Progress filling = partOf(progress, 0.5, 1.0);
  LabelVolume filled = volume; // so that a stop leaves the volume as it was
  parallelFor(n.z, filling, [&](int k) {
    std::vector<float> depthMm;
    std::size_t skinHere = 0;
    std::size_t softHere = 0;
    for (int j = 0; j < n.y; ++j)
    {
      depth.ofRow(j, k, depthMm);
      std::uint16_t* voxel = filled.voxels.data() + std::size_t(n.x) * (std::size_t(j) + std::size_t(n.y) * k);
      for (int i = 0; i < n.x; ++i)
      {
        const float here = depthMm[std::size_t(i)];
        if (voxel[i] == 0 && here > 0.0f)
        {
          const bool isSkin = double(here) <= settings.skinMm;
          voxel[i] = std::uint16_t(isSkin ? fill.skinId : fill.softTissueId);
          ++(isSkin ? skinHere : softHere);
        }
      }
    }
    skin += skinHere;
    soft += softHere;
  });
  fill.skinVoxels = skin;
  fill.softTissueVoxels = soft;
  addLabel(filled, fill.skinId, "skin", { 0.87f, 0.68f, 0.55f });
  addLabel(filled, fill.softTissueId, "soft_tissue", { 0.78f, 0.5f, 0.45f });
  filled.collectLabels();
  volume = std::move(filled);
  return fill;
}

} // namespace sono
