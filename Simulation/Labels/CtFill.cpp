#include "Labels/CtFill.h"

#include "Core/LargeMemory.h"
#include "Core/ParallelFor.h"
#include "Core/Simd.h"
#include "Labels/BodyDepth.h"
#include "Labels/FreeLabels.h"

#include <algorithm>
#include <array>
#include <mutex>

namespace sono {

namespace {

constexpr std::int16_t airBelowHu = -300;
constexpr std::int16_t fatBelowHu = -30;
constexpr double boneFromHu = 200.0;
constexpr double boneAboveBloodHu = 150.0;
constexpr double lungFromHu = -930.0;
constexpr double lungToHu = -400.0;
constexpr double leastLungMm3 = 2e4;
constexpr double closingMm = 6.0;
constexpr float surfaceMm = 4.5f; // as far as blocks may mistake it: there the voxels tell

enum Class
{
  outside,
  skin,
  gas,
  lung,
  fat,
  muscle,
  bone,
  classCount
};

struct Look
{
  const char* name;
  std::array<float, 3> color;
};

constexpr Look looks[classCount] = { { "", {} },
                                     { "skin", { 0.87f, 0.68f, 0.55f } },
                                     { "gas", { 0.6f, 0.8f, 0.9f } },
                                     { "lung", { 0.76f, 0.64f, 0.7f } },
                                     { "fat", { 0.9f, 0.84f, 0.5f } },
                                     { "muscle", { 0.75f, 0.4f, 0.35f } },
                                     { "bone", { 0.95f, 0.92f, 0.83f } } };

/// What a block holds.
struct Block
{
  int labelledOrDense = 0; // voxels
  int others = 0;
  int gas = 0; // unlabelled, as thin as gas or lung
  std::int64_t gasHu = 0;
};

/// What the columns of voxels of a row of blocks hold; the sums of blocks follow from theirs.
struct Columns
{
  std::vector<int> labelledOrDense;
  std::vector<int> gas;
  std::vector<std::int64_t> gasHu;

  explicit Columns(std::size_t count)
    : labelledOrDense(count)
    , gas(count)
    , gasHu(count)
  {
  }
};

SONO_SIMD_CLONES void addRow(const std::uint16_t* labels, const std::int16_t* values, std::size_t count,
                             int* labelledOrDense, int* gas, std::int64_t* gasHu)
{
  for (std::size_t i = 0; i < count; ++i)
  {
    const int hu = values[i];
    const int isLabelled = labels[i] != 0 ? 1 : 0;
    const int isThin = hu <= airBelowHu ? 1 : 0;
    const int isGas = isThin & (1 - isLabelled) & (hu != MatchedScan::nothing ? 1 : 0);
    labelledOrDense[i] += isLabelled | (1 - isThin);
    gas[i] += isGas;
    gasHu[i] += isGas * hu;
  }
}

std::vector<Block> blocksOf(const LabelVolume& volume, const MatchedScan& ct, const CoarseGrid& grid)
{
  std::vector<Block> blocks(grid.count());
  const Vec3i n = volume.placement.size;
  parallelFor(grid.size.z, {}, [&](int ck) {
    for (int cj = 0; cj < grid.size.y; ++cj)
    {
      Columns columns(std::size_t(n.x));
      const Vec3i low = Vec3i(0, cj, ck) * grid.factor;
      const Vec3i high = glm::min(low + grid.factor, n);
      for (int k = low.z; k < high.z; ++k)
      {
        for (int j = low.y; j < high.y; ++j)
        {
          const std::size_t first = std::size_t(n.x) * (std::size_t(j) + std::size_t(n.y) * k);
          addRow(volume.voxels.data() + first, ct.values.begin() + first, std::size_t(n.x),
                 columns.labelledOrDense.data(), columns.gas.data(), columns.gasHu.data());
        }
      }
      const int voxelsOfColumn = (high.y - low.y) * (high.z - low.z);
      Block* row = blocks.data() + grid.index({ 0, cj, ck });
      for (int i = 0; i < n.x; ++i)
      {
        Block& block = row[i / grid.factor.x];
        const int dense = columns.labelledOrDense[std::size_t(i)];
        block.labelledOrDense += dense;
        block.others += voxelsOfColumn - dense;
        block.gas += columns.gas[std::size_t(i)];
        block.gasHu += columns.gasHu[std::size_t(i)];
      }
    }
  });
  return blocks;
}

/// Gas or lung, of each block that holds such voxels inside of the body and of those beside it; elsewhere 0.
std::vector<char> classesOfBlocks(const std::vector<Block>& blocks, const BodyDepth& body)
{
  const CoarseGrid& grid = body.grid();
  std::vector<char> wanted(blocks.size());
  for (std::size_t b = 0; b < blocks.size(); ++b)
  {
    wanted[b] = body.ofBlocks()[b] > 0.0f && 2 * blocks[b].gas > blocks[b].labelledOrDense + blocks[b].others;
  }
  const double voxelMm3 =
    grid.spacingMm.x * grid.spacingMm.y * grid.spacingMm.z / (double(grid.factor.x) * grid.factor.y * grid.factor.z);
  std::vector<char> classes(blocks.size(), 0);
  forBlocks(grid, [&](const Vec3i& c) {
    if (!wanted[grid.index(c)])
    {
      return;
    }
    const std::vector<Vec3i> part = takeComponent(grid, wanted, c, -1);
    double voxels = 0.0;
    double sum = 0.0;
    for (const Vec3i& member : part)
    {
      voxels += blocks[grid.index(member)].gas;
      sum += double(blocks[grid.index(member)].gasHu);
    }
    const double mean = sum / voxels;
    const bool isLung = voxels * voxelMm3 >= leastLungMm3 && mean >= lungFromHu && mean <= lungToHu;
    for (const Vec3i& member : part)
    {
      classes[grid.index(member)] = isLung ? lung : gas;
    }
  });
  const std::vector<char> found = classes;
  forBlocks(grid, [&](const Vec3i& c) {
    const Vec3i low = glm::max(c - 1, Vec3i(0));
    const Vec3i high = glm::min(c + 1, grid.size - 1);
    for (int k = low.z; k <= high.z && !found[grid.index(c)]; ++k)
    {
      for (int j = low.y; j <= high.y; ++j)
      {
        for (int i = low.x; i <= high.x; ++i)
        {
          char& own = classes[grid.index(c)];
          own = std::max(own, found[grid.index({ i, j, k })]); // lung before gas
        }
      }
    }
  });
  return classes;
}

} // namespace

std::vector<std::string> fillFromCt(LabelVolume& volume, const MatchedScan& ct, double skinMm, double bloodHu,
                                    const Progress& progress)
{
  if (!ct.isCt)
  {
    throw Error("The scan is no CT, so its values do not tell tissues; leave label 0 to the estimate of the body.");
  }
  const CoarseGrid grid(volume.placement);
  const std::vector<Block> blocks = blocksOf(volume, ct, grid);
  report(progress, 0.2);
  std::vector<char> known(blocks.size());
  std::transform(blocks.begin(), blocks.end(), known.begin(),
                 [](const Block& b) { return b.labelledOrDense > b.others ? 1 : 0; });
  fillSliceHoles(volume.placement, grid, known); // or the rims of lungs would count as skin
  const BodyDepth body(volume.placement, known, { closingMm, 0.0 });
  report(progress, 0.5);
  const std::vector<char> thin = classesOfBlocks(blocks, body);
  const double boneHu = std::max(boneFromHu, bloodHu + boneAboveBloodHu);
  const auto classOf = [&](std::int16_t hu, float depthMm, std::size_t block) {
    const bool isKnown = hu != MatchedScan::nothing;
    if (depthMm <= (isKnown ? -surfaceMm : 0.0f) || (isKnown && depthMm < surfaceMm && hu <= airBelowHu))
    {
      return outside;
    }
    if (depthMm <= float(skinMm))
    {
      return skin;
    }
    if (!isKnown)
    {
      return muscle;
    }
    if (hu <= airBelowHu)
    {
      return thin[block] == lung ? lung : gas;
    }
    return hu < fatBelowHu ? fat : double(hu) < boneHu ? muscle : bone;
  };

  const Vec3i n = volume.placement.size;
  auto found = largeVector(volume.voxels.size(), std::uint8_t(outside));
  std::array<bool, classCount> occurs{};
  std::mutex mutex;
  parallelFor(n.z, partOf(progress, 0.5, 0.95), [&](int k) {
    std::array<bool, classCount> here{};
    std::vector<float> depthMm;
    for (int j = 0; j < n.y; ++j)
    {
      body.ofRow(j, k, depthMm);
      const std::size_t first = std::size_t(n.x) * (std::size_t(j) + std::size_t(n.y) * k);
      for (int i = 0; i < n.x; ++i)
      {
        const std::size_t at = first + std::size_t(i);
        if (volume.voxels[at] == 0)
        {
          const std::size_t block = grid.index(Vec3i(i, j, k) / grid.factor);
          found[at] = std::uint8_t(classOf(ct.values[at], depthMm[std::size_t(i)], block));
          here[found[at]] = true;
        }
      }
    }
    const std::lock_guard<std::mutex> lock(mutex);
    std::transform(here.begin(), here.end(), occurs.begin(), occurs.begin(), std::logical_or<>());
  });

  const int wanted = int(std::count(occurs.begin() + 1, occurs.end(), true));
  const std::vector<int> ids = freeLabelIds(volume, wanted);
  std::array<std::uint16_t, classCount> idOf{};
  std::vector<std::string> names;
  for (int c = 1; c < classCount; ++c)
  {
    if (occurs[std::size_t(c)])
    {
      idOf[std::size_t(c)] = std::uint16_t(ids[names.size()]);
      addLabel(volume, ids[names.size()], looks[c].name, looks[c].color);
      names.emplace_back(looks[c].name);
    }
  }
  const std::size_t slice = std::size_t(n.x) * n.y;
  parallelFor(n.z, {}, [&](int k) {
    for (std::size_t at = slice * k; at < slice * (k + 1); ++at)
    {
      volume.voxels[at] = found[at] != outside ? idOf[found[at]] : volume.voxels[at];
    }
  });
  volume.collectLabels();
  report(progress, 1.0);
  return names;
}

} // namespace sono
