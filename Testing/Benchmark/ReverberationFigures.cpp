#include "ReverberationFigures.h"

#include "BeamScenes.h"
#include "Folders.h"
#include "TargetScenes.h"
#include "TestScenes.h"

#include "Echo/Pulse.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <functional>
#include <memory>
#include <numeric>

namespace sono {

namespace {

using namespace sono::test;

constexpr double leastDb = -60.0;
constexpr double besideMm = 0.5; ///< a peak is looked for so far from where it should be
constexpr double faceReflection = 0.5;
constexpr int mostCollisions = 30;

double decibels(double ratio)
{
  return 20.0 * std::log10(std::max(ratio, 1e-12));
}

Tissue fluid(const std::string& name, double impedance, double speed, double attenuation, double backscatter = 0.0)
{
  Tissue tissue = makeTissue(name, impedance, speed, attenuation);
  tissue.roughnessMm = 0.0;
  tissue.backscatterPerCmSr = backscatter;
  tissue.scattererMean = tissue.scattererProbability = backscatter > 0.0 ? 1.0 : 0.0;
  return tissue;
}

/// All that a line down the axis needs, of a beam and a pulse.
ImageSettings settingsOf(const EchoSettings& echo, double face, int pathsPerLine)
{
  ImageSettings settings;
  settings.echo = echo;
  settings.geometry.depthMm = echo.depthMm;
  settings.tracing.pathsPerLine = pathsPerLine;
  settings.tracing.maxCollisions = mostCollisions;
  settings.tracing.reverberation = true;
  settings.tracing.faceReflection = face;

  settings.matchStages();
  return settings;
}

/// IQ of a line down the middle of plane layers, `acrossMm` wide.
RfLines layersRf(const LayerStack& stack, const ImageSettings& settings, int acrossMm, double voxelMm = 1.0)
{
  std::vector<Tissue> tissues;
  for (const StackLayer& layer : stack.layers)
  {
    tissues.push_back(fluid("layer " + std::to_string(tissues.size()), layer.impedanceMRayl, layer.speedMPerS,
                            layer.attenuationDbPerCmMHz));
  }
  const auto labelAt = [&](const Vec3d& p) {
    int layer = 0;
    while (layer < stack.boundaries() && p.z > stack.depthMm(layer))
    {
      ++layer;
    }
    return layer;
  };
  const int deep = int((1.2 * settings.echo.depthMm + 4.0) / voxelMm);
  const auto scene = makeScene({ acrossMm, acrossMm, deep }, Vec3d(1.0, 1.0, voxelMm), tissues, labelAt);
  const std::vector<ScanLine> lines{ makeLine({ 0.5 * acrossMm + 0.2, 0.5 * acrossMm + 0.4, 0.0 }, { 0, 0, 1 }) };
  return formRf(*scene, lines, trace(*scene, lines, settings.tracing), settings.echo);
}

template<class T>
std::vector<double> envelopeOf(const std::vector<std::complex<T>>& iq)
{
  std::vector<double> envelope;
  for (const std::complex<T>& v : iq)
  {
    envelope.push_back(double(std::abs(v)));
  }
  return envelope;
}

struct Peak
{
  double rangeMm;
  double amplitude;
};

/// The largest value near a place, by the parabola through the logarithms around it.
Peak peakNear(const std::vector<double>& envelope, double sampleMm, double rangeMm, double reachMm = besideMm)
{
  const int first = std::max(1, int(std::ceil((rangeMm - reachMm) / sampleMm)));
  const int last = std::min(int(envelope.size()) - 2, int((rangeMm + reachMm) / sampleMm));
  const int at = int(std::max_element(envelope.begin() + first, envelope.begin() + last + 1) - envelope.begin());
  const auto level = [&](int n) { return std::log(std::max(envelope[std::size_t(n)], 1e-30)); };
  const double slope = 0.5 * (level(at + 1) - level(at - 1));
  const double bend = level(at + 1) - 2.0 * level(at) + level(at - 1);
  const double off = bend < 0.0 ? std::clamp(-slope / bend, -1.0, 1.0) : 0.0;
  return { (at + off) * sampleMm, std::exp(level(at) + 0.5 * slope * off) };
}

/// Exact IQ of arrivals: each absorbs its own share of each frequency of a Gaussian band (12.5).
std::vector<std::complex<double>> exactIq(const std::vector<Arrival>& arrivals, const EchoSettings& s)
{
  const double pulseMm = pulseSigmaMm(s.centreFrequencyMHz, s.fractionalBandwidth);
  const double band2 = std::pow(assumedSoundSpeedMmPerUs / (4.0 * M_PI * pulseMm), 2);
  std::vector<std::complex<double>> iq(std::size_t(s.sampleCount()));
  for (const Arrival& a : arrivals)
  {
    const double sunkMHz = a.exponentNpPerMHz * band2;
    const double peak = a.at(s.centreFrequencyMHz) * std::exp(0.5 * a.exponentNpPerMHz * sunkMHz);
    for (int n = 0; n < s.sampleCount(); ++n)
    {
      const double behindMm = n * s.sampleMm() - a.rangeMm;
      if (std::abs(behindMm) < 8.0 * pulseMm)
      {
        const double turns = 2.0 * (s.centreFrequencyMHz * a.rangeMm + sunkMHz * behindMm) / assumedSoundSpeedMmPerUs;
        iq[std::size_t(n)] +=
          std::polar(peak * std::exp(-0.5 * behindMm * behindMm / (pulseMm * pulseMm)), -2.0 * M_PI * turns);
      }
    }
  }
  return iq;
}

struct HeardArrival
{
  Arrival arrival;
  Peak exact;
  Peak heard;
};

/// What a line shows of a stack beside what it must.
std::vector<HeardArrival> hearStack(const std::string& name, const LayerStack& stack, double fractionalBandwidth,
                                    int pathsPerLine, double voxelMm = 1.0)
{
  EchoSettings echo;
  echo.fractionalBandwidth = fractionalBandwidth;
  const double f = echo.centreFrequencyMHz;
  const auto counted = stackArrivals(stack, f, std::pow(10.0, leastDb / 20.0), 150.0);
  echo.depthMm = counted.back().rangeMm + 4.0;
  const ImageSettings settings = settingsOf(echo, stack.faceReflection, pathsPerLine);
  const RfLines rf = layersRf(stack, settings, 24, voxelMm);
  const auto exactSignal = exactIq(everyArrival(stack, f, 1e-7, echo.depthMm + 4.0), echo);
  const std::vector<double> envelope = envelopeOf(rf.iq);
  const std::vector<double> exact = envelopeOf(exactSignal);
  std::vector<HeardArrival> heard;
  for (const Arrival& a : counted)
  {
    heard.push_back({ a, peakNear(exact, echo.sampleMm(), a.rangeMm), peakNear(envelope, echo.sampleMm(), a.rangeMm) });
    const HeardArrival& h = heard.back();
    const std::size_t at = std::size_t(std::lround(h.exact.rangeMm / echo.sampleMm()));
    std::fprintf(stderr,
                 "%s, band %g: %8.3f mm, %s, %lld routes, exact %7.2f dB; heard %+.4f mm, %+.3f dB, %+.1f deg\n",
                 name.c_str(), fractionalBandwidth, a.rangeMm, a.primary ? "boundary" : "reverberation",
                 static_cast<long long>(a.routes), decibels(h.exact.amplitude), h.heard.rangeMm - h.exact.rangeMm,
                 decibels(h.heard.amplitude / h.exact.amplitude),
                 std::arg(std::complex<double>(rf.iq[at]) / exactSignal[at]) * 180.0 / M_PI);
  }
  return heard;
}

/// Soft tissue over a lung, as the table has them.
LayerStack lungStack(double depthMm)
{
  const TissueTable table = TissueTable::read(dataFile("tissues.csv"));
  const Tissue& tissue = *table.find("soft_tissue");
  const Tissue& lung = *table.find("lung");
  return { { { tissue.impedanceMRayl, tissue.soundSpeedMPerS, tissue.attenuationDbPerCmMHz, depthMm },
             { lung.impedanceMRayl, lung.soundSpeedMPerS, lung.attenuationDbPerCmMHz, 0.0 } },
           faceReflection };
}

constexpr double lungMm = 30.0;
constexpr int alines = 3;

/// A-lines through the P4-2's beam against the lung's own echo at so many times its depth: the largest error, dB.
double apertureAlinesDb(int pathsPerLine)
{
  const ImageSettings settings = settingsOf(echoOf(p42(), alines * lungMm + 6.0), faceReflection, pathsPerLine);
  const double sampleMm = settings.echo.sampleMm();
  const LayerStack near = lungStack(lungMm);
  const std::vector<double> heard = envelopeOf(layersRf(near, settings, 80).iq);
  double worst = 0.0;
  for (int n = 1; n <= alines; ++n)
  {
    const LayerStack deep = lungStack(n * lungMm);
    const double once = peakNear(envelopeOf(layersRf(deep, settings, 80).iq), sampleMm, deep.rangeMm(0)).amplitude;
    const Peak line = peakNear(heard, sampleMm, deep.rangeMm(0));
    const double expected = once * std::pow(std::abs(near.reflection(0)) * faceReflection, n - 1);
    std::fprintf(stderr, "A-line %d of the P4-2: %+.4f mm, %+.3f dB against a lung as deep\n", n,
                 line.rangeMm - deep.rangeMm(0), decibels(line.amplitude / expected));
    worst = std::max(worst, std::abs(decibels(line.amplitude / expected)));
  }
  return worst;
}

/// Mean power of lines over several seeds of scatterers.
std::vector<double> meanPower(const Scene& scene, const std::vector<ScanLine>& lines, const TracedLines& traced,
                              EchoSettings echo, int seeds)
{
  std::vector<double> power;
  for (int seed = 1; seed <= seeds; ++seed)
  {
    echo.seed = std::uint64_t(seed);
    const RfLines rf = formRf(scene, lines, traced, echo);
    power.resize(rf.iq.size());
    std::transform(rf.iq.begin(), rf.iq.end(), power.begin(), power.begin(),
                   [&](const std::complex<float>& v, double sum) { return sum + std::norm(v) / seeds; });
  }
  return power;
}

} // namespace

StackErrors stackErrors(const std::string& name, const LayerStack& stack, double fractionalBandwidth, int pathsPerLine,
                        double voxelMm)
{
  StackErrors worst;
  for (const HeardArrival& h : hearStack(name, stack, fractionalBandwidth, pathsPerLine, voxelMm))
  {
    const double error = decibels(h.heard.amplitude / h.exact.amplitude);
    worst.amplitudeDb = std::max(worst.amplitudeDb, std::abs(error));
    if (error > -20.0) // what is not heard lies nowhere
    {
      worst.rangeMm = std::max(worst.rangeMm, std::abs(h.heard.rangeMm - h.exact.rangeMm));
    }
  }
  return worst;
}

AlineErrors alineErrors(int pathsPerLine)
{
  AlineErrors worst;
  const LayerStack stack = lungStack(lungMm);
  const auto lines = hearStack("A-lines", stack, EchoSettings().fractionalBandwidth, pathsPerLine);
  for (std::size_t n = 0; n < std::min<std::size_t>(alines, lines.size()); ++n)
  {
    const double before = n == 0 ? 0.0 : lines[n - 1].heard.rangeMm;
    worst.spacingMm = std::max(worst.spacingMm, std::abs(lines[n].heard.rangeMm - before - stack.rangeMm(0)));
    worst.amplitudeDb =
      std::max(worst.amplitudeDb, std::abs(decibels(lines[n].heard.amplitude / lines[n].exact.amplitude)));
  }
  worst.apertureDb = apertureAlinesDb(pathsPerLine);
  return worst;
}

double tissueReverberationErrorDb(int pathsPerLine)
{
  // Speckle between 5 and 12 mm over a lung, without loss: r and rt are all that there is.
  const LayerStack stack = lungStack(lungMm);
  const StackLayer& tissue = stack.layers[0];
  const StackLayer& lung = stack.layers[1];
  const double r = std::abs(stack.reflection(0));
  const double rt = r * faceReflection;
  constexpr double fromMm = 5.0;
  constexpr double toMm = 12.0;
  const auto scene = makeScene({ 60, 60, 100 }, Vec3d(1.0),
                               { fluid("clear", tissue.impedanceMRayl, tissue.speedMPerS, 0.0),
                                 fluid("bright", tissue.impedanceMRayl, tissue.speedMPerS, 0.0, 1e-2),
                                 fluid("lung", lung.impedanceMRayl, lung.speedMPerS, 0.0) },
                               [&](const Vec3d& p) { return p.z > lungMm ? 2 : (p.z > fromMm && p.z < toMm ? 1 : 0); });
  EchoSettings echo;
  echo.depthMm = 80.0;
  const ImageSettings settings = settingsOf(echo, faceReflection, pathsPerLine);
  std::vector<ScanLine> lines;
  for (int l = 0; l < 36; ++l)
  {
    lines.push_back(makeLine({ 10.0 + 8.0 * (l % 6), 10.0 + 8.0 * (l / 6), 0.0 }, { 0, 0, 1 }));
  }
  const std::vector<double> power = meanPower(*scene, lines, trace(*scene, lines, settings.tracing), echo, 4);
  const auto level = [&](double from) {
    const int first = int((from + 1.0) / echo.sampleMm());
    const int last = int((from + toMm - fromMm - 1.0) / echo.sampleMm());
    double sum = 0.0;
    for (std::size_t l = 0; l < lines.size(); ++l)
    {
      const auto line = power.begin() + std::ptrdiff_t(l) * echo.sampleCount();
      sum += std::accumulate(line + first, line + last, 0.0);
    }
    return std::sqrt(sum);
  };
  struct Copy
  {
    const char* what;
    double fromMm;
    double amplitude;
  };
  const double direct = level(fromMm);
  double worst = 0.0;
  for (const Copy& copy :
       { Copy{ "straight back, by the lung and the face", lungMm + fromMm, 2.0 * rt },
         Copy{ "mirrored by the lung", 2.0 * lungMm - toMm, r * r },
         Copy{ "by lung and face once each way, or twice one way", 2.0 * lungMm + fromMm, 3.0 * rt * rt } })
  {
    const double error = decibels(level(copy.fromMm) / (direct * copy.amplitude));
    std::fprintf(stderr, "tissue at %g to %g mm, %s: at %g mm %.2f dB, which is off by %+.2f dB\n", fromMm, toMm,
                 copy.what, copy.fromMm, decibels(level(copy.fromMm) / direct), error);
    worst = std::max(worst, std::abs(error));
  }
  return worst;
}

double mirrorImageErrorMm(int pathsPerLine, Diaphragm diaphragm)
{
  const double speed = 1550.0; // the liver's
  const double slant = 25.0 * M_PI / 180.0;
  const Vec3d normal(std::sin(slant), 0.0, std::cos(slant));
  const Vec3d origin(50.0, 16.0, 0.0);
  const Vec3d onDiaphragm(50.0, 16.0, 60.0);
  const Vec3d image(50.0, 16.0, 85.0);
  const Vec3d sphere = image - 2.0 * glm::dot(image - onDiaphragm, normal) * normal;
  constexpr double radiusMm = 5.0;
  const bool meshed = diaphragm == Diaphragm::Mesh;
  const Tissue lung = fluid("lung", 0.18, 600.0, 40.0);
  const auto labelAt = [&](const Vec3d& p) {
    if (!meshed && glm::dot(p - onDiaphragm, normal) > 0.0)
    {
      return 1;
    }
    return glm::distance(p, sphere) < radiusMm ? 2 : 0;
  };
  const auto scene =
    makeScene({ 200, 64, 200 }, Vec3d(0.5),
              { fluid("liver", 1.65, speed, 0.1, 1e-9), lung, fluid("bright", 1.65, speed, 0.1, 1e-2) }, labelAt);
  std::vector<TargetSurface> targets;
  if (meshed)
  {
    targets.push_back(makeBox("mesh", lung, { -40, -14, 0 }, { 40, 14, 20 }));
    const Vec3d along(normal.z, 0.0, -normal.x);
    for (Vec3d& p : targets.back().pointsMm)
    {
      p = onDiaphragm + along * p.x + Vec3d(0.0, p.y, 0.0) + normal * p.z;
    }
  }
  EchoSettings echo;
  echo.depthMm = 105.0;
  const ImageSettings settings = settingsOf(echo, 0.0, pathsPerLine);
  constexpr double stepDeg = 0.35;
  constexpr int half = 20;
  std::vector<ScanLine> lines;
  for (int l = -half; l <= half; ++l)
  {
    const double angle = l * stepDeg * M_PI / 180.0;
    lines.push_back(makeLine(origin, { std::sin(angle), 0.0, std::cos(angle) }));
  }
  const TracedLines traced = trace(*scene, lines, settings.tracing, {}, targets);
  const std::vector<double> power = meanPower(*scene, lines, traced, settings.echo, 16);
  const int samples = settings.echo.sampleCount();
  const Vec3d shown = origin + (image - origin) * (1000.0 * assumedSoundSpeedMmPerUs / speed);
  double sum = 0.0;
  Vec3d moment(0.0);
  for (std::size_t l = 0; l < lines.size(); ++l)
  {
    for (int n = 0; n < samples; ++n)
    {
      const double range = n * settings.echo.sampleMm();
      const Vec3d place = origin + lines[l].axis * range;
      if (glm::distance(place, shown) < 1.8 * radiusMm)
      {
        const double weight = power[l * std::size_t(samples) + std::size_t(n)] * range; // a sector's area
        sum += weight;
        moment += weight * place;
      }
    }
  }
  if (!(sum > 0.0))
  {
    std::fprintf(stderr, "mirror image: nothing is seen behind the diaphragm\n");
    return 1.8 * radiusMm;
  }
  const Vec3d seen = moment / sum;
  std::fprintf(
    stderr,
    "mirror image in a diaphragm of %s: seen at %.3f, %.3f mm (lateral, axial), a mirror would show it at %.3f, %.3f\n",
    meshed ? "triangles" : "labels", seen.x - origin.x, seen.z - origin.z, shown.x - origin.x, shown.z - origin.z);
  return glm::distance(seen, shown);
}

namespace {

/// The mean power of lines from one depth to another.
double meanPower(const RfLines& rf, double fromMm, double toMm)
{
  const int first = int(fromMm / rf.sampleMm);
  const int last = int(toMm / rf.sampleMm);
  double power = 0.0;
  for (int l = 0; l < rf.lineCount; ++l)
  {
    for (int n = first; n < last; ++n)
    {
      power += std::norm(rf.iq[std::size_t(l) * std::size_t(rf.sampleCount) + std::size_t(n)]);
    }
  }
  return power / (double(rf.lineCount) * (last - first));
}

} // namespace

std::vector<ReverberationDrift> reverberationDrifts(const Scene& scene, const std::vector<ScanLine>& lines,
                                                    TraceSettings tracing, const EchoSettings& echo,
                                                    const std::vector<int>& pathsPerLine)
{
  constexpr double bandMm = 20.0;
  std::vector<ReverberationDrift> drifts;
  for (double from = bandMm; from + bandMm <= echo.depthMm; from += bandMm)
  {
    drifts.push_back({ from, from + bandMm, 0.0, {}, 0.0 });
  }
  for (const int paths : pathsPerLine)
  {
    tracing.pathsPerLine = paths;
    // What few paths get wrong by chance is their error, not a drift.
    const int draws = std::max(1, std::min(10, 20000 / paths));
    std::vector<double> whole(drifts.size());
    std::vector<double> alone(drifts.size());
    for (int draw = 0; draw < draws; ++draw)
    {
      tracing.seed = std::uint64_t(draw);
      const TracedLines traced = trace(scene, lines, tracing);
      const RfLines picture = formRf(scene, lines, traced, echo);
      const RfLines reverberation = formRf({ nullptr, &traced, nullptr }, lines, echo);
      for (std::size_t d = 0; d < drifts.size(); ++d)
      {
        whole[d] += meanPower(picture, drifts[d].fromMm, drifts[d].toMm) / draws;
        alone[d] += meanPower(reverberation, drifts[d].fromMm, drifts[d].toMm) / draws;
      }
    }
    for (std::size_t d = 0; d < drifts.size(); ++d)
    {
      drifts[d].pictureDb = 0.5 * decibels(whole[d]);
      drifts[d].levelDb.push_back(0.5 * decibels(alone[d]));
    }
  }
  for (ReverberationDrift& drift : drifts)
  {
    const auto [least, most] = std::minmax_element(drift.levelDb.begin(), drift.levelDb.end());
    drift.driftDb = *most - *least;
  }
  return drifts;
}

} // namespace sono
