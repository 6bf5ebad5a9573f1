#pragma once

#include <vector>

namespace sono {

/// How strong each frequency of evenly spaced samples is: |sum over n of a_n exp(i pi n k / 2048)| for k from 0 to
/// 2048, which is half the sampling frequency. For any number of samples.
std::vector<double> evenSpectrum(const std::vector<double>& samples);

} // namespace sono
