#include "Image/ErrorMap.h"

#include "Kernel/TimeOfFlight.h"

#include <algorithm>

namespace sono {

namespace {

float errorPercent(float intensity, float standardError)
{
  return intensity > 0.0f ? std::min(100.0f, 100.0f * standardError / intensity) : 100.0f;
}

/// Percent of the intensity, by line and range, at multiples of half a bin: a bin's value stands for its middle.
std::vector<float> errorsByRange(const TracedLines& traced)
{
  const std::size_t bins = std::size_t(traced.binCount);
  const float binMm = float(traced.binMm);
  std::vector<float> percent(traced.intensity.size());
  std::transform(traced.intensity.begin(), traced.intensity.end(), traced.standardError.begin(), percent.begin(),
                 errorPercent);
  std::vector<float> samples(2 * percent.size());
  for (std::size_t line = 0; line < std::size_t(traced.lineCount); ++line)
  {
    const float* from = percent.data() + line * bins;
    float* to = samples.data() + 2 * line * bins;
    const RangeMap map{ traced.depthOffsetMm.empty() ? nullptr : traced.depthOffsetMm.data() + line * bins,
                        traced.binCount, 1.0f / binMm };
    for (std::size_t s = 0; s < 2 * bins; ++s)
    {
      const float rangeMm = 0.5f * binMm * float(s);
      const float depthMm = map.offsetMm ? map.depthOf(rangeMm) : rangeMm;
      const float position = std::clamp(depthMm / binMm - 0.5f, 0.0f, float(traced.binCount - 1));
      const std::size_t bin = std::size_t(position);
      const std::size_t next = std::min(bin + 1, bins - 1);
      to[s] = from[bin] + (position - float(bin)) * (from[next] - from[bin]);
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
