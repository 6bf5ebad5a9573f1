#include "Files/LineCine.h"
#include "Files/ZeaParts.h"

#include <cmath>
#include <limits>

namespace sono {

namespace {

constexpr double mPerMm = 1e-3;
constexpr double hzPerMHz = 1e6;
constexpr double sPerUs = 1e-6;

// Where the parts lie; a file has one track or several.
const std::string dataGroup = "tracks/track_0/data/beamformed_data/";
const std::string scanGroup = "tracks/track_0/scan/";

/// Of lines x samples, or elevations x lines x samples, what zea has as samples x lines (x elevations).
class Order
{
public:
  explicit Order(const LineCineInfo& info)
    : samples_(std::size_t(info.sampleCount))
    , rows_(info.probe.geometry.isVolume() ? std::size_t(info.probe.geometry.elevationLineCount) : 1)
    , lines_(info.lineCount() / rows_)
  {
  }

  Hdf5File::Shape shape() const
  {
    return rows_ > 1 ? Hdf5File::Shape{ samples_, lines_, rows_ } : Hdf5File::Shape{ samples_, lines_ };
  }
  /// Calls take(index) for each of the file's numbers in turn, with where it is in the frame.
  template<class Take>
  void forEach(const Take& take) const
  {
    for (std::size_t sample = 0; sample < samples_; ++sample)
    {
      for (std::size_t line = 0; line < lines_; ++line)
      {
        for (std::size_t row = 0; row < rows_; ++row)
        {
          take((row * lines_ + line) * samples_ + sample);
        }
      }
    }
  }

private:
  std::size_t samples_;
  std::size_t rows_;
  std::size_t lines_;
};

class ZeaFile : public LineCine
{
public:
  ZeaFile(const std::string& path, const LineCineInfo& info)
    : LineCine(path, info)
    , order_(info)
    , file_(path, info.floatCount(arrayElements(info.probe).centresMm.size()))
  {
    writeZeaHeader(file_);
    writeData(info);
    const ArrayElements elements = arrayElements(info.probe);
    writeZeaProbe(info.probe, elements, file_);
    writeScan(info, elements);
    writeZeaPose(info.pose, file_);
  }

private:
  void writeData(const LineCineInfo& info)
  {
    Hdf5File::Shape places = order_.shape();
    places.push_back(3);
    const std::vector<Vec3d> all = samplePlacesM(info);
    std::vector<Vec3d> ordered;
    ordered.reserve(all.size());
    order_.forEach([&](std::size_t index) { ordered.push_back(all[index]); });
    file_.floats(dataGroup + "coordinates", places, zeaCoordinates(ordered, 1.0));
    file_.texts(dataGroup + "labels", { "I", "Q" });
    Hdf5File::Shape values = order_.shape();
    values.insert(values.begin(), info.timesS.size());
    values.push_back(2);
    file_.announce(dataGroup + "values", values);
    writeZeaTimes(info.timesS, dataGroup, file_);
  }

  void writeScan(const LineCineInfo& info, const ArrayElements& elements)
  {
    const ProbeSettings& probe = info.probe;
    const std::vector<ScanLine> lines = makeScanLines(probe.geometry, ProbePose());
    std::vector<float> starts;
    std::vector<float> delays;
    std::vector<float> weights;
    std::vector<float> polar;
    std::vector<float> azimuth;
    std::vector<Vec3d> origins;
    for (const ScanLine& line : lines)
    {
      const LineFiring firing = lineFiring(elements, probe, line);
      starts.push_back(float(sPerUs * firing.startUs));
      for (std::size_t n = 0; n < elements.centresMm.size(); ++n)
      {
        delays.push_back(float(sPerUs * firing.delaysUs[n]));
        weights.push_back(firing.isActive[n] ? 1.0f : 0.0f);
      }
      polar.push_back(
        float(std::atan2(std::hypot(line.axis.x, line.axis.y) * (line.axis.x < 0.0 ? -1.0 : 1.0), line.axis.z)));
      azimuth.push_back(float(line.axis.x == 0.0 ? 0.0 : std::atan(line.axis.y / line.axis.x)));
      origins.push_back(line.originMm);
    }
    const std::uint64_t count = lines.size();
    const float focusM =
      probe.transmitFocusMm > 0.0 ? float(mPerMm * probe.transmitFocusMm) : std::numeric_limits<float>::infinity();
    file_.number(scanGroup + "sampling_frequency", hzPerMHz * info.samplingMHz);
    file_.number(scanGroup + "center_frequency", hzPerMHz * probe.centreFrequencyMHz);
    file_.number(scanGroup + "demodulation_frequency", hzPerMHz * info.demodulationMHz);
    file_.number(scanGroup + "sound_speed", probe.geometry.assumedSoundSpeedMPerS);
    file_.floats(scanGroup + "initial_times", { count }, starts);
    file_.floats(scanGroup + "t0_delays", { count, elements.centresMm.size() }, delays);
    file_.floats(scanGroup + "tx_apodizations", { count, elements.centresMm.size() }, weights);
    file_.floats(scanGroup + "focus_distances", { count }, std::vector<float>(count, focusM));
    file_.floats(scanGroup + "transmit_origins", { count, 3 }, zeaCoordinates(origins, mPerMm));
    file_.floats(scanGroup + "polar_angles", { count }, polar);
    file_.floats(scanGroup + "azimuth_angles", { count }, azimuth);
  }

  void write(std::size_t frame, const std::vector<std::complex<float>>& iq) override
  {
    std::vector<float> values;
    values.reserve(2 * iq.size());
    order_.forEach([&](std::size_t index) { values.insert(values.end(), { iq[index].real(), iq[index].imag() }); });
    file_.part(dataGroup + "values", frame, values);
  }
  void close() override { file_.finish(); }

  Order order_;
  Hdf5File file_;
};

} // namespace

std::unique_ptr<LineCine> zeaFile(const std::string& path, const LineCineInfo& info)
{
  return std::make_unique<ZeaFile>(path, info);
}

} // namespace sono
