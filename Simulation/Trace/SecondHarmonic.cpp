#include "Trace/SecondHarmonic.h"

#include "Core/ParallelFor.h"
#include "Probe/BeamAperture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double depletion = 8.0 / 3.0;
/// Below it, -200 dB, nothing is heard that grows there, and the quotient is of noise.
constexpr float leastIntensity = 1e-10f;

/// What reverberates has been reflected, a first multiple about halfway to where it is shown: behind that it is too
/// weak to let its harmonic grow.
void growReverberation(const std::vector<float>& growth, int line, TracedLines& doubled)
{
  const auto bins = std::size_t(doubled.binCount);
  for (std::size_t bin = 0; bin < bins && !doubled.reverberation.empty(); ++bin)
  {
    doubled.reverberation[std::size_t(line) * bins + bin] *= growth[bin / 2];
    doubled.reverberationError[std::size_t(line) * bins + bin] *= growth[bin / 2];
  }
  for (int s = 0; s < doubled.echoCount; ++s)
  {
    const auto bin = std::min(std::size_t(0.5 * s * doubled.echoSampleMm / doubled.binMm), bins - 1);
    doubled.boundaryEcho[std::size_t(line) * std::size_t(doubled.echoCount) + std::size_t(s)] *= growth[bin];
  }
}

} // namespace

double harmonicSourcePerMm(const Tissue& tissue, double faceMRayl, const SentSound& sent)
{
  return tissue.nonlinearity * pi * sent.frequencyMHz * sent.facePressureKPa /
         (tissue.soundSpeedMPerS * tissue.soundSpeedMPerS * std::sqrt(tissue.impedanceMRayl * faceMRayl));
}

TraceSettings doubledTone(TraceSettings settings)
{
  settings.frequencyMHz = receivedMHz(ImagingMode::Harmonic, settings.frequencyMHz);
  return settings;
}

std::vector<float> harmonicSources(const Scene& scene, const std::vector<ScanLine>& lines,
                                   const TraceSettings& settings)
{
  const auto bins = std::size_t(settings.binCount());
  const SentSound sent{ settings.frequencyMHz, settings.facePressureKPa };
  const Vec3i size = scene.placement().size;
  std::vector<float> sources(lines.size() * bins, 0.0f);
  parallelFor(int(lines.size()), {}, [&](int l) {
    const ScanLine& line = lines[std::size_t(l)];
    double faceMRayl = 0.0;
    for (std::size_t bin = 0; bin < bins; ++bin)
    {
      const Vec3d place = line.originMm + (double(bin) + 0.5) * settings.radialBinMm * line.axis;
      const Vec3d voxel = glm::floor(scene.placement().indexFromWorld(place) + 0.5);
      if (!glm::all(glm::greaterThanEqual(voxel, Vec3d(0.0))) || !glm::all(glm::lessThan(voxel, Vec3d(size))))
      {
        continue;
      }
      const Vec3i v(voxel);
      const int index = scene.tissueVoxels()[v.x + std::size_t(size.x) * (v.y + std::size_t(size.y) * v.z)];
      if (index == scene.outsideIndex())
      {
        continue;
      }
      const Tissue& tissue = scene.tissues()[std::size_t(index)];
      faceMRayl = faceMRayl > 0.0 ? faceMRayl : tissue.impedanceMRayl;
      sources[std::size_t(l) * bins + bin] = float(harmonicSourcePerMm(tissue, faceMRayl, sent));
    }
  });
  return sources;
}

std::vector<std::complex<double>> sentGains(const TraceSettings& settings)
{
  std::vector<std::complex<double>> gains;
  for (int bin = 0; bin < settings.binCount(); ++bin)
  {
    gains.push_back(sentGain(settings.aperture, settings.frequencyMHz, (bin + 0.5) * settings.radialBinMm));
  }
  return gains;
}

TracedLines secondHarmonic(const TracedLines& sent, TracedLines doubled, const std::vector<float>& sourcesPerMm,
                           const std::vector<std::complex<double>>& gains)
{
  const auto bins = std::size_t(doubled.binCount);
  parallelFor(doubled.lineCount, {}, [&](int l) {
    std::complex<double> grown;
    std::vector<float> growth; // of each bin
    for (std::size_t bin = 0; bin < bins; ++bin)
    {
      const std::size_t at = std::size_t(l) * bins + bin;
      const double i2 = doubled.intensity[at];
      const double i1 = std::max(double(sent.intensity[at]), i2);
      std::complex<double> here;
      if (doubled.intensity[at] > leastIntensity)
      {
        here = double(sourcesPerMm[at]) * std::min(i1 / std::sqrt(i2), 1.0) * gains[bin] * doubled.binMm;
      }
      else
      {
        // What the next bin, which may be lit, must not be blended with: it would be lifted by tens of decibels.
        doubled.attenuationNpPerMHz[at] = 0.0f;
      }
      const double amount = std::abs(grown + 0.5 * here); // in the middle of the bin
      grown += here;
      const double ofSent2 = i1 > 0.0 ? amount * amount * i2 / i1 : 0.0;
      const auto factor = float(amount / std::sqrt(1.0 + depletion * ofSent2));
      doubled.intensity[at] *= factor;
      doubled.standardError[at] *= factor;
      growth.push_back(factor);
    }
    growReverberation(growth, l, doubled);
  });
  doubled.segments += sent.segments;
  return doubled;
}

} // namespace sono
