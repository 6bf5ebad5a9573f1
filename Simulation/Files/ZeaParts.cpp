#include "Files/ZeaParts.h"

#include "Core/Version.h"

#include <cmath>

namespace sono {

namespace {

constexpr double mPerMm = 1e-3;
constexpr double hzPerMHz = 1e6;

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

} // namespace

std::vector<float> zeaCoordinates(const std::vector<Vec3d>& vectors, double factor)
{
  std::vector<float> values;
  values.reserve(3 * vectors.size());
  for (const Vec3d& vector : vectors)
  {
    values.insert(values.end(), { float(factor * vector.x), float(factor * vector.y), float(factor * vector.z) });
  }
  return values;
}

void writeZeaHeader(Hdf5File& file)
{
  file.attribute("/", "zea_version", "0.1.0");
  file.attribute("/", "us_machine", "SonoVDB (Simulated)");
  file.attribute("/", "description",
                 std::string("Simulated by SonoVDB ") + version() + " from labelled anatomy; nobody was scanned.");
}

void writeZeaTimes(const std::vector<double>& timesS, const std::string& group, Hdf5File& file)
{
  if (timesS.size() < 2)
  {
    return;
  }
  std::vector<float> times;
  for (const double timeS : timesS)
  {
    times.push_back(float(timeS - timesS.front()));
  }
  file.floats(group + "timestamps", { times.size() }, times);
  file.number(group + "start_time_offset", 0.0);
}

void writeZeaProbe(const ProbeSettings& probe, const ArrayElements& elements, Hdf5File& file)
{
  file.text("probe/name", std::string("SonoVDB ") + traitsOf(probe.geometry.kind).label);
  file.text("probe/type", probeType(probe.geometry.lineOrigin()));
  file.number("probe/probe_center_frequency", hzPerMHz * probe.centreFrequencyMHz);
  file.number("probe/probe_bandwidth_percent", 100.0 * probe.fractionalBandwidth);
  file.floats("probe/probe_geometry", { elements.centresMm.size(), 3 }, zeaCoordinates(elements.centresMm, mPerMm));
  file.number("probe/element_width", mPerMm * elements.widthMm);
  if (elements.heightMm > 0.0)
  {
    file.number("probe/element_height", mPerMm * elements.heightMm);
  }
}

void writeZeaPose(const ProbePose& pose, Hdf5File& file)
{
  const std::string group = "metadata/probe_pose/";
  file.floats(group + "translation", { 1, 3 }, zeaCoordinates({ pose.positionMm }, mPerMm));
  file.floats(group + "rotation", { 1, 4 }, quaternionOf(pose));
  file.text(group + "rotation_representation", "quaternion_wxyz");
  file.number(group + "start_time_offset", 0.0);
  file.floats(group + "timestamps", { 1 }, { 0.0f });
}

} // namespace sono
