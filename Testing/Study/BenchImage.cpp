#include "BenchImage.h"

#include "DoubleEcho.h"
#include "DoubleTrace.h"
#include "RelativeRms.h"

#include "Core/SoundSpeed.h"
#include "Echo/EchoSetup.h"
#include "Echo/Pulse.h"
#include "Simulator.h"
#include "Trace/TargetBvh.h"
#include "Trace/TraceSetup.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace sono::study {

namespace {

std::array<double, 3> array(const Vec3d& v)
{
  return { v.x, v.y, v.z };
}

std::array<int, 3> array(const Vec3i& v)
{
  return { v.x, v.y, v.z };
}

DoubleInput::Medium doubleMedium(const Tissue& t, const TraceSettings& tracing)
{
  return { t.impedanceMRayl,
           t.soundSpeedMPerS,
           tracing.rangeIsTime() ? 1000.0 * assumedSoundSpeedMmPerUs / t.soundSpeedMPerS : 1.0,
           t.attenuationDbPerCmMHz * tracing.frequencyMHz * std::log(10.0) / 100.0,
           t.tau,
           t.gamma,
           t.roughnessMm,
           t.correlationMm };
}

void addTargets(const TraceSetup& setup, DoubleInput& input)
{
  const TargetBvh bvh = buildTargetBvh(setup.targets->triangles());
  for (const BvhNode& n : bvh.nodes)
  {
    input.nodes.push_back({ array(Vec3d(n.low)), array(Vec3d(n.high)), n.first, n.count });
  }
  for (const BvhTriangle& t : bvh.triangles)
  {
    input.triangles.push_back({ { array(Vec3d(t.a)), array(Vec3d(t.b)), array(Vec3d(t.c)) }, t.target });
  }
}

/// The setup's numbers before they were rounded to single precision.
DoubleInput doubleInput(const BenchScene& bench, const TraceSettings& tracing, const TraceSetup& setup)
{
  DoubleInput input{};
  const TraceRegion& region = *setup.region;
  const Scene& scene = *bench.scene;
  input.cell = region.cell.data();
  input.firstRecord = region.firstRecord.data();
  input.record = region.record.data();
  const Vec3d spacing = scene.placement().spacingMm;
  input.size = array(region.box.size());
  input.spacing = array(spacing);
  for (const Tissue& t : scene.tissues())
  {
    input.media.push_back(doubleMedium(t, tracing));
  }
  input.firstTargetMedium = int(input.media.size());
  for (const TargetSurface& target : bench.targets)
  {
    input.media.push_back(doubleMedium(target.tissue, tracing));
  }
  if (!bench.targets.empty())
  {
    addTargets(setup, input);
  }
  const Vec3d corner = Vec3d(region.box.first) * spacing;
  for (const ScanLine& line : bench.lines)
  {
    input.lines.push_back(
      { array(scene.localFromWorld(line.originMm) - corner), array(scene.rotationToLocal() * line.axis) });
  }
  input.outsideTissue = scene.outsideIndex();
  TraceSettings::visit(tracing, [&input](const auto& value, const Parameter& parameter) {
    input.settings[parameter.name] = numberOf(value);
  });
  input.lowDiscrepancy = tracing.sampling != Sampling::Independent;
  input.depthMm = tracing.pathDepthMm();
  input.rangeIsTime = tracing.rangeIsTime();
  input.binCount = tracing.binCount();
  input.echoSampleMm = tracing.echoSampleMm;
  input.echoCount = tracing.echoCount();
  input.frequencyMHz = tracing.frequencyMHz;
  input.paths = setup.paths;
  return input;
}

/// RF of Acoustic by the product's own image formation. `image` has the intensity, `absorbed` is A times that, and the
/// offsets are those of TracedLines.
std::vector<std::complex<double>> rfOf(const BenchScene& bench, const TraceSettings& tracing, const BenchImage& image,
                                       const std::vector<double>& absorbed, const std::vector<double>& depthOffsetMm)
{
  TracedLines traced = tracedLayout(image.lineCount, tracing, bench.targets);
  traced.intensity.assign(image.intensity.begin(), image.intensity.end());
  traced.standardError.resize(image.intensity.size());
  traced.depthOffsetMm.assign(depthOffsetMm.begin(), depthOffsetMm.end());
  for (std::size_t i = 0; i < absorbed.size(); ++i)
  {
    const double intensity = image.intensity[i];
    traced.attenuationNpPerMHz.push_back(intensity > 0.0 ? float(absorbed[i] / (intensity * tracing.frequencyMHz))
                                                         : 0.0f);
  }
  EchoSettings echo = bench.echo;
  echo.device = Device::Cpu;
  const RfLines rf = formRf(*bench.scene, bench.lines, traced, echo);
  return { rf.iq.begin(), rf.iq.end() };
}

/// RF of Amadou2024, all in double precision. `image` has the intensity.
std::vector<std::complex<double>> rfInDouble(const BenchScene& bench, const BenchImage& image,
                                             const std::vector<std::complex<double>>& echo)
{
  const EchoSources sources{ bench.scene.get(), nullptr, nullptr, InterfaceModel::Amadou2024 };
  const EchoSetup setup(sources, bench.lines, bench.echo);
  const Scene& scene = *bench.scene;
  DoubleEchoInput input{};
  input.tissues = scene.tissueVoxels().data();
  input.size = array(scene.placement().size);
  input.spacing = array(scene.placement().spacingMm);
  for (const ScatteringMedium& m : setup.tissues->media())
  {
    input.media.push_back({ m.mean, m.sigma, m.probability });
  }
  input.cellMm = bench.echo.scattererCellMm;
  input.seed = bench.echo.seed;
  const Mat3d toLocal = scene.rotationToLocal();
  for (const ScanLine& line : bench.lines)
  {
    input.lines.push_back({ array(scene.localFromWorld(line.originMm)), array(toLocal * line.axis),
                            array(toLocal * line.lateral), array(toLocal * line.elevation) });
  }
  input.lateralSigmaMm = bench.echo.lateralSigmaMm;
  input.elevationalSigmaMm = bench.echo.elevationalSigmaMm;
  input.sampleMm = bench.echo.sampleMm();
  input.sampleCount = bench.echo.sampleCount();
  input.radPerMm = setup.finisher.radPerMm();
  input.pulseSigmaMm = pulseSigmaMm(bench.echo.centreFrequencyMHz, bench.echo.fractionalBandwidth);
  input.intensity = image.intensity.data();
  input.binMm = image.binMm;
  input.binCount = image.binCount;
  input.echo = echo.data();
  input.echoCount = int(echo.size() / bench.lines.size());
  return formRfInDouble(input);
}

BenchImage emptyImage(const BenchScene& bench, const TraceSettings& tracing)
{
  BenchImage image;
  image.lineCount = int(bench.lines.size());
  image.binCount = tracing.binCount();
  image.binMm = tracing.radialBinMm;
  return image;
}

double secondsSince(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

BenchImage imageInDouble(const BenchScene& bench, const TraceSettings& tracing)
{
  BenchImage image = emptyImage(bench, tracing);
  const auto start = std::chrono::steady_clock::now();
  const TraceSetup setup(*bench.scene, bench.lines, tracing, bench.targets, {});
  DoubleTraced traced = traceInDouble(doubleInput(bench, tracing, setup));
  image.traceSeconds = secondsSince(start);
  image.intensity = std::move(traced.intensity);
  image.iq = tracing.model == InterfaceModel::Amadou2024
               ? rfInDouble(bench, image, traced.echo)
               : rfOf(bench, tracing, image, traced.absorbed, traced.depthOffsetMm);
  return image;
}

/// An image's intensity in bins of `stepMm`, of the first `count` of them of each line.
std::vector<double> inBins(const BenchImage& image, double stepMm, int count)
{
  std::vector<double> values;
  for (int line = 0; line < image.lineCount; ++line)
  {
    for (int b = 0; b < count; ++b)
    {
      const int bin = std::min(image.binCount - 1, int((b + 0.5) * stepMm / image.binMm));
      values.push_back(image.intensity[std::size_t(line) * std::size_t(image.binCount) + std::size_t(bin)]);
    }
  }
  return values;
}

/// An image's envelope in dB, cut off 60 dB below the reference's maximum.
std::vector<double> decibels(const BenchImage& image, const BenchImage& reference)
{
  double most = 0.0;
  for (const std::complex<double>& v : reference.iq)
  {
    most = std::max(most, std::abs(v));
  }
  std::vector<double> values;
  for (const std::complex<double>& v : image.iq)
  {
    values.push_back(20.0 * std::log10(std::max(std::abs(v), 1e-3 * most)));
  }
  return values;
}

/// The root of the summed products of two differences, 0 where that sum is negative.
template<class Values>
double commonDifference(const Values& first, const Values& firstReference, const Values& second,
                        const Values& secondReference)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < first.size(); ++i)
  {
    sum += std::real((first[i] - firstReference[i]) * std::conj(second[i] - secondReference[i]));
  }
  return std::sqrt(std::max(0.0, sum));
}

template<class Values>
double length(const Values& values)
{
  double sum = 0.0;
  for (const auto& v : values)
  {
    sum += std::norm(v);
  }
  return std::sqrt(sum);
}

} // namespace

void warmUp(const BenchScene& bench, const TraceSettings& tracing)
{
  const TraceSetup all(*bench.scene, bench.lines, tracing, bench.targets, {});
}

BenchImage makeBenchImage(const BenchScene& bench, const TraceSettings& tracing, Precision precision)
{
  if (precision == Precision::Double)
  {
    return imageInDouble(bench, tracing);
  }
  BenchImage image = emptyImage(bench, tracing);
  const auto start = std::chrono::steady_clock::now();
  Simulator simulator(bench.scene);
  const TracedResult result = simulator.trace(bench.lines, tracing, bench.targets);
  const TracedLines& traced = result.host();
  image.traceSeconds = secondsSince(start);
  image.intensity.assign(traced.intensity.begin(), traced.intensity.end());
  image.standardError.assign(traced.standardError.begin(), traced.standardError.end());
  image.segments = double(traced.segments);
  EchoSettings echo = bench.echo;
  echo.device = tracing.device;
  const RfResult formed = simulator.formRf(bench.lines, result, echo);
  const RfLines& rf = formed.host();
  image.iq.assign(rf.iq.begin(), rf.iq.end());
  return image;
}

BenchImage exactStackImage(const BenchScene& stack)
{
  BenchImage image = emptyImage(stack, stack.tracing);
  const StackLine line = stackLine(stack.tracing);
  std::vector<double> absorbed;
  std::vector<double> depthOffsetMm;
  for (int i = 0; i < image.lineCount; ++i)
  {
    image.intensity.insert(image.intensity.end(), line.intensity.begin(), line.intensity.end());
    absorbed.insert(absorbed.end(), line.absorbed.begin(), line.absorbed.end());
    depthOffsetMm.insert(depthOffsetMm.end(), line.depthOffsetMm.begin(), line.depthOffsetMm.end());
  }
  image.iq = rfOf(stack, stack.tracing, image, absorbed, depthOffsetMm);
  return image;
}

BenchImage meanOf(const std::vector<BenchImage>& images)
{
  BenchImage mean = images.front();
  const double share = 1.0 / double(images.size());
  for (std::size_t i = 0; i < mean.intensity.size(); ++i)
  {
    mean.intensity[i] = 0.0;
    for (const BenchImage& image : images)
    {
      mean.intensity[i] += share * image.intensity[i];
    }
  }
  for (std::size_t i = 0; i < mean.iq.size(); ++i)
  {
    mean.iq[i] = 0.0;
    for (const BenchImage& image : images)
    {
      mean.iq[i] += share * image.iq[i];
    }
  }
  return mean;
}

double intensityError(const BenchImage& image, const BenchImage& reference)
{
  const double step = std::min(image.binMm, reference.binMm);
  const int count = int(std::min(image.binCount * image.binMm, reference.binCount * reference.binMm) / step + 0.5);
  return test::relativeRms(inBins(image, step, count), inBins(reference, step, count));
}

ImageError imageError(const BenchImage& image, const BenchImage& reference)
{
  const std::vector<double> is = decibels(image, reference);
  const std::vector<double> should = decibels(reference, reference);
  return { intensityError(image, reference), test::relativeRms(image.iq, reference.iq),
           commonDifference(is, should, is, should) / std::sqrt(double(is.size())) };
}

ImageError errorWithoutNoise(const std::array<BenchImage, 2>& images, const std::array<BenchImage, 2>& references)
{
  const auto common = [&](const auto& of) {
    return commonDifference(of(images[0]), of(references[0]), of(images[1]), of(references[1]));
  };
  const auto intensity = [](const BenchImage& image) { return image.intensity; };
  const auto iq = [](const BenchImage& image) { return image.iq; };
  const auto inDecibels = [&](const BenchImage& image) { return decibels(image, references[0]); };
  return { common(intensity) / length(references[0].intensity), common(iq) / length(references[0].iq),
           common(inDecibels) / std::sqrt(double(references[0].iq.size())) };
}

} // namespace sono::study
