#include "KernelsInDouble.h"
// Apart, since that one redefines the types of the kernels.
#include "DoubleTrace.h"

namespace sonoInDouble {

// The deposit on the CPU, Trace/Deposit.cpp, without its vector loops.

LineTally::LineTally(int binCount, double binMm, int echoCount, double echoSampleMm, double wavesPerMm)
  : bins_(std::size_t(binCount), 0.0)
  , binMm_(binMm)
  , echoCount_(echoCount)
  , echoSampleMm_(echoSampleMm)
  , radPerMm_(4.0 * M_PI * wavesPerMm)
{
}

void LineTally::start(const TraceLine& line, double coherenceMm, std::complex<double>* echo)
{
  line_ = line;
  coherenceMm_ = coherenceMm;
  echo_ = echo;
}

void LineTally::clearBins()
{
  std::fill(bins_.begin(), bins_.end(), 0.0);
}

void LineTally::segment(const PathSegment& s)
{
  ++segments_;
  const BeamSegment g = beamSegment(line_, s, coherenceMm_);
  const DepthSpan span = depthSpan(g, s.length, binMm_ * double(bins_.size()));
  if (!(span.high > span.low))
  {
    return;
  }
  const int last = int(bins_.size()) - 1;
  for (int b = std::min(last, int(span.low / binMm_)); b <= std::min(last, int(span.high / binMm_)); ++b)
  {
    const double from = std::max(span.low, b * binMm_);
    const double to = std::min(span.high, (b + 1) * binMm_);
    bins_[std::size_t(b)] += meanOver(g, from, to, 1.0 / g.mu) * (to - from) / binMm_;
  }
}

void LineTally::echo(const Vec3d& point, double amplitude)
{
  const EchoSplit split =
    splitEcho(line_, point, amplitude * echoWeight_, coherenceMm_, echoSampleMm_, echoCount_, radPerMm_);
  if (split.sample >= 0)
  {
    echo_[split.sample] += std::complex<double>(split.amplitude[0], split.amplitude[1]);
    echo_[split.sample + 1] += std::complex<double>(split.amplitude[2], split.amplitude[3]);
  }
}

} // namespace sonoInDouble

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
  view.rouletteIntensity = input.rouletteIntensity;
  view.model = kernel::InterfaceModel(input.model);
  view.lobe = kernel::makeLobe(input.lobeMean, input.lobeSigma, input.lobeMin, input.lobeMax);
  view.lowDiscrepancy = input.lowDiscrepancy;
  view.deterministic = input.deterministic;
  view.maxCollisions = input.maxCollisions;
  view.coherenceMm = input.coherenceMm;
  view.depthMm = input.depthMm;
  view.seed = input.seed;
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

/// One line by paths of its own, as trace() follows it.
void traceLine(const DoubleInput& input, const kernel::TraceView& view, const Space& space,
               const kernel::TraceLine& line, int index, kernel::TracedLines& out)
{
  kernel::LineTally tally(input.binCount, input.binMm, input.echoCount, input.echoSampleMm,
                          input.frequencyMHz / kernel::assumedSoundSpeedMmPerUs);
  tally.start(line, view.coherenceMm, out.boundaryEcho.data() + std::size_t(index) * std::size_t(input.echoCount));
  const kernel::LineStart start = kernel::startLine(view, space, line, tally);
  std::copy(tally.bins().begin(), tally.bins().end(),
            out.intensity.begin() + std::ptrdiff_t(index) * std::ptrdiff_t(input.binCount));
  if (!start.meets)
  {
    return;
  }
  tally.setEchoWeight(1.0 / input.paths);
  const int batches = std::min(kernel::batchCount, input.paths);
  std::vector<kernel::BounceScramble> scrambles(std::size_t(view.maxCollisions));
  std::vector<std::vector<double>> means;
  for (int batch = 0; batch < batches; ++batch)
  {
    const kernel::PathRange range = kernel::batchRange(input.paths, batches, batch);
    for (std::size_t b = 0; b < scrambles.size(); ++b)
    {
      scrambles[b] =
        kernel::makeBounceScramble(view.seed, std::uint32_t(index), std::uint32_t(batch), std::uint32_t(b));
    }
    tally.clearBins();
    for (int path = range.first; path < range.last; ++path)
    {
      kernel::tracePath(
        view, space, line, start,
        { std::uint32_t(index), std::uint32_t(batch), std::uint32_t(path - range.first), scrambles.data() }, tally);
    }
    means.push_back(tally.bins());
    for (double& v : means.back())
    {
      v /= range.last - range.first;
    }
  }
  kernel::addBatchMeans(means, index, out);
}

} // namespace

DoubleTraced traceInDouble(const DoubleInput& input)
{
  std::vector<kernel::TraceMedium> media;
  for (const DoubleInput::Medium& m : input.media)
  {
    media.push_back({ m.impedance, m.speed, m.decayPerMm, m.tau, m.gamma });
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
  out.binMm = input.binMm;
  out.binCount = input.binCount;
  out.echoSampleMm = input.echoSampleMm;
  out.echoCount = input.echoCount;
  out.intensity.assign(lines.size() * std::size_t(input.binCount), 0.0);
  out.standardError.assign(out.intensity.size(), 0.0);
  out.boundaryEcho.assign(lines.size() * std::size_t(input.echoCount), {});
  if (input.sharedPaths)
  {
    kernel::traceSharedLines(space, { view, lines, input.paths, input.frequencyMHz }, out, {});
  }
  else
  {
    parallelFor(out.lineCount, {}, [&](int i) { traceLine(input, view, space, lines[std::size_t(i)], i, out); });
  }
  return { std::move(out.intensity), std::move(out.boundaryEcho) };
}

} // namespace sono::study
