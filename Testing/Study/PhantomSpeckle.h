#pragma once

#include <string>
#include <vector>

namespace sono::study {

/// Envelope samples of the seed's speckle experiment: scatterers of amplitude 1 in a sheet of 40 x 40 mm, beam sigma
/// 2 mm both ways, from where the field is uniform.
std::vector<float> speckleSamples(unsigned seed, double densityPerMm2);

/// Sum over 100 bins of 0.04 rms of the squared difference between the share of the samples and that of the Rayleigh
/// distribution of the same mean square, its maximum-likelihood fit. N independent samples of a Rayleigh variable leave
/// about 1 / N. `histogram` takes the rows (bin's middle in rms, share, fit).
double rayleighSse(const std::vector<float>& envelope, std::vector<std::vector<std::string>>* histogram = nullptr);

} // namespace sono::study
