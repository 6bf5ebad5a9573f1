#include "Trace/BatchMeans.h"

#include "Core/Simd.h"

#include <cmath>
#include <cstddef>

namespace sono {

namespace {

/// Adds the means of a batch.
SONO_SIMD_CLONES void addMeans(const BinSums<double>* batch, double batches, std::size_t count,
                               double* __restrict intensity, double* __restrict absorbed)
{
  const double share = 1.0 / batches;
  for (std::size_t b = 0; b < count; ++b)
  {
    intensity[b] += double(float(batch[b].of[intensitySum]));
    absorbed[b] += batch[b].of[absorbedSum] * share;
  }
}

SONO_SIMD_CLONES void addSpread(const BinSums<double>* batch, const double* __restrict mean, std::size_t count,
                                double* __restrict spread)
{
  for (std::size_t b = 0; b < count; ++b)
  {
    const double off = double(float(batch[b].of[intensitySum])) - mean[b];
    spread[b] += off * off;
  }
}

SONO_SIMD_CLONES void writeArrays(const BinSums<double>* shared, const double* mean, const double* absorbed,
                                  const double* spread, double pairs, double absorbs, std::size_t count,
                                  const BinRows& out)
{
  float* const intensity = out.intensity;
  float* const error = out.standardError;
  float* const attenuation = out.attenuation;
#pragma GCC ivdep
  for (std::size_t b = 0; b < count; ++b)
  {
    intensity[b] = float(shared[b].of[intensitySum]) + float(mean[b]);
    error[b] = float(std::sqrt(spread[b] / pairs));
  }
#pragma GCC ivdep
  for (std::size_t b = 0; b < count; ++b)
  {
    attenuation[b] = intensity[b] > 0.0f ? float(absorbs * absorbed[b] / double(intensity[b])) : 0.0f;
  }
}

/// What the means of batches come to.
struct Accumulated
{
  std::vector<double> own, cell, cellSquares, straight, straightSquares;

  explicit Accumulated(std::size_t count)
    : own(count)
    , cell(count)
    , cellSquares(count)
    , straight(count)
    , straightSquares(count)
  {
  }
};

SONO_SIMD_CLONES void addReverberation(const ReverberationSums* batch, double batches, std::size_t count,
                                       Accumulated& sums)
{
  const double share = 1.0 / batches;
  double* const own = sums.own.data();
  double* const cell = sums.cell.data();
  double* const cellSquares = sums.cellSquares.data();
  double* const straight = sums.straight.data();
  double* const straightSquares = sums.straightSquares.data();
#pragma GCC ivdep
  for (std::size_t b = 0; b < count; ++b)
  {
    const double plus = batch[b].of[plusSum];
    const double minus = batch[b].of[minusSum];
    const double power = batch[b].of[straightPowerSum];
    const double signedMean = plus - minus;
    own[b] += (plus + minus) * share;
    cell[b] += signedMean;
    cellSquares[b] += signedMean * signedMean;
    straight[b] += power;
    straightSquares[b] += power * power;
  }
}

} // namespace

void finishBins(const std::vector<BinSums<double>>& shared, const std::vector<std::vector<BinSums<double>>>& batches,
                int sums, double frequencyMHz, const BinRows& out)
{
  const std::size_t count = shared.size();
  const double number = double(batches.size());
  std::vector<double> mean(count);
  std::vector<double> absorbed(count);
  std::vector<double> spread(count);
  for (std::size_t b = 0; b < count; ++b)
  {
    absorbed[b] = shared[b].of[absorbedSum];
  }
  for (const auto& batch : batches)
  {
    addMeans(batch.data(), number, count, mean.data(), absorbed.data());
  }
  for (std::size_t b = 0; b < count && !batches.empty(); ++b)
  {
    mean[b] /= number;
  }
  for (const auto& batch : batches)
  {
    addSpread(batch.data(), mean.data(), count, spread.data());
  }
  const double pairs = batches.size() > 1 ? number * (number - 1.0) : 1.0; // of one batch the spread is 0
  writeArrays(shared.data(), mean.data(), absorbed.data(), spread.data(), pairs,
              sums > absorbedSum ? 1.0 / frequencyMHz : 0.0, count, out);
}

ReverberationLine reverberationOf(const std::vector<std::vector<ReverberationSums>>& batches, int count)
{
  const std::size_t bins = std::size_t(count);
  const int number = int(batches.size());
  Accumulated sums(bins);
  for (const auto& batch : batches)
  {
    if (!batch.empty())
    {
      addReverberation(batch.data(), double(number), bins, sums);
    }
  }
  ReverberationLine line{ ReverberationRows(1, count), std::vector<float>(bins), std::vector<float>(bins) };
  for (std::size_t b = 0; b < bins; ++b)
  {
    const ReverberationMeans means =
      reverberationMeansOf(float(sums.own[b]), meanAndErrorOf(number, sums.cell[b], sums.cellSquares[b]),
                           meanAndErrorOf(number, sums.straight[b], sums.straightSquares[b]));
    line.ownLevel[b] = means.ownLevel;
    line.error[b] = means.error;
    line.around.set(0, int(b), aroundOf(means));
  }
  return line;
}

} // namespace sono
