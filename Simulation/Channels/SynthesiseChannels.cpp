#include "Channels/ChannelPlan.h"

#include "Core/ParallelFor.h"
#include "Core/Simd.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

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

/// How far a frequency has turned after so many samples, in samples' shares of a turn.
std::size_t turnOf(const ChannelShells& shells, int bin, int sample)
{
  const std::int64_t turn = (std::int64_t(shells.firstBin) + bin) * sample % shells.samples;
  return std::size_t(turn < 0 ? turn + shells.samples : turn);
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
    const std::size_t turn = turnOf(shells, int(bin), shell.firstSample);
    const std::complex<float> weight =
      shells.pulse[bin] * std::complex<float>(shells.turnCosine[turn], -shells.turnSine[turn]);
    for (std::size_t t = 0; t < transmits; ++t)
    {
      const float* row = sums.data() + (bin * transmits + t) * 2 * padded;
      for (std::size_t n = 0; n < elements; ++n)
      {
        const std::complex<float> value = weight * std::complex<float>(row[n], row[padded + n]);
        re[(t * elements + n) * bins + bin] = value.real();
        im[(t * elements + n) * bins + bin] = value.imag();
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
      std::size_t turn = turnOf(shells, int(bin), number * tile);
      const std::size_t step = std::size_t(shells.firstBin) + bin;
      for (std::size_t m = 0; m < std::size_t(tile); ++m)
      {
        cosines[bin * tile + m] = shells.turnCosine[turn];
        sines[bin * tile + m] = shells.turnSine[turn];
        turn = (turn + step) % std::size_t(shells.samples);
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
