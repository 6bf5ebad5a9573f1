// Time and memory as labels, voxels, lines, depth, elevations, cores and GPUs grow, each case in a process of its own.
#include "GrowthCase.h"
#include "Study.h"

#include "Core/Error.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>

namespace sono::study {
namespace {

/// Of a case's process: what it is to do, and that it is one.
constexpr const char* caseVariable = "SONOVDB_GROWTH_CASE";

std::string ownProgram()
{
  return std::filesystem::read_symlink("/proc/self/exe").string();
}

/// Runs commands side by side; what each printed.
std::vector<std::string> outputsOf(const std::vector<std::string>& commands)
{
  std::vector<FILE*> pipes;
  for (const std::string& command : commands)
  {
    pipes.push_back(popen(command.c_str(), "r"));
  }
  std::vector<std::string> outputs;
  for (FILE* pipe : pipes)
  {
    std::string text;
    std::array<char, 256> some{};
    while (pipe && std::fgets(some.data(), int(some.size()), pipe))
    {
      text += some.data();
    }
    if (!pipe || pclose(pipe) != 0)
    {
      throw Error("a case of the study of growth failed: its message stands above");
    }
    outputs.push_back(text);
  }
  return outputs;
}

std::string commandFor(const Output& output, const std::string& axis, double value, const std::string& before = "")
{
  std::ostringstream command;
  command << before << caseVariable << "='" << axis << ' ' << number(value) << "' '" << ownProgram() << "' '"
          << output.file("growth_case").string() << "'" << (output.quick() ? " --quick" : "") << " growth";
  return command.str();
}

GrowthCost costIn(const std::string& text)
{
  std::istringstream stream(text);
  GrowthCost cost;
  for (GrowthCost::Seconds* seconds : { &cost.scene, &cost.first, &cost.next })
  {
    stream >> seconds->wall >> seconds->core;
  }
  stream >> cost.peakMb;
  if (!stream)
  {
    throw Error("a case of the study of growth printed '" + text + "'");
  }
  return cost;
}

/// As a case's process.
void printCase(const std::string& words, bool quick)
{
  std::istringstream stream(words);
  std::string axis;
  double value = 0.0;
  stream >> axis >> value;
  const GrowthCost cost = runGrowthCase(axis, value, quick);
  for (const GrowthCost::Seconds& seconds : { cost.scene, cost.first, cost.next })
  {
    std::printf("%.6g %.6g ", seconds.wall, seconds.core);
  }
  std::printf("%.6g\n", cost.peakMb);
}

/// Exponent of y = factor x^slope by least squares in logarithms, and the largest factor between a point and the line.
struct PowerLaw
{
  double slope = 0.0;
  double worst = 1.0;
};

PowerLaw powerLaw(const std::vector<double>& x, const std::vector<double>& y)
{
  const double count = double(x.size());
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    const double a = std::log(x[i]);
    const double b = std::log(y[i]);
    sx += a;
    sy += b;
    sxx += a * a;
    sxy += a * b;
  }
  PowerLaw law;
  law.slope = (count * sxy - sx * sy) / (count * sxx - sx * sx);
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    const double left = std::log(y[i]) - sy / count - law.slope * (std::log(x[i]) - sx / count);
    law.worst = std::max(law.worst, std::exp(std::fabs(left)));
  }
  return law;
}

/// y = at0 + each x by least squares of the relative deviations, and the largest of these.
struct StraightLine
{
  double at0 = 0.0;
  double each = 0.0;
  double worst = 0.0;
};

StraightLine straightLine(const std::vector<double>& x, const std::vector<double>& y)
{
  double s11 = 0.0, s1x = 0.0, sxx = 0.0, s1 = 0.0, sx = 0.0; // of 1 / y and x / y, which are to make 1
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    const double a = 1.0 / y[i];
    const double b = x[i] / y[i];
    s11 += a * a;
    s1x += a * b;
    sxx += b * b;
    s1 += a;
    sx += b;
  }
  const double determinant = s11 * sxx - s1x * s1x;
  StraightLine line{ (s1 * sxx - sx * s1x) / determinant, (sx * s11 - s1 * s1x) / determinant, 0.0 };
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    line.worst = std::max(line.worst, std::fabs((line.at0 + line.each * x[i]) / y[i] - 1.0));
  }
  return line;
}

int gpuCount()
{
  int count = 0;
  while (std::filesystem::exists("/dev/nvidia" + std::to_string(count)))
  {
    ++count;
  }
  return count;
}

/// Pictures a second of one GPU and of two, a process each.
void growGpus(Output& output, std::vector<std::vector<std::string>>& rows)
{
  const int gpus = gpuCount();
  if (gpus == 0)
  {
    rows.push_back({ "GPUs", "1", "not measured: no GPU was here", "", "", "", "", "" });
    return;
  }
  double one = 0.0;
  for (int count = 1; count <= std::min(2, gpus); ++count)
  {
    std::vector<std::string> commands;
    for (int gpu = 0; gpu < count; ++gpu)
    {
      commands.push_back(commandFor(output, "gpu", gpu, "CUDA_VISIBLE_DEVICES=" + std::to_string(gpu) + " "));
    }
    double rate = 0.0;
    double peak = 0.0;
    for (const std::string& text : outputsOf(commands))
    {
      const GrowthCost cost = costIn(text);
      rate += 1.0 / cost.next.wall;
      peak += cost.peakMb;
    }
    one = count == 1 ? rate : one;
    rows.push_back({ "GPUs", number(count), "", "", "", number(1.0 / rate), "", number(peak) });
    if (count == 2)
    {
      output.figure("growth_gpus_rate_ratio", rate / one, "1");
    }
  }
  if (gpus == 1)
  {
    rows.push_back({ "GPUs", "2", "not measured: one GPU was here", "", "", "", "", "" });
  }
}

void growth(Output& output)
{
  if (const char* words = std::getenv(caseVariable))
  {
    printCase(words, output.quick());
    return;
  }
  std::vector<std::vector<std::string>> rows;
  std::vector<std::vector<std::string>> slopes;
  std::vector<std::vector<std::string>> lines;
  for (const GrowthAxis& axis : growthAxes(output.quick()))
  {
    std::vector<double> scene, first, next, peak;
    for (const double value : axis.values)
    {
      const GrowthCost cost = costIn(outputsOf({ commandFor(output, axis.name, value) }).front());
      // Cores are what the wall's time is to shrink by.
      const auto of = [&](const GrowthCost::Seconds& seconds) {
        return axis.name == "cores" ? seconds.wall : seconds.core;
      };
      scene.push_back(of(cost.scene));
      first.push_back(of(cost.first));
      next.push_back(of(cost.next));
      peak.push_back(cost.peakMb);
      rows.push_back({ axis.label, number(value), number(cost.scene.wall), number(cost.first.wall),
                       number(cost.first.core), number(cost.next.wall), number(cost.next.core), number(cost.peakMb) });
    }
    std::vector<std::string> row{ axis.label };
    for (const auto& [what, values] : { std::pair<const char*, const std::vector<double>&>{ "scene", scene },
                                        { "first_picture", first },
                                        { "next_picture", next },
                                        { "memory", peak } })
    {
      const PowerLaw law = powerLaw(axis.values, values);
      output.figure("growth_" + axis.name + "_" + what + "_slope", law.slope, "1");
      row.push_back(number(law.slope));
      row.push_back(number(100.0 * (law.worst - 1.0)));
    }
    slopes.push_back(row);
    for (const auto& [what, values] : { std::pair<const char*, const std::vector<double>&>{ "first picture, s", first },
                                        { "next picture, s", next },
                                        { "memory, MB", peak } })
    {
      const StraightLine line = straightLine(axis.values, values);
      lines.push_back({ axis.label, what, number(line.at0), number(line.each), number(100.0 * line.worst) });
    }
  }
  growGpus(output, rows);
  output.table(
    "growth.csv",
    { "axis", "value", "scene, s", "first picture, s", "first, core s", "next picture, s", "next, core s", "peak, MB" },
    rows);
  output.table(
    "growth_slopes.csv",
    { "axis", "scene", "off the line, %", "first picture", "off, %", "next picture", "off, %", "memory", "off, %" },
    slopes);
  output.table("growth_lines.csv", { "axis", "what", "at 0", "each", "off the straight line, %" }, lines);
  std::error_code ignored;
  std::filesystem::remove_all(output.file("growth_case"), ignored);
}

const Part part("growth", growth);

} // namespace
} // namespace sono::study
