#include "KernelsInDouble.h"
// Apart, since that one redefines the types of the kernels.
#include "DoubleTrace.h"

#define float double
#define sono sonoInDouble
#include "Trace/Deposit.cpp"
#include "Trace/ReverberationBins.cpp"
#undef float
#undef sono

namespace sono::study {

namespace {

namespace kernel = sonoInDouble;
using Space = kernel::CellSpace<kernel::BvhTargets>;

glm::dvec3 vec(const std::array<double, 3>& v)
{
  return { v[0], v[1], v[2] };
}

kernel::TraceView makeView(const DoubleInput& input, const std::vector<kernel::TraceMedium>& media)
{
  kernel::TraceView view;
  view.media = media.data();
  view.firstTargetMedium = input.firstTargetMedium;
  view.outsideTissue = input.outsideTissue;
  const auto setting = [&input](const char* name) { return input.settings.at(name); };
  const auto radians = [&setting](const char* name) { return setting(name) * M_PI / 180.0; };
  const bool deterministic = setting("deterministic") != 0.0;
  view.rouletteIntensity = deterministic ? 0.0 : std::pow(10.0, setting("rouletteDb") / 20.0);
  view.model = kernel::InterfaceModel(int(setting("interfaceModel")));
  view.lobe =
    kernel::makeLobe(radians("lobeMeanDeg"), radians("lobeSigmaDeg"), radians("lobeMinDeg"), radians("lobeMaxDeg"));
  view.waveNumberAtOne = 2000.0 * M_PI * input.frequencyMHz;
  view.lowDiscrepancy = input.lowDiscrepancy;
  view.deterministic = deterministic;
  view.reverberates = view.favoursReflections = false; // the study's settings have none
  view.maxCollisions = int(setting("maxCollisions"));
  view.coherenceMm = setting("coherenceMm");
  view.depthMm = input.depthMm;
  return view;
}

Space makeSpace(const DoubleInput& input, const std::vector<kernel::BvhNode>& nodes,
                const std::vector<kernel::BvhTriangle>& triangles)
{
  Space space;
  space.cells.cell = input.cell;
  space.cells.firstRecord = input.firstRecord;
  space.cells.record = input.record;
  space.cells.size = { input.size[0], input.size[1], input.size[2] };
  space.cells.blocks = kernel::TissueCells::blocksFor(space.cells.size);
  space.cells.spacing = vec(input.spacing);
  space.cells.perMm = glm::dvec3(1.0) / vec(input.spacing);
  space.cells.meanSpacing = std::cbrt(input.spacing[0] * input.spacing[1] * input.spacing[2]);
  space.targets = { nodes.data(), triangles.data(), std::int32_t(nodes.size()) };
  return space;
}

/// Where the line's axis leads, by time, as trace() finds it.
void findDepthOffsets(const DoubleInput& input, const kernel::TraceView& view, const Space& space,
                      const kernel::TraceLine& line, double* offset)
{
  const double binMm = input.settings.at("radialBinMm");
  const int each = kernel::flightSteps(binMm);
  const double stepMm = binMm / each;
  const kernel::TargetSpans spans = kernel::targetSpans(view, space, line);
  int medium = kernel::mediumOnAxis(view, space, line, spans, 0.0);
  std::vector<double> rangeMm{ 0.0 };
  for (int s = 0; s < input.binCount * each; ++s)
  {
    rangeMm.push_back(rangeMm.back() + kernel::flightStepOn(view, space, line, spans, stepMm, s, medium).rangeMm);
  }
  for (int b = 0; b < input.binCount; ++b)
  {
    offset[b] = kernel::depthOfRange(rangeMm.data(), input.binCount * each, stepMm, b * binMm) - b * binMm;
  }
}

/// One line by paths of its own, as trace() follows it.
void traceLine(const DoubleInput& input, const kernel::TraceView& view, const Space& space,
               const kernel::TraceLine& line, int index, kernel::TracedLines& out, double* absorbed)
{
  kernel::LineTally tally(input.binCount, input.settings.at("radialBinMm"), kernel::binSumsOf(view.model),
                          input.echoCount, input.echoSampleMm, input.frequencyMHz / kernel::assumedSoundSpeedMmPerUs);
  tally.begin(view, line, 0, {});
  const kernel::LineStart start = kernel::startLine(view, space, line, tally);
  std::complex<double>* echoes = out.boundaryEcho.data() + std::ptrdiff_t(index) * input.echoCount;
  const std::vector<kernel::BinSums<double>> shared = tally.takeBins(1);
  std::vector<std::vector<kernel::BinSums<double>>> means; // of batches
  const auto finish = [&] {
    tally.takeEchoes(echoes);
    for (std::size_t b = 0; b < shared.size(); ++b)
    {
      const std::size_t at = std::size_t(index) * shared.size() + b;
      const auto meanOf = [&](int batch) { return means[std::size_t(batch)][b]; };
      out.intensity[at] =
        kernel::finishBin(shared[b], int(means.size()), meanOf, kernel::binSumsOf(view.model), input.frequencyMHz)
          .of[kernel::intensityArray];
      absorbed[at] = shared[b].of[kernel::absorbedSum];
      for (const auto& ofBatch : means)
      {
        absorbed[at] += ofBatch[b].of[kernel::absorbedSum] / double(means.size());
      }
    }
  };
  if (!start.meets)
  {
    finish();
    return;
  }
  tally.setEchoWeight(1.0 / input.paths);
  const int batches = std::min(kernel::batchCount, input.paths);
  const auto seed = std::uint64_t(std::int64_t(input.settings.at("pathSeed")));
  std::vector<kernel::BounceScramble> scrambles(std::size_t(view.maxCollisions));
  for (int batch = 0; batch < batches; ++batch)
  {
    const kernel::PathRange range = kernel::batchRange(input.paths, batches, batch);
    for (std::size_t b = 0; b < scrambles.size(); ++b)
    {
      scrambles[b] = kernel::makeBounceScramble(seed, std::uint32_t(index), std::uint32_t(batch), std::uint32_t(b));
    }
    for (int path = range.first; path < range.last; ++path)
    {
      kernel::tracePath(
        view, space, line, start,
        { std::uint32_t(index), std::uint32_t(batch), std::uint32_t(path - range.first), seed, scrambles.data() },
        tally);
    }
    means.push_back(tally.takeBins(range.last - range.first));
  }
  finish();
}

} // namespace

DoubleTraced traceInDouble(const DoubleInput& input)
{
  std::vector<kernel::TraceMedium> media;
  for (const DoubleInput::Medium& m : input.media)
  {
    media.push_back(
      { m.impedance, m.speed, m.rangePerMm, m.decayPerMm, m.tau, m.gamma, m.roughnessMm, m.correlationMm });
  }
  std::vector<kernel::BvhNode> nodes;
  for (const DoubleInput::Node& n : input.nodes)
  {
    nodes.push_back({ vec(n.low), vec(n.high), n.first, n.count });
  }
  std::vector<kernel::BvhTriangle> triangles;
  for (const DoubleInput::Triangle& t : input.triangles)
  {
    triangles.push_back({ vec(t.corner[0]), vec(t.corner[1]), vec(t.corner[2]), t.target });
  }
  std::vector<kernel::TraceLine> lines;
  for (const DoubleInput::Line& l : input.lines)
  {
    lines.push_back({ vec(l.origin), vec(l.axis) });
  }
  const kernel::TraceView view = makeView(input, media);
  const Space space = makeSpace(input, nodes, triangles);
  kernel::TracedLines out;
  out.lineCount = int(lines.size());
  out.binMm = input.settings.at("radialBinMm");
  out.binCount = input.binCount;
  out.echoSampleMm = input.echoSampleMm;
  out.echoCount = input.echoCount;
  out.intensity.assign(lines.size() * std::size_t(input.binCount), 0.0);
  out.boundaryEcho.assign(lines.size() * std::size_t(input.echoCount), {});
  std::vector<double> absorbed(out.intensity.size(), 0.0);
  out.depthOffsetMm.assign(input.rangeIsTime ? out.intensity.size() : 0, 0.0);
  parallelFor(out.lineCount, {}, [&](int i) {
    const kernel::TraceLine& line = lines[std::size_t(i)];
    traceLine(input, view, space, line, i, out, absorbed.data());
    if (input.rangeIsTime)
    {
      findDepthOffsets(input, view, space, line, out.depthOffsetMm.data() + std::ptrdiff_t(i) * input.binCount);
    }
  });
  return { std::move(out.intensity), std::move(absorbed), std::move(out.depthOffsetMm), std::move(out.boundaryEcho) };
}

} // namespace sono::study
