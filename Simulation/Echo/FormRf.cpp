#include "Echo/FormRf.h"

#include "Echo/FieldLevel.h"
#include "Echo/FieldSight.h"
#include "Echo/LineFinisher.h"
#include "Echo/Pulse.h"
#include "Echo/TissueScatterers.h"
#include "ParallelFor.h"
#include "Require.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int groupLines = 8; // neighbouring lines that share the generated bricks

double gaussianAreaMm2(const EchoSettings& s)
{
  return pi * s.lateralSigmaMm * s.elevationalSigmaMm;
}

/// Amplitude of a unit scatterer such that a tissue full of them (one a cell) has the wanted rms echo: the expected sum
/// of squares over the beam is density * integral of w^2 g^2 = (1 / h^3) * A * integral of g^2, with the beam's area
/// A = pi sL sE for a Gaussian and that at the focus for a field.
double scattererScale(const EchoSettings& s, double areaMm2)
{
  const double seen = areaMm2 * pulseEnergyMm(s) / (s.scattererCellMm * s.scattererCellMm * s.scattererCellMm);
  return std::pow(10.0, s.scattererLevelDb / 20.0) / std::sqrt(seen);
}

void requireReaches(const PulseEchoField& field, double depthMm)
{
  const BeamFieldAxis depth = field.view().depth;
  const double slackMm = 1e-3; // for rounded steps
  if (depth.highMm < depthMm - slackMm || depth.lowMm > depthMm)
  {
    throw Error("the pulse-echo field covers depths of " + std::to_string(depth.lowMm) + " to " +
                std::to_string(depth.highMm) + " mm but the image is " + std::to_string(depthMm) +
                " mm deep: give a field that reaches there, or lower the depth");
  }
}

void requireConsistent(const EchoSources& sources, const std::vector<ScanLine>& lines, const EchoSettings& settings)
{
  if (lines.empty())
  {
    throw Error("the probe has no scan lines: give it at least one");
  }
  if (double(lines.size()) * settings.sampleCount() > 5e8)
  {
    throw Error("the number of scan lines is " + std::to_string(lines.size()) +
                ": at this depth and sampling their samples do not fit; use fewer lines or a lower sampling frequency");
  }
  for (std::size_t l = 0; l < lines.size(); ++l)
  {
    const Vec3d sum = lines[l].originMm + lines[l].axis + lines[l].lateral + lines[l].elevation;
    if (!std::isfinite(sum.x + sum.y + sum.z))
    {
      throw Error("scan line " + std::to_string(l) +
                  " has an origin or a direction that is not finite: place the probe");
    }
  }
  if (!sources.traced)
  {
    return;
  }
  const TracedLines& traced = *sources.traced;
  if (lines.size() != std::size_t(traced.lineCount))
  {
    throw Error("the probe has " + std::to_string(lines.size()) + " scan lines but " +
                std::to_string(traced.lineCount) + " were traced: trace again with this probe");
  }
  if (traced.binCount < 1 || !(traced.binMm > 0.0) ||
      traced.intensity.size() != lines.size() * std::size_t(traced.binCount) || traced.echoCount < 0 ||
      (traced.echoCount > 0 && !(traced.echoSampleMm > 0.0)) ||
      traced.boundaryEcho.size() != lines.size() * std::size_t(traced.echoCount))
  {
    throw Error("the traced lines do not have the intensities and echoes that they announce: trace again");
  }
}

/// What the beams of all lines are made of.
struct BeamMaker
{
  const std::vector<ScanLine>& lines;
  const EchoSettings& settings;
  const LineFinisher& finisher;
  std::optional<BeamFieldView> field;

  /// The beams of the lines [first, last) in the coordinates of their scatterers, which the sight's bricks hold.
  std::vector<BeamReach> make(int first, int last, const std::function<Vec3d(const Vec3d&)>& toFrame,
                              const Mat3d& rotation, const std::optional<FieldSight>& sight) const
  {
    std::vector<BeamReach> beams;
    for (int l = first; l < last; ++l)
    {
      const ScanLine& w = lines[std::size_t(l)];
      beams.push_back({ { Vec3f(toFrame(w.originMm)), Vec3f(rotation * w.axis), Vec3f(rotation * w.lateral),
                          Vec3f(rotation * w.elevation), float(settings.lateralSigmaMm),
                          float(settings.elevationalSigmaMm), field ? &*field : nullptr },
                        finisher.reachMm(l),
                        sight ? &*sight : nullptr });
    }
    return beams;
  }
};

/// Where the settings' field matters to bricks of this size; nothing for a Gaussian beam.
std::optional<FieldSight> sightOf(const EchoSettings& settings, const BrickGrid& grid)
{
  return settings.field ? std::optional<FieldSight>(std::in_place, *settings.field, grid.edgeMm) : std::nullopt;
}

void addTissues(const TissueScatterers& tissues, const std::vector<BeamReach>& beams, std::vector<LineSum>& sums)
{
  TissueScatterers::Buffer buffer;
  forSeenBricks(tissues.grid(), beams, [&](const Vec3i& brick, const std::vector<std::size_t>& seeing) {
    const ScattererView scatterers = tissues.generate(brick, buffer);
    for (const std::size_t i : seeing)
    {
      splat(scatterers, beams[i].beam, sums[i]);
    }
  });
}

void addPoints(const PointScatterers& points, const std::vector<BeamReach>& beams, std::vector<LineSum>& sums)
{
  forSeenBricks(points.grid(), beams, [&](const Vec3i& brick, const std::vector<std::size_t>& seeing) {
    const ScattererView scatterers = points.brick(brick);
    for (const std::size_t i : seeing)
    {
      splat(scatterers, beams[i].beam, sums[i]);
    }
  });
}

} // namespace

void EchoSettings::validate() const
{
  requireInRange(centreFrequencyMHz > 0.0 && std::isfinite(centreFrequencyMHz), "centre frequency (MHz)",
                 centreFrequencyMHz, "more than 0");
  requireInRange(fractionalBandwidth > 0.0 && fractionalBandwidth < 2.0, "fractional bandwidth", fractionalBandwidth,
                 "more than 0 and below 2");
  requireInRange(
    samplingMHz > 2.0 * centreFrequencyMHz && samplingMHz <= 1000.0, "sampling frequency (MHz)", samplingMHz,
    "above twice the centre frequency (" + std::to_string(2.0 * centreFrequencyMHz) + ") and at most 1000");
  requireInRange(depthMm > 0.0 && depthMm <= 1000.0, "depth (mm)", depthMm, "more than 0 and at most 1000");
  requireInRange(lateralSigmaMm > 0.0 && lateralSigmaMm <= 50.0, "lateral beam sigma (mm)", lateralSigmaMm,
                 "more than 0 and at most 50");
  requireInRange(elevationalSigmaMm > 0.0 && elevationalSigmaMm <= 50.0, "elevational beam sigma (mm)",
                 elevationalSigmaMm, "more than 0 and at most 50");
  if (field)
  {
    requireReaches(*field, depthMm);
  }
  requireInRange(scattererCellMm >= 0.05 && scattererCellMm <= 10.0, "scatterer cell (mm)", scattererCellMm,
                 "0.05 to 10");
  requireInRange(std::isfinite(scattererLevelDb) && std::fabs(scattererLevelDb) <= 200.0, "scatterer level (dB)",
                 scattererLevelDb, "-200 to 200");
}

int EchoSettings::sampleCount() const
{
  return int(std::floor(depthMm / sampleMm())) + 1;
}

std::vector<float> RfLines::rf() const
{
  std::vector<std::complex<float>> carrier(static_cast<std::size_t>(sampleCount));
  for (int s = 0; s < sampleCount; ++s)
  {
    const double phase = 4.0 * pi * centreFrequencyMHz / assumedSoundSpeedMmPerUs * (s * sampleMm);
    carrier[std::size_t(s)] = std::complex<float>(std::polar(1.0, phase));
  }
  std::vector<float> out(iq.size());
  parallelFor(lineCount, {}, [&](int line) {
    const std::size_t row = std::size_t(line) * std::size_t(sampleCount);
    for (std::size_t s = 0; s < carrier.size(); ++s)
    {
      out[row + s] = iq[row + s].real() * carrier[s].real() - iq[row + s].imag() * carrier[s].imag();
    }
  });
  return out;
}

std::vector<float> RfLines::envelope() const
{
  std::vector<float> out(iq.size());
  parallelFor(lineCount, {}, [&](int line) {
    const std::size_t row = std::size_t(line) * std::size_t(sampleCount);
    for (std::size_t s = row; s < row + std::size_t(sampleCount); ++s)
    {
      out[s] = std::sqrt(iq[s].real() * iq[s].real() + iq[s].imag() * iq[s].imag());
    }
  });
  return out;
}

RfLines formRf(const EchoSources& sources, const std::vector<ScanLine>& lines, const EchoSettings& settings,
               const Progress& progress)
{
  settings.validate();
  requireConsistent(sources, lines, settings);
  RfLines out;
  out.lineCount = int(lines.size());
  out.sampleCount = settings.sampleCount();
  out.sampleMm = settings.sampleMm();
  out.centreFrequencyMHz = settings.centreFrequencyMHz;
  out.samplingMHz = settings.samplingMHz;

  std::optional<FieldLevel> level;
  if (settings.field)
  {
    level.emplace(*settings.field);
  }
  const LineFinisher finisher(settings, sources.traced, level ? &*level : nullptr);
  BeamMaker beams{ lines, settings, finisher, std::nullopt };
  if (settings.field)
  {
    beams.field = settings.field->view();
  }
  std::optional<TissueScatterers> tissues;
  std::optional<FieldSight> tissueSight;
  if (sources.scene)
  {
    const double scale = scattererScale(settings, level ? level->focusAreaMm2() : gaussianAreaMm2(settings));
    tissues.emplace(*sources.scene, settings.scattererCellMm, scale, settings.seed);
    tissueSight = sightOf(settings, tissues->grid());
  }
  std::optional<FieldSight> pointSight;
  if (sources.points)
  {
    pointSight = sightOf(settings, sources.points->grid());
  }
  out.iq.resize(std::size_t(out.lineCount) * std::size_t(out.sampleCount));
  const auto formGroup = [&](int group) {
    const int first = group * groupLines;
    const int last = std::min(first + groupLines, out.lineCount);
    std::vector<LineSum> sums(std::size_t(last - first), finisher.emptySum());
    if (tissues)
    {
      const Scene& scene = *sources.scene;
      const auto toLocal = [&](const Vec3d& world) { return scene.localFromWorld(world); };
      addTissues(*tissues, beams.make(first, last, toLocal, scene.rotationToLocal(), tissueSight), sums);
    }
    if (sources.points)
    {
      const auto toPoints = [&](const Vec3d& world) { return world - sources.points->originMm(); };
      addPoints(*sources.points, beams.make(first, last, toPoints, Mat3d(1.0), pointSight), sums);
    }
    for (int l = first; l < last; ++l)
    {
      finisher.finish(l, sums[std::size_t(l - first)], out.iq.data() + std::size_t(l) * std::size_t(out.sampleCount));
    }
  };
  parallelFor((out.lineCount + groupLines - 1) / groupLines, progress, formGroup);
  return out;
}

RfLines formRf(const Scene& scene, const std::vector<ScanLine>& lines, const TracedLines& traced,
               const EchoSettings& settings, const Progress& progress)
{
  return formRf({ &scene, &traced, nullptr }, lines, settings, progress);
}

} // namespace sono
