#include "DataSets/ImageSight.h"

#include "Image/LabelSlice.h"
#include "Image/ShownPlace.h"
#include "Kernel/TimeOfFlight.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr double softTissueDbPerCmMHz = 0.5;
constexpr double shadowDb = 20.0;

const float* offsetsOf(const TracedLines& traced)
{
  return traced.depthOffsetMm.empty() ? nullptr : traced.depthOffsetMm.data();
}

} // namespace

double ImageSight::leastIntensity(double frequencyMHz, double depthMm)
{
  const double db = -2.0 * softTissueDbPerCmMHz * frequencyMHz * depthMm / 10.0 - shadowDb; // there and back
  return std::pow(10.0, db / 20.0);
}

ImageSight::ImageSight(const ImageSettings& settings, const ProbePose& pose, const PlaneImage& layout,
                       const TracedLines& traced)
  : traced_(traced)
  , pose_(pose)
  , scan_(offsetScan(settings.geometry, traced.binCount, traced.binMm, layout.pixelMm))
  , rangeMm_(settings.geometry.rangeMm())
{
  const std::size_t bins = std::size_t(traced.binCount);
  for (std::size_t bin = 0; bin < bins; ++bin)
  {
    leastIntensity_.push_back(leastIntensity(settings.tracing.frequencyMHz, (double(bin) + 0.5) * traced.binMm));
  }
  clearByRange_.resize(std::size_t(traced.lineCount) * bins);
  for (std::size_t first = 0; first < clearByRange_.size(); first += bins)
  {
    const float* offsetMm = offsetsOf(traced);
    const RangeMap map{ offsetMm ? offsetMm + first : nullptr, traced.binCount, float(1.0 / traced.binMm) };
    for (std::size_t bin = 0; bin < bins; ++bin)
    {
      const int depthBin = depthSample(map, float(traced.binMm), int(bin), traced.binCount);
      clearByRange_[first + bin] =
        traced.intensity[first + std::size_t(depthBin)] < leastIntensity_[std::size_t(depthBin)] ? 0.0f : 1.0f;
    }
  }
}

double ImageSight::shareShadowed(const std::vector<ScanLine>& lines) const
{
  double all = 0.0;
  double shadowed = 0.0;
  const int bins = std::min(traced_.binCount, int(rangeMm_ / traced_.binMm));
  for (std::size_t line = 0; line + 1 < lines.size(); ++line)
  {
    const float* intensity = traced_.intensity.data() + line * std::size_t(traced_.binCount);
    for (int bin = 0; bin < bins; ++bin)
    {
      const double r = (bin + 0.5) * traced_.binMm;
      const double area =
        glm::distance(lines[line].originMm + r * lines[line].axis, lines[line + 1].originMm + r * lines[line + 1].axis);
      all += area;
      shadowed += intensity[bin] < leastIntensity_[std::size_t(bin)] ? area : 0.0;
    }
  }
  return all > 0.0 ? shadowed / all : 0.0;
}

std::vector<double> ImageSight::visibleShares(const std::vector<std::uint8_t>& mask, std::size_t count) const
{
  std::vector<double> clear(count + 1, 0.0);
  std::vector<double> all(count + 1, 0.0);
  for (int j = 0; j < scan_.height; ++j)
  {
    const float x = scan_.beams.axialFromCentre(scan_.axialMm(j));
    for (int i = 0; i < scan_.width; ++i)
    {
      const std::uint8_t value = mask[std::size_t(j) * std::size_t(scan_.width) + std::size_t(i)];
      if (value > 0)
      {
        clear[value] += scan_.levelAt(clearByRange_.data(), scan_.lateralMm(i), x);
        all[value] += 1.0;
      }
    }
  }
  std::vector<double> shares;
  for (std::size_t value = 1; value <= count; ++value)
  {
    shares.push_back(all[value] > 0.0 ? clear[value] / all[value] : 0.0);
  }
  return shares;
}

ImagePoint ImageSight::pointAt(const Vec3d& worldMm) const
{
  const ShownPlace place = shownPlace(scan_, offsetsOf(traced_), pose_, worldMm);
  ImagePoint point;
  point.worldMm = worldMm;
  point.column = (place.lateralMm - scan_.lateralMinMm) / scan_.pixelMm;
  point.row = (place.axialMm - scan_.axialMinMm) / scan_.pixelMm;
  point.offPlaneMm = place.offPlaneMm;
  point.inSector = place.inSector;
  const float x = scan_.beams.axialFromCentre(float(place.axialMm));
  point.inShadow = place.inSector && scan_.levelAt(clearByRange_.data(), float(place.lateralMm), x) < 0.5f;
  return point;
}

} // namespace sono
