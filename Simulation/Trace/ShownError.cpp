#include "Trace/ShownError.h"

#include "Core/SoundSpeed.h"
#include "Kernel/Reverberation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace sono {

namespace {

constexpr double wantedCellMm = 1.0; // a pulse of the usual probes
// A picture by BModeSettings' defaults.
constexpr double gainDbPerMm = 0.5;
constexpr double nearFieldMm = 6.0;
constexpr double shownBelowRankDb = 35.0;
constexpr double rank = 0.9;
constexpr int linesBeside = 2;
constexpr double decibelsPerShare = 8.685889638065037; // 20 / ln 10

/// Visits the lines from `linesBeside` before to as many behind.
template<class Visit>
int forLinesAround(int line, int lineCount, const Visit& visit)
{
  const int first = std::max(0, line - linesBeside);
  const int last = std::min(lineCount - 1, line + linesBeside);
  for (int l = first; l <= last; ++l)
  {
    visit(l);
  }
  return last - first + 1;
}

/// Which cells are shown, and the level that would be black there.
struct Shown
{
  std::vector<char> cells;
  std::vector<float> black; ///< by depth
};

Shown shownCells(const ShownCells& cells)
{
  const auto count = std::size_t(cells.cellCount);
  std::vector<float> gained(cells.level.size(), 0.0f);
  std::vector<float> gain;
  for (std::size_t c = 0; c < count; ++c)
  {
    gain.push_back(float(std::pow(10.0, gainDbPerMm * (double(c) + 0.5) * cells.cellMm / 20.0)));
  }
  for (int line = 0; line < cells.lineCount; ++line)
  {
    float* own = gained.data() + std::size_t(line) * count;
    const int lines = forLinesAround(line, cells.lineCount, [&](int l) {
      const float* level = cells.level.data() + std::size_t(l) * count;
      for (std::size_t c = 0; c < count; ++c)
      {
        own[c] += level[c];
      }
    });
    for (std::size_t c = 0; c < count; ++c)
    {
      own[c] *= gain[c] / float(lines);
    }
  }
  std::vector<float> ranked;
  const std::size_t near = std::min(count - 1, std::size_t(std::ceil(nearFieldMm / cells.cellMm)));
  for (std::size_t line = 0; line < std::size_t(cells.lineCount); ++line)
  {
    const auto row = gained.begin() + std::ptrdiff_t(line * count);
    ranked.insert(ranked.end(), row + std::ptrdiff_t(near), row + std::ptrdiff_t(count));
  }
  const auto at = ranked.begin() + std::ptrdiff_t(rank * double(ranked.size() - 1));
  std::nth_element(ranked.begin(), at, ranked.end());
  const float black = *at * float(std::pow(10.0, -shownBelowRankDb / 20.0));
  Shown shown{ std::vector<char>(gained.size()), std::move(gain) };
  std::transform(gained.begin(), gained.end(), shown.cells.begin(), [&](float g) { return char(g > black); });
  for (float& g : shown.black)
  {
    g = black / g;
  }
  return shown;
}

} // namespace

ShownCells cellLayout(const TracedLines& traced)
{
  ShownCells cells;
  cells.lineCount = traced.lineCount;
  cells.binsEach = std::max(1, int(std::lround(wantedCellMm / traced.binMm)));
  cells.cellMm = cells.binsEach * traced.binMm;
  const double depthMm =
    traced.binCount * traced.binMm / (traced.model == InterfaceModel::Acoustic ? deepestPerRange : 1.0);
  cells.cellCount = std::max(1, int(depthMm / cells.cellMm));
  cells.level.resize(std::size_t(cells.lineCount) * std::size_t(cells.cellCount));
  cells.error.resize(cells.level.size());
  return cells;
}

void fillEchoCells(const TracedLines& traced, const LineEchoes& echoes, int line, int paths, double radPerMm,
                   const ShownCells& layout, EchoCells& cells)
{
  const auto count = std::size_t(layout.cellCount);
  std::vector<std::complex<double>> sums(count);
  for (int s = echoes.first; s <= echoes.last; ++s)
  {
    const std::complex<double> echo = echoes.samples[std::size_t(s)];
    const double rangeMm = s * traced.echoSampleMm;
    const auto cell = std::size_t(rangeMm / layout.cellMm);
    if (cell < count && echo != std::complex<double>())
    {
      sums[cell] += echo * std::polar(1.0, -radPerMm * rangeMm);
    }
  }
  const double perSpeckle = 1.0 / (double(boundaryPerSpeckle) * paths);
  for (std::size_t c = 0; c < count; ++c)
  {
    double power = 0.0;
    for (std::size_t b = c * std::size_t(layout.binsEach);
         b < std::min((c + 1) * std::size_t(layout.binsEach), echoes.power.size()); ++b)
    {
      power += echoes.power[b];
    }
    const std::size_t at = std::size_t(line) * count + c;
    cells.level[at] = float(perSpeckle * std::abs(sums[c]));
    cells.error[at] = float(perSpeckle * std::sqrt(std::max(0.0, power - std::norm(sums[c]) / paths)));
  }
}

void fillCells(const TracedLines& traced, const EchoCells& echoes, int line, ShownCells& cells)
{
  const auto bins = std::size_t(traced.binCount);
  const auto each = std::size_t(cells.binsEach);
  for (std::size_t c = 0; c < std::size_t(cells.cellCount); ++c)
  {
    double level = 0.0;
    double error = 0.0;
    const std::size_t last = std::min(bins, (c + 1) * each);
    for (std::size_t b = std::size_t(line) * bins + c * each; b < std::size_t(line) * bins + last; ++b)
    {
      const bool reverberates = !traced.reverberation.empty();
      level += double(traced.intensity[b]) + (reverberates ? double(traced.reverberation[b]) : 0.0);
      error += std::hypot(double(traced.standardError[b]), reverberates ? double(traced.reverberationError[b]) : 0.0);
    }
    const double share = 1.0 / double(last - c * each);
    const std::size_t at = std::size_t(line) * std::size_t(cells.cellCount) + c;
    const bool echo = !echoes.level.empty();
    cells.level[at] = float(std::hypot(level * share, echo ? double(echoes.level[at]) : 0.0));
    cells.error[at] = float(std::hypot(error * share, echo ? double(echoes.error[at]) : 0.0));
  }
}

double LineErrors::rmsDb() const
{
  const double squares = std::accumulate(squaredDb.begin(), squaredDb.end(), 0.0);
  const auto count = std::accumulate(shown.begin(), shown.end(), std::int64_t(0));
  return count > 0 ? std::sqrt(squares / double(count)) : 0.0;
}

LineErrors lineErrors(const ShownCells& cells, const std::vector<int>& paths)
{
  const Shown shown = shownCells(cells);
  std::vector<double> own(std::size_t(cells.lineCount));
  LineErrors errors{ own, std::vector<int>(own.size()) };
  for (std::size_t line = 0; line < own.size(); ++line)
  {
    for (std::size_t c = 0; c < std::size_t(cells.cellCount); ++c)
    {
      const std::size_t at = line * std::size_t(cells.cellCount) + c;
      if (shown.cells[at] != 0)
      {
        const double share = std::min(1.0, double(cells.error[at] / std::max(cells.level[at], shown.black[c])));
        own[line] += decibelsPerShare * share * decibelsPerShare * share;
        ++errors.shown[line];
      }
    }
  }
  for (int line = 0; line < cells.lineCount; ++line)
  {
    double ofOnePath = 0.0;
    const int lines =
      forLinesAround(line, cells.lineCount, [&](int l) { ofOnePath += own[std::size_t(l)] * paths[std::size_t(l)]; });
    errors.squaredDb[std::size_t(line)] = ofOnePath / lines / paths[std::size_t(line)];
  }
  return errors;
}

std::vector<int> linesToDouble(const LineErrors& errors, const std::vector<int>& paths, int mostPaths, double targetDb)
{
  const auto gain = [&](int line) { return errors.squaredDb[std::size_t(line)] / paths[std::size_t(line)]; };
  std::vector<int> order;
  for (int line = 0; line < int(paths.size()); ++line)
  {
    if (paths[std::size_t(line)] <= mostPaths / 2 && gain(line) > 0.0)
    {
      order.push_back(line);
    }
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return gain(a) > gain(b); });
  const auto count = std::accumulate(errors.shown.begin(), errors.shown.end(), std::int64_t(0));
  double above =
    std::accumulate(errors.squaredDb.begin(), errors.squaredDb.end(), 0.0) - targetDb * targetDb * double(count);
  std::size_t chosen = 0;
  for (; chosen < order.size() && above > 0.0; ++chosen)
  {
    above -= 0.5 * errors.squaredDb[std::size_t(order[chosen])];
  }
  order.resize(chosen);
  std::sort(order.begin(), order.end());
  return order;
}

double shownErrorDb(const TracedLines& traced)
{
  ShownCells cells = cellLayout(traced);
  for (int line = 0; line < cells.lineCount; ++line)
  {
    fillCells(traced, {}, line, cells);
  }
  return lineErrors(cells, traced.paths).rmsDb();
}

} // namespace sono
