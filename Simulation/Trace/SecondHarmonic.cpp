#include "Trace/SecondHarmonic.h"

#include "Core/ParallelFor.h"
#include "Core/Simd.h"
#include "Kernel/HarmonicGrowth.h"
#include "Probe/BeamAperture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
/// What the bins of a line add (see harmonicStrength).
SONO_SIMD_CLONES void findStrengths(const float* __restrict sent, const float* __restrict doubled,
                                    const float* __restrict sourcesPerMm, double binMm, int bins,
                                    double* __restrict strengths)
{
  for (int bin = 0; bin < bins; ++bin)
  {
    strengths[bin] = harmonicStrength(sent[bin], doubled[bin], sourcesPerMm[bin], binMm);
  }
}

SONO_SIMD_CLONES void findGrowth(const float* __restrict sent, const float* __restrict doubled,
                                 const double* __restrict amounts2, int bins, float* __restrict growth)
{
  for (int bin = 0; bin < bins; ++bin)
  {
    growth[bin] = harmonicGrowth(sent[bin], doubled[bin], amounts2[bin]);
  }
}

/// The voxel's number in the middle of each bin of a line, by its place in the volume, from the corner, and its way for
/// a millimetre, in voxels; -1 beyond the volume.
SONO_SIMD_CLONES void findVoxels(const Vec3d& first, const Vec3d& step, const Vec3d& size, double binMm, int bins,
                                 double* __restrict voxels)
{
  for (int bin = 0; bin < bins; ++bin)
  {
    const double mm = (bin + 0.5) * binMm;
    const double x = first.x + mm * step.x;
    const double y = first.y + mm * step.y;
    const double z = first.z + mm * step.z;
    const bool isThere = (x >= 0.0) & (y >= 0.0) & (z >= 0.0) & (x < size.x) & (y < size.y) & (z < size.z);
    const double voxel = std::floor(x) + size.x * (std::floor(y) + size.y * std::floor(z));
    voxels[bin] = isThere ? voxel : -1.0;
  }
}

std::vector<int> binsOfEchoes(const TracedLines& lines)
{
  std::vector<int> bins;
  bins.reserve(std::size_t(lines.echoCount));
  for (int s = 0; s < lines.echoCount; ++s)
  {
    bins.push_back(binOfEchoSample(s, lines.echoSampleMm, lines.binMm, lines.binCount));
  }
  return bins;
}

/// See binOfEchoSample.
void growReverberation(const std::vector<float>& growth, const std::vector<int>& binOfEcho, int line,
                       TracedLines& doubled)
{
  const auto bins = std::size_t(doubled.binCount);
  for (std::size_t bin = 0; bin < bins && !doubled.reverberation.empty(); ++bin)
  {
    doubled.reverberation[std::size_t(line) * bins + bin] *= growth[bin / 2];
    doubled.reverberationError[std::size_t(line) * bins + bin] *= growth[bin / 2];
  }
  std::complex<float>* echo = doubled.boundaryEcho.data() + std::size_t(line) * binOfEcho.size();
  for (const int bin : binOfEcho)
  {
    *echo++ *= growth[std::size_t(bin)];
  }
}

} // namespace

double harmonicSourcePerMm(const Tissue& tissue, double faceMRayl, const SentSound& sent)
{
  return tissue.nonlinearity * pi * sent.frequencyMHz * sent.facePressureKPa /
         (tissue.soundSpeedMPerS * tissue.soundSpeedMPerS * std::sqrt(tissue.impedanceMRayl * faceMRayl));
}

TraceSettings sentTone(TraceSettings settings)
{
  settings.intensityAlone = true;
  return settings;
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
  const std::vector<Tissue>& tissues = scene.tissues();
  std::vector<float> perMm; // by the tissue at the face and the one there
  for (const Tissue& face : tissues)
  {
    for (const Tissue& tissue : tissues)
    {
      perMm.push_back(float(harmonicSourcePerMm(tissue, face.impedanceMRayl, sent)));
    }
  }
  std::vector<float> sources(lines.size() * bins, 0.0f);
  parallelFor(int(lines.size()), {}, [&](int l) {
    const ScanLine& line = lines[std::size_t(l)];
    const float* ofFace = nullptr;
    // From corners, where places in the volume are not negative.
    const Vec3d first = scene.placement().indexFromWorld(line.originMm) + 0.5;
    const Vec3d step = scene.placement().indexFromWorld(line.originMm + line.axis) + 0.5 - first;
    std::vector<double> voxels(bins);
    findVoxels(first, step, Vec3d(scene.placement().size), settings.radialBinMm, int(bins), voxels.data());
    for (std::size_t bin = 0; bin < bins; ++bin)
    {
      const int index = voxels[bin] < 0.0 ? scene.outsideIndex() : int(scene.tissueVoxels()[std::size_t(voxels[bin])]);
      if (voxels[bin] < 0.0 || index == scene.outsideIndex())
      {
        continue;
      }
      ofFace = ofFace ? ofFace : perMm.data() + std::size_t(index) * tissues.size();
      sources[std::size_t(l) * bins + bin] = ofFace[index];
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
  const std::vector<int> binOfEcho = binsOfEchoes(doubled);
  parallelFor(doubled.lineCount, {}, [&](int l) {
    const std::size_t first = std::size_t(l) * bins;
    std::vector<double> amounts(bins); // first what a bin adds
    std::vector<float> growth(bins);
    findStrengths(sent.intensity.data() + first, doubled.intensity.data() + first, sourcesPerMm.data() + first,
                  doubled.binMm, doubled.binCount, amounts.data());
    HarmonicSum sum;
    for (std::size_t bin = 0; bin < bins; ++bin)
    {
      if (!(doubled.intensity[first + bin] > leastDoubledIntensity))
      {
        // What the next bin, which may be lit, must not be blended with: it would be lifted by tens of decibels.
        doubled.attenuationNpPerMHz[first + bin] = 0.0f;
      }
      amounts[bin] = sum.add(amounts[bin], gains[bin].real(), gains[bin].imag());
    }
    findGrowth(sent.intensity.data() + first, doubled.intensity.data() + first, amounts.data(), doubled.binCount,
               growth.data());
    for (std::size_t bin = 0; bin < bins; ++bin)
    {
      doubled.intensity[first + bin] *= growth[bin];
      doubled.standardError[first + bin] *= growth[bin];
    }
    growReverberation(growth, binOfEcho, l, doubled);
  });
  doubled.segments += sent.segments;
  return doubled;
}

} // namespace sono
