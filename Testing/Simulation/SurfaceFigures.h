#pragma once

#include "EchoScenes.h"
#include "TargetScenes.h"
#include "TestScenes.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

// Echoes of surfaces against integrals over those surfaces in double precision (Data/docs/physics.md section 10), as a
// test judges them and `measure picture` prints them.

namespace sono::test {

constexpr double inMedium = 1.5;
constexpr double behind = 3.0;
constexpr double r0 = (behind - inMedium) / (behind + inMedium);

inline Tissue surfaceTissue(const std::string& name, double impedance, double roughnessMm, double correlationMm = 1.0)
{
  Tissue t = makeTissue(name, impedance, 1540.0, 0.0);
  t.roughnessMm = roughnessMm;
  t.correlationMm = correlationMm;
  return t;
}

inline EchoSettings surfaceSettings()
{
  EchoSettings s;
  s.samplingMHz = 50.0; // what is asked is how surfaces are summed
  s.depthMm = 36.0;
  return s;
}

inline double wavenumber(const EchoSettings& s)
{
  return 2.0 * M_PI * s.centreFrequencyMHz / assumedSoundSpeedMmPerUs;
}

inline double beamArea(const EchoSettings& s)
{
  return 2.0 * M_PI * s.lateralSigmaMm * s.elevationalSigmaMm;
}

inline double coherentShare(const EchoSettings& s, double roughnessMm, double cosine)
{
  return std::exp(-2.0 * std::pow(wavenumber(s) * roughnessMm * cosine, 2));
}

inline double peak(const std::vector<std::complex<double>>& iq)
{
  double largest = 0.0;
  for (const auto& v : iq)
  {
    largest = std::max(largest, std::abs(v));
  }
  return largest;
}

inline double peak(const RfLines& rf)
{
  double largest = 0.0;
  for (const auto& v : rf.iq)
  {
    largest = std::max(largest, double(std::abs(v)));
  }
  return largest;
}

inline double decibels(double ratio)
{
  return 20.0 * std::log10(ratio);
}

/// A plane tilted about the elevational axis, summed along its slope in steps of 5 um; across, in closed form.
inline double planePeak(const EchoSettings& s, double degrees, double roughnessMm, double depthMm)
{
  const double t = degrees * M_PI / 180.0;
  constexpr double stepMm = 0.005;
  std::vector<PointScatterer> points;
  const double amplitude = r0 * std::cos(t) * coherentShare(s, roughnessMm, std::cos(t)) * stepMm / std::cos(t) *
                           std::sqrt(2.0 * M_PI) * s.elevationalSigmaMm / beamArea(s);
  for (double x = -8.0; x <= 8.0; x += stepMm)
  {
    points.push_back({ { x, 0.0, depthMm + std::tan(t) * x }, float(amplitude) });
  }
  return peak(directIq(points, makeLine({ 0, 0, 0 }, { 0, 0, 1 }), s));
}

/// Eq. 10.6.
inline double closedForm(const EchoSettings& s, double degrees)
{
  const double pulse = pulseSigmaMm(s.centreFrequencyMHz, s.fractionalBandwidth);
  const double spread = s.lateralSigmaMm * std::tan(degrees * M_PI / 180.0);
  const double all = pulse * pulse + spread * spread;
  return pulse / std::sqrt(all) * std::exp(-2.0 * std::pow(wavenumber(s) * spread * pulse, 2) / all);
}

inline TracedLines nothingLost(int lines, double depthMm, std::vector<TargetSurface> targets)
{
  TracedLines traced;
  traced.lineCount = lines;
  traced.binMm = 0.25;
  traced.binCount = int(depthMm / traced.binMm) + 1;
  traced.intensity.assign(std::size_t(traced.binCount) * std::size_t(lines), 1.0f);
  traced.standardError.assign(traced.intensity.size(), 0.0f);
  traced.targets = std::make_shared<const std::vector<TargetSurface>>(std::move(targets));
  return traced;
}

/// A box whose upper face goes through the middle of a volume of 32 x 24 x 40 mm at this tilt.
inline TargetSurface tiltedBox(const Tissue& tissue, double degrees)
{
  TargetSurface box = makeBox("box", tissue, { -14, -11, 0 }, { 14, 11, 30 });
  const double t = degrees * M_PI / 180.0;
  for (Vec3d& p : box.pointsMm)
  {
    p = Vec3d(16.0 + p.x * std::cos(t) - p.z * std::sin(t), 12.0 + p.y, 20.0 + p.x * std::sin(t) + p.z * std::cos(t));
  }
  return box;
}

inline const Vec3i targetVolume{ 32, 24, 40 };

/// Of a target's plane at this tilt: the peak of its echo against the integral's. Of short correlation, so that the
/// diffuse echo spreads over all directions and is small beside.
inline double planeOfTargetErrorDb(double degrees, double roughnessMm)
{
  const EchoSettings s = surfaceSettings();
  const auto scene =
    makeScene(targetVolume, Vec3d(1.0), { surfaceTissue("a", inMedium, 0.0) }, [](const Vec3d&) { return 0; });
  const TracedLines traced =
    nothingLost(1, s.depthMm, { tiltedBox(surfaceTissue("b", behind, roughnessMm, 0.01), degrees) });
  const RfLines rf = formRf({ scene.get(), &traced, nullptr }, { makeLine({ 16, 12, 0 }, { 0, 0, 1 }) }, s);
  return decibels(peak(rf) / planePeak(s, degrees, roughnessMm, 20.0));
}

/// The same of a plane of labels, voxels of 0.5 mm, that the axis meets at 18 mm and this much.
inline double planeOfLabelsErrorDb(double degrees, double roughnessMm, double offsetMm = 0.03, bool moving = false)
{
  EchoSettings s = surfaceSettings();
  s.interactive = moving;
  s.depthMm = 30.0;
  const double slope = std::tan(degrees * M_PI / 180.0);
  const auto scene = makeScene({ 64, 48, 72 }, Vec3d(0.5),
                               { surfaceTissue("a", inMedium, 0.0), surfaceTissue("b", behind, roughnessMm, 0.01) },
                               [&](const Vec3d& p) { return p.z < 18.0 + offsetMm + slope * (p.x - 16.0) ? 0 : 1; });
  const RfLines rf = formRf({ scene.get(), nullptr, nullptr }, { makeLine({ 16.1, 12.2, 0.0 }, { 0, 0, 1 }) }, s);
  return decibels(peak(rf) / planePeak(s, degrees, roughnessMm, 18.0));
}

/// A ball around the axis of a beam, in rings.
inline double ballPeak(const EchoSettings& s, double radiusMm, double centreMm, bool back)
{
  constexpr int rings = 40000;
  std::vector<PointScatterer> points;
  for (int n = 0; n < rings; ++n)
  {
    const double angle = (n + 0.5) * 0.5 * M_PI / rings;
    const double across = radiusMm * std::sin(angle);
    if (across > 8.0)
    {
      break;
    }
    const double area = 2.0 * M_PI * radiusMm * across * 0.5 * M_PI / rings;
    const double z = centreMm + (back ? 1.0 : -1.0) * radiusMm * std::cos(angle);
    points.push_back({ { across, 0.0, z }, float((back ? -r0 : r0) * std::cos(angle) * area / beamArea(s)) });
  }
  return peak(directIq(points, makeLine({ 0, 0, 0 }, { 0, 0, 1 }), s));
}

/// The largest of the envelope from one depth to another.
inline double peakBetween(const RfLines& rf, double fromMm, double toMm)
{
  double largest = 0.0;
  for (int n = int(fromMm / rf.sampleMm); n < int(toMm / rf.sampleMm); ++n)
  {
    largest = std::max(largest, double(std::abs(rf.iq[std::size_t(n)])));
  }
  return largest;
}

inline TargetSurface ball(const Tissue& tissue, const Vec3d& centre, double radiusMm, int rings)
{
  TargetSurface out{ "ball", tissue, {}, {} };
  const int around = 2 * rings;
  out.pointsMm.push_back(centre + Vec3d(0, 0, radiusMm));
  for (int i = 1; i < rings; ++i)
  {
    for (int j = 0; j < around; ++j)
    {
      const double a = i * M_PI / rings;
      const double b = j * 2.0 * M_PI / around;
      out.pointsMm.push_back(centre +
                             radiusMm * Vec3d(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)));
    }
  }
  out.pointsMm.push_back(centre - Vec3d(0, 0, radiusMm));
  const int last = int(out.pointsMm.size()) - 1;
  const auto at = [&](int i, int j) { return 1 + (i - 1) * around + (j % around); };
  for (int j = 0; j < around; ++j)
  {
    out.triangles.push_back({ 0, at(1, j), at(1, j + 1) });
    out.triangles.push_back({ last, at(rings - 1, j + 1), at(rings - 1, j) });
    for (int i = 1; i + 1 < rings; ++i)
    {
      out.triangles.push_back({ at(i, j), at(i + 1, j), at(i + 1, j + 1) });
      out.triangles.push_back({ at(i, j), at(i + 1, j + 1), at(i, j + 1) });
    }
  }
  return out;
}

/// Of the side of a ball towards the probe and of the one away from it.
struct BallErrors
{
  double frontDb;
  double backDb;

  double worstDb() const { return std::max(std::fabs(frontDb), std::fabs(backDb)); }
};

inline BallErrors ballErrors(const RfLines& rf, const EchoSettings& s, double radiusMm, double centreMm)
{
  const double front = peakBetween(rf, 3.0, 9.0) / ballPeak(s, radiusMm, centreMm, false);
  const double back = peakBetween(rf, centreMm + radiusMm - 3.0, s.depthMm) / ballPeak(s, radiusMm, centreMm, true);
  return { decibels(front), decibels(back) };
}

inline BallErrors ballOfTargetErrors(double radiusMm)
{
  EchoSettings s = surfaceSettings();
  s.depthMm = 2.0 * radiusMm + 14.0;
  const auto scene = makeScene({ 24, 24, int(s.depthMm) + 4 }, Vec3d(1.0), { surfaceTissue("a", inMedium, 0.0) },
                               [](const Vec3d&) { return 0; });
  const double centre = 6.0 + radiusMm;
  const TracedLines traced = nothingLost(1, s.depthMm,
                                         { ball(surfaceTissue("b", behind, 0.0), { 12, 12, centre }, radiusMm,
                                                int(std::ceil(20.0 * std::sqrt(radiusMm)))) });
  const RfLines rf = formRf({ scene.get(), &traced, nullptr }, { makeLine({ 12, 12, 0 }, { 0, 0, 1 }) }, s);
  return ballErrors(rf, s, radiusMm, centre);
}

/// Voxels of 0.5 mm.
inline BallErrors ballOfLabelsErrors(double radiusMm, double offsetMm = 0.13, bool moving = false)
{
  EchoSettings s = surfaceSettings();
  s.interactive = moving;
  s.depthMm = 2.0 * radiusMm + 12.0;
  const double centre = 6.0 + offsetMm + radiusMm;
  const auto scene =
    makeScene({ 48, 48, 2 * int(s.depthMm) + 8 }, Vec3d(0.5),
              { surfaceTissue("a", inMedium, 0.0), surfaceTissue("b", behind, 0.0) },
              [&](const Vec3d& p) { return glm::distance(p, Vec3d(12.1, 12.2, centre)) < radiusMm ? 1 : 0; });
  const RfLines rf = formRf({ scene.get(), nullptr, nullptr }, { makeLine({ 12.1, 12.2, 0.0 }, { 0, 0, 1 }) }, s);
  return ballErrors(rf, s, radiusMm, centre);
}

/// Mean energy of a rough plane's echo along a line, against the pulse's: Kirchhoff's integral, eq. 10.12 with a tilt
/// about the elevational axis, averaged over the pulse's band. The local slope in the integrand is integrated by parts,
/// which makes 1 / cos t of cos t for what is not coherent; n = 0 is the coherent share.
inline double planeEnergy(const EchoSettings& s, double degrees, double roughnessMm, double correlationMm)
{
  const double t = degrees * M_PI / 180.0;
  const double bandMHz =
    assumedSoundSpeedMmPerUs / (4.0 * M_PI * pulseSigmaMm(s.centreFrequencyMHz, s.fractionalBandwidth));
  const double along2 = std::pow(s.lateralSigmaMm / std::cos(t), 2); // of the beam, on the plane
  const double across2 = s.elevationalSigmaMm * s.elevationalSigmaMm;
  double energy = 0.0;
  double ofPulse = 0.0;
  for (double x = -5.95; x < 6.0; x += 0.1)
  {
    const double k = 2.0 * M_PI * (s.centreFrequencyMHz + x * bandMHz) / assumedSoundSpeedMmPerUs;
    const double g = std::pow(2.0 * k * roughnessMm * std::cos(t), 2);
    double sum = 0.0;
    double poisson = std::exp(-g);
    for (int n = 0; n < 400; ++n)
    {
      const double rough = n / (correlationMm * correlationMm);
      const double along = 0.25 / along2 + rough;
      // Of the wave numbers that the beam adds, over 2 k.
      const double mean = std::sin(t) * 0.25 / along2 / along;
      const double variance = 0.5 / along2 * rough / along / (4.0 * k * k);
      const double obliquity =
        std::pow(1.0 / std::cos(t) - std::tan(t) * mean, 2) + std::pow(std::tan(t), 2) * variance;
      sum += poisson * obliquity * std::exp(-std::pow(k * std::sin(t), 2) / along) /
             std::sqrt(along * (0.25 / across2 + rough));
      poisson *= g / (n + 1);
    }
    energy += std::exp(-x * x) * sum;
    ofPulse += std::exp(-x * x);
  }
  return std::pow(r0 * M_PI / beamArea(s), 2) * std::sqrt(along2 * across2) * energy / ofPulse;
}

inline std::vector<ScanLine> manyLines(int across, double stepMm, double firstMm)
{
  std::vector<ScanLine> lines;
  for (int j = 0; j < across; ++j)
  {
    for (int i = 0; i < across; ++i)
    {
      lines.push_back(makeLine({ firstMm + i * stepMm, firstMm + j * stepMm, 0.0 }, { 0, 0, 1 }));
    }
  }
  return lines;
}

/// Of a rough plane of labels at this tilt: its echo's mean energy over 800 lines against the integral's.
inline double roughPlaneErrorDb(double degrees, double roughnessMm, double correlationMm)
{
  EchoSettings s = surfaceSettings();
  const double slope = std::tan(degrees * M_PI / 180.0);
  s.depthMm = 10.0 + 40.0 * slope + 8.0;
  const auto scene =
    makeScene({ 52, 138, int(s.depthMm) + 10 }, Vec3d(1.0),
              { surfaceTissue("a", inMedium, 0.0), surfaceTissue("b", behind, roughnessMm, correlationMm) },
              [&](const Vec3d& p) { return p.z < 10.03 + slope * (p.x - 6.0) ? 0 : 1; });
  std::vector<ScanLine> lines;
  for (int l = 0; l < 800; ++l)
  {
    lines.push_back(makeLine({ 6.0 + 2.5 * (l % 16), 6.0 + 2.5 * (l / 16), 0.0 }, { 0, 0, 1 }));
  }
  const RfLines rf = formRf({ scene.get(), nullptr, nullptr }, lines, s);
  double energyMm = 0.0;
  for (const std::complex<float>& v : rf.iq)
  {
    energyMm += std::norm(std::complex<double>(v)) * rf.sampleMm / rf.lineCount;
  }
  return 10.0 * std::log10(energyMm / pulseEnergyMm(s) / planeEnergy(s, degrees, roughnessMm, correlationMm));
}

} // namespace sono::test
