#include "Detectability.h"

#include <algorithm>
#include <cmath>

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

/// Probability that a gamma variable of shape m and scale 1 exceeds x.
double gammaTail(int m, double x)
{
  double term = 1.0;
  double sum = 0.0;
  for (int k = 0; k < m; ++k)
  {
    sum += term;
    term *= x / (k + 1);
  }
  return std::exp(-x) * sum;
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

double gcnrOfSpeckle(double contrastDb, int looks)
{
  const double ratio = std::pow(10.0, std::fabs(contrastDb) / 10.0);
  if (ratio < 1.0 + 1e-9)
  {
    return 0.0;
  }
  const double crossing = looks * std::log(ratio) / (1.0 - 1.0 / ratio);
  return gammaTail(looks, crossing / ratio) - gammaTail(looks, crossing);
}

double leastGcnrError(const std::vector<MeasuredLesion>& lesions, double meanContrastDb)
{
  double bound = 0.0;
  for (double multiplier = 0.0; multiplier < 0.2; multiplier += 0.0005)
  {
    double value = 0.0;
    for (const MeasuredLesion& lesion : lesions)
    {
      double best = 1e30;
      for (double contrast = 0.0; contrast < 40.0; contrast += 0.01)
      {
        best = std::min(best, std::fabs(gcnrOfSpeckle(contrast) - lesion.gcnr) +
                                multiplier * std::fabs(contrast - std::fabs(lesion.contrastDb)));
      }
      value += best / double(lesions.size());
    }
    bound = std::max(bound, value - multiplier * meanContrastDb);
  }
  return bound;
}

} // namespace sono::study
