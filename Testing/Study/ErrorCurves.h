#pragma once

#include "BenchImage.h"

#include <string>
#include <vector>

namespace sono::study {

/// A point of a curve of run time against error.
struct ErrorPoint
{
  double paths;
  double seconds;
  double error;
};

/// An exponent and its standard error, as the scatter around the line tells it.
struct Slope
{
  double value;
  double error;
};

/// Exponent of error = factor paths^slope, by least squares in logarithms over the points of at least 100 paths whose
/// error is above three times `floor`, the reference's own. NaN when fewer than two are left; its error is NaN when
/// fewer than three are.
Slope convergenceSlope(const std::vector<ErrorPoint>& curve, double floor);

/// Exponent and error as tables hold them; "-" where there is none.
std::string slopeText(const std::vector<ErrorPoint>& curve, double floor);

/// Seconds until the error stays at `target` or below, between two points by a power law; those of the first point when
/// it is there already, infinity when the last is not.
double secondsToReach(const std::vector<ErrorPoint>& curve, double target);

/// The same as tables hold it.
std::string reachedText(double seconds);

/// What images are compared with, and how far off it is itself.
struct BenchReference
{
  BenchImage image;
  ImageError floor;
};

/// The mean of eight images of low discrepancy, `paths` altogether, whose seeds nobody else takes; how far they lie
/// from it tells its error.
BenchReference meanReference(const BenchScene& bench, int paths);

/// The stack's is a finite sum, without error; the others' are such means.
BenchReference makeReference(const BenchScene& bench, int paths);

/// An image's error with the reference's own taken out, which is of another chance, so that their squares add up. 0
/// where nothing is left.
ImageError errorAgainst(const BenchReference& reference, const BenchImage& image);

} // namespace sono::study
