#include "Probe/ArrayBeam.h"

#include "Core/ParallelFor.h"
#include "Core/Simd.h"
#include "Probe/ApertureElements.h"
#include "Probe/ElevationProfile.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double decibelsPerNeper = 8.685889638065037;

struct Tone
{
  double frequencyMHz;
  double power; ///< sums to 1
};

/// A Gaussian spectrum falls by 2^(-u^2) in amplitude, u = -1 and 1 at the ends of the band at -6 dB.
std::vector<Tone> tonesOf(const ArrayAperture& aperture)
{
  if (aperture.fractionalBandwidth == 0.0)
  {
    return { { aperture.centreFrequencyMHz, 1.0 } };
  }
  std::vector<Tone> tones;
  double sum = 0.0;
  for (const double u : { -0.8, -0.4, 0.0, 0.4, 0.8 })
  {
    const double power = std::exp2(-2.0 * u * u);
    tones.push_back({ aperture.centreFrequencyMHz * (1.0 + 0.5 * aperture.fractionalBandwidth * u), power });
    sum += power;
  }
  for (Tone& tone : tones)
  {
    tone.power /= sum;
  }
  return tones;
}

double sinc(double x)
{
  return std::abs(x) < 1e-4 ? 1.0 - x * x / 6.0 : std::sin(x) / x;
}

/// Complex sums over the pieces, for every elevation.
struct BeamSums
{
  std::vector<float> transmitRe, transmitIm, receiveRe, receiveIm;

  explicit BeamSums(std::size_t count)
    : transmitRe(count)
    , transmitIm(count)
    , receiveRe(count)
    , receiveIm(count)
  {
  }
  void clear()
  {
    for (std::vector<float>* sum : { &transmitRe, &transmitIm, &receiveRe, &receiveIm })
    {
      std::fill(sum->begin(), sum->end(), 0.0f);
    }
  }
};

SONO_SIMD_CLONES void addPiece(const float* rows, const float* weight, int count, std::complex<float> transmit,
                               std::complex<float> receive, float* transmitRe, float* transmitIm, float* receiveRe,
                               float* receiveIm)
{
  const float w0 = weight[0], w1 = weight[1], w2 = weight[2], w3 = weight[3];
  const float tr = transmit.real(), ti = transmit.imag(), rr = receive.real(), ri = receive.imag();
  const int row = 2 * count;
#pragma GCC ivdep
  for (int j = 0; j < count; ++j)
  {
    const float* re = rows + j;
    const float* im = re + count;
    const float a = w0 * re[0] + w1 * re[row] + w2 * re[2 * row] + w3 * re[3 * row];
    const float b = w0 * im[0] + w1 * im[row] + w2 * im[2 * row] + w3 * im[3 * row];
    transmitRe[j] += tr * a - ti * b;
    transmitIm[j] += tr * b + ti * a;
    receiveRe[j] += rr * a - ri * b;
    receiveIm[j] += rr * b + ri * a;
  }
}

/// Squared amplitudes of one frequency, added to the grid with its power.
class ToneField
{
public:
  ToneField(const ArrayAperture& aperture, const FieldGrid& grid, const Elements& elements, const Tone& tone,
            const Progress& progress)
    : aperture_(aperture)
    , grid_(grid)
    , elements_(elements)
    , power_(tone.power)
    , waveNumber_(2.0 * pi * tone.frequencyMHz / aperture.soundSpeedMmPerUs)
    , attenuationNpPerMm_(aperture.attenuationDbPerCmMHz * tone.frequencyMHz / 10.0 / decibelsPerNeper)
    , transmitDelaysMm_(delayLengthsMm(elements, aperture.transmitFocusMm))
    , profile_(setup(), progress)
  {
  }

  /// `squares` holds a depth's values, lateral fastest.
  void addDepth(int depth, bool twoWay, double* squares) const
  {
    const double depthMm = grid_.depth.at(depth);
    const std::vector<double> receiveDelaysMm = delayLengthsMm(elements_, depthMm);
    const std::size_t count = std::size_t(grid_.elevational.count);
    BeamSums sums(count);
    for (int i = 0; i < grid_.lateral.count; ++i)
    {
      sums.clear();
      addPieces({ grid_.lateral.at(i), depthMm }, receiveDelaysMm, sums);
      for (std::size_t j = 0; j < count; ++j)
      {
        const double transmit = std::norm(std::complex<double>(sums.transmitRe[j], sums.transmitIm[j]));
        const double receive = std::norm(std::complex<double>(sums.receiveRe[j], sums.receiveIm[j]));
        squares[j * std::size_t(grid_.lateral.count) + std::size_t(i)] += power_ * transmit * (twoWay ? receive : 1.0);
      }
    }
  }

private:
  double nearestMm() const { return 0.25 * aperture_.wavelengthMm(); }

  ElevationSetup setup() const
  {
    ElevationSetup setup{
      aperture_.elementHeightMm, aperture_.elevationFocusMm, waveNumber_, attenuationNpPerMm_, nearestMm(), 0.0, {}
    };
    for (int j = 0; j < grid_.elevational.count; ++j)
    {
      setup.elevationMm.push_back(grid_.elevational.at(j));
    }
    for (const Piece& piece : elements_.pieces)
    {
      const double across = std::max(std::abs(grid_.lateral.minMm - piece.centre.lateralMm),
                                     std::abs(grid_.lateral.maxMm() - piece.centre.lateralMm));
      const double range = std::hypot(across, grid_.depth.maxMm() - piece.centre.axialMm);
      setup.maxRangeMm = std::max(setup.maxRangeMm, std::max(range, 2.0 * nearestMm()));
    }
    return setup;
  }

  void addPieces(const Place& point, const std::vector<double>& receiveDelaysMm, BeamSums& sums) const
  {
    const double scale = 1.0 / aperture_.wavelengthMm(); // k0 / (2 pi)
    for (const Piece& piece : elements_.pieces)
    {
      const double dx = point.lateralMm - piece.centre.lateralMm;
      const double dz = point.axialMm - piece.centre.axialMm;
      if (dx * piece.normal.lateralMm + dz * piece.normal.axialMm < 0.0)
      {
        continue; // behind a convex face
      }
      const double r = std::max(std::sqrt(dx * dx + dz * dz), nearestMm());
      const double sine = (dx * piece.normal.axialMm - dz * piece.normal.lateralMm) / r;
      const double size = scale * piece.weight * sinc(0.5 * waveNumber_ * elements_.pieceWidthMm * sine) *
                          std::exp(-attenuationNpPerMm_ * r) / r;
      const std::size_t element = std::size_t(piece.element);
      const auto transmit = std::polar(size, waveNumber_ * (r - transmitDelaysMm_[element]));
      const auto receive = std::polar(size, waveNumber_ * (r - receiveDelaysMm[element]));
      const ElevationProfile::Stencil stencil = profile_.at(r);
      addPiece(stencil.firstRow, stencil.weight, grid_.elevational.count, std::complex<float>(transmit),
               std::complex<float>(receive), sums.transmitRe.data(), sums.transmitIm.data(), sums.receiveRe.data(),
               sums.receiveIm.data());
    }
  }

  const ArrayAperture& aperture_;
  const FieldGrid& grid_;
  const Elements& elements_;
  double power_;
  double waveNumber_;
  double attenuationNpPerMm_;
  std::vector<double> transmitDelaysMm_;
  ElevationProfile profile_;
};

std::vector<float> computeField(const ArrayAperture& aperture, const FieldGrid& grid, bool twoWay,
                                const Progress& progress)
{
  aperture.validate();
  grid.validate("the field");
  const std::vector<Tone> tones = tonesOf(aperture);
  const Elements elements = makeElements(aperture, aperture.soundSpeedMmPerUs / tones.back().frequencyMHz);
  std::vector<ToneField> fields;
  const Progress tablesOnly = progress ? [&](double) { return progress(0.0); } : Progress();
  for (const Tone& tone : tones)
  {
    fields.emplace_back(aperture, grid, elements, tone, tablesOnly);
  }
  std::vector<float> values(grid.size());
  const std::size_t sliceSize = std::size_t(grid.lateral.count) * std::size_t(grid.elevational.count);
  parallelFor(grid.depth.count, progress, [&](int depth) {
    std::vector<double> squares(sliceSize, 0.0);
    for (const ToneField& field : fields)
    {
      field.addDepth(depth, twoWay, squares.data());
    }
    std::transform(squares.begin(), squares.end(), values.begin() + std::ptrdiff_t(std::size_t(depth) * sliceSize),
                   [](double square) { return float(std::sqrt(square)); });
  });
  return values;
}

} // namespace

std::vector<float> transmitField(const ArrayAperture& aperture, const FieldGrid& grid, const Progress& progress)
{
  return computeField(aperture, grid, false, progress);
}

PulseEchoField pulseEchoField(const ArrayAperture& aperture, const FieldGrid& grid, const Progress& progress)
{
  return PulseEchoField(grid, computeField(aperture, grid, true, progress), "the computed pulse-echo field");
}

} // namespace sono
