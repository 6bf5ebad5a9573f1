#include "ErrorCurves.h"

#include "Study.h"

#include "Core/ParallelFor.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace sono::study {

Slope convergenceSlope(const std::vector<ErrorPoint>& curve, double floor)
{
  double n = 0.0;
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (const ErrorPoint& p : curve)
  {
    if (p.paths >= 100.0 && p.error > 3.0 * floor && p.error > 0.0)
    {
      const double lx = std::log(p.paths);
      const double ly = std::log(p.error);
      n += 1.0;
      x += lx;
      y += ly;
      xx += lx * lx;
      xy += lx * ly;
      yy += ly * ly;
    }
  }
  Slope slope{ std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN() };
  if (n >= 2.0)
  {
    const double spread = xx - x * x / n;
    slope.value = (xy - x * y / n) / spread;
    if (n >= 3.0)
    {
      const double residual = std::max(0.0, yy - y * y / n - slope.value * slope.value * spread);
      slope.error = std::sqrt(residual / (n - 2.0) / spread);
    }
  }
  return slope;
}

std::string slopeText(const std::vector<ErrorPoint>& curve, double floor)
{
  const Slope of = convergenceSlope(curve, floor);
  char text[32];
  std::snprintf(text, sizeof text, std::isfinite(of.error) ? "%.2f +- %.2f" : "%.2f", of.value, of.error);
  return std::isfinite(of.value) ? std::string(text) : "-";
}

std::string reachedText(double seconds)
{
  return std::isfinite(seconds) ? number(seconds) : "not reached";
}

double secondsToReach(const std::vector<ErrorPoint>& curve, double target)
{
  std::size_t first = curve.size(); // from here on the error stays there
  while (first > 0 && curve[first - 1].error <= target)
  {
    --first;
  }
  if (first == curve.size())
  {
    return std::numeric_limits<double>::infinity();
  }
  const ErrorPoint& to = curve[first];
  if (first == 0 || to.error <= 0.0)
  {
    return to.seconds;
  }
  const ErrorPoint& from = curve[first - 1];
  const double share = std::log(from.error / target) / std::log(from.error / to.error);
  return from.seconds * std::pow(to.seconds / from.seconds, share);
}

BenchReference makeReference(const BenchScene& bench, int paths)
{
  if (bench.name == "stack")
  {
    return { exactStackImage(bench), {} };
  }
  return meanReference(bench, paths);
}

BenchReference meanReference(const BenchScene& bench, int paths)
{
  constexpr int count = 8;
  std::vector<BenchImage> images(count);
  parallelFor(count, {}, [&](int i) {
    TraceSettings tracing = bench.tracing;
    tracing.device = Device::Cpu;
    tracing.sampling = Sampling::LowDiscrepancy;
    tracing.pathsPerLine = paths / count;
    tracing.seed = std::uint64_t(4711 + i);
    images[std::size_t(i)] = makeBenchImage(bench, tracing, Precision::Single);
  });
  BenchReference reference{ meanOf(images), {} };
  const auto standardError = [&](double ImageError::*which) {
    double sum = 0.0;
    for (const BenchImage& image : images)
    {
      sum += std::pow(imageError(image, reference.image).*which, 2);
    }
    return std::sqrt(sum / (count * (count - 1.0)));
  };
  reference.floor = { standardError(&ImageError::intensity), standardError(&ImageError::rf),
                      standardError(&ImageError::decibels) };
  return reference;
}

ImageError errorAgainst(const BenchReference& reference, const BenchImage& image)
{
  const ImageError all = imageError(image, reference.image);
  const ImageError& floor = reference.floor;
  const auto rest = [](double whole, double own) { return std::sqrt(std::max(0.0, whole * whole - own * own)); };
  return { rest(all.intensity, floor.intensity), rest(all.rf, floor.rf), rest(all.decibels, floor.decibels) };
}

} // namespace sono::study
