#pragma once

#include "BenchScenes.h"

namespace sono::study {

/// What a way to compute gives for a scene: intensity and RF.
struct BenchImage
{
  TracedLines traced;
  RfLines rf;
  double traceSeconds = 0.0;
};

BenchImage makeBenchImage(const BenchScene& bench, const TraceSettings& tracing);

/// Root mean square errors against a reference.
struct ImageError
{
  double intensity; ///< of the reference's rms
  double rf;        ///< of the reference's rms
  double decibels;  ///< of the envelope in dB, both cut off 60 dB below the reference's maximum
};

ImageError imageError(const BenchImage& image, const BenchImage& reference);

/// Of the intensity alone, on the finer of the two grids of bins; the coarser bins must be made of whole finer ones.
double intensityError(const TracedLines& traced, const TracedLines& reference);

} // namespace sono::study
