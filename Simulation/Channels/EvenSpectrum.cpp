#include "Channels/EvenSpectrum.h"

#include "Core/Simd.h"

#include <cmath>
#include <memory>

namespace sono {

namespace {

// Samples that lie a whole period apart have the same turn at each frequency, so that all are folded into one period of
// 64 x 64. Of it 64 transforms of every 64th sample, each turned by where its samples begin, and 64 transforms across
// these: Cooley and Tukey 1965, "An algorithm for the machine calculation of complex Fourier series", in one step.
constexpr int side = 64;
constexpr int period = side * side;
constexpr double pi = 3.14159265358979323846;

struct Row
{
  double re[side] = {};
  double im[side] = {};
};

/// cos and sin of 2 pi n / period.
struct Turns
{
  double cosine[period];
  double sine[period];

  Turns()
  {
    for (int n = 0; n < period; ++n)
    {
      cosine[n] = std::cos(2.0 * pi * n / period);
      sine[n] = std::sin(2.0 * pi * n / period);
    }
  }
};

SONO_SIMD_CLONES void addTurned(const Row& row, double cosine, double sine, Row& sums)
{
  for (int n = 0; n < side; ++n)
  {
    sums.re[n] += row.re[n] * cosine - row.im[n] * sine;
    sums.im[n] += row.re[n] * sine + row.im[n] * cosine;
  }
}

} // namespace

std::vector<double> evenSpectrum(const std::vector<double>& samples)
{
  static const auto turns = std::make_unique<const Turns>();
  std::vector<double> folded(period, 0.0);
  for (std::size_t n = 0; n < samples.size(); ++n)
  {
    folded[n % period] += samples[n];
  }
  std::vector<Row> tones(side); // of the rows' beginnings, at each frequency modulo 64
  for (int q = 0; q < side; ++q)
  {
    for (int k = 0; k < side; ++k)
    {
      tones[std::size_t(q)].re[k] = turns->cosine[side * (q * k % side)];
      tones[std::size_t(q)].im[k] = turns->sine[side * (q * k % side)];
    }
  }
  std::vector<Row> columns(side);
  for (int r = 0; r < side; ++r)
  {
    Row sums;
    for (int q = 0; q < side; ++q)
    {
      if (const double value = folded[std::size_t(side * q + r)]; value != 0.0)
      {
        addTurned(tones[std::size_t(q)], value, 0.0, sums);
      }
    }
    Row& column = columns[std::size_t(r)];
    for (int k = 0; k < side; ++k)
    {
      const double cosine = turns->cosine[r * k];
      const double sine = turns->sine[r * k];
      column.re[k] = sums.re[k] * cosine - sums.im[k] * sine;
      column.im[k] = sums.re[k] * sine + sums.im[k] * cosine;
    }
  }
  std::vector<double> moduli;
  for (int first = 0; first <= period / 2; first += side)
  {
    Row sums;
    for (int r = 0; r < side; ++r)
    {
      const int turn = r * first % period;
      addTurned(columns[std::size_t(r)], turns->cosine[turn], turns->sine[turn], sums);
    }
    for (int k = 0; k < side && first + k <= period / 2; ++k)
    {
      moduli.push_back(std::hypot(sums.re[k], sums.im[k]));
    }
  }
  return moduli;
}

} // namespace sono
