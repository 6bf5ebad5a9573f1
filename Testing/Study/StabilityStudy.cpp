// Single against double precision on every scene, and cost and error as scenes degrade (PHYSICS section 8).
#include "StabilityStudy.h"

#include "HardScenes.h"
#include "Study.h"

#include "Progress.h"

#include <cmath>

namespace sono::study {

Difference singleAgainstDouble(const BenchScene& bench, TraceSettings tracing)
{
  tracing.device = Device::Cpu;  // the twin's
  TraceSettings first = tracing; // builds the cache of the scene, which is no cost of a path
  first.pathsPerLine = 1;
  trace(*bench.scene, bench.lines, first, {}, bench.targets);
  const BenchImage single = makeBenchImage(bench, tracing, Precision::Single);
  Difference d;
  const double paths = double(tracing.pathsPerLine) * double(bench.lines.size());
  d.microsecondsPerPath = 1e6 * single.traceSeconds / paths;
  d.segmentsPerPath = single.segments / paths;
  for (std::size_t i = 0; i < single.intensity.size(); ++i)
  {
    d.finite = d.finite && std::isfinite(single.intensity[i]) && std::isfinite(single.standardError[i]);
  }
  for (const std::complex<double>& v : single.iq)
  {
    d.finite = d.finite && std::isfinite(v.real()) && std::isfinite(v.imag());
  }
  if (bench.echo.field)
  {
    return d;
  }
  const BenchImage twice = makeBenchImage(bench, tracing, Precision::Double);
  d.of = imageError(single, twice);
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
    worst = std::max(worst, d.finite ? d.of.intensity : 1.0);
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
