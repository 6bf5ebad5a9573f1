#include "DataSets/ImageSight.h"

#include "Core/Simd.h"
#include "Image/LabelSlice.h"
#include "Image/ShownPlace.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace sono {

namespace {

constexpr double softTissueDbPerCmMHz = 0.5;
constexpr double shadowDb = 20.0;

constexpr std::uint8_t isMixed = 2;

const float* offsetsOf(const TracedLines& traced)
{
  return traced.depthOffsetMm.empty() ? nullptr : traced.depthOffsetMm.data();
}

/// How far apart two lines lie at each of `count` bins.
SONO_SIMD_CLONES void findGaps(const ScanLine& a, const ScanLine& b, double binMm, int count, double* __restrict gapsMm)
{
  const Vec3d start = b.originMm - a.originMm;
  const Vec3d perMm = b.axis - a.axis;
  const double c0 = glm::dot(start, start);
  const double c1 = 2.0 * glm::dot(start, perMm);
  const double c2 = glm::dot(perMm, perMm);
  for (int bin = 0; bin < count; ++bin)
  {
    const double r = (bin + 0.5) * binMm;
    const double gap2 = c0 + r * (c1 + r * c2);
    gapsMm[bin] = std::sqrt(gap2 > 0.0 ? gap2 : 0.0);
  }
}

/// The cell of lines and bins in which each of a row's pixels lies, of a plane that is not steered; -1 beside the
/// scanned area, and in a last line's or bin's. `x` is the row's, as PlaneBeams::axialFromCentre.
SONO_SIMD_CLONES void findCells(const PlaneScan& scan, const float* __restrict lateralMm, int count, float x,
                                int* __restrict cells)
{
  const PlaneBeams beams = scan.beams;
  const float forward = PlaneBeams::notZero(x);
  const float firstMm = std::max(0.0f, scan.area.firstMm);
  const auto lastLine = float(scan.lineCount - 1);
  const int bins = scan.sampleCount;
  const float endMm = std::min(scan.area.lastMm, float(bins - 1) / scan.samplesPerMm);
  const float perMm = scan.samplesPerMm;
  const auto cellAt = [=](float line, float depthMm) {
    const bool isThere = (line >= 0.0f) & (line < lastLine) & (depthMm >= firstMm) & (depthMm < endMm);
    const int cell = int(std::min(std::max(line, 0.0f), lastLine)) * bins + int(std::max(depthMm, 0.0f) * perMm);
    return isThere ? cell : -1;
  };
  for (int n = 0; beams.parallel && n < count; ++n)
  {
    cells[n] = cellAt(beams.lineOfParallel(lateralMm[n]), x - beams.faceRadiusMm);
  }
  for (int n = 0; !beams.parallel && n < count; ++n)
  {
    cells[n] = cellAt(beams.lineOfFan(lateralMm[n], forward), beams.depthInFan(lateralMm[n], x));
  }
}

/// Intensities at depths that are shown at a line's bins of range, held against the least ones: 0 below, else 1.
void findClear(const float* intensity, const float* offsetMm, const std::vector<double>& least, double binMm,
               float* clear)
{
  const int last = int(least.size()) - 1;
  const auto perBin = float(1.0 / binMm);
  for (int bin = 0; bin <= last; ++bin)
  {
    // At the bins themselves a RangeMap is what its table has.
    const int shown = offsetMm ? int(std::max(0.0f, float(bin) + offsetMm[bin] * perBin + 0.5f)) : bin;
    const auto depthBin = std::size_t(std::min(shown, last));
    clear[bin] = intensity[depthBin] < least[depthBin] ? 0.0f : 1.0f;
  }
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
    findClear(traced.intensity.data() + first, offsetMm ? offsetMm + first : nullptr, leastIntensity_, traced.binMm,
              clearByRange_.data() + first);
  }
  findWholeCells();
}

void ImageSight::findWholeCells()
{
  wholeCells_.assign(clearByRange_.size(), isMixed);
  const auto bins = std::size_t(scan_.sampleCount);
  for (std::size_t line = 0; line + 1 < std::size_t(scan_.lineCount) && scan_.fanCount == 1; ++line)
  {
    const float* near = clearByRange_.data() + line * bins;
    const float* far = near + bins;
    std::uint8_t* whole = wholeCells_.data() + line * bins;
    for (std::size_t bin = 0; bin + 1 < bins; ++bin)
    {
      const float sum = near[bin] + near[bin + 1] + far[bin] + far[bin + 1];
      whole[bin] = sum == 0.0f ? std::uint8_t(0) : sum == 4.0f ? std::uint8_t(1) : isMixed;
    }
  }
}

double ImageSight::shareShadowed(const std::vector<ScanLine>& lines) const
{
  double all = 0.0;
  double shadowed = 0.0;
  const int bins = std::min(traced_.binCount, int(rangeMm_ / traced_.binMm));
  std::vector<double> gapsMm(std::size_t(std::max(bins, 0)));
  for (std::size_t line = 0; line + 1 < lines.size(); ++line)
  {
    const float* intensity = traced_.intensity.data() + line * std::size_t(traced_.binCount);
    findGaps(lines[line], lines[line + 1], traced_.binMm, bins, gapsMm.data());
    for (std::size_t bin = 0; bin < gapsMm.size(); ++bin)
    {
      all += gapsMm[bin];
      shadowed += intensity[bin] < leastIntensity_[bin] ? gapsMm[bin] : 0.0;
    }
  }
  return all > 0.0 ? shadowed / all : 0.0;
}

std::vector<double> ImageSight::visibleShares(const std::vector<std::uint8_t>& mask, std::size_t count) const
{
  std::vector<double> clear(count + 1, 0.0);
  std::vector<double> all(count + 1, 0.0);
  std::vector<int> cells(std::size_t(scan_.width));
  std::vector<float> lateralMm;
  for (int i = 0; i < scan_.width; ++i)
  {
    lateralMm.push_back(scan_.lateralMm(i));
  }
  for (int j = 0; j < scan_.height; ++j)
  {
    const std::uint8_t* row = mask.data() + std::size_t(j) * std::size_t(scan_.width);
    const std::uint8_t* end = row + scan_.width;
    const auto isAny = [](std::uint8_t value) { return value > 0; };
    const int first = int(std::find_if(row, end, isAny) - row);
    const int here =
      int(std::find_if(std::make_reverse_iterator(end), std::make_reverse_iterator(row + first), isAny).base() - row) -
      first;
    const float x = scan_.beams.axialFromCentre(scan_.axialMm(j));
    findCells(scan_, lateralMm.data() + first, here, x, cells.data());
    for (int n = 0; n < here; ++n)
    {
      const std::uint8_t value = row[first + n];
      if (value > 0)
      {
        const std::uint8_t whole =
          cells[std::size_t(n)] < 0 ? isMixed : wholeCells_[std::size_t(cells[std::size_t(n)])];
        clear[value] += whole != isMixed
                          ? double(whole)
                          : double(scan_.levelAt(clearByRange_.data(), lateralMm[std::size_t(first + n)], x));
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
