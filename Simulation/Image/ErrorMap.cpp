#include "Image/ErrorMap.h"

#include <algorithm>

namespace sono {

namespace {

/// Percent of the intensity, by line and bin.
std::vector<float> errorPercent(const std::vector<float>& intensity, const std::vector<float>& standardError)
{
  std::vector<float> percent(intensity.size());
  for (std::size_t i = 0; i < percent.size(); ++i)
  {
    percent[i] = intensity[i] > 0.0f ? std::min(100.0f, 100.0f * standardError[i] / intensity[i]) : 100.0f;
  }
  return percent;
}

/// Scan conversion takes the first sample to lie at depth 0, but a bin's value stands for its middle. So the bins are
/// sampled twice as finely: the odd samples are the bins, the even ones lie between two.
std::vector<float> betweenBins(const std::vector<float>& bins, int binCount)
{
  std::vector<float> samples(2 * bins.size());
  for (std::size_t first = 0; first < bins.size(); first += std::size_t(binCount))
  {
    const float* from = bins.data() + first;
    float* to = samples.data() + 2 * first;
    for (int bin = 0; bin < binCount; ++bin)
    {
      to[2 * bin] = 0.5f * (from[std::max(0, bin - 1)] + from[bin]);
      to[2 * bin + 1] = from[bin];
    }
  }
  return samples;
}

} // namespace

PlaneImage errorPlane(const ScanGeometry& geometry, const std::vector<float>& intensity,
                      const std::vector<float>& standardError, int binCount, double binMm, double pixelMm)
{
  return scanConvert(geometry, betweenBins(errorPercent(intensity, standardError), binCount), 2 * binCount, binMm / 2.0,
                     pixelMm);
}

VolumeImage errorVolume(const ScanGeometry& geometry, const std::vector<float>& intensity,
                        const std::vector<float>& standardError, int binCount, double binMm, double voxelMm,
                        const Progress& progress)
{
  return scanConvertVolume(geometry, betweenBins(errorPercent(intensity, standardError), binCount), 2 * binCount,
                           binMm / 2.0, voxelMm, progress);
}

} // namespace sono
