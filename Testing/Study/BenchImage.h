#pragma once

#include "BenchScenes.h"

#include <array>
#include <complex>
#include <vector>

namespace sono::study {

/// What a bench scene is computed with. Double is a twin of the CPU's way for this study alone, several times slower:
/// of the tracer, and with Amadou2024 of image formation too.
enum class Precision
{
  Single,
  Double
};

/// Intensity and RF of a bench scene.
struct BenchImage
{
  int lineCount = 0;
  int binCount = 0;
  double binMm = 0.0;
  std::vector<double> intensity;        ///< by line and bin
  std::vector<double> standardError;    ///< of it; empty in double precision
  std::vector<std::complex<double>> iq; ///< by line and sample
  double traceSeconds = 0.0;            ///< the wall's
  double segments = 0.0;                ///< of all paths; 0 in double precision
};

BenchImage makeBenchImage(const BenchScene& bench, const TraceSettings& tracing, Precision precision);

/// Makes the tracer's cache of the scene with all its records, which is no cost of a path: a tracer bakes those that
/// its paths meet while they run.
void warmUp(const BenchScene& bench, const TraceSettings& tracing);

/// The stack without noise: the intensity is a finite sum over the ways through the layers, and the product's image
/// formation makes its RF.
BenchImage exactStackImage(const BenchScene& stack);

/// The mean of images that differ by chance alone, in intensity and RF.
BenchImage meanOf(const std::vector<BenchImage>& images);

/// Root mean square errors against a reference.
struct ImageError
{
  double intensity; ///< of the reference's rms
  double rf;        ///< of the reference's rms
  double decibels;  ///< of the envelope in dB, both cut off 60 dB below the reference's maximum
};

ImageError imageError(const BenchImage& image, const BenchImage& reference);

/// The part of the error that is no matter of chance: the root of the mean product of two differences that have nothing
/// but that part in common, since each image and each reference has random numbers of its own. 0 where the product is
/// negative. All on the same bins.
ImageError errorWithoutNoise(const std::array<BenchImage, 2>& images, const std::array<BenchImage, 2>& references);

/// Of the intensity alone, on the finer of the two grids of bins; the coarser bins must be made of whole finer ones.
double intensityError(const BenchImage& image, const BenchImage& reference);

} // namespace sono::study
