#pragma once

#include <cmath>
#include <complex>
#include <cstddef>

namespace sono::test {

/// Root mean square of the difference of two arrays of one size, real or complex, of the second one's rms.
template<class Is, class Should>
double relativeRms(const Is& is, const Should& should)
{
  double error = 0.0;
  double power = 0.0;
  for (std::size_t i = 0; i < should.size(); ++i)
  {
    error += std::norm(std::complex<double>(is[i]) - std::complex<double>(should[i]));
    power += std::norm(std::complex<double>(should[i]));
  }
  return std::sqrt(error / power);
}

} // namespace sono::test
