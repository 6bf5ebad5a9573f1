#include "Core/Version.h"
#include "Probe/ArrayElements.h"
#include "Files/Hdf5File.h"
#include "Files/LineCine.h"

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

const char* probeType(LineOrigin origin)
{
  switch (origin)
  {
    case LineOrigin::Aperture:
      return "linear";
    case LineOrigin::Apex:
      return "phased";
    default:
      return "curved";
  }
}

std::vector<float> flat(const std::vector<Vec3d>& vectors, double factor)
{
  std::vector<float> values;
  values.reserve(3 * vectors.size());
  for (const Vec3d& vector : vectors)
  {
    values.insert(values.end(), { float(factor * vector.x), float(factor * vector.y), float(factor * vector.z) });
  }
  return values;
}

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

/// (w, x, y, z) of the rotation from the probe's axes (lateral, elevation, axial) to the world's (Shepperd 1978).
std::vector<float> quaternionOf(const ProbePose& pose)
{
  Mat3d m;
  m[0] = pose.lateral;
  m[1] = glm::cross(pose.axial, pose.lateral);
  m[2] = pose.axial;
  const double squares[4] = { 1.0 + m[0][0] + m[1][1] + m[2][2], 1.0 + m[0][0] - m[1][1] - m[2][2],
                              1.0 - m[0][0] + m[1][1] - m[2][2], 1.0 - m[0][0] - m[1][1] + m[2][2] };
  int largest = 0;
  for (int n = 1; n < 4; ++n)
  {
    largest = squares[n] > squares[largest] ? n : largest;
  }
  // Products of two parts, times four: m[column][row].
  const double wx = m[1][2] - m[2][1];
  const double wy = m[2][0] - m[0][2];
  const double wz = m[0][1] - m[1][0];
  const double xy = m[0][1] + m[1][0];
  const double xz = m[2][0] + m[0][2];
  const double yz = m[1][2] + m[2][1];
  const double products[4][4] = {
    { squares[0], wx, wy, wz }, { wx, squares[1], xy, xz }, { wy, xy, squares[2], yz }, { wz, xz, yz, squares[3] }
  };
  std::vector<float> parts;
  for (const double product : products[largest])
  {
    parts.push_back(float(product / (2.0 * std::sqrt(squares[largest]))));
  }
  return parts;
}

class ZeaFile : public LineCine
{
public:
  ZeaFile(const std::string& path, const LineCineInfo& info)
    : LineCine(path, info)
    , order_(info)
    , file_(path, info.floatCount(arrayElements(info.probe).centresMm.size()))
  {
    file_.attribute("/", "zea_version", "0.1.0");
    file_.attribute("/", "us_machine", "SonoVDB (Simulated)");
    file_.attribute("/", "description",
                    std::string("Simulated by SonoVDB ") + version() + " from labelled anatomy; nobody was scanned.");
    writeData(info);
    const ArrayElements elements = arrayElements(info.probe);
    writeProbe(info.probe, elements);
    writeScan(info, elements);
    writePose(info.pose);
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
    file_.floats(dataGroup + "coordinates", places, flat(ordered, 1.0));
    file_.texts(dataGroup + "labels", { "I", "Q" });
    Hdf5File::Shape values = order_.shape();
    values.insert(values.begin(), info.timesS.size());
    values.push_back(2);
    file_.announce(dataGroup + "values", values);
    if (info.timesS.size() > 1)
    {
      std::vector<float> times;
      for (const double timeS : info.timesS)
      {
        times.push_back(float(timeS - info.timesS.front()));
      }
      file_.floats(dataGroup + "timestamps", { times.size() }, times);
      file_.number(dataGroup + "start_time_offset", 0.0);
    }
  }

  void writeProbe(const ProbeSettings& probe, const ArrayElements& elements)
  {
    file_.text("probe/name", std::string("SonoVDB ") + traitsOf(probe.geometry.kind).label);
    file_.text("probe/type", probeType(probe.geometry.lineOrigin()));
    file_.number("probe/probe_center_frequency", hzPerMHz * probe.centreFrequencyMHz);
    file_.number("probe/probe_bandwidth_percent", 100.0 * probe.fractionalBandwidth);
    file_.floats("probe/probe_geometry", { elements.centresMm.size(), 3 }, flat(elements.centresMm, mPerMm));
    file_.number("probe/element_width", mPerMm * elements.widthMm);
    if (elements.heightMm > 0.0)
    {
      file_.number("probe/element_height", mPerMm * elements.heightMm);
    }
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
    file_.floats(scanGroup + "transmit_origins", { count, 3 }, flat(origins, mPerMm));
    file_.floats(scanGroup + "polar_angles", { count }, polar);
    file_.floats(scanGroup + "azimuth_angles", { count }, azimuth);
  }

  void writePose(const ProbePose& pose)
  {
    const std::string group = "metadata/probe_pose/";
    file_.floats(group + "translation", { 1, 3 }, flat({ pose.positionMm }, mPerMm));
    file_.floats(group + "rotation", { 1, 4 }, quaternionOf(pose));
    file_.text(group + "rotation_representation", "quaternion_wxyz");
    file_.number(group + "start_time_offset", 0.0);
    file_.floats(group + "timestamps", { 1 }, { 0.0f });
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
