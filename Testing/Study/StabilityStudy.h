#pragma once

#include "BenchScenes.h"

namespace sono::study {

/// The tracer beside its own source in double precision, with the same random numbers.
struct Difference
{
  double rms = 0.0;   ///< of single from double, of double's rms
  double noise = 0.0; ///< the standard error, likewise
  bool finite = true;
  double microsecondsPerPath = 0.0;
  double segmentsPerPath = 0.0;
};

/// Without the scene's targets. SharedPaths has no twin: take another sampling.
Difference singleAgainstDouble(const BenchScene& bench, const TraceSettings& tracing);

} // namespace sono::study
