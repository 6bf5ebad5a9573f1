#include "Channels/Transmits.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;

double wayMm(const Transmit& transmit, const Vec3d& element)
{
  const Vec3d direction(std::sin(transmit.angleRad), 0.0, std::cos(transmit.angleRad));
  switch (transmit.kind)
  {
    case TransmitKind::DivergingWaves:
      return glm::length(element + transmit.distanceMm * direction) - transmit.distanceMm;
    case TransmitKind::FocusedWaves:
      return transmit.distanceMm - glm::length(transmit.distanceMm * direction - element);
    default:
      return glm::dot(element, direction);
  }
}

double apertureMm(const ArrayElements& elements)
{
  return elements.centresMm.back().x - elements.centresMm.front().x + elements.widthMm;
}

double distanceFor(const ChannelSettings& settings, const ProbeSettings& probe, const ArrayElements& elements)
{
  if (settings.transmitKind == TransmitKind::PlaneWaves)
  {
    return 0.0;
  }
  if (settings.transmitDistanceMm > 0.0)
  {
    return settings.transmitDistanceMm;
  }
  if (settings.transmitKind == TransmitKind::DivergingWaves)
  {
    return 0.5 * apertureMm(elements);
  }
  if (!(probe.transmitFocusMm > 0.0))
  {
    throw Error("transmitDistanceMm is 0 and the probe has no transmit focus: set where the focused waves meet, or "
                "choose plane waves");
  }
  return probe.transmitFocusMm;
}

} // namespace

Transmits timeTransmits(std::vector<Transmit> each, Apodization apodization, const ArrayElements& elements,
                        double mmPerUs)
{
  Transmits out;
  out.each = std::move(each);
  const std::size_t count = elements.centresMm.size();
  double earliestMm = 0.0;
  for (const Transmit& transmit : out.each)
  {
    for (std::size_t n = 0; n < count; ++n)
    {
      const double mm = wayMm(transmit, elements.centresMm[n]);
      earliestMm = std::min(earliestMm, mm);
      out.delaysUs.push_back(mm / mmPerUs);
      const double share = (double(n) - 0.5 * double(count - 1)) / double(count);
      out.weights.push_back(apodization == Apodization::Hann ? float(0.5 + 0.5 * std::cos(2.0 * pi * share)) : 1.0f);
    }
  }
  out.passUs = -earliestMm / mmPerUs;
  for (double& delay : out.delaysUs)
  {
    delay += out.passUs;
  }
  return out;
}

Transmits makeTransmits(const ChannelSettings& settings, const ProbeSettings& probe, const ArrayElements& elements)
{
  std::vector<Transmit> each;
  const double distanceMm = distanceFor(settings, probe, elements);
  const double spanRad = settings.transmitSpanDeg * pi / 180.0;
  for (int t = 0; t < settings.transmitCount; ++t)
  {
    const double share = settings.transmitCount > 1 ? double(t) / (settings.transmitCount - 1) - 0.5 : 0.0;
    each.push_back({ settings.transmitKind, share * spanRad, distanceMm });
  }
  return timeTransmits(std::move(each), settings.apodization, elements, 1e-3 * probe.geometry.assumedSoundSpeedMPerS);
}

} // namespace sono
