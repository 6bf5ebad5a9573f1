#include "SameSettings.h"

#include <algorithm>
#include <memory>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace sono {

namespace {

/// All parameters that a struct declares, as numbers.
template<class Settings>
std::vector<double> parametersOf(const Settings& settings)
{
  std::vector<double> numbers;
  Settings::visit(settings, [&](const auto& value, const Parameter&) { numbers.push_back(numberOf(value)); });
  return numbers;
}

// What the structs hold besides their parameters.

auto rest(const TraceSettings& s)
{
  return std::tie(s.march, s.frequencyMHz, s.imagingMode, s.facePressureKPa, s.depthMm, s.aperture, s.echoSampleMm,
                  s.interactive, s.seed);
}

auto rest(const EchoSettings& s)
{
  return std::tie(s.centreFrequencyMHz, s.fractionalBandwidth, s.imagingMode, s.samplingMHz, s.depthMm, s.aperture,
                  s.field, s.arrayField, s.pulse, s.interactive, s.seed);
}

auto rest(const BModeSettings& s)
{
  return std::tie(s.greyMap, s.noiseSeed, s.frequencyMHz, s.pulseSigmaMm, s.hazeGrowthPerMm, s.linesAcross,
                  s.shownPerRange);
}

auto all(const ProbePose& p)
{
  return std::tie(p.positionMm, p.axial, p.lateral);
}

auto all(const ScanLine& l)
{
  return std::tie(l.originMm, l.axis, l.lateral, l.elevation, l.steeringLateral, l.steeringElevational);
}

bool sameTissue(const Tissue& a, const Tissue& b)
{
  const auto& columns = tissueColumns();
  return a.name == b.name && std::all_of(columns.begin(), columns.end(), [&](const TissueColumn& column) {
           return a.*column.member == b.*column.member;
         });
}

/// Writes down what `rest` has; false where something is shared.
class Describer
{
public:
  explicit Describer(KeyText& key)
    : key_(key)
  {
  }
  template<class Settings>
  void all(const Settings& settings)
  {
    for (const double number : parametersOf(settings))
    {
      key_.add(number);
    }
    std::apply([&](const auto&... values) { (one(values), ...); }, rest(settings));
  }
  bool whole() const { return whole_; }

private:
  template<class Value>
  std::enable_if_t<std::is_arithmetic_v<Value> || std::is_enum_v<Value>> one(const Value& value)
  {
    key_.add(numberOf(value));
  }
  void one(const BeamAperture& aperture)
  {
    BeamAperture::visit(aperture, [&](double value, const Parameter&) { key_.add(value); });
    key_.add(double(aperture.elevationIsArray));
  }
  void one(const std::vector<float>& table)
  {
    key_.add(double(table.size()));
    for (const float value : table)
    {
      key_.add(double(value));
    }
  }
  template<class Shared>
  void one(const std::shared_ptr<Shared>& shared)
  {
    whole_ = whole_ && !shared;
  }

  KeyText& key_;
  bool whole_ = true;
};

} // namespace

bool describe(const ImageSettings& settings, KeyText& key)
{
  Describer describer(key);
  describer.all(settings.tracing);
  describer.all(settings.echo);
  describer.all(settings.bmode);
  for (const double number : parametersOf(settings.geometry))
  {
    key.add(number);
  }
  key.add(settings.pixelMm);
  return describer.whole();
}

void describe(const ProbePose& pose, KeyText& key)
{
  for (const Vec3d& v : { pose.positionMm, pose.axial, pose.lateral })
  {
    key.add(v.x).add(v.y).add(v.z);
  }
}

bool same(const TraceSettings& a, const TraceSettings& b)
{
  const bool samePulse = !a.refines() || a.fractionalBandwidth == b.fractionalBandwidth;
  return samePulse && rest(a) == rest(b) && parametersOf(a) == parametersOf(b);
}

bool same(const EchoSettings& a, const EchoSettings& b)
{
  return rest(a) == rest(b) && parametersOf(a) == parametersOf(b);
}

bool same(const BModeSettings& a, const BModeSettings& b)
{
  return rest(a) == rest(b) && parametersOf(a) == parametersOf(b);
}

bool same(const DisplaySettings& a, const DisplaySettings& b)
{
  return parametersOf(a) == parametersOf(b);
}

bool same(const ScanGeometry& a, const ScanGeometry& b)
{
  return parametersOf(a) == parametersOf(b);
}

bool same(const ProbePose& a, const ProbePose& b)
{
  return all(a) == all(b);
}

bool same(const std::vector<ScanLine>& a, const std::vector<ScanLine>& b)
{
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const ScanLine& x, const ScanLine& y) { return all(x) == all(y); });
}

bool same(const std::vector<TargetSurface>& a, const std::vector<TargetSurface>& b)
{
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const TargetSurface& x, const TargetSurface& y) {
    return x.name == y.name && sameTissue(x.tissue, y.tissue) && x.pointsMm == y.pointsMm &&
           x.triangles == y.triangles && x.rodDiameterMm == y.rodDiameterMm;
  });
}

} // namespace sono
