#include "Files/LineCine.h"
#include "Files/UffObjects.h"

#include <algorithm>

namespace sono {

namespace {

constexpr double hzPerMHz = 1e6;

class UffFile : public LineCine
{
public:
  UffFile(const std::string& path, const LineCineInfo& info)
    : LineCine(path, info)
    , pixels_(info.lineCount() * std::size_t(info.sampleCount))
    , file_(path, info.floatCount(arrayElements(info.probe).centresMm.size()))
  {
    objects_.object("b_data", "uff.beamformed_data");
    objects_.header("b_data", info.timesS, "frame_rate");
    objects_.number("b_data/sampling_frequency", hzPerMHz * info.samplingMHz);
    objects_.number("b_data/modulation_frequency", hzPerMHz * info.demodulationMHz);
    writeScan(info);
    objects_.probe("b_data/probe", arrayElements(info.probe));
    objects_.pulse("b_data/pulse", info.probe);
    const Hdf5File::Shape shape{ info.timesS.size(), 1, 1, pixels_ };
    for (const char* part : { "real", "imag" })
    {
      file_.announce(std::string("b_data/data/") + part, shape);
      objects_.describe(std::string("b_data/data/") + part, "single", 0, part == std::string("imag"));
    }
    objects_.describe("b_data/data", "single", 1, 0);
  }

private:
  void writeScan(const LineCineInfo& info)
  {
    objects_.object("b_data/scan", "uff.scan");
    const std::vector<Vec3d> places = samplePlacesM(info);
    for (int axis = 0; axis < 3; ++axis)
    {
      std::vector<float> values(places.size());
      std::transform(places.begin(), places.end(), values.begin(),
                     [&](const Vec3d& place) { return float(place[axis]); });
      objects_.floats(
        std::string("b_data/scan/") + "xyz" [axis], { places.size() }, values);
    }
  }

  void write(std::size_t frame, const std::vector<std::complex<float>>& iq) override
  {
    std::vector<float> values(iq.size());
    std::transform(iq.begin(), iq.end(), values.begin(), [](const std::complex<float>& value) { return value.real(); });
    file_.part("b_data/data/real", frame, values);
    std::transform(iq.begin(), iq.end(), values.begin(), [](const std::complex<float>& value) { return value.imag(); });
    file_.part("b_data/data/imag", frame, values);
  }
  void close() override { file_.finish(); }

  std::uint64_t pixels_;
  Hdf5File file_;
  UffObjects objects_{ file_ };
};

} // namespace

std::unique_ptr<LineCine> uffFile(const std::string& path, const LineCineInfo& info)
{
  return std::make_unique<UffFile>(path, info);
}

} // namespace sono
