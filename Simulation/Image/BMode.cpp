#include "Image/BMode.h"

#include "Core/LargeMemory.h"
#include "Core/ParallelFor.h"
#include "Core/Require.h"
#include "Core/Simd.h"
#include "Image/Haze.h"
#include "Image/ReceiverNoise.h"
#include "Kernel/GreyLevel.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>

namespace sono {
namespace {

/// The automatic reference leaves it out: the skin and what the transducer's own ringing would cover.
constexpr double nearFieldMm = 6.0;

/// Between sliders that stand in the middle of equal parts, at a share of the whole from 0 to 1.
double sliderGainDb(const GainSliders& sliders, double share)
{
  const double last = double(sliders.size() - 1);
  const double position = std::clamp(share * double(sliders.size()) - 0.5, 0.0, last);
  const auto i = std::size_t(std::min(position, last - 1.0));
  return sliders[i] + (position - double(i)) * (sliders[i + 1] - sliders[i]);
}

constexpr int chunk = 512; // samples whose bits are found together

SONO_SIMD_CLONES __attribute__((flatten)) void bitsOf(const float* __restrict envelope, const float* __restrict factor,
                                                      int count, std::uint32_t* __restrict bits)
{
  for (int s = 0; s < count; ++s)
  {
    bits[s] = gainedBits(envelope[s], factor[s]);
  }
}

SONO_SIMD_CLONES __attribute__((flatten)) void compress(const float* __restrict envelope,
                                                        const float* __restrict offsetDb, float lineDb, float rangeDb,
                                                        float rejectDb, int count, float* __restrict grey)
{
  for (int s = 0; s < count; ++s)
  {
    grey[s] = compressedLevel(envelope[s], offsetDb[s] + lineDb, rangeDb, rejectDb);
  }
}

/// Exact order statistic in two passes: the upper bits of the floats are counted, then the values that share the
/// wanted upper bits are sorted out. Counts and order statistics do not depend on who counted.
class RankSearch
{
public:
  /// Of the samples from `first` on of each line.
  RankSearch(const std::vector<float>& envelope, const std::vector<float>& factor, std::size_t first, int lineCount)
    : envelope_(envelope)
    , factor_(factor)
    , first_(first)
    , lineCount_(lineCount)
  {
    tbb::enumerable_thread_specific<Histogram> partial([] { return Histogram(binCount, 0u); });
    forEachChunk([&](const std::uint32_t* bits, int count) {
      auto& counts = partial.local();
      for (int s = 0; s < count; ++s)
      {
        ++counts[bits[s] >> lowBits];
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

  /// `work` is given the gained bits of some samples of a line, and how many these are.
  template<class Work>
  void forEachChunk(const Work& work) const
  {
    parallelFor(lineCount_, {}, [&](int l) {
      const float* line = envelope_.data() + std::size_t(l) * factor_.size();
      std::uint32_t bits[chunk];
      for (std::size_t first = first_; first < factor_.size(); first += chunk)
      {
        const int count = int(std::min<std::size_t>(chunk, factor_.size() - first));
        bitsOf(line + first, factor_.data() + first, count, bits);
        work(bits, count);
      }
    });
  }

  std::vector<std::uint32_t> collect(std::uint32_t bin) const
  {
    tbb::enumerable_thread_specific<std::vector<std::uint32_t>> partial;
    forEachChunk([&](const std::uint32_t* bits, int count) {
      auto& found = partial.local();
      std::copy_if(bits, bits + count, std::back_inserter(found),
                   [bin](std::uint32_t value) { return value >> lowBits == bin; });
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
  std::size_t first_;
  int lineCount_;
  Histogram histogram_ = Histogram(binCount, 0u);
};

double automaticReference(const std::vector<float>& envelope, int lineCount, const std::vector<double>& gainDb,
                          double sampleMm)
{
  std::vector<float> factor(gainDb.size());
  std::transform(gainDb.begin(), gainDb.end(), factor.begin(), gainFactor);
  const auto first = std::size_t(firstReferenceSample(int(factor.size()), sampleMm));
  const RankSearch search(envelope, factor, first, lineCount);
  const std::uint64_t count = (factor.size() - first) * std::uint64_t(lineCount);
  const float percentile = search.find(referenceRank(count));
  if (percentile >= smallestNormalFloat)
  {
    return whiteOverRank * double(percentile);
  }
  const float largest = search.find(count);
  return largest >= smallestNormalFloat ? largest : 1.0;
}

/// By its width at half height, in steps; empty where that is 0.
std::vector<float> gaussianOf(double width)
{
  std::vector<float> weights;
  const double sigma = width / std::sqrt(8.0 * std::log(2.0));
  for (int i = 0; width > 0.0 && i <= int(std::ceil(4.0 * sigma)); ++i)
  {
    weights.push_back(float(std::exp(-0.5 * (i / sigma) * (i / sigma))));
  }
  return weights;
}

void validateSizes(const std::vector<float>& envelope, int lineCount, int sampleCount, double sampleMm)
{
  requireInRange(lineCount >= 1, "lineCount", lineCount, "at least 1");
  requireInRange(sampleCount >= 1, "sampleCount", sampleCount, "at least 1");
  requireInRange(sampleMm > 0.0 && std::isfinite(sampleMm), "sampleMm", sampleMm, "positive and finite");
  if (envelope.size() != std::size_t(lineCount) * sampleCount)
  {
    throw Error(
      "The envelope has " + std::to_string(envelope.size()) +
      " values but must have lineCount x sampleCount = " + std::to_string(std::size_t(lineCount) * sampleCount) + ".");
  }
}

/// Envelopes or levels, along the lines and then across them.
std::vector<float> smooth(std::vector<float> values, int lineCount, int sampleCount, double sampleMm,
                          const BModeSettings& settings)
{
  const std::vector<float> axial = axialSmoothing(settings, sampleMm);
  const std::vector<float> lateral = lateralSmoothing(settings);
  std::vector<float> smoothed(axial.empty() && lateral.empty() ? 0 : values.size());
  if (!axial.empty())
  {
    parallelFor(lineCount, {}, [&](int l) {
      const std::size_t first = std::size_t(l) * std::size_t(sampleCount);
      for (int s = 0; s < sampleCount; ++s)
      {
        smoothed[first + std::size_t(s)] =
          smoothedEnvelope(values.data() + first, sampleCount, 1, s, axial.data(), int(axial.size()) - 1);
      }
    });
    values.swap(smoothed);
  }
  if (!lateral.empty())
  {
    const int across = linesAcross(settings, lineCount);
    parallelFor(lineCount, {}, [&](int l) {
      const float* plane = values.data() + std::size_t(l - l % across) * std::size_t(sampleCount);
      float* line = smoothed.data() + std::size_t(l) * std::size_t(sampleCount);
      for (int s = 0; s < sampleCount; ++s)
      {
        line[s] = smoothedEnvelope(plane + s, across, sampleCount, l % across, lateral.data(), int(lateral.size()) - 1);
      }
    });
    values.swap(smoothed);
  }
  return values;
}

/// The envelope with noise and haze, smoothed where it is what is.
std::vector<float> receive(std::vector<float> envelope, int lineCount, int sampleCount, double sampleMm,
                           const BModeSettings& settings)
{
  if (settings.addNoise)
  {
    addReceiverNoise(envelope, sampleCount, settings.noiseDb, settings.pulseSigmaMm / sampleMm, settings.noiseSeed);
  }
  const HazePower haze = makeHaze(settings, lineCount, sampleCount, sampleMm);
  parallelFor(lineCount, {}, [&](int l) {
    float* line = envelope.data() + std::size_t(l) * std::size_t(sampleCount);
    const float* power = haze.power.data() + std::size_t(l) * std::size_t(haze.nodeCount);
    for (int s = 0; haze.nodeCount > 0 && s < sampleCount; ++s)
    {
      line[s] = hazyEnvelope(line[s], power, float(s) * haze.nodesPerSample);
    }
  });
  return settings.smoothCompressed ? std::move(envelope)
                                   : smooth(std::move(envelope), lineCount, sampleCount, sampleMm, settings);
}

} // namespace

int firstReferenceSample(int sampleCount, double sampleMm)
{
  const double near = std::ceil(nearFieldMm / sampleMm);
  return near < sampleCount ? int(near) : 0; // a line that ends there has nothing else
}

std::vector<double> depthGainDb(const BModeSettings& settings, int sampleCount, double sampleMm)
{
  std::vector<double> gain(sampleCount);
  for (int s = 0; s < sampleCount; ++s)
  {
    const double depthMm = s * sampleMm * settings.shownPerRange;
    gain[s] =
      settings.tgcDbPerCm * depthMm / 10.0 + sliderGainDb(settings.tgcDb, double(s) / std::max(1, sampleCount - 1));
  }
  return gain;
}

std::vector<float> lateralGainDb(const BModeSettings& settings, int lineCount)
{
  const int across = linesAcross(settings, lineCount);
  std::vector<float> gain(lineCount);
  for (int l = 0; l < lineCount; ++l)
  {
    gain[l] = float(sliderGainDb(settings.lateralGainDb, (l % across + 0.5) / across));
  }
  return gain;
}

std::vector<float> axialSmoothing(const BModeSettings& settings, double sampleMm)
{
  return gaussianOf(settings.axialSmoothingMm / (sampleMm * settings.shownPerRange));
}

std::vector<float> lateralSmoothing(const BModeSettings& settings)
{
  return gaussianOf(settings.lateralSmoothingLines);
}

int linesAcross(const BModeSettings& settings, int lineCount)
{
  return settings.linesAcross > 0 ? settings.linesAcross : lineCount;
}

float gainFactor(double decibels)
{
  return static_cast<float>(std::min(std::pow(10.0, decibels / 20.0), double(largestFiniteFloat)));
}

BModeLines makeBMode(const std::vector<float>& echoEnvelope, int lineCount, int sampleCount, double sampleMm,
                     const BModeSettings& settings)
{
  settings.validate();
  validateSizes(echoEnvelope, lineCount, sampleCount, sampleMm);

  const bool smooths = settings.axialSmoothingMm > 0.0 || settings.lateralSmoothingLines > 0.0;
  std::vector<float> received;
  if (settings.addNoise || settings.addHaze || (smooths && !settings.smoothCompressed))
  {
    received = receive(echoEnvelope, lineCount, sampleCount, sampleMm, settings);
  }
  const std::vector<float>& envelope = received.empty() ? echoEnvelope : received;
  const std::vector<double> gainDb = depthGainDb(settings, sampleCount, sampleMm);
  BModeLines result{ lineCount, sampleCount, sampleMm, settings.referenceAmplitude, {} };
  if (settings.automaticReference)
  {
    result.referenceAmplitude = automaticReference(envelope, lineCount, gainDb, sampleMm);
  }

  const double constantDb = settings.gainDb - 20.0 * std::log10(result.referenceAmplitude) + settings.dynamicRangeDb;
  std::vector<float> offsetDb(sampleCount);
  std::transform(gainDb.begin(), gainDb.end(), offsetDb.begin(),
                 [&](double decibels) { return static_cast<float>(decibels + constantDb); });

  result.grey = largeVector<float>(envelope.size());
  float* grey = result.grey.data();
  const auto rangeDb = static_cast<float>(settings.dynamicRangeDb);
  const auto rejectDb = static_cast<float>(settings.rejectDb);
  const std::vector<float> lineDb = lateralGainDb(settings, lineCount);
  parallelFor(lineCount, {}, [&](int l) {
    const std::size_t first = std::size_t(l) * sampleCount;
    compress(envelope.data() + first, offsetDb.data(), lineDb[l], rangeDb, rejectDb, sampleCount, grey + first);
  });
  if (smooths && settings.smoothCompressed)
  {
    result.grey = smooth(std::move(result.grey), lineCount, sampleCount, sampleMm, settings);
  }
  if (!settings.greyMap.empty())
  {
    parallelFor(lineCount, {}, [&](int l) {
      float* line = result.grey.data() + std::size_t(l) * std::size_t(sampleCount);
      std::transform(line, line + sampleCount, line,
                     [&](float x) { return mapGrey(settings.greyMap.data(), int(settings.greyMap.size()), x); });
    });
  }
  return result;
}

} // namespace sono
