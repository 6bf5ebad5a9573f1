#include "Labels/ReadIntensities.h"

#include "Core/LargeMemory.h"
#include "Core/ParallelFor.h"
#include "Core/Simd.h"
#include "Labels/ReadDicomSeries.h"
#include "Labels/ReadNifti.h"
#include "Labels/VoxelFile.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <new>
#include <vector>

namespace sono {

namespace {

IntensityVolume readVoxelFile(const std::string& path, const Progress& progress)
{
  VoxelFile file = openVoxels(path);
  const int volumes = isNiftiName(path) ? readNiftiPhases(path).count : int(file.layers);
  if (volumes > 1)
  {
    throw Error("'" + path + "' holds " + std::to_string(volumes) +
                " volumes; save the one that belongs to the labels.");
  }
  file.bytes.need(file.numbers() * bytesOf(file.type)); // before memory is taken for them
  IntensityVolume volume;
  volume.placement = file.placement;
  if (areShorts(file))
  {
    auto shorts = largeVector<std::int16_t>(std::size_t(file.numbers()));
    readNumbers(file, progress, [&](const auto* numbers, std::size_t count, std::size_t position) {
      std::copy(numbers, numbers + count, shorts.data() + position);
    });
    volume.shorts = SharedSpan<std::int16_t>(std::move(shorts));
    return volume;
  }
  volume.values = largeVector<float>(std::size_t(file.numbers()));
  readNumbers(file, progress, [&](const auto* numbers, std::size_t count, std::size_t position) {
    float* const values = volume.values.data() + position;
    bool finite = true;
    for (std::size_t n = 0; n < count; ++n)
    {
      values[n] = float(file.slope * double(numbers[n]) + file.intercept);
      finite = finite && std::isfinite(values[n]);
    }
    if (!finite)
    {
      throw Error("'" + path + "' holds a number that is not finite; save it with a number in the place of NaN.");
    }
  });
  return volume;
}

/// Several lanes, because the order of comparisons must not matter for them to be vectors.
SONO_SIMD_CLONES IntensityRange rangeOfPart(const float* values, std::size_t count)
{
  constexpr std::size_t lanes = 32;
  float low[lanes];
  float high[lanes];
  std::uint32_t notFinite[lanes] = {};
  std::fill(low, low + lanes, values[0]);
  std::fill(high, high + lanes, values[0]);
  const auto add = [&](std::size_t lane, float value) {
    constexpr std::uint32_t exponent = 0x7f800000u;
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    notFinite[lane] |= std::uint32_t((bits & exponent) == exponent);
    low[lane] = value < low[lane] ? value : low[lane];
    high[lane] = value > high[lane] ? value : high[lane];
  };
  std::size_t at = 0;
  for (; at + lanes <= count; at += lanes)
  {
    for (std::size_t lane = 0; lane < lanes; ++lane)
    {
      add(lane, values[at + lane]);
    }
  }
  for (; at < count; ++at)
  {
    add(0, values[at]);
  }
  return { *std::min_element(low, low + lanes), *std::max_element(high, high + lanes),
           std::count(notFinite, notFinite + lanes, 0u) == std::ptrdiff_t(lanes) };
}

SONO_SIMD_CLONES IntensityRange rangeOfPart(const std::int16_t* values, std::size_t count)
{
  std::int16_t low = values[0];
  std::int16_t high = values[0];
  for (std::size_t n = 0; n < count; ++n)
  {
    low = std::min(low, values[n]);
    high = std::max(high, values[n]);
  }
  return { float(low), float(high), true };
}

template<class Value>
IntensityRange rangeOfAll(const Value* values, std::size_t count)
{
  constexpr std::size_t together = std::size_t(1) << 20;
  std::vector<IntensityRange> parts((count + together - 1) / together);
  parallelFor(int(parts.size()), {}, [&](int part) {
    const std::size_t first = std::size_t(part) * together;
    parts[std::size_t(part)] = rangeOfPart(values + first, std::min(together, count - first));
  });
  IntensityRange all = parts.empty() ? IntensityRange() : parts.front();
  for (const IntensityRange& part : parts)
  {
    all = { std::min(all.low, part.low), std::max(all.high, part.high), all.finite && part.finite };
  }
  return all;
}

} // namespace

IntensityRange rangeOf(const float* values, std::size_t count)
{
  return rangeOfAll(values, count);
}

IntensityRange rangeOf(const std::int16_t* values, std::size_t count)
{
  return rangeOfAll(values, count);
}

bool areShorts(const VoxelFile& file)
{
  const bool isSmall =
    file.type == NumberType::Int8 || file.type == NumberType::UInt8 || file.type == NumberType::Int16;
  return isSmall && file.slope == 1.0 && file.intercept == 0.0;
}

IntensityVolume readIntensities(const std::string& path, const Progress& progress)
{
  try
  {
    std::error_code error;
    const bool isSeries = std::filesystem::is_directory(path, error) || isDicomFile(path);
    return isSeries ? readDicomSeries(path, progress) : readVoxelFile(path, progress);
  }
  catch (const std::bad_alloc&)
  {
    throw Error("cannot read '" + path + "': it does not fit into memory; crop or resample it.");
  }
}

} // namespace sono
