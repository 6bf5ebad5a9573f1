#include "KernelsInDouble.h"
// Apart, since that one redefines the types of the kernels.
#include "DoubleEcho.h"

namespace sono::study {

namespace {

namespace kernel = sonoInDouble;
using Vec = glm::dvec3;
using Complex = std::complex<double>;

Vec vec(const std::array<double, 3>& v)
{
  return { v[0], v[1], v[2] };
}

/// Samples from the middle of the pulse to its end: the product's.
int pulseHalf(const DoubleEchoInput& input)
{
  return int(std::ceil(4.2 * input.pulseSigmaMm / input.sampleMm));
}

/// Visits the cells around the beam's axis, to `deepestMm`.
template<class Visit>
void forCells(const DoubleEchoInput& input, const kernel::Beam& beam, double deepestMm, const Visit& visit)
{
  const double radius = kernel::beamCutSigma * std::max(input.lateralSigmaMm, input.elevationalSigmaMm);
  const Vec end = beam.origin + beam.axis * deepestMm;
  const Vec low = (glm::min(beam.origin, end) - radius) / input.cellMm;
  const Vec high = (glm::max(beam.origin, end) + radius) / input.cellMm;
  const double near = radius + input.cellMm * std::sqrt(3.0); // of a cell's corner to the axis
  for (int z = int(std::floor(low.z)); z <= int(std::floor(high.z)); ++z)
  {
    for (int y = int(std::floor(low.y)); y <= int(std::floor(high.y)); ++y)
    {
      for (int x = int(std::floor(low.x)); x <= int(std::floor(high.x)); ++x)
      {
        const Vec q = Vec(x, y, z) * input.cellMm - beam.origin;
        const double r = glm::dot(q, beam.axis);
        if (glm::dot(q, q) - r * r < near * near)
        {
          visit(glm::ivec3(x, y, z));
        }
      }
    }
  }
}

void addScatterers(const DoubleEchoInput& input, const kernel::Beam& beam, std::vector<Complex>& sum)
{
  const kernel::LineGrid grid = kernel::makeLineGrid(input.sampleMm, input.radPerMm, int(sum.size()));
  const glm::ivec3 size(input.size[0], input.size[1], input.size[2]);
  const Vec spacing = vec(input.spacing);
  forCells(input, beam, double(sum.size()) * input.sampleMm, [&](const glm::ivec3& cell) {
    const kernel::ScattererSeed seed = kernel::scattererSeed(input.seed, cell);
    const Vec place = (Vec(cell) + seed.fraction) * input.cellMm;
    const glm::ivec3 voxel(glm::floor(place / spacing));
    if (glm::any(glm::lessThan(voxel, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(voxel, size)))
    {
      return;
    }
    const std::size_t at =
      std::size_t(voxel.x) + std::size_t(size.x) * (std::size_t(voxel.y) + std::size_t(size.y) * std::size_t(voxel.z));
    const DoubleEchoInput::Medium& m = input.media[input.tissues[at]];
    const double amplitude =
      kernel::scattererAmplitude({ m.mean, m.sigma, m.probability }, seed.presence, seed.deviate);
    const kernel::BeamPlace p = kernel::placeInBeam(place.x, place.y, place.z, beam, grid);
    const double squared = kernel::squaredSigmas(p, 1.0 / beam.lateralSigmaMm, 1.0 / beam.elevationalSigmaMm);
    if (squared < kernel::beamCutSigma * kernel::beamCutSigma && p.position >= 0.0 && p.position < grid.lastSample)
    {
      const kernel::ScattererSplit s = kernel::splitScatterer(amplitude * std::exp(-0.5 * squared), p.position, grid);
      const std::size_t sample = std::size_t(s.sample);
      sum[sample] += Complex(s.added[0], s.added[1]);
      sum[sample + 1] += Complex(s.added[2], s.added[3]);
    }
  });
}

/// Linear between the centres of the tracer's bins.
double intensityAt(const DoubleEchoInput& input, const double* bins, double depthMm)
{
  const double position = std::clamp(depthMm / input.binMm - 0.5, 0.0, double(input.binCount - 1));
  const int bin = std::min(int(position), std::max(0, input.binCount - 2));
  const int next = std::min(bin + 1, input.binCount - 1);
  return bins[bin] + (bins[next] - bins[bin]) * (position - bin);
}

void formLine(const DoubleEchoInput& input, int line, Complex* iq)
{
  const DoubleEchoInput::Line& l = input.lines[std::size_t(line)];
  kernel::Beam beam{};
  beam.origin = vec(l.origin);
  beam.axis = vec(l.axis);
  beam.lateral = vec(l.lateral);
  beam.elevation = vec(l.elevation);
  beam.lateralSigmaMm = input.lateralSigmaMm;
  beam.elevationalSigmaMm = input.elevationalSigmaMm;
  beam.kind = kernel::BeamKind::Gaussian;
  const int half = pulseHalf(input);
  std::vector<Complex> sum(std::size_t(input.sampleCount + half));
  addScatterers(input, beam, sum);
  const double* bins = input.intensity + std::ptrdiff_t(line) * input.binCount;
  const Complex* echo = input.echo + std::ptrdiff_t(line) * input.echoCount;
  for (std::size_t s = 0; s < sum.size(); ++s)
  {
    const double depth = double(s) * input.sampleMm;
    sum[s] *= intensityAt(input, bins, depth);
    sum[s] += s < std::size_t(input.echoCount) ? echo[s] : Complex();
    sum[s] *= std::polar(1.0, -input.radPerMm * depth);
  }
  // The split between two samples adds a variance of a sixth of a sample's square, which is taken off.
  const double sigma = input.pulseSigmaMm / input.sampleMm;
  const double narrowed = std::sqrt(sigma * sigma - 1.0 / 6.0);
  for (int s = 0; s < input.sampleCount; ++s)
  {
    iq[s] = 0.0;
    for (int n = std::max(0, s - half); n <= s + half && n < int(sum.size()); ++n)
    {
      iq[s] += sum[std::size_t(n)] * (sigma / narrowed * std::exp(-0.5 * std::pow((n - s) / narrowed, 2)));
    }
  }
}

} // namespace

std::vector<std::complex<double>> formRfInDouble(const DoubleEchoInput& input)
{
  std::vector<Complex> iq(input.lines.size() * std::size_t(input.sampleCount));
  parallelFor(int(input.lines.size()), {},
              [&](int line) { formLine(input, line, iq.data() + std::ptrdiff_t(line) * input.sampleCount); });
  return iq;
}

} // namespace sono::study
