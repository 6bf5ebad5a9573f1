#include "ImageError.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace sono::study {

BenchImage makeBenchImage(const BenchScene& bench, const TraceSettings& tracing)
{
  BenchImage image;
  const auto start = std::chrono::steady_clock::now();
  image.traced = trace(*bench.scene, bench.lines, tracing, {}, bench.targets);
  image.traceSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  image.rf = formRf(*bench.scene, bench.lines, image.traced, bench.echo);
  return image;
}

double intensityError(const TracedLines& traced, const TracedLines& reference)
{
  const double step = std::min(traced.binMm, reference.binMm);
  double error = 0.0;
  double power = 0.0;
  const auto valueAt = [](const TracedLines& t, int line, double r) {
    return double(t.intensity[std::size_t(line) * std::size_t(t.binCount) +
                              std::size_t(std::min(t.binCount - 1, int(r / t.binMm)))]);
  };
  const int count = int(std::min(traced.binCount * traced.binMm, reference.binCount * reference.binMm) / step + 0.5);
  for (int line = 0; line < reference.lineCount; ++line)
  {
    for (int b = 0; b < count; ++b)
    {
      const double r = (b + 0.5) * step;
      const double is = valueAt(traced, line, r);
      const double should = valueAt(reference, line, r);
      error += (is - should) * (is - should);
      power += should * should;
    }
  }
  return std::sqrt(error / power);
}

ImageError imageError(const BenchImage& image, const BenchImage& reference)
{
  ImageError result{ intensityError(image.traced, reference.traced), 0.0, 0.0 };
  double error = 0.0;
  double power = 0.0;
  float most = 0.0f;
  for (std::size_t i = 0; i < reference.rf.iq.size(); ++i)
  {
    error += std::norm(image.rf.iq[i] - reference.rf.iq[i]);
    power += std::norm(reference.rf.iq[i]);
    most = std::max(most, std::abs(reference.rf.iq[i]));
  }
  result.rf = std::sqrt(error / power);
  double squared = 0.0;
  const auto decibels = [&](const std::complex<float>& v) {
    return 20.0 * std::log10(std::max(double(std::abs(v)), 1e-3 * most));
  };
  for (std::size_t i = 0; i < reference.rf.iq.size(); ++i)
  {
    squared += std::pow(decibels(image.rf.iq[i]) - decibels(reference.rf.iq[i]), 2);
  }
  result.decibels = std::sqrt(squared / double(reference.rf.iq.size()));
  return result;
}

} // namespace sono::study
