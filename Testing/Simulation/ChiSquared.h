#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace sono::test {

/// Regularised upper incomplete gamma function Q(a, x), a > 0, x >= 0: by the series of P below a + 1, by Lentz's
/// continued fraction above (Abramowitz and Stegun 6.5.29 and 6.5.31). Relative error below 1e-10.
inline double upperGamma(double a, double x)
{
  const double factor = x > 0.0 ? std::exp(a * std::log(x) - x - std::lgamma(a)) : 0.0;
  if (x < a + 1.0)
  {
    double term = 1.0 / a;
    double sum = term;
    for (int n = 1; n < 10000 && term > sum * 1e-16; ++n)
    {
      term *= x / (a + n);
      sum += term;
    }
    return 1.0 - factor * sum;
  }
  double b = x + 1.0 - a;
  double c = 1e300;
  double d = 1.0 / b;
  double fraction = d;
  for (int n = 1; n < 10000; ++n)
  {
    const double an = -n * (n - a);
    b += 2.0;
    d = 1.0 / (an * d + b);
    c = b + an / c;
    const double change = c * d;
    fraction *= change;
    if (std::abs(change - 1.0) < 1e-15)
    {
      break;
    }
  }
  return factor * fraction;
}

/// Probability of a chi-squared statistic at least this large.
inline double chiSquaredTail(double statistic, double degreesOfFreedom)
{
  return upperGamma(0.5 * degreesOfFreedom, 0.5 * statistic);
}

/// p-value of observed counts against the probabilities of their cells. Cells with fewer than five expected counts are
/// pooled into one. A count in a cell of probability 0 gives p = 0.
inline double chiSquaredPValue(const std::vector<double>& observed, const std::vector<double>& probability)
{
  double total = 0.0;
  for (const double o : observed)
  {
    total += o;
  }
  double statistic = 0.0;
  double pooledObserved = 0.0;
  double pooledExpected = 0.0;
  int cells = 0;
  for (std::size_t i = 0; i < observed.size(); ++i)
  {
    const double expected = total * probability[i];
    if (expected < 5.0)
    {
      pooledObserved += observed[i];
      pooledExpected += expected;
      continue;
    }
    statistic += (observed[i] - expected) * (observed[i] - expected) / expected;
    ++cells;
  }
  if (pooledExpected > 0.0)
  {
    statistic += (pooledObserved - pooledExpected) * (pooledObserved - pooledExpected) / pooledExpected;
    ++cells;
  }
  else if (pooledObserved > 0.0)
  {
    return 0.0;
  }
  return cells > 1 ? chiSquaredTail(statistic, cells - 1.0) : 1.0;
}

/// The level a single one of `tests` must keep so that all of them together keep 0.001 (Bonferroni).
inline double significanceOfEach(int tests)
{
  return 0.001 / tests;
}

/// p-value of the independence of two numbers in [0, 1): counts in a table of cells x cells, whose margins are given.
inline double independencePValue(const std::vector<double>& table, int cells)
{
  std::vector<double> row(std::size_t(cells), 0.0);
  std::vector<double> column(std::size_t(cells), 0.0);
  double total = 0.0;
  for (int i = 0; i < cells * cells; ++i)
  {
    row[std::size_t(i / cells)] += table[std::size_t(i)];
    column[std::size_t(i % cells)] += table[std::size_t(i)];
    total += table[std::size_t(i)];
  }
  double statistic = 0.0;
  for (int i = 0; i < cells * cells; ++i)
  {
    const double expected = row[std::size_t(i / cells)] * column[std::size_t(i % cells)] / total;
    statistic += (table[std::size_t(i)] - expected) * (table[std::size_t(i)] - expected) / expected;
  }
  return chiSquaredTail(statistic, double(cells - 1) * (cells - 1));
}

} // namespace sono::test
