// The seed's speckle experiment: envelope SNR and the fit of a Rayleigh distribution, over ten seeds.
#include "EchoScenes.h"
#include "Study.h"

#include <cmath>

namespace sono::study {
namespace {

std::vector<std::vector<std::string>> histogramOf(const test::RayleighFit& fit)
{
  std::vector<std::vector<std::string>> rows;
  for (std::size_t bin = 0; bin < fit.share.size(); ++bin)
  {
    rows.push_back(
      { number((double(bin) + 0.5) * test::RayleighFit::binRms), number(fit.share[bin]), number(fit.fit[bin]) });
  }
  return rows;
}

void run(Output& output)
{
  // The fit's error is what the number of independent samples leaves, so the pulse is short. A wider band would reach
  // down to zero frequency, where scatterers that are all alike add up.
  const EchoSettings echo = test::speckleEcho(25.0, 150.0);
  const int seeds = 10;
  double snr = 0.0;
  double snrSquares = 0.0;
  double sse = 0.0;
  std::vector<float> all;
  for (int seed = 1; seed <= seeds; ++seed)
  {
    const std::vector<float> samples = test::speckleEnvelope(unsigned(seed), echo);
    const double ratio = test::signalToNoise(samples);
    snr += ratio / seeds;
    snrSquares += ratio * ratio / seeds;
    const test::RayleighFit fit = test::rayleighFit(samples);
    sse += fit.sse / seeds;
    if (seed == 1)
    {
      output.table("phantom_speckle.csv", { "envelope of rms", "share", "Rayleigh" }, histogramOf(fit));
    }
    all.insert(all.end(), samples.begin(), samples.end());
  }
  output.figure("speckle_snr", snr, "1");
  output.figure("speckle_snr_std", std::sqrt(std::max(0.0, snrSquares - snr * snr)), "1");
  output.figure("rayleigh_sse", sse, "1");
  output.figure("rayleigh_sse_of_ten_seeds_pooled", test::rayleighFit(all).sse, "1");
}

const Part part("phantom_speckle", run);

} // namespace
} // namespace sono::study
