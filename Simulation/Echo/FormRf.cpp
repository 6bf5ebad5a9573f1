#include "Echo/FormRf.h"

#include "Echo/BeamSplat.h"
#include "Echo/Pulse.h"
#include "Echo/ScattererBricks.h"
#include "ParallelFor.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int groupLines = 8; // neighbouring lines that share the generated bricks

void require(bool ok, const char* parameter, double value, const std::string& range)
{
  if (!ok)
  {
    throw Error(std::string(parameter) + " is " + std::to_string(value) + ": it must be " + range);
  }
}

/// Amplitude of a unit scatterer such that a tissue full of them (one a cell) has the wanted rms echo: the expected sum
/// of squares over the beam is density * integral of w^2 g^2 = (1 / h^3) * pi sL sE * sqrt(pi) sr.
float scattererScale(const EchoSettings& s, double pulseSigma)
{
  const double seen = pi * s.lateralSigmaMm * s.elevationalSigmaMm * std::sqrt(pi) * pulseSigma /
                      (s.scattererCellMm * s.scattererCellMm * s.scattererCellMm);
  return float(std::pow(10.0, s.scattererLevelDb / 20.0) / std::sqrt(seen));
}

/// Intensity at each RF sample, linear between the centres of the tracer's bins.
std::vector<float> intensityAtSamples(const TracedLines& traced, int line, int samples, double sampleMm)
{
  const float* bins = traced.intensity.data() + std::size_t(line) * std::size_t(traced.binCount);
  std::vector<float> out(static_cast<std::size_t>(samples));
  for (int s = 0; s < samples; ++s)
  {
    const double position = std::clamp(s * sampleMm / traced.binMm - 0.5, 0.0, double(traced.binCount - 1));
    const int b = std::min(int(position), std::max(0, traced.binCount - 2));
    const float f = float(position - b);
    out[std::size_t(s)] = traced.binCount > 1 ? bins[b] * (1.0f - f) + bins[b + 1] * f : bins[0];
  }
  return out;
}

/// Depth below which the line has no intensity left that a float image could show.
float visibleDepth(const TracedLines& traced, int line)
{
  const float* bins = traced.intensity.data() + std::size_t(line) * std::size_t(traced.binCount);
  int b = traced.binCount;
  while (b > 0 && bins[b - 1] < 1e-9f)
  {
    --b;
  }
  return b == 0 ? 0.0f : float((b + 1) * traced.binMm);
}

/// Moves the boundary echoes from the tracer's grid to the RF samples, phases kept.
void addBoundaryEchoes(const TracedLines& traced, int line, LineSum& sum)
{
  const std::complex<float>* echo = traced.boundaryEcho.data() + std::size_t(line) * std::size_t(traced.echoCount);
  const int samples = int(sum.re.size());
  for (int e = 0; e < traced.echoCount; ++e)
  {
    if (echo[e] == std::complex<float>{})
    {
      continue;
    }
    const double position = e * traced.echoSampleMm / double(sum.sampleMm);
    const int s = int(std::floor(position + 1e-6));
    const float fraction = std::max(0.0f, float(position - s));
    for (int i = 0; i < 2; ++i)
    {
      const float share = i == 0 ? 1.0f - fraction : fraction;
      if (share > 0.0f && s + i < samples)
      {
        const float phase = sum.radPerMm * sum.sampleMm * (fraction - float(i));
        const std::complex<float> v = echo[e] * std::polar(share, -phase);
        sum.re[std::size_t(s + i)] += v.real();
        sum.im[std::size_t(s + i)] += v.imag();
      }
    }
  }
}

} // namespace

void EchoSettings::validate() const
{
  require(centreFrequencyMHz > 0.0 && std::isfinite(centreFrequencyMHz), "centre frequency (MHz)", centreFrequencyMHz,
          "more than 0");
  require(fractionalBandwidth > 0.0 && fractionalBandwidth < 2.0, "fractional bandwidth", fractionalBandwidth,
          "more than 0 and below 2");
  require(samplingMHz > 2.0 * centreFrequencyMHz && samplingMHz <= 1000.0, "sampling frequency (MHz)", samplingMHz,
          "above twice the centre frequency (" + std::to_string(2.0 * centreFrequencyMHz) + ") and at most 1000");
  require(depthMm > 0.0 && depthMm <= 1000.0, "depth (mm)", depthMm, "more than 0 and at most 1000");
  require(lateralSigmaMm > 0.0 && lateralSigmaMm <= 50.0, "lateral beam sigma (mm)", lateralSigmaMm,
          "more than 0 and at most 50");
  require(elevationalSigmaMm > 0.0 && elevationalSigmaMm <= 50.0, "elevational beam sigma (mm)", elevationalSigmaMm,
          "more than 0 and at most 50");
  require(scattererCellMm >= 0.05 && scattererCellMm <= 10.0, "scatterer cell (mm)", scattererCellMm, "0.05 to 10");
  require(std::isfinite(scattererLevelDb) && std::fabs(scattererLevelDb) <= 200.0, "scatterer level (dB)",
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

RfLines formRf(const Scene& scene, const std::vector<ScanLine>& lines, const TracedLines& traced,
               const EchoSettings& settings, const Progress& progress)
{
  settings.validate();
  if (int(lines.size()) != traced.lineCount)
  {
    throw Error("the probe has " + std::to_string(lines.size()) + " scan lines but " +
                std::to_string(traced.lineCount) + " were traced: trace again with this probe");
  }
  RfLines out;
  out.lineCount = traced.lineCount;
  out.sampleCount = settings.sampleCount();
  out.sampleMm = settings.sampleMm();
  out.centreFrequencyMHz = settings.centreFrequencyMHz;
  out.samplingMHz = settings.samplingMHz;
  if (double(out.lineCount) * out.sampleCount > 5e8)
  {
    throw Error("the number of scan lines is " + std::to_string(out.lineCount) +
                ": at this depth and sampling their samples do not fit; use fewer lines or a lower sampling frequency");
  }
  out.iq.resize(std::size_t(out.lineCount) * std::size_t(out.sampleCount));

  const double pulseSigma = pulseSigmaMm(settings.centreFrequencyMHz, settings.fractionalBandwidth);
  const std::vector<float> envelope = pulseEnvelope(pulseSigma, out.sampleMm);
  const float scale = scattererScale(settings, pulseSigma);
  const double radPerMm = 4.0 * pi * settings.centreFrequencyMHz / assumedSoundSpeedMmPerUs;
  const std::size_t samples = std::size_t(out.sampleCount);
  std::vector<float> demodRe(samples);
  std::vector<float> demodIm(samples);
  for (std::size_t s = 0; s < samples; ++s)
  {
    demodRe[s] = float(std::cos(radPerMm * double(s) * out.sampleMm));
    demodIm[s] = float(-std::sin(radPerMm * double(s) * out.sampleMm));
  }

  const ScattererBricks bricks(scene, settings.scattererCellMm, settings.seed);
  const Mat3d toLocal = scene.rotationToLocal();
  const int groups = (out.lineCount + groupLines - 1) / groupLines;
  parallelFor(groups, progress, [&](int g) {
    const int first = g * groupLines;
    const int last = std::min(first + groupLines, out.lineCount);
    std::vector<BeamReach> group;
    std::vector<LineSum> sums;
    for (int l = first; l < last; ++l)
    {
      const ScanLine& w = lines[std::size_t(l)];
      group.push_back(
        { { Vec3f(scene.localFromWorld(w.originMm)), Vec3f(toLocal * w.axis), Vec3f(toLocal * w.lateral),
            Vec3f(toLocal * w.elevation), float(settings.lateralSigmaMm), float(settings.elevationalSigmaMm) },
          std::min(visibleDepth(traced, l), float(settings.depthMm)) });
      sums.push_back(
        { std::vector<float>(samples, 0.0f), std::vector<float>(samples, 0.0f), float(out.sampleMm), float(radPerMm) });
    }
    bricks.forGroup(group, [&](const ScattererList& list, std::size_t i) { splat(list, group[i].beam, sums[i]); });

    std::vector<float> re(samples);
    std::vector<float> im(samples);
    for (int l = first; l < last; ++l)
    {
      LineSum& sum = sums[std::size_t(l - first)];
      const std::vector<float> intensity = intensityAtSamples(traced, l, out.sampleCount, out.sampleMm);
      for (std::size_t s = 0; s < samples; ++s)
      {
        sum.re[s] *= scale * intensity[s];
        sum.im[s] *= scale * intensity[s];
      }
      addBoundaryEchoes(traced, l, sum);
      for (std::size_t s = 0; s < samples; ++s)
      {
        const float a = sum.re[s];
        const float b = sum.im[s];
        sum.re[s] = a * demodRe[s] - b * demodIm[s];
        sum.im[s] = a * demodIm[s] + b * demodRe[s];
      }
      convolve(sum.re.data(), out.sampleCount, envelope, re.data());
      convolve(sum.im.data(), out.sampleCount, envelope, im.data());
      std::complex<float>* row = out.iq.data() + std::size_t(l) * samples;
      for (std::size_t s = 0; s < samples; ++s)
      {
        row[s] = { re[s], im[s] };
      }
    }
  });
  return out;
}

} // namespace sono
