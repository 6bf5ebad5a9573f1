#include "Detectability.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace sono::study {
namespace {

struct Moments
{
  double mean = 0.0;
  double variance = 0.0;
};

Moments momentsOf(const std::vector<float>& values)
{
  Moments m;
  for (const float v : values)
  {
    m.mean += v / double(values.size());
  }
  for (const float v : values)
  {
    m.variance += (v - m.mean) * (v - m.mean) / double(values.size());
  }
  return m;
}

/// Probability that a gamma variable of shape m and scale 1 is at most x: x^m e^-x / Gamma(m+1) times the sum of
/// x^k / ((m+1) ... (m+k)).
double gammaBelow(double m, double x)
{
  double term = 1.0;
  double sum = 0.0;
  for (int k = 1; term > 1e-16 * sum; ++k)
  {
    sum += term;
    term *= x / (m + k);
  }
  return std::exp(m * std::log(x) - x - std::lgamma(m + 1.0)) * sum;
}

double meanError(const std::vector<MeasuredLesion>& lesions, const std::function<double(double)>& gcnrOfContrast)
{
  double error = 0.0;
  for (const MeasuredLesion& lesion : lesions)
  {
    error += std::fabs(gcnrOfContrast(lesion.contrastDb) - lesion.gcnr) / double(lesions.size());
  }
  return error;
}

/// Of parameters from `low` to `high` in steps of a thousandth of themselves.
double leastOf(const std::function<double(double)>& error, double low, double high)
{
  double least = error(low);
  for (double x = low; x <= high; x *= 1.001)
  {
    least = std::min(least, error(x));
  }
  return least;
}

} // namespace

double gcnrByThreshold(const std::vector<float>& inside, const std::vector<float>& outside)
{
  std::vector<float> a = inside;
  std::vector<float> b = outside;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  double most = 0.0;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size())
  {
    const float threshold = std::min(a[i], b[j]);
    while (i < a.size() && a[i] <= threshold)
    {
      ++i;
    }
    while (j < b.size() && b[j] <= threshold)
    {
      ++j;
    }
    most = std::max(most, std::fabs(double(i) / double(a.size()) - double(j) / double(b.size())));
  }
  return most;
}

double gcnrByHistogram(const std::vector<float>& inside, const std::vector<float>& outside, int bins)
{
  const auto [lowIn, highIn] = std::minmax_element(inside.begin(), inside.end());
  const auto [lowOut, highOut] = std::minmax_element(outside.begin(), outside.end());
  const double low = std::min(*lowIn, *lowOut);
  const double width = (std::max(*highIn, *highOut) - low) / bins;
  const auto histogram = [&](const std::vector<float>& values) {
    std::vector<double> shares(std::size_t(bins), 0.0);
    for (const float v : values)
    {
      const int bin = width > 0.0 ? std::min(bins - 1, int((v - low) / width)) : 0;
      shares[std::size_t(bin)] += 1.0 / double(values.size());
    }
    return shares;
  };
  const auto a = histogram(inside);
  const auto b = histogram(outside);
  double overlap = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    overlap += std::min(a[i], b[i]);
  }
  return 1.0 - overlap;
}

Detectability detectability(const std::vector<float>& envelopeInside, const std::vector<float>& envelopeOutside,
                            const std::vector<float>& shownInside, const std::vector<float>& shownOutside)
{
  const Moments in = momentsOf(envelopeInside);
  const Moments out = momentsOf(envelopeOutside);
  Detectability d;
  d.gcnr = gcnrByThreshold(envelopeInside, envelopeOutside);
  d.gcnrShown = gcnrByThreshold(shownInside, shownOutside);
  d.cnr = std::fabs(in.mean - out.mean) / std::sqrt(in.variance + out.variance);
  d.contrastDb = 20.0 * std::log10(in.mean / out.mean);
  return d;
}

double gcnrOfSpeckle(double contrastDb, double looks)
{
  const double ratio = std::pow(10.0, std::fabs(contrastDb) / 10.0);
  if (ratio < 1.0 + 1e-9)
  {
    return 0.0;
  }
  const double crossing = looks * std::log(ratio) / (1.0 - 1.0 / ratio);
  return gammaBelow(looks, crossing) - gammaBelow(looks, crossing / ratio);
}

double gcnrOfNormalLevels(double differenceDb, double deviationDb)
{
  return std::erf(std::fabs(differenceDb) / (2.0 * std::sqrt(2.0) * deviationDb));
}

double gcnrErrorOfNormalLevels(const std::vector<MeasuredLesion>& lesions, double deviationDb)
{
  return meanError(lesions, [&](double contrastDb) { return gcnrOfNormalLevels(contrastDb, deviationDb); });
}

double leastGcnrErrorOfNormalLevels(const std::vector<MeasuredLesion>& lesions)
{
  return leastOf([&](double deviationDb) { return gcnrErrorOfNormalLevels(lesions, deviationDb); }, 0.1, 20.0);
}

double leastGcnrErrorOfLooks(const std::vector<MeasuredLesion>& lesions)
{
  return leastOf(
    [&](double looks) {
      return meanError(lesions, [&](double contrastDb) { return gcnrOfSpeckle(contrastDb, looks); });
    },
    1.0, 200.0);
}

double leastGcnrError(const std::vector<MeasuredLesion>& lesions, double meanContrastDb)
{
  constexpr double stepDb = 0.01;
  const int budget = int(meanContrastDb * double(lesions.size()) / stepDb + 0.5);
  std::vector<double> least(std::size_t(budget) + 1, 0.0); // of the lesions so far, for what they may be off together
  for (const MeasuredLesion& lesion : lesions)
  {
    std::vector<double> own; // of this one, for what it may be off
    for (int off = 0; off <= budget; ++off)
    {
      double error = off == 0 ? 1.0 : own.back();
      for (const double contrast :
           { std::fabs(lesion.contrastDb) - off * stepDb, std::fabs(lesion.contrastDb) + off * stepDb })
      {
        error = contrast >= 0.0 ? std::min(error, std::fabs(gcnrOfSpeckle(contrast) - lesion.gcnr)) : error;
      }
      own.push_back(error);
    }
    for (int together = budget; together >= 0; --together)
    {
      double best = 1e30;
      for (int off = 0; off <= together; ++off)
      {
        best = std::min(best, least[std::size_t(together - off)] + own[std::size_t(off)]);
      }
      least[std::size_t(together)] = best;
    }
  }
  return least.back() / double(lesions.size());
}

} // namespace sono::study
