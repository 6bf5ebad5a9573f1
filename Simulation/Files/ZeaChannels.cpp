#include "Files/ChannelCine.h"
#include "Files/ZeaParts.h"

#include <limits>

namespace sono {

namespace {

constexpr double mPerMm = 1e-3;
constexpr double hzPerMHz = 1e6;
constexpr double sPerUs = 1e-6;

const std::string dataGroup = "tracks/track_0/data/";
const std::string scanGroup = "tracks/track_0/scan/";

/// From the middle of the face: before it positive, behind it negative, of a plane wave infinite.
float focusM(const Transmit& transmit)
{
  switch (transmit.kind)
  {
    case TransmitKind::FocusedWaves:
      return float(mPerMm * transmit.distanceMm);
    case TransmitKind::DivergingWaves:
      return float(-mPerMm * transmit.distanceMm);
    default:
      return std::numeric_limits<float>::infinity();
  }
}

class ZeaChannels : public ChannelCine
{
public:
  ZeaChannels(const std::string& path, const ChannelCineInfo& info)
    : ChannelCine(path, info)
    , transmits_(info.transmits.each.size())
    , elements_(info.elements.centresMm.size())
    , samples_(std::size_t(info.sampleCount))
    , file_(path, info.timesS.size() * info.valueCount() + 8 * transmits_ * elements_)
  {
    writeZeaHeader(file_);
    file_.announce(dataGroup + "raw_data", { info.timesS.size(), transmits_, samples_, elements_, 1 });
    writeZeaProbe(info.probe, info.elements, file_);
    writeScan(info);
    writeZeaPose(info.pose, file_);
  }

private:
  void writeScan(const ChannelCineInfo& info)
  {
    std::vector<float> delays;
    std::vector<float> polar;
    std::vector<float> focus;
    for (const double delayUs : info.transmits.delaysUs)
    {
      delays.push_back(float(sPerUs * delayUs));
    }
    for (const Transmit& transmit : info.transmits.each)
    {
      polar.push_back(float(transmit.angleRad));
      focus.push_back(focusM(transmit));
    }
    const Hdf5File::Shape each{ transmits_ };
    const std::vector<float> zeros(3 * transmits_, 0.0f);
    file_.number(scanGroup + "sampling_frequency", hzPerMHz * info.samplingMHz);
    file_.number(scanGroup + "center_frequency", hzPerMHz * info.probe.centreFrequencyMHz);
    file_.number(scanGroup + "demodulation_frequency", 0.0);
    file_.number(scanGroup + "sound_speed", info.probe.geometry.assumedSoundSpeedMPerS);
    file_.floats(scanGroup + "initial_times", each, { zeros.begin(), zeros.begin() + std::ptrdiff_t(transmits_) });
    file_.floats(scanGroup + "t0_delays", { transmits_, elements_ }, delays);
    file_.floats(scanGroup + "tx_apodizations", { transmits_, elements_ }, info.transmits.weights);
    file_.floats(scanGroup + "focus_distances", each, focus);
    file_.floats(scanGroup + "transmit_origins", { transmits_, 3 }, zeros);
    file_.floats(scanGroup + "polar_angles", each, polar);
    file_.floats(scanGroup + "azimuth_angles", each, { zeros.begin(), zeros.begin() + std::ptrdiff_t(transmits_) });
    if (info.timesS.size() > 1)
    {
      std::vector<float> pauses; // transmits of a frame are simulated at its time
      for (std::size_t frame = 0; frame < info.timesS.size(); ++frame)
      {
        for (std::size_t t = 0; t < transmits_; ++t)
        {
          const bool isLast = t + 1 == transmits_ && frame + 1 < info.timesS.size();
          pauses.push_back(isLast ? float(info.timesS[frame + 1] - info.timesS[frame]) : 0.0f);
        }
      }
      file_.floats(scanGroup + "time_to_next_transmit", { info.timesS.size(), transmits_ }, pauses);
    }
  }

  void write(std::size_t frame, const std::vector<float>& rf) override
  {
    std::vector<float> values;
    values.reserve(rf.size());
    for (std::size_t t = 0; t < transmits_; ++t)
    {
      for (std::size_t s = 0; s < samples_; ++s)
      {
        for (std::size_t n = 0; n < elements_; ++n)
        {
          values.push_back(rf[(t * elements_ + n) * samples_ + s]);
        }
      }
    }
    file_.part(dataGroup + "raw_data", frame, values);
  }
  void close() override { file_.finish(); }

  std::size_t transmits_;
  std::size_t elements_;
  std::size_t samples_;
  Hdf5File file_;
};

} // namespace

std::unique_ptr<ChannelCine> zeaChannels(const std::string& path, const ChannelCineInfo& info)
{
  return std::make_unique<ZeaChannels>(path, info);
}

} // namespace sono
