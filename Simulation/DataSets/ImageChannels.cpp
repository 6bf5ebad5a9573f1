#include "DataSets/ImageChannels.h"

#include "Kernel/TimeOfFlight.h"

#include <algorithm>

namespace sono {

namespace {

bool has(const std::vector<ImageChannel>& wanted, ImageChannel channel)
{
  return std::find(wanted.begin(), wanted.end(), channel) != wanted.end();
}

/// One-way intensity at each sample of range, between the middles of the tracer's bins of depth.
std::vector<float> intensityBySample(const TracedLines& traced, int sampleCount, double sampleMm)
{
  const std::size_t bins = std::size_t(traced.binCount);
  const std::size_t samples = std::size_t(sampleCount);
  std::vector<float> out(std::size_t(traced.lineCount) * samples);
  for (std::size_t line = 0; line < std::size_t(traced.lineCount); ++line)
  {
    const float* intensity = traced.intensity.data() + line * bins;
    const RangeMap map{ traced.depthOffsetMm.empty() ? nullptr : traced.depthOffsetMm.data() + line * bins,
                        traced.binCount, float(1.0 / traced.binMm) };
    for (std::size_t s = 0; s < samples; ++s)
    {
      const float rangeMm = float(double(s) * sampleMm);
      const float depthMm = map.offsetMm ? map.depthOf(rangeMm) : rangeMm;
      const float at = std::clamp(depthMm / float(traced.binMm) - 0.5f, 0.0f, float(bins - 1));
      const std::size_t bin = std::size_t(at);
      const float next = intensity[std::min(bin + 1, bins - 1)];
      out[line * samples + s] = intensity[bin] + (at - float(bin)) * (next - intensity[bin]);
    }
  }
  return out;
}

} // namespace

ChannelImage pixelChannels(const std::vector<ImageChannel>& wanted, const ImageInput& input, Simulator& simulator,
                           const ScanPicture& picture, const std::vector<std::uint8_t>& mask)
{
  const ImageResult result = simulator.image(input);
  const PlaneImage& layout = result.plane().layout();
  ChannelImage image;
  std::string units;
  const auto add = [&](ImageChannel channel, const std::string& unit, const auto& make) {
    if (has(wanted, channel))
    {
      image.add(nameOf(channel), make());
      units += (units.empty() ? "" : "; ") + std::string(nameOf(channel)) + ": " + unit;
    }
  };
  const auto ofLabels = [&](const auto& value) {
    std::vector<float> values(picture.labels.size, 0.0f);
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      values[i] = picture.mask[i] ? float(value(picture.labels[i])) : 0.0f;
    }
    return values;
  };
  add(ImageChannel::Grey, "0 (black) to 1 (white)", [&] { return result.plane().host().value; });
  add(ImageChannel::Mask, "mask group, from 1", [&] { return std::vector<float>(mask.begin(), mask.end()); });
  add(ImageChannel::Label, "id of the label map", [&] { return ofLabels([](std::uint16_t id) { return id; }); });
  add(ImageChannel::Tissue, "tissue, from 1", [&] {
    const Scene& scene = *simulator.scene();
    const int beyond = scene.volume().find(0) ? scene.tissueOfLabel()[0] : scene.outsideIndex(); // of no label
    return ofLabels([&](std::uint16_t id) { return 1 + (id > 0 ? scene.tissueOfLabel()[id] : beyond); });
  });
  add(ImageChannel::Error, "percent of the intensity", [&] {
    const ImageSettings& settings = input.settings;
    return simulator.errorMap(settings.geometry, simulator.traced(input), false, settings.pixelMm).plane().host().value;
  });
  if (!image.names.empty())
  {
    image.width = layout.width;
    image.height = layout.height;
    image.numbers = { { "pixelMm", layout.pixelMm },
                      { "lateralMinMm", layout.lateralMinMm },
                      { "axialMinMm", layout.axialMinMm } };
    image.texts = { { "units", units } };
  }
  return image;
}

ChannelImage beamChannels(const std::vector<ImageChannel>& wanted, const ImageInput& input, Simulator& simulator)
{
  ChannelImage image;
  if (!has(wanted, ImageChannel::Beam))
  {
    return image;
  }
  const RfLines& rf = simulator.rf(input).host();
  const BModeLines& bmode = simulator.bmode(input).host();
  const TracedLines& traced = simulator.traced(input).host();
  std::vector<float> re;
  std::vector<float> im;
  for (const std::complex<float>& value : rf.iq)
  {
    re.push_back(value.real());
    im.push_back(value.imag());
  }
  image.width = rf.sampleCount;
  image.height = rf.lineCount;
  image.add("grey", bmode.grey);
  image.add("envelope", rf.envelope());
  image.add("iq.re", std::move(re));
  image.add("iq.im", std::move(im));
  image.add("intensity", intensityBySample(traced, rf.sampleCount, rf.sampleMm));
  image.numbers = { { "sampleMm", rf.sampleMm },
                    { "samplingMHz", rf.samplingMHz },
                    { "centreFrequencyMHz", rf.centreFrequencyMHz } };
  image.texts = { { "units", "grey: 0 (black) to 1 (white); envelope, iq.re, iq.im: amplitude; intensity: 1 at the "
                             "transducer; a row is a line, a column a sample of range" } };
  return image;
}

} // namespace sono
