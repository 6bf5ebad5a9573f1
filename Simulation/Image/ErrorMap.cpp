#include "Image/ErrorMap.h"

#include "Kernel/TimeOfFlight.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

/// Of the sum of two levels.
float errorPercent(float intensity, float standardError, float other, float otherError)
{
  const float level = intensity + other;
  return level > 0.0f ? std::min(100.0f, 100.0f * std::hypot(standardError, otherError) / level) : 100.0f;
}

/// Percent of the intensity, with what reverberates, by line and range, at multiples of half a bin: a bin's value
/// stands for its middle.
std::vector<float> errorsByRange(const TracedLines& traced)
{
  const std::size_t bins = std::size_t(traced.binCount);
  const float binMm = float(traced.binMm);
  struct Place
  {
    std::size_t bin;
    std::size_t next;
    float share;
  };
  const auto placeOf = [&](std::size_t line, float mm) {
    const float inside = std::clamp(mm / binMm - 0.5f, 0.0f, float(bins - 1));
    const std::size_t bin = line * bins + std::size_t(inside);
    return Place{ bin, std::min(bin + 1, line * bins + bins - 1), inside - std::floor(inside) };
  };
  const auto at = [](const std::vector<float>& values, const Place& p) {
    return values.empty() ? 0.0f : values[p.bin] + p.share * (values[p.next] - values[p.bin]);
  };
  std::vector<float> samples(2 * traced.intensity.size());
  for (std::size_t line = 0; line < std::size_t(traced.lineCount); ++line)
  {
    const RangeMap map{ traced.depthOffsetMm.empty() ? nullptr : traced.depthOffsetMm.data() + line * bins,
                        traced.binCount, 1.0f / binMm };
    for (std::size_t s = 0; s < 2 * bins; ++s)
    {
      const float rangeMm = 0.5f * binMm * float(s);
      const Place depth = placeOf(line, map.offsetMm ? map.depthOf(rangeMm) : rangeMm);
      const Place range = placeOf(line, rangeMm);
      const float other = at(traced.reverberation, range);
      const float otherError = at(traced.reverberationError, range);
      const auto percent = [&](std::size_t bin) {
        return errorPercent(traced.intensity[bin], traced.standardError[bin], other, otherError);
      };
      const float near = percent(depth.bin);
      samples[2 * line * bins + s] = near + depth.share * (percent(depth.next) - near);
    }
  }
  return samples;
}

} // namespace

PlaneImage errorPlane(const ScanGeometry& geometry, const TracedLines& traced, double pixelMm)
{
  return scanConvert(geometry, errorsByRange(traced), 2 * traced.binCount, traced.binMm / 2.0, pixelMm);
}

VolumeImage errorVolume(const ScanGeometry& geometry, const TracedLines& traced, double voxelMm,
                        const Progress& progress)
{
  return scanConvertVolume(geometry, errorsByRange(traced), 2 * traced.binCount, traced.binMm / 2.0, voxelMm, progress);
}

} // namespace sono
