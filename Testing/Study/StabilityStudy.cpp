// Single against double precision on every scene, and cost and error as scenes degrade (Data/docs/physics.md section
// 8).
#include "StabilityStudy.h"

#include "HardScenes.h"
#include "Study.h"

#include "Core/Progress.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

namespace sono::study {

namespace {

bool allFinite(const BenchImage& image)
{
  const auto number = [](double v) { return std::isfinite(v); };
  return std::all_of(image.intensity.begin(), image.intensity.end(), number) &&
         std::all_of(image.standardError.begin(), image.standardError.end(), number) &&
         std::all_of(image.iq.begin(), image.iq.end(),
                     [](const std::complex<double>& v) { return std::isfinite(v.real()) && std::isfinite(v.imag()); });
}

double medianSeconds(const BenchScene& bench, const TraceSettings& tracing)
{
  warmUp(bench, tracing);
  std::array<double, 5> seconds;
  for (double& s : seconds)
  {
    const auto start = std::chrono::steady_clock::now();
    trace(*bench.scene, bench.lines, tracing, {}, bench.targets);
    s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  std::sort(seconds.begin(), seconds.end());
  return seconds[2];
}

} // namespace

Difference singleAgainstDouble(const BenchScene& bench, TraceSettings tracing)
{
  tracing.device = Device::Cpu; // the twin's
  Difference d;
  const int paths = (tracing.deterministic ? 1 : tracing.pathsPerLine) * int(bench.lines.size());
  d.microsecondsPerPath = 1e6 * medianSeconds(bench, tracing) / paths;
  const BenchImage single = makeBenchImage(bench, tracing, Precision::Single);
  d.segmentsPerPath = single.segments / paths;
  d.finite = allFinite(single);
  if (bench.echo.field)
  {
    return d;
  }
  const BenchImage twice = makeBenchImage(bench, tracing, Precision::Double);
  d.of = imageError(single, twice);
  d.finite = d.finite && allFinite(twice) && std::isfinite(d.of.intensity) && std::isfinite(d.of.rf) &&
             std::isfinite(d.of.decibels);
  double noise = 0.0;
  double power = 0.0;
  for (std::size_t i = 0; i < twice.intensity.size(); ++i)
  {
    noise += single.standardError[i] * single.standardError[i];
    power += twice.intensity[i] * twice.intensity[i];
  }
  d.noise = std::sqrt(noise / power);
  return d;
}

namespace {

std::vector<std::string> rowOf(const HardScene& hard, bool quick, double& worst)
{
  try
  {
    const BenchScene bench = hard.make();
    TraceSettings tracing = bench.tracing;
    tracing.pathsPerLine = std::min(tracing.pathsPerLine, quick ? 40 : 1000000);
    const Difference d = singleAgainstDouble(bench, tracing);
    worst = std::max(worst, d.finite ? d.of.intensity : std::numeric_limits<double>::infinity());
    const auto twin = [&](double value) { return bench.echo.field ? std::string("-") : number(value); };
    return { hard.hazard,
             hard.name,
             d.finite ? "finite" : "NOT FINITE",
             number(d.microsecondsPerPath),
             number(d.segmentsPerPath),
             twin(d.of.intensity),
             twin(d.of.rf),
             twin(d.of.decibels),
             twin(d.noise) };
  }
  catch (const Error& error)
  {
    return { hard.hazard, hard.name, std::string("refused: ") + error.what(), "", "", "", "", "", "" };
  }
}

void measureStability(Output& output)
{
  std::vector<std::vector<std::string>> rows;
  double worst = 0.0;
  for (const HardScene& hard : hardScenes())
  {
    rows.push_back(rowOf(hard, output.quick(), worst));
  }
  output.table("stability.csv",
               { "hazard", "scene", "result", "microseconds a path", "segments a path",
                 "single against double: intensity, of rms", "RF, of rms", "B-mode, dB",
                 "standard error of the intensity, of rms" },
               rows);
  output.figure("single_against_double_worst", worst, "of_rms");
}

const Part part("stability", measureStability);

} // namespace
} // namespace sono::study
