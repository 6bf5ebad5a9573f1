#include "Channels/ChannelPlan.h"

#include "Channels/ChannelLoops.h"
#include "Core/Require.h"
#include "Core/Simd.h"
#include "Core/SoundSpeed.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double dbPerNp = 8.685889638065035;
constexpr double mostSamples = 1e9;
constexpr double leastShellUs = 8.0;
/// A block's frequencies span at most this share of the centre frequency, over which E is a ComplexCurve.
constexpr double mostSpan = 0.12;
constexpr double shellShare = 0.25; // of the longest stretch that a single point takes

/// No piece is wider than the shortest wavelength of the pulse's -6 dB band, as SIMUS has it.
ElementPieces cutUp(const ArrayElements& elements, const ProbeSettings& probe)
{
  const double shortestMm =
    assumedSoundSpeedMmPerUs / (probe.centreFrequencyMHz * (1.0 + 0.5 * probe.fractionalBandwidth));
  ElementPieces out;
  out.elements = int(elements.centresMm.size());
  out.padded = inWholeVectors(out.elements);
  out.perElement = std::max(1, int(std::ceil(elements.widthMm / shortestMm - 1e-6)));
  const double widthMm = elements.widthMm / out.perElement;
  out.halfWidthMm = float(0.5 * widthMm);
  const std::size_t count = std::size_t(out.padded) * std::size_t(out.perElement);
  for (std::vector<float>* values : { &out.x, &out.z, &out.normalX, &out.normalZ })
  {
    values->assign(count, 0.0f);
  }
  for (int p = 0; p < out.perElement; ++p)
  {
    const double alongMm = (p - 0.5 * (out.perElement - 1)) * widthMm;
    for (int n = 0; n < out.elements; ++n)
    {
      const std::size_t at = std::size_t(p) * std::size_t(out.padded) + std::size_t(n);
      const double azimuth = elements.azimuthsRad[std::size_t(n)];
      out.x[at] = float(elements.centresMm[std::size_t(n)].x + alongMm * std::cos(azimuth));
      out.z[at] = float(elements.centresMm[std::size_t(n)].z - alongMm * std::sin(azimuth));
      out.normalX[at] = float(std::sin(azimuth));
      out.normalZ[at] = float(std::cos(azimuth));
    }
  }
  return out;
}

ElementShape shapeOf(const ChannelSettings& settings, const ProbeSettings& probe)
{
  ElementShape shape;
  shape.wavesPerMm = float(1.0 / assumedSoundSpeedMmPerUs);
  if (settings.flat)
  {
    return shape;
  }
  if (!(probe.elevationApertureMm > 0.0))
  {
    throw Error("the probe does not say how high its elements are: set elevationApertureMm, or flat for channels in "
                "two dimensions");
  }
  shape.perHeightMm = float(1.0 / probe.elevationApertureMm);
  shape.perFocusMm = probe.elevationFocusMm > 0.0 ? float(1.0 / probe.elevationFocusMm) : 0.0f;
  return shape;
}

const ChannelSettings& checked(const ChannelSettings& settings, const ProbeSettings& probe)
{
  settings.validate();
  probe.geometry.validate();
  if (probe.imagingMode == ImagingMode::Harmonic)
  {
    throw Error("imagingMode is Harmonic: channels are made of the sound that is sent; choose Fundamental");
  }
  return settings;
}

PulseSpectrum spectrumOf(const ProbeSettings& probe, std::shared_ptr<const SampledPulse> pulse)
{
  return pulse ? PulseSpectrum(std::move(pulse)) : PulseSpectrum(probe.centreFrequencyMHz, probe.fractionalBandwidth);
}

/// When a point is heard first and last, us.
struct Stretch
{
  double fromUs;
  double toUs;
};

Stretch stretchOf(const ChannelPlan& plan, const ChannelPoints& points, std::size_t i, Stretch sent)
{
  const ElementPieces& pieces = plan.pieces;
  float nearest = 3e38f;
  float furthest = 0.0f;
  for (int n = 0; n < pieces.elements; ++n)
  {
    const float dx = points.x[i] - pieces.x[std::size_t(n)];
    const float dz = points.z[i] - pieces.z[std::size_t(n)];
    const float squared = dx * dx + dz * dz + (plan.settings.flat ? 0.0f : points.y[i] * points.y[i]);
    nearest = std::min(nearest, squared);
    furthest = std::max(furthest, squared);
  }
  // A piece's middle may lie nearer than the element's.
  const double slackMm = 0.5 * plan.elements.widthMm;
  const double lag = points.lagMm[i];
  return { sent.fromUs + 2.0 * (std::sqrt(double(nearest)) - slackMm + lag) / assumedSoundSpeedMmPerUs,
           sent.toUs + 2.0 * (std::sqrt(double(furthest)) + slackMm + lag) / assumedSoundSpeedMmPerUs };
}

} // namespace

ChannelPlan::ChannelPlan(const ChannelSettings& given, const ProbeSettings& probe,
                         std::shared_ptr<const SampledPulse> pulse)
  : settings(checked(given, probe))
  , elements(arrayElements(probe, settings.elementCount))
  , transmits(makeTransmits(settings, probe, elements))
  , spectrum(spectrumOf(probe, std::move(pulse)))
  , pieces(cutUp(elements, probe))
  , shape(shapeOf(settings, probe))
  , shortestMm(float(0.5 * assumedSoundSpeedMmPerUs / probe.centreFrequencyMHz))
  , npPerMmMHz(float(settings.attenuationDbPerCmMHz / dbPerNp / 10.0))
  , centreMHz(probe.centreFrequencyMHz)
  , samplingMHz(settings.samplingFor(probe))
  , highMHz(std::min(spectrum.highMHz(), 0.4999 * samplingMHz))
{
  const double leastMHz = 2.0 * spectrum.strongestMHz() * (1.0 + 0.5 * probe.fractionalBandwidth);
  requireInRange(samplingMHz >= leastMHz, "channelSamplingMHz", samplingMHz,
                 "at least " + std::to_string(leastMHz) + ", twice the upper end of the pulse's band");
  const double lastUs = *std::max_element(transmits.delaysUs.begin(), transmits.delaysUs.end());
  const double durationUs =
    lastUs + 2.0 * probe.geometry.rangeMm() / assumedSoundSpeedMmPerUs + std::max(0.0, spectrum.endUs());
  const double count = std::ceil(durationUs * samplingMHz) + 1.0;
  if (count * double(transmits.each.size()) * double(pieces.elements) > mostSamples)
  {
    throw Error("transmitCount is " + std::to_string(transmits.each.size()) +
                ": the channels' samples do not fit; use fewer transmits or elements, less depth, or a lower sampling "
                "frequency");
  }
  sampleCount = int(count);
}

ChannelData ChannelPlan::described() const
{
  ChannelData data;
  data.transmitCount = int(transmits.each.size());
  data.elementCount = pieces.elements;
  data.sampleCount = sampleCount;
  data.samplingMHz = samplingMHz;
  return data;
}

ChannelData ChannelPlan::empty() const
{
  ChannelData data = described();
  data.rf.assign(transmits.each.size() * std::size_t(pieces.elements) * std::size_t(sampleCount), 0.0f);
  return data;
}

ChannelShells makeShells(const ChannelPlan& plan, const ChannelPoints& points)
{
  const Stretch sent{
    *std::min_element(plan.transmits.delaysUs.begin(), plan.transmits.delaysUs.end()) + plan.spectrum.startUs(),
    *std::max_element(plan.transmits.delaysUs.begin(), plan.transmits.delaysUs.end()) + plan.spectrum.endUs()
  };
  const double endUs = plan.sampleCount / plan.samplingMHz;
  std::vector<Stretch> stretches(points.size());
  std::vector<std::size_t> order;
  double longestUs = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    stretches[i] = stretchOf(plan, points, i, sent);
    if (points.z[i] > 0.0f && stretches[i].fromUs < endUs)
    {
      order.push_back(i);
      longestUs = std::max(longestUs, stretches[i].toUs - stretches[i].fromUs);
    }
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return stretches[a].fromUs < stretches[b].fromUs; });
  ChannelShells out;
  const double shellUs = std::max(leastShellUs, shellShare * longestUs);
  double windowUs = 0.0;
  double lastUs = 0.0;
  for (std::size_t k = 0; k < order.size(); ++k)
  {
    const Stretch& stretch = stretches[order[k]];
    const double startUs = out.shells.empty() ? 0.0 : out.shells.back().firstSample / plan.samplingMHz;
    if (out.shells.empty() || stretch.fromUs > startUs + shellUs)
    {
      out.shells.push_back({ k, k, int(std::floor(stretch.fromUs * plan.samplingMHz)) });
      lastUs = 0.0;
    }
    ChannelShell& shell = out.shells.back();
    shell.end = k + 1;
    lastUs = std::max(lastUs, stretch.toUs);
    windowUs = std::max(windowUs, lastUs - shell.firstSample / plan.samplingMHz);
  }
  out.points = points.ordered(order);
  windowUs = std::max(windowUs, (channelBins - 1) / (mostSpan * plan.centreMHz));
  out.samples = int(std::ceil(windowUs * plan.samplingMHz)) + 2;
  out.stepMHz = plan.samplingMHz / out.samples;
  out.firstBin = std::max(1, int(std::ceil(plan.spectrum.lowMHz() / out.stepMHz)));
  out.bins = std::max(0, int(std::floor(plan.highMHz / out.stepMHz)) - out.firstBin + 1);
  for (const std::complex<double>& value : plan.spectrum.at(out.frequencyMHz(0), out.stepMHz, out.bins))
  {
    out.pulse.emplace_back(2.0 * out.stepMHz * value);
  }
  for (int n = 0; n < out.samples; ++n)
  {
    out.turnCosine.push_back(float(std::cos(2.0 * pi * n / out.samples)));
    out.turnSine.push_back(float(std::sin(2.0 * pi * n / out.samples)));
  }
  return out;
}

std::vector<float> driveTable(const ChannelPlan& plan, const ChannelShells& shells)
{
  const std::size_t padded = std::size_t(plan.pieces.padded);
  const std::size_t transmits = plan.transmits.each.size();
  std::vector<float> table(std::size_t(shells.bins) * transmits * 2 * padded, 0.0f);
  for (int bin = 0; bin < shells.bins; ++bin)
  {
    const double radPerUs = 2.0 * pi * shells.frequencyMHz(bin);
    for (std::size_t t = 0; t < transmits; ++t)
    {
      float* re = table.data() + (std::size_t(bin) * transmits + t) * 2 * padded;
      for (std::size_t n = 0; n < std::size_t(plan.pieces.elements); ++n)
      {
        const double weight = plan.transmits.weights[t * std::size_t(plan.pieces.elements) + n];
        const double phase = radPerUs * plan.transmits.delayUs(t, n);
        re[n] = float(weight * std::cos(phase));
        re[padded + n] = float(weight * std::sin(phase));
      }
    }
  }
  return table;
}

} // namespace sono
