#include "DoubleTrace.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

// The kernels' own source with every float a double, under another name, so that both can be linked. The numbers that
// decide, labels, records and random words, are the same.
#define float double
#define vec2 dvec2
#define vec3 dvec3
#define sono sonoInDouble
#define atan2f atan2
#define cosf cos
#define expf exp
#define fabsf fabs
#define floorf floor
#define fmaxf fmax
#define fminf fmin
#define logf log
#define powf pow
#define sinf sin
#define sqrtf sqrt
#include "Kernel/TracePath.h"
#undef float
#undef vec2
#undef vec3
#undef sono

namespace sono::study {

namespace {

namespace kernel = sonoInDouble;
using Vec = glm::dvec3;

/// The deposit of Kernel/BeamDeposit.h, whose fast exponentials are single precision by construction, with the
/// library's: exact in the decay, two Gauss points for the coherence weight.
class DoubleTally
{
public:
  DoubleTally(const DoubleInput& input, const kernel::TraceLine& line, std::vector<double>& bins)
    : input_(input)
    , line_(line)
    , bins_(bins)
  {
  }

  void segment(const kernel::PathSegment& s)
  {
    const Vec q = s.start - line_.origin;
    const double r0 = glm::dot(q, line_.axis);
    const double mu = glm::dot(s.direction, line_.axis);
    const double low = std::max(0.0, std::min(r0, r0 + mu * s.length));
    const double high = std::min(std::max(r0, r0 + mu * s.length), input_.binMm * double(bins_.size()));
    if (!(high - low > 1e-6) || std::fabs(mu) < 1e-6)
    {
      return;
    }
    const auto weight = [&](double t) {
      const Vec p = q + s.direction * t;
      const double distance = glm::length(p - line_.axis * glm::dot(p, line_.axis));
      return distance < 1e-3 ? 1.0 : input_.coherenceMm / (input_.coherenceMm + distance);
    };
    const int last = int(bins_.size()) - 1;
    for (int b = std::min(last, int(low / input_.binMm)); b <= std::min(last, int(high / input_.binMm)); ++b)
    {
      const double from = std::max(low, b * input_.binMm);
      const double to = std::min(high, (b + 1) * input_.binMm);
      const double near = std::max(0.0, std::min((from - r0) / mu, (to - r0) / mu));
      const double step = std::max(0.0, (to - from) / std::fabs(mu));
      const double x = s.decayPerMm * step;
      const double share = x > 0.0 ? -std::expm1(-x) / x : 1.0;
      bins_[std::size_t(b)] += s.intensity * std::exp(-s.decayPerMm * near) * share * 0.5 *
                               (weight(near + 0.2113248654 * step) + weight(near + 0.7886751346 * step)) * (to - from) /
                               input_.binMm;
    }
  }
  void echo(const Vec&, double) {}

private:
  const DoubleInput& input_;
  const kernel::TraceLine& line_;
  std::vector<double>& bins_;
};

Vec vec(const std::array<double, 3>& v)
{
  return { v[0], v[1], v[2] };
}

} // namespace

std::vector<double> traceInDouble(const DoubleInput& input)
{
  std::vector<kernel::TraceMedium> media;
  for (const DoubleInput::Medium& m : input.media)
  {
    media.push_back({ m.impedance, m.speed, m.decayPerMm, m.tau, m.gamma });
  }
  kernel::CellSpace<kernel::NoTargets> space;
  space.cells.cell = input.cell;
  space.cells.firstRecord = input.firstRecord;
  space.cells.record = input.record;
  space.cells.size = { input.size[0], input.size[1], input.size[2] };
  space.cells.blocks = kernel::TissueCells::blocksFor(space.cells.size);
  space.cells.spacing = vec(input.spacing);
  space.cells.perMm = Vec(1.0 / input.spacing[0], 1.0 / input.spacing[1], 1.0 / input.spacing[2]);
  space.cells.meanSpacing = std::cbrt(input.spacing[0] * input.spacing[1] * input.spacing[2]);
  kernel::TraceView view;
  view.media = media.data();
  view.firstTargetMedium = int(media.size());
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

  const std::size_t binCount = std::size_t(std::ceil(input.depthMm / input.binMm - 1e-9));
  const int batches = std::min(8, input.paths); // the tracer's
  std::vector<double> result;
  for (std::size_t i = 0; i < input.lines.size(); ++i)
  {
    const kernel::TraceLine line{ vec(input.lines[i].origin), vec(input.lines[i].axis) };
    std::vector<double> total(binCount, 0.0);
    DoubleTally first(input, line, total);
    const kernel::LineStart start = kernel::startLine(view, space, line, first);
    for (int batch = 0; batch < batches && start.meets; ++batch)
    {
      const int begin = int(std::int64_t(input.paths) * batch / batches);
      const int end = int(std::int64_t(input.paths) * (batch + 1) / batches);
      std::vector<double> bins(binCount, 0.0);
      DoubleTally tally(input, line, bins);
      for (int path = begin; path < end; ++path)
      {
        const kernel::PathKey key{ std::uint32_t(i), std::uint32_t(batch), std::uint32_t(path - begin) };
        kernel::tracePath(view, space, line, start, key, tally);
      }
      for (std::size_t b = 0; b < binCount; ++b)
      {
        total[b] += bins[b] / (double(end - begin) * batches);
      }
    }
    result.insert(result.end(), total.begin(), total.end());
  }
  return result;
}

} // namespace sono::study
