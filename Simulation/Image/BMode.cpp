#include "Image/BMode.h"

#include "Image/PixelMath.h"
#include "Image/ReceiverNoise.h"
#include "Progress.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <sstream>

namespace sono {
namespace {

constexpr float smallestNormal = std::numeric_limits<float>::min();
constexpr float largestFinite = std::numeric_limits<float>::max();

void require(bool good, const char* parameter, double value, const char* range)
{
  if (!good)
  {
    std::ostringstream message;
    message << parameter << " is " << value << " but must be " << range << ".";
    throw Error(message.str());
  }
}

bool within(double value, double low, double high)
{
  return value >= low && value <= high; // false for NaN
}

double curveGainDb(const std::vector<std::pair<double, double>>& curve, double depthMm)
{
  if (curve.empty())
  {
    return 0.0;
  }
  const auto above = std::upper_bound(curve.begin(), curve.end(), depthMm,
                                      [](double depth, const auto& point) { return depth < point.first; });
  if (above == curve.begin())
  {
    return curve.front().second;
  }
  if (above == curve.end())
  {
    return curve.back().second;
  }
  const auto& [depthA, gainA] = *(above - 1);
  const auto& [depthB, gainB] = *above;
  return gainA + (gainB - gainA) * (depthMm - depthA) / (depthB - depthA);
}

std::vector<double> depthGainDb(const BModeSettings& settings, int sampleCount, double sampleMm)
{
  std::vector<double> gain(sampleCount);
  for (int s = 0; s < sampleCount; ++s)
  {
    const double depthMm = s * sampleMm;
    gain[s] = settings.tgcDbPerCm * depthMm / 10.0 + curveGainDb(settings.tgcCurve, depthMm);
  }
  return gain;
}

/// The bits of the gained envelope, which order as the non-negative floats do; 0 for what is no amplitude.
std::uint32_t gainedBits(float envelope, float factor)
{
  const bool usable = envelope > 0.0f && envelope <= largestFinite;
  const float gained = std::min(usable ? envelope * factor : 0.0f, largestFinite);
  std::uint32_t bits;
  std::memcpy(&bits, &gained, sizeof bits);
  return bits;
}

/// Exact order statistic in two passes: the upper bits of the floats are counted, then the values that share the
/// wanted upper bits are sorted out. Counts and order statistics do not depend on who counted.
class RankSearch
{
public:
  RankSearch(const std::vector<float>& envelope, const std::vector<float>& factor, int lineCount)
    : envelope_(envelope)
    , factor_(factor)
    , lineCount_(lineCount)
  {
    tbb::enumerable_thread_specific<Histogram> partial([] { return Histogram(binCount, 0u); });
    forEachLine([&](const float* line) {
      auto& counts = partial.local();
      for (std::size_t s = 0; s < factor_.size(); ++s)
      {
        ++counts[gainedBits(line[s], factor_[s]) >> lowBits];
      }
    });
    for (const auto& counts : partial)
    {
      std::transform(counts.begin(), counts.end(), histogram_.begin(), histogram_.begin(), std::plus<>());
    }
  }

  /// The value of 1-based rank `rank` in ascending order.
  float find(std::uint64_t rank) const
  {
    std::uint32_t bin = 0;
    while (rank > histogram_[bin])
    {
      rank -= histogram_[bin++];
    }
    std::vector<std::uint32_t> candidates = collect(bin);
    const auto wanted = candidates.begin() + static_cast<std::ptrdiff_t>(rank - 1);
    std::nth_element(candidates.begin(), wanted, candidates.end());
    float value;
    std::memcpy(&value, &*wanted, sizeof value);
    return value;
  }

private:
  using Histogram = std::vector<std::uint32_t>;
  static constexpr int lowBits = 16;
  static constexpr std::size_t binCount = std::size_t(1) << (31 - lowBits);

  template<class Work>
  void forEachLine(const Work& work) const
  {
    tbb::parallel_for(tbb::blocked_range<int>(0, lineCount_), [&](const tbb::blocked_range<int>& lines) {
      for (int l = lines.begin(); l < lines.end(); ++l)
      {
        work(envelope_.data() + l * factor_.size());
      }
    });
  }

  std::vector<std::uint32_t> collect(std::uint32_t bin) const
  {
    tbb::enumerable_thread_specific<std::vector<std::uint32_t>> partial;
    forEachLine([&](const float* line) {
      auto& found = partial.local();
      for (std::size_t s = 0; s < factor_.size(); ++s)
      {
        const std::uint32_t bits = gainedBits(line[s], factor_[s]);
        if (bits >> lowBits == bin)
        {
          found.push_back(bits);
        }
      }
    });
    std::vector<std::uint32_t> all;
    for (const auto& found : partial)
    {
      all.insert(all.end(), found.begin(), found.end());
    }
    return all;
  }

  const std::vector<float>& envelope_;
  const std::vector<float>& factor_;
  int lineCount_;
  Histogram histogram_ = Histogram(binCount, 0u);
};

double automaticReference(const std::vector<float>& envelope, int lineCount, const std::vector<double>& gainDb)
{
  std::vector<float> factor(gainDb.size());
  std::transform(gainDb.begin(), gainDb.end(), factor.begin(), [](double decibels) {
    return static_cast<float>(std::min(std::pow(10.0, decibels / 20.0), double(largestFinite)));
  });
  const RankSearch search(envelope, factor, lineCount);
  const std::uint64_t count = envelope.size();
  const float percentile = search.find(count - count / 1000); // ceil(0.999 n) without rounding
  if (percentile >= smallestNormal)
  {
    return percentile;
  }
  const float largest = search.find(count);
  return largest >= smallestNormal ? largest : 1.0;
}

/// One line, in a form that vectorises: a comparison with NaN is false, so that NaN ends up black.
void compressLine(const float* envelope, const std::vector<float>& offsetDb, float rangeDb, float rejectDb, float* grey)
{
  const float perRange = 1.0f / rangeDb;
  const std::size_t count = offsetDb.size();
  for (std::size_t s = 0; s < count; ++s)
  {
    const float e = envelope[s];
    const float floored = e > smallestNormal ? e : smallestNormal;
    const float usable = floored < largestFinite ? floored : largestFinite;
    const float aboveBottomDb = fastDecibels(usable) + offsetDb[s];
    const float capped = aboveBottomDb < rangeDb ? aboveBottomDb : rangeDb;
    const bool shown = (e >= smallestNormal) & (capped > 0.0f) & (capped >= rejectDb);
    grey[s] = shown ? capped * perRange : 0.0f;
  }
}

void mapLine(GreyMap map, std::size_t count, float* grey)
{
  switch (map)
  {
    case GreyMap::Linear:
      return;
    case GreyMap::SquareRoot:
      std::transform(grey, grey + count, grey, [](float x) { return std::sqrt(x); });
      return;
    case GreyMap::Sigmoid:
      std::transform(grey, grey + count, grey, [](float x) { return x * x * (3.0f - 2.0f * x); });
      return;
  }
}

void validateSizes(const std::vector<float>& envelope, int lineCount, int sampleCount, double sampleMm)
{
  require(lineCount >= 1, "lineCount", lineCount, "at least 1");
  require(sampleCount >= 1, "sampleCount", sampleCount, "at least 1");
  require(sampleMm > 0.0 && std::isfinite(sampleMm), "sampleMm", sampleMm, "positive and finite");
  if (envelope.size() != std::size_t(lineCount) * sampleCount)
  {
    throw Error(
      "The envelope has " + std::to_string(envelope.size()) +
      " values but must have lineCount x sampleCount = " + std::to_string(std::size_t(lineCount) * sampleCount) + ".");
  }
}

} // namespace

void BModeSettings::validate() const
{
  require(within(tgcDbPerCm, -100.0, 100.0), "tgcDbPerCm", tgcDbPerCm, "in [-100, 100] dB/cm");
  require(within(gainDb, -300.0, 300.0), "gainDb", gainDb, "in [-300, 300] dB");
  require(automaticReference || (referenceAmplitude >= smallestNormal && referenceAmplitude <= largestFinite),
          "referenceAmplitude", referenceAmplitude, "in [1.2e-38, 3.4e38]");
  require(dynamicRangeDb > 0.0 && dynamicRangeDb <= 300.0, "dynamicRangeDb", dynamicRangeDb, "in (0, 300] dB");
  require(rejectDb >= 0.0 && rejectDb < dynamicRangeDb, "rejectDb", rejectDb, "in [0, dynamicRangeDb) dB");
  require(greyMap == GreyMap::Linear || greyMap == GreyMap::SquareRoot || greyMap == GreyMap::Sigmoid, "greyMap",
          double(int(greyMap)), "linear (0), square root (1) or sigmoid (2)");
  require(noiseDb <= 200.0, "noiseDb", noiseDb, "at most 200 dB, or minus infinity for none");
  double previousMm = -std::numeric_limits<double>::infinity();
  for (const auto& [depthMm, gain] : tgcCurve)
  {
    require(std::isfinite(depthMm) && depthMm > previousMm, "A depth of tgcCurve", depthMm,
            "finite and greater than the depth before it, in mm");
    require(within(gain, -300.0, 300.0), "A gain of tgcCurve", gain, "in [-300, 300] dB");
    previousMm = depthMm;
  }
}

BModeLines makeBMode(const std::vector<float>& echoEnvelope, int lineCount, int sampleCount, double sampleMm,
                     const BModeSettings& settings)
{
  settings.validate();
  validateSizes(echoEnvelope, lineCount, sampleCount, sampleMm);

  std::vector<float> noisy;
  const bool hasNoise = settings.noiseDb > -std::numeric_limits<double>::infinity();
  if (hasNoise)
  {
    noisy = echoEnvelope;
    addReceiverNoise(noisy, sampleCount, settings.noiseDb, settings.noiseSeed);
  }
  const std::vector<float>& envelope = hasNoise ? noisy : echoEnvelope;
  const std::vector<double> gainDb = depthGainDb(settings, sampleCount, sampleMm);
  BModeLines result{ lineCount, sampleCount, sampleMm, settings.referenceAmplitude, {} };
  if (settings.automaticReference)
  {
    result.referenceAmplitude = automaticReference(envelope, lineCount, gainDb);
  }

  const double constantDb = settings.gainDb - 20.0 * std::log10(result.referenceAmplitude) + settings.dynamicRangeDb;
  std::vector<float> offsetDb(sampleCount);
  std::transform(gainDb.begin(), gainDb.end(), offsetDb.begin(),
                 [&](double decibels) { return static_cast<float>(decibels + constantDb); });

  result.grey.resize(envelope.size());
  tbb::parallel_for(tbb::blocked_range<int>(0, lineCount), [&](const tbb::blocked_range<int>& lines) {
    for (int l = lines.begin(); l < lines.end(); ++l)
    {
      const std::size_t first = std::size_t(l) * sampleCount;
      compressLine(envelope.data() + first, offsetDb, static_cast<float>(settings.dynamicRangeDb),
                   static_cast<float>(settings.rejectDb), result.grey.data() + first);
      mapLine(settings.greyMap, std::size_t(sampleCount), result.grey.data() + first);
    }
  });
  return result;
}

} // namespace sono
