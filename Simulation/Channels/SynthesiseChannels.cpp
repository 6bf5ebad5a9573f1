#include "Channels/ChannelPlan.h"

#include "Core/ParallelFor.h"
#include "Core/Simd.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int tile = 64; // samples that are summed together

/// signal[m] += sum over bins of re[bin] cosines[bin][m] + im[bin] sines[bin][m], of one tile.
SONO_SIMD_CLONES void addTile(const float* re, const float* im, int bins, const float* cosines, const float* sines,
                              float* signal)
{
  float sum[tile] = {};
  for (int bin = 0; bin < bins; ++bin)
  {
    const float* c = cosines + std::ptrdiff_t(bin) * tile;
    const float* s = sines + std::ptrdiff_t(bin) * tile;
    const float a = re[bin];
    const float b = im[bin];
    for (int m = 0; m < tile; ++m)
    {
      sum[m] += a * c[m] + b * s[m];
    }
  }
  std::copy(sum, sum + tile, signal);
}

} // namespace

void synthesise(const ChannelPlan& plan, const ChannelShells& shells, const ChannelShell& shell,
                const std::vector<float>& sums, ChannelData& data)
{
  const std::size_t bins = std::size_t(shells.bins);
  const std::size_t padded = std::size_t(plan.pieces.padded);
  const std::size_t elements = std::size_t(plan.pieces.elements);
  const std::size_t transmits = plan.transmits.each.size();
  const int signals = int(transmits * elements);
  // Re of P sum exp(-2 pi i f t), t from the stretch's first sample on, both sides of the spectrum.
  std::vector<float> re(bins * std::size_t(signals));
  std::vector<float> im(re.size());
  for (std::size_t bin = 0; bin < bins; ++bin)
  {
    const double turns = (double(shells.firstBin) + double(bin)) * shell.firstSample / shells.samples;
    const std::complex<double> weight = 2.0 * shells.stepMHz * plan.spectrum.at(shells.frequencyMHz(int(bin))) *
                                        std::polar(1.0, -2.0 * pi * (turns - std::floor(turns)));
    for (std::size_t t = 0; t < transmits; ++t)
    {
      const float* row = sums.data() + (bin * transmits + t) * 2 * padded;
      for (std::size_t n = 0; n < elements; ++n)
      {
        const std::complex<double> value = weight * std::complex<double>(row[n], row[padded + n]);
        re[(t * elements + n) * bins + bin] = float(value.real());
        im[(t * elements + n) * bins + bin] = float(value.imag());
      }
    }
  }
  const int end = std::min(shell.firstSample + shells.samples, plan.sampleCount);
  const int tiles = (shells.samples + tile - 1) / tile;
  parallelFor(tiles, {}, [&](int number) {
    const int first = shell.firstSample + number * tile;
    if (first >= end || first + tile <= 0)
    {
      return;
    }
    std::vector<float> cosines(bins * tile);
    std::vector<float> sines(bins * tile);
    for (std::size_t bin = 0; bin < bins; ++bin)
    {
      for (int m = 0; m < tile; ++m)
      {
        const std::int64_t turn =
          (std::int64_t(shells.firstBin) + std::int64_t(bin)) * (number * tile + m) % shells.samples;
        const double angle = 2.0 * pi * double(turn) / shells.samples;
        cosines[bin * tile + std::size_t(m)] = float(std::cos(angle));
        sines[bin * tile + std::size_t(m)] = float(std::sin(angle));
      }
    }
    float added[tile];
    const int from = std::max(0, -first);
    const int to = std::min({ tile, end - first });
    for (int signal = 0; signal < signals; ++signal)
    {
      addTile(re.data() + std::size_t(signal) * bins, im.data() + std::size_t(signal) * bins, int(bins), cosines.data(),
              sines.data(), added);
      float* out = data.rf.data() + std::size_t(signal) * std::size_t(plan.sampleCount);
      for (int m = from; m < to; ++m)
      {
        out[first + m] += added[m];
      }
    }
  });
}

} // namespace sono
