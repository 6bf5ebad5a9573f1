#pragma once

#include "BenchImage.h"

namespace sono::study {

/// Tracing and image formation in single precision beside the same in double, with the same random numbers.
struct Difference
{
  ImageError of{};                  ///< of single, from double
  double noise = 0.0;               ///< the standard error of the intensity, of its rms
  bool finite = true;               ///< of either precision, and the differences
  double microsecondsPerPath = 0.0; ///< median of five traces by all threads, with the set-up of a call
  double segmentsPerPath = 0.0;
};

/// With a computed field, for which image formation has no twin, only what single precision gives.
Difference singleAgainstDouble(const BenchScene& bench, TraceSettings tracing);

} // namespace sono::study
