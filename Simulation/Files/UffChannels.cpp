#include "Files/ChannelCine.h"
#include "Files/UffObjects.h"

#include <limits>

namespace sono {

namespace {

constexpr double mPerMm = 1e-3;
constexpr double hzPerMHz = 1e6;
constexpr double sPerUs = 1e-6;
constexpr double pi = 3.14159265358979323846;

class UffChannels : public ChannelCine
{
public:
  UffChannels(const std::string& path, const ChannelCineInfo& info)
    : ChannelCine(path, info)
    , file_(path, info.timesS.size() * info.valueCount() + 64 * info.transmits.each.size())
  {
    objects_.object("channel_data", "uff.channel_data");
    objects_.header("channel_data", info.timesS, "PRF");
    objects_.number("channel_data/sampling_frequency", hzPerMHz * info.samplingMHz);
    // Time 0 is when the wave passes the origin.
    objects_.number("channel_data/initial_time", -sPerUs * info.transmits.passUs);
    objects_.number("channel_data/sound_speed", info.probe.geometry.assumedSoundSpeedMPerS);
    objects_.number("channel_data/modulation_frequency", 0.0);
    objects_.probe("channel_data/probe", info.elements);
    objects_.pulse("channel_data/pulse", info.probe);
    writeSequence(info);
    file_.announce("channel_data/data", { info.timesS.size(), info.transmits.each.size(),
                                          info.elements.centresMm.size(), std::uint64_t(info.sampleCount) });
    objects_.describe("channel_data/data", "single", 0, 0);
  }

private:
  void writeSequence(const ChannelCineInfo& info)
  {
    const std::string list = "channel_data/sequence";
    const std::size_t count = info.transmits.each.size();
    if (count > 1)
    {
      objects_.list(list, "uff.wave", count);
    }
    for (std::size_t t = 0; t < count; ++t)
    {
      writeWave(count > 1 ? UffObjects::item(list, t) : list, info.transmits.each[t], info);
    }
  }

  void writeWave(const std::string& name, const Transmit& transmit, const ChannelCineInfo& info)
  {
    const bool isPlane = transmit.kind == TransmitKind::PlaneWaves;
    const bool isBehind = transmit.kind == TransmitKind::DivergingWaves;
    objects_.object(name, "uff.wave");
    objects_.choice(name + "/wavefront", "uff.wavefront", isPlane ? 0 : 1);
    // A source behind the face lies where its wave comes from.
    objects_.point(name + "/source", isPlane ? std::numeric_limits<double>::infinity() : mPerMm * transmit.distanceMm,
                   isBehind ? transmit.angleRad + pi : transmit.angleRad);
    objects_.point(name + "/origin", 0.0, 0.0);
    objects_.object(name + "/apodization", "uff.apodization");
    objects_.choice(name + "/apodization/window", "uff.window", 0);
    objects_.number(name + "/delay", 0.0);
    objects_.number(name + "/sound_speed", info.probe.geometry.assumedSoundSpeedMPerS);
  }

  void write(std::size_t frame, const std::vector<float>& rf) override { file_.part("channel_data/data", frame, rf); }
  void close() override { file_.finish(); }

  Hdf5File file_;
  UffObjects objects_{ file_ };
};

} // namespace

std::unique_ptr<ChannelCine> uffChannels(const std::string& path, const ChannelCineInfo& info)
{
  return std::make_unique<UffChannels>(path, info);
}

} // namespace sono
