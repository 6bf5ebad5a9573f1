#include "Echo/EchoSetup.h"

#include "Core/LargeMemory.h"
#include "Core/Policy.h"
#include "Core/Require.h"
#include "Echo/Pulse.h"

#include <cmath>
#include <string>

namespace sono {

namespace {

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
      !(traced.attenuationNpPerMHz.empty() || traced.attenuationNpPerMHz.size() == traced.intensity.size()) ||
      !(traced.reverberationNpPerMHz.empty() || traced.reverberationNpPerMHz.size() == traced.intensity.size()) ||
      !(traced.reverberation.empty() || traced.reverberation.size() == traced.intensity.size()) ||
      !(traced.depthOffsetMm.empty() || traced.depthOffsetMm.size() == traced.intensity.size()) ||
      (traced.echoCount > 0 && !(traced.echoSampleMm > 0.0)) ||
      traced.boundaryEcho.size() != lines.size() * std::size_t(traced.echoCount))
  {
    throw Error("the traced lines do not have the intensities and echoes that they announce: trace again");
  }
}

/// The settings, once they and the sources are known to be good.
const EchoSettings& checked(const EchoSources& sources, const std::vector<ScanLine>& lines,
                            const EchoSettings& settings)
{
  settings.validate();
  if (settings.beam == BeamForm::Computed && !settings.arrayField && !settings.field)
  {
    throw Error("the computed beam was not computed: form the lines through a simulator, or give the array's field");
  }
  requireConsistent(sources, lines, settings);
  return settings;
}

/// Nothing where it is known that nothing reverberates.
ReverberationSpeckle speckleOf(const EchoSettings& settings, InterfaceModel model, const BeamModel& beams,
                               const std::vector<ScanLine>& lines, int linesPerImage, const TracedLines* traced)
{
  if (model != InterfaceModel::Acoustic || (traced && traced->reverberation.empty()))
  {
    return {};
  }
  return reverberationSpeckle(settings, beams, lines, linesPerImage,
                              settings.sampleCount() + PulseKernel(settings).half());
}

} // namespace

double tissueScattererScale(const EchoSettings& s, double areaMm2)
{
  const double seen = areaMm2 * pulseEnergyMm(s) / (s.scattererCellMm * s.scattererCellMm * s.scattererCellMm);
  return std::pow(10.0, s.scattererLevelDb / 20.0) / std::sqrt(seen);
}

EchoSetup::EchoSetup(const EchoSources& echoSources, const std::vector<ScanLine>& scanLines,
                     const EchoSettings& echoSettings, int linesPerImage, EchoDetail detail)
  : sources(echoSources)
  , lines(scanLines)
  , settings(checked(echoSources, scanLines, echoSettings))
  , model(sources.traced ? sources.traced->model : sources.model)
  , level(settings.field ? std::optional<FieldLevel>(*settings.field) : std::nullopt)
  , beams(settings, model)
  , finisher(
      settings, model, sources.traced, level ? &*level : nullptr,
      speckleOf(settings, model, beams, lines, linesPerImage > 0 ? linesPerImage : int(lines.size()), sources.traced))
{
  const bool isAcoustic = model == InterfaceModel::Acoustic;
  if (sources.scene && isAcoustic)
  {
    const double wavelengthMm = assumedSoundSpeedMmPerUs / settings.centreFrequencyMHz;
    nested.emplace(*sources.scene, settings.centreFrequencyMHz, wavelengthMm / beams.focusAreaMm2(), settings.seed);
    const double energyMm = pulseEnergyMm(settings);
    density.emplace(
      finisher.sumCount() * settings.sampleMm(), [&](double depthMm) { return beams.cellAreaMm2(depthMm) * energyMm; },
      detail == EchoDetail::Moving ? interactiveCandidates(candidatesPerCell) : candidatesPerCell);
    for (int level = density->finest(); settings.field && level <= density->coarsest(); ++level)
    {
      nestedSight.emplace_back(*settings.field, nested->grid(level).edgeMm);
    }
  }
  else if (sources.scene)
  {
    const double scale = tissueScattererScale(settings, beams.focusPowerAreaMm2());
    tissues.emplace(*sources.scene, settings.scattererCellMm, scale, settings.seed);
  }
  if (sources.scene && isAcoustic)
  {
    surfaces.emplace(*sources.scene, sources.traced ? sources.traced->targets.get() : sources.targets, settings, beams,
                     detail == EchoDetail::Moving ? SurfaceDetail::Coarse : SurfaceDetail::Full);
  }
  if (settings.field && tissues)
  {
    tissueSight.emplace(*settings.field, tissues->grid().edgeMm);
  }
  if (settings.field && sources.points)
  {
    pointSight.emplace(*settings.field, sources.points->grid().edgeMm);
  }
}

Beam EchoSetup::sceneBeam(int l) const
{
  const ScanLine& line = lines[std::size_t(l)];
  return beams.beamOf(line, sources.scene->localFromWorld(line.originMm), sources.scene->rotationToLocal());
}

Beam EchoSetup::pointBeam(int l) const
{
  const ScanLine& line = lines[std::size_t(l)];
  return beams.beamOf(line, line.originMm - sources.points->originMm(), Mat3d(1.0));
}

RfLines rfLayout(int lineCount, const EchoSettings& settings)
{
  RfLines out;
  out.lineCount = lineCount;
  out.sampleCount = settings.sampleCount();
  out.sampleMm = settings.sampleMm();
  out.centreFrequencyMHz = settings.centreFrequencyMHz;
  out.samplingMHz = settings.samplingInMHz();
  return out;
}

RfLines EchoSetup::emptyRf() const
{
  RfLines out = rfLayout(int(lines.size()), settings);
  out.iq = largeVector<std::complex<float>>(std::size_t(out.lineCount) * std::size_t(out.sampleCount));
  return out;
}

} // namespace sono
