// The beam and the medium: attenuation slope, width of a wire's echo against depth.
#include "PhantomBeam.h"
#include "Core/SoundSpeed.h"

#include "Probe/ArrayAperture.h"
#include "Simulator.h"
#include "Study.h"

#include <algorithm>
#include <cmath>

namespace sono::study {
namespace {

constexpr double frequencyMHz = 3.6;
constexpr double slopeFromMm = 10.0;
constexpr double slopeToMm = 150.0;

/// Least squares slope of y over x.
double slopeOf(const std::vector<double>& x, const std::vector<double>& y)
{
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    sx += x[i];
    sy += y[i];
    sxx += x[i] * x[i];
    sxy += x[i] * y[i];
  }
  const double n = double(x.size());
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

struct GelImage
{
  TracedLines traced;
  RfLines rf;
};

GelImage gelImage(int lines, unsigned seed)
{
  CalibrationPhantomSettings settings;
  settings.spacingMm = 1.0;
  Simulator simulator(sceneOf(makeCalibrationPhantom({}, settings)));
  ScanGeometry geometry;
  geometry.kind = ScanKind::Linear;
  geometry.lineCount = lines;
  geometry.widthMm = 120.0;
  geometry.depthMm = 160.0;
  EchoSettings echo;
  echo.centreFrequencyMHz = frequencyMHz;
  echo.depthMm = geometry.depthMm;
  echo.seed = seed;
  TraceSettings tracing;
  tracing.frequencyMHz = frequencyMHz;
  tracing.depthMm = geometry.depthMm;
  tracing.echoSampleMm = echo.sampleMm();
  tracing.pathsPerLine = 1; // there is no boundary to meet
  // A beam of one width and a pulse that keeps its spectrum: nothing but the medium's attenuation has a slope.
  tracing.model = InterfaceModel::Amadou2024;
  const auto scanLines = makeScanLines(geometry, ProbePose{});
  GelImage image;
  const TracedResult traced = simulator.trace(scanLines, tracing);
  image.traced = traced.host();
  image.rf = simulator.formRf(scanLines, traced, echo).host();
  return image;
}

/// Width at half the maximum of a sampled peak, linear between samples.
double halfWidth(const std::vector<double>& values, double step)
{
  const auto peak = std::max_element(values.begin(), values.end());
  const double half = 0.5 * *peak;
  const auto crossing = [&](int direction) {
    std::ptrdiff_t i = peak - values.begin();
    while (i + direction >= 0 && i + direction < std::ptrdiff_t(values.size()) && values[std::size_t(i)] > half)
    {
      i += direction;
    }
    const double below = values[std::size_t(i)];
    const double above = values[std::size_t(i - direction)];
    return (double(i) - direction * (half - below) / (above - below)) * step;
  };
  return crossing(1) - crossing(-1);
}

} // namespace

double intensitySlopeDbPerCm()
{
  const TracedLines traced = gelImage(1, 1).traced;
  std::vector<double> cm;
  std::vector<double> decibels;
  for (int b = int(slopeFromMm / traced.binMm); b < int(slopeToMm / traced.binMm); ++b)
  {
    cm.push_back((b + 0.5) * traced.binMm / 10.0);
    decibels.push_back(20.0 * std::log10(traced.intensity[std::size_t(b)]));
  }
  return -slopeOf(cm, decibels);
}

double speckleSlopeDbPerCm(int lines, unsigned seed)
{
  const RfLines rf = gelImage(lines, seed).rf;
  const std::vector<float> envelope = rf.envelope();
  const double stepMm = 2.0;
  std::vector<double> cm;
  std::vector<double> decibels;
  for (double depth = slopeFromMm; depth < slopeToMm; depth += stepMm)
  {
    double squares = 0.0;
    for (int line = 0; line < rf.lineCount; ++line)
    {
      const std::size_t row = std::size_t(line) * std::size_t(rf.sampleCount);
      for (int s = int(depth / rf.sampleMm); s < int((depth + stepMm) / rf.sampleMm); ++s)
      {
        squares += double(envelope[row + std::size_t(s)]) * envelope[row + std::size_t(s)];
      }
    }
    cm.push_back((depth + 0.5 * stepMm) / 10.0);
    decibels.push_back(10.0 * std::log10(squares));
  }
  return -slopeOf(cm, decibels);
}

EchoWidth wireEchoWidth(const PhantomImaging& imaging, double depthMm)
{
  const double stepDeg = 0.05;
  ScanGeometry geometry = imaging.geometry;
  geometry.lineCount = 161;
  geometry.sectorDeg = stepDeg * (geometry.lineCount - 1);
  const std::vector<PhantomTarget> wire{ { PhantomTargetKind::Wire, 2, "vertical", 0.0, depthMm, 0.1,
                                           "phantom_nylon" } };
  const PointScatterers points(phantomWireScatterers(wire, {}, 1.0));
  const RfLines rf = formRf({ nullptr, nullptr, &points }, makeScanLines(geometry, ProbePose{}), imaging.echo);
  const std::vector<float> envelope = rf.envelope();
  const auto strongest = std::max_element(envelope.begin(), envelope.end()) - envelope.begin();
  const std::size_t line = std::size_t(strongest) / std::size_t(rf.sampleCount);
  std::vector<double> across;
  for (int l = 0; l < rf.lineCount; ++l)
  {
    const auto row = envelope.begin() + std::ptrdiff_t(l) * rf.sampleCount;
    across.push_back(*std::max_element(row, row + rf.sampleCount));
  }
  const auto row = envelope.begin() + std::ptrdiff_t(line) * rf.sampleCount;
  const std::vector<double> along(row, row + rf.sampleCount);
  return { halfWidth(across, stepDeg * M_PI / 180.0 * depthMm), halfWidth(along, rf.sampleMm) };
}

double pulseWidthMm(double centreFrequencyMHz, double fractionalBandwidth)
{
  const double k = std::pow(M_PI * centreFrequencyMHz * fractionalBandwidth, 2) / (4.0 * std::log(std::pow(10.0, 0.3)));
  return assumedSoundSpeedMmPerUs * std::sqrt(std::log(2.0) / k);
}

namespace {

void run(Output& output)
{
  output.figure("attenuation_slope_db_per_cm", intensitySlopeDbPerCm(), "dB/cm");
  const unsigned seeds = output.quick() ? 1 : 10;
  double slope = 0.0;
  for (unsigned seed = 1; seed <= seeds; ++seed)
  {
    slope += speckleSlopeDbPerCm(128, seed) / seeds; // each is good for 0.01
  }
  output.figure("attenuation_slope_of_speckle_db_per_cm", slope, "dB/cm");

  const PhantomImaging imaging = phantomImaging();
  const double wavelengthMm = assumedSoundSpeedMmPerUs / imaging.echo.centreFrequencyMHz;
  const double apertureMm = phantomAperture().widthMm();
  const double axialTheory = pulseWidthMm(imaging.echo.centreFrequencyMHz, imaging.echo.fractionalBandwidth);
  std::vector<std::vector<std::string>> rows;
  for (double depth = 10.0; depth <= 150.0; depth += output.quick() ? 40.0 : 10.0)
  {
    const EchoWidth width = wireEchoWidth(imaging, depth);
    rows.push_back({ number(depth), number(width.lateralMm), number(0.886 * wavelengthMm * depth / apertureMm),
                     number(width.axialMm), number(axialTheory) });
    if (depth == 50.0)
    {
      output.figure("fwhm_lateral_at_focus_mm", width.lateralMm, "mm");
      output.figure("fwhm_lateral_at_focus_theory_mm", 0.886 * wavelengthMm * depth / apertureMm, "mm");
      output.figure("fwhm_axial_at_focus_mm", width.axialMm, "mm");
      output.figure("fwhm_axial_theory_mm", axialTheory, "mm");
    }
  }
  output.table("phantom_fwhm.csv",
               { "depth mm", "lateral mm", "lateral, both ways focused there mm", "axial mm", "axial, closed form mm" },
               rows);
}

const Part part("phantom_beam", run);

} // namespace
} // namespace sono::study
