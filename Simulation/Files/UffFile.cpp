#include "Core/Version.h"
#include "Probe/ArrayElements.h"
#include "Files/Hdf5File.h"
#include "Files/LineCine.h"

#include <algorithm>

namespace sono {

namespace {

constexpr double mPerMm = 1e-3;
constexpr double hzPerMHz = 1e6;

// MATLAB, whose format it is, names the fastest axis first: [pixel x channel x wave x frame] is frame x 1 x 1 x pixel
// here, and [element x 7] is 7 x elements.

class UffFile : public LineCine
{
public:
  UffFile(const std::string& path, const LineCineInfo& info)
    : LineCine(path, info)
    , pixels_(info.lineCount() * std::size_t(info.sampleCount))
    , file_(path, info.floatCount(arrayElements(info.probe).centresMm.size()))
  {
    object("b_data", "uff.beamformed_data");
    words("b_data/name", "Simulated ultrasound");
    words("b_data/author", std::string("SonoVDB ") + version());
    words("b_data/info", "Simulated from labelled anatomy; nobody was scanned.");
    number("b_data/sampling_frequency", hzPerMHz * info.samplingMHz);
    number("b_data/modulation_frequency", hzPerMHz * info.demodulationMHz);
    if (info.timesS.size() > 1)
    {
      const double durationS = info.timesS.back() - info.timesS.front();
      number("b_data/frame_rate", double(info.timesS.size() - 1) / durationS);
    }
    writeScan(info);
    writeProbe(info.probe);
    writePulse(info.probe);
    const Hdf5File::Shape shape{ info.timesS.size(), 1, 1, pixels_ };
    for (const char* part : { "real", "imag" })
    {
      file_.announce(std::string("b_data/data/") + part, shape);
      describe(std::string("b_data/data/") + part, "single", 0, part == std::string("imag"));
    }
    describe("b_data/data", "single", 1, 0);
  }

private:
  static std::string lastOf(const std::string& name) { return name.substr(name.rfind('/') + 1); }

  void object(const std::string& name, const std::string& kind)
  {
    file_.group(name);
    file_.attribute(name, "class", kind);
    file_.attribute(name, "name", lastOf(name));
    file_.numbers(name, "array", { 0 });
    file_.numbers(name, "size", { 1, 1 });
  }
  void describe(const std::string& name, const std::string& kind, int isComplex, int isImaginary)
  {
    file_.attribute(name, "class", kind);
    file_.attribute(name, "name", lastOf(name));
    file_.numbers(name, "complex", { isComplex });
    file_.numbers(name, "imaginary", { isImaginary });
  }
  void words(const std::string& name, const std::string& value)
  {
    file_.codes(name, value);
    file_.attribute(name, "class", "char");
    file_.attribute(name, "name", lastOf(name));
  }
  void floats(const std::string& name, const Hdf5File::Shape& shape, const std::vector<float>& values)
  {
    file_.floats(name, shape, values);
    describe(name, "single", 0, 0);
  }
  void number(const std::string& name, double value) { floats(name, { 1, 1 }, { float(value) }); }

  void writeScan(const LineCineInfo& info)
  {
    object("b_data/scan", "uff.scan");
    const std::vector<Vec3d> places = samplePlacesM(info);
    for (int axis = 0; axis < 3; ++axis)
    {
      std::vector<float> values(places.size());
      std::transform(places.begin(), places.end(), values.begin(),
                     [&](const Vec3d& place) { return float(place[axis]); });
      floats(
        std::string("b_data/scan/") + "xyz" [axis], { places.size() }, values);
    }
  }

  void writeProbe(const ProbeSettings& probe)
  {
    object("b_data/probe", "uff.probe");
    object("b_data/probe/origin", "uff.point");
    for (const char* part : { "distance", "azimuth", "elevation" })
    {
      number(std::string("b_data/probe/origin/") + part, 0.0);
    }
    const ArrayElements elements = arrayElements(probe);
    const std::size_t count = elements.centresMm.size();
    std::vector<float> geometry;
    for (int axis = 0; axis < 3; ++axis)
    {
      for (const Vec3d& centre : elements.centresMm)
      {
        geometry.push_back(float(mPerMm * centre[axis]));
      }
    }
    geometry.insert(geometry.end(), elements.azimuthsRad.begin(), elements.azimuthsRad.end());
    geometry.insert(geometry.end(), count, 0.0f);
    geometry.insert(geometry.end(), count, float(mPerMm * elements.widthMm));
    geometry.insert(geometry.end(), count, float(mPerMm * elements.heightMm));
    floats("b_data/probe/geometry", { 7, count }, geometry);
  }

  void writePulse(const ProbeSettings& probe)
  {
    object("b_data/pulse", "uff.pulse");
    number("b_data/pulse/center_frequency", hzPerMHz * probe.centreFrequencyMHz);
    number("b_data/pulse/fractional_bandwidth", probe.fractionalBandwidth);
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
};

} // namespace

std::unique_ptr<LineCine> uffFile(const std::string& path, const LineCineInfo& info)
{
  return std::make_unique<UffFile>(path, info);
}

} // namespace sono
