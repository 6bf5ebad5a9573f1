#include "Files/UffObjects.h"

#include "Core/Version.h"

#include <cstdio>

namespace sono {

namespace {

constexpr double mPerMm = 1e-3;
constexpr double hzPerMHz = 1e6;

std::string lastOf(const std::string& name)
{
  return name.substr(name.rfind('/') + 1);
}

} // namespace

void UffObjects::object(const std::string& name, const std::string& kind)
{
  file_.group(name);
  file_.attribute(name, "class", kind);
  file_.attribute(name, "name", lastOf(name));
  file_.numbers(name, "array", { 0 });
  file_.numbers(name, "size", { 1, 1 });
}

void UffObjects::list(const std::string& name, const std::string& kind, std::size_t count)
{
  file_.group(name);
  file_.attribute(name, "class", kind);
  file_.attribute(name, "name", lastOf(name));
  file_.numbers(name, "array", { 1 });
  file_.numbers(name, "size", { 1, std::int32_t(count) });
}

std::string UffObjects::item(const std::string& list, std::size_t number)
{
  char digits[16];
  std::snprintf(digits, sizeof digits, "_%04zu", number + 1);
  return list + "/" + lastOf(list) + digits;
}

void UffObjects::describe(const std::string& name, const std::string& kind, int isComplex, int isImaginary)
{
  file_.attribute(name, "class", kind);
  file_.attribute(name, "name", lastOf(name));
  file_.numbers(name, "complex", { isComplex });
  file_.numbers(name, "imaginary", { isImaginary });
}

void UffObjects::words(const std::string& name, const std::string& value)
{
  file_.codes(name, value);
  file_.attribute(name, "class", "char");
  file_.attribute(name, "name", lastOf(name));
}

void UffObjects::floats(const std::string& name, const Hdf5File::Shape& shape, const std::vector<float>& values)
{
  file_.floats(name, shape, values);
  describe(name, "single", 0, 0);
}

void UffObjects::choice(const std::string& name, const std::string& kind, int value)
{
  file_.floats(name, { 1, 1 }, { float(value) });
  file_.attribute(name, "class", kind);
  file_.attribute(name, "name", lastOf(name));
}

void UffObjects::point(const std::string& name, double distance, double azimuth)
{
  object(name, "uff.point");
  number(name + "/distance", distance);
  number(name + "/azimuth", azimuth);
  number(name + "/elevation", 0.0);
}

void UffObjects::probe(const std::string& name, const ArrayElements& elements)
{
  object(name, "uff.probe");
  point(name + "/origin", 0.0, 0.0);
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
  floats(name + "/geometry", { 7, count }, geometry);
}

void UffObjects::pulse(const std::string& name, const ProbeSettings& probe)
{
  object(name, "uff.pulse");
  number(name + "/center_frequency", hzPerMHz * probe.centreFrequencyMHz);
  number(name + "/fractional_bandwidth", probe.fractionalBandwidth);
}

void UffObjects::header(const std::string& name, const std::vector<double>& timesS, const std::string& rate)
{
  words(name + "/name", "Simulated ultrasound");
  words(name + "/author", std::string("SonoVDB ") + version());
  words(name + "/info", "Simulated from labelled anatomy; nobody was scanned.");
  if (timesS.size() > 1)
  {
    const double durationS = timesS.back() - timesS.front();
    number(name + "/" + rate, double(timesS.size() - 1) / durationS);
  }
}

} // namespace sono
