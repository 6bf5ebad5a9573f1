#include "Channels/FanPlaces.h"

#include "Core/Error.h"
#include "Kernel/TimeOfFlight.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr int depthIterations = 6; // offsets rise by at most a tenth of the depth: each gains a digit

} // namespace

FanPlaces::FanPlaces(const ScanGeometry& geometry, const TracedLines* traced, const std::optional<Downshift>& downshift)
  : geometry_(geometry)
  , traced_(traced)
  , downshift_(downshift)
  , beams_(planeBeams(geometry))
{
  if (geometry.lineCount < 2)
  {
    throw Error("lineCount is 1: shadows in channels are those of a fan; give the probe at least 2 lines");
  }
  if (geometry.fanCount() > 1)
  {
    throw Error("compoundFans is " + std::to_string(geometry.fanCount()) +
                ": channels are made of one fan that is not steered; choose 1");
  }
}

double FanPlaces::depthMm(double lateralMm, double axialMm) const
{
  const double forward = axialMm - double(beams_.centreAxialMm);
  return (beams_.parallel ? forward : std::hypot(lateralMm, forward)) - double(beams_.faceRadiusMm);
}

std::optional<FanPlaces::Place> FanPlaces::at(double lateralMm, double axialMm) const
{
  float line = 0.0f;
  float depth = 0.0f;
  beams_.beamAt(float(lateralMm), beams_.axialFromCentre(float(axialMm)), line, depth);
  const float last = float(geometry_.lineCount - 1);
  const double deepestMm = traced_ ? traced_->binCount * traced_->binMm : geometry_.rangeMm();
  if (!(line >= 0.0f) || !(line <= last) || !(depth > 0.0f) || !(double(depth) < deepestMm) || !(axialMm > 0.0))
  {
    return std::nullopt;
  }
  const int first = std::min(int(line), geometry_.lineCount - 2);
  return Place{ first, line - float(first), depth };
}

float FanPlaces::binAt(const std::vector<float>& values, int line, float depthMm) const
{
  const float* bins = values.data() + std::size_t(line) * std::size_t(traced_->binCount);
  const float place =
    std::clamp(float(depthMm / traced_->binMm) - 0.5f, 0.0f, float(traced_->binCount - 1)); // between middles
  const int first = std::min(int(place), std::max(0, traced_->binCount - 2));
  const int second = std::min(first + 1, traced_->binCount - 1);
  return bins[first] + (place - float(first)) * (bins[second] - bins[first]);
}

float FanPlaces::lagMm(int line, float depthMm) const
{
  if (!traced_ || traced_->depthOffsetMm.empty())
  {
    return 0.0f;
  }
  const RangeMap map{ traced_->depthOffsetMm.data() + std::size_t(line) * std::size_t(traced_->binCount),
                      traced_->binCount, float(1.0 / traced_->binMm) };
  float range = depthMm;
  for (int n = 0; n < depthIterations; ++n)
  {
    range = std::max(0.0f, range + depthMm - map.depthOf(range));
  }
  return range - depthMm;
}

FanPlaces::Arrival FanPlaces::arrival(const Place& place) const
{
  if (!traced_)
  {
    return { 1.0f, 0.0f, 0.0f };
  }
  const auto between = [&](auto valueAt) {
    const float a = valueAt(place.line);
    return a + place.share * (valueAt(place.line + 1) - a);
  };
  const auto bins = [&](const std::vector<float>& values) {
    return values.empty() ? 0.0f : between([&](int line) { return binAt(values, line, place.depthMm); });
  };
  return { bins(traced_->intensity), between([&](int line) { return lagMm(line, place.depthMm); }),
           downshift_ ? shiftingExponent(*downshift_, bins(traced_->attenuationNpPerMHz)) : 0.0f };
}

} // namespace sono
