#include "Echo/SampleLoops.h"

#include "Core/Simd.h"
#include "Kernel/ReverberationNoise.h"
#include "Kernel/TimeOfFlight.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr int block = samplePadding;
constexpr int shortBlock = block / 2; // eight samples a period are six or seven a bin

/// The first sample at or behind a place. Within the loops, so that it is compiled for their instruction sets.
__attribute__((always_inline)) inline int sampleAt(double place, int count)
{
  return int(std::clamp(std::ceil(place), 0.0, double(count)));
}

} // namespace

SONO_SIMD_CLONES void linearAtSamples(const float* bins, int binCount, double binsPerSample, int count, float* out)
{
  const float rise = float(binsPerSample);
  const double samplesPerBin = 1.0 / binsPerSample;
  int from = 0;
  for (int k = -1; k < binCount && from < count; ++k)
  {
    const int to = k + 1 < binCount ? sampleAt((k + 1.5) * samplesPerBin, count) : count;
    const float a = bins[std::max(k, 0)];
    const float difference = bins[std::min(k + 1, binCount - 1)] - a;
    const float share = float(from * binsPerSample - 0.5 - k);
    for (int s = from; s < to; s += shortBlock)
    {
      for (int i = 0; i < shortBlock; ++i)
      {
        out[s + i] = a + difference * (share + float(s - from + i) * rise);
      }
    }
    from = to;
  }
}

SONO_SIMD_CLONES void binAtSamples(const float* bins, int binCount, double binsPerSample, int count, float* out)
{
  const double samplesPerBin = 1.0 / binsPerSample;
  int from = 0;
  for (int k = 0; k < binCount && from < count; ++k)
  {
    const int to = k + 1 < binCount ? sampleAt((k + 1) * samplesPerBin, count) : count;
    for (int s = from; s < to; s += block)
    {
      std::fill_n(out + s, block, bins[k]);
    }
    from = to;
  }
}

SONO_SIMD_CLONES void offsetsAtSamples(const RangeMap& map, float sampleMm, int count, float* out)
{
  const double binsPerSample = double(map.perBinMm) * double(sampleMm);
  const float perSampleMm = 1.0f / sampleMm;
  const float rise = float(binsPerSample);
  const double samplesPerBin = 1.0 / binsPerSample;
  int from = 0;
  for (int k = 0; k < map.bins && from < count; ++k)
  {
    const bool isLast = k + 1 == map.bins;
    const int to = isLast ? count : sampleAt((k + 1) * samplesPerBin, count);
    const float* at = map.offsetMm + k;
    // As bentAt.
    const float a = at[0] * perSampleMm;
    const float here = isLast ? 0.0f : at[1] * perSampleMm - a;
    const float before = !isLast && k > 0 ? a - at[-1] * perSampleMm : here;
    const float behind = k + 2 < map.bins ? (at[2] - at[1]) * perSampleMm : here;
    const Slopes slopes{ before, here, behind };
    const float share = float(from * binsPerSample - k);
    for (int s = from; s < to; s += block)
    {
      for (int i = 0; i < block; ++i)
      {
        const float way = share + float(s - from + i) * rise;
        out[s + i] = bentBetween(a, a + here, way, 1.0f - way, slopes);
      }
    }
    from = to;
  }
}

SONO_SIMD_CLONES int lastOther(const float* values, int count)
{
  constexpr int part = 256;
  while (count >= part)
  {
    const float* from = values + count - part;
    int others = 0;
    for (int i = 0; i < part; ++i)
    {
      others += from[i] != 0.0f ? 1 : 0;
    }
    if (others > 0)
    {
      break;
    }
    count -= part;
  }
  while (count > 0 && values[count - 1] == 0.0f)
  {
    --count;
  }
  return count;
}

SONO_SIMD_CLONES void scaleAndAdd(const float* iq, const float* factor, const float* added, int count, SamplePair out)
{
  float* re = out.re;
  float* im = out.im;
  if (factor && added)
  {
    for (int s = 0; s < count; ++s)
    {
      re[s] = iq[2 * s] * factor[s] + added[2 * s];
      im[s] = iq[2 * s + 1] * factor[s] + added[2 * s + 1];
    }
    return;
  }
  for (int s = 0; s < count; ++s)
  {
    const float f = factor ? factor[s] : 1.0f;
    re[s] = iq[2 * s] * f + (added ? added[2 * s] : 0.0f);
    im[s] = iq[2 * s + 1] * f + (added ? added[2 * s + 1] : 0.0f);
  }
}

Carrier::Carrier(double radians, std::size_t count)
  : radPerSample(float(radians))
{
  // The quotient of neighbouring ones is the same: in double, its errors do not show after any number of samples.
  const std::complex<double> half = std::polar(1.0, -0.5 * radians);
  std::complex<double> at = 1.0;
  for (std::vector<float>* values : { &re, &im, &middleRe, &middleIm })
  {
    values->resize(count);
  }
  for (std::size_t s = 0; s < count; ++s)
  {
    re[s] = float(at.real());
    im[s] = float(at.imag());
    at *= half;
    middleRe[s] = float(at.real());
    middleIm[s] = float(at.imag());
    at *= half;
  }
}

SONO_SIMD_CLONES void demodulate(const SamplePair& in, const Carrier& carrier, int count, SamplePair out)
{
  const float* a = in.re;
  const float* b = in.im;
  const float* re = carrier.re.data();
  const float* im = carrier.im.data();
  float* outRe = out.re;
  float* outIm = out.im;
  for (int s = 0; s < count; ++s)
  {
    outRe[s] = a[s] * re[s] - b[s] * im[s];
    outIm[s] = a[s] * im[s] + b[s] * re[s];
  }
}

SONO_SIMD_CLONES void addDemodulated(const float* iq, const Carrier& carrier, int count, SamplePair out)
{
  const float* re = carrier.re.data();
  const float* im = carrier.im.data();
  float* outRe = out.re;
  float* outIm = out.im;
  for (int s = 0; s < count; ++s)
  {
    const float a = iq[2 * s];
    const float b = iq[2 * s + 1];
    outRe[s] += a * re[s] - b * im[s];
    outIm[s] += a * im[s] + b * re[s];
  }
}

SONO_SIMD_CLONES __attribute__((flatten)) void showDepths(const SamplePair& byDepth, int depthCount,
                                                          const float* offset, const Carrier& carrier, int count,
                                                          SamplePair out, std::vector<float>& room)
{
  room.resize(3 * std::size_t(count));
  float* farRe = room.data();
  float* farIm = farRe + count;
  float* depths = farIm + count; // that lie between this sample of range and the next
  float* nearRe = out.re;
  float* nearIm = out.im;
  const float* re = byDepth.re;
  const float* im = byDepth.im;
  const float* middleRe = carrier.middleRe.data();
  const float* middleIm = carrier.middleIm.data();
  const float radPerSample = carrier.radPerSample;
  // Depths are counted from the sample of range, since a float would not do for both. A step ends where the next one
  // begins, also where the two round differently. The first depth of each:
#pragma GCC ivdep
  for (int s = 0; s < count; ++s)
  {
    const float from = offset[s];
    const float to = 1.0f + offset[s + 1];
    const float first = std::ceil(from);
    const int d = s + int(first);
    const int held = std::min(std::max(d, 0), depthCount - 1);
    const float end = 1.0f + std::ceil(offset[s + 1]);
    const float isThere = (first < end) & (d == held) ? 1.0f : 0.0f;
    const float share = smaller((first - from) / larger(to - from, 1e-6f), 1.0f);
    const ShownSample shown =
      shownSample(isThere * re[held], isThere * im[held], (share - 0.5f) * radPerSample, middleRe[s], middleIm[s]);
    nearRe[s] = (1.0f - share) * shown.re;
    nearIm[s] = (1.0f - share) * shown.im;
    farRe[s] = share * shown.re;
    farIm[s] = share * shown.im;
    depths[s] = end - first;
  }
  // Where sound is faster than assumed there is another now and then.
  for (int s = 0; s < count; ++s)
  {
    if (depths[s] > 1.0f)
    {
      const float from = offset[s];
      const float perSample = 1.0f / larger(1.0f + offset[s + 1] - from, 1e-6f);
      const int first = int(std::ceil(from));
      for (int n = std::max(1, -(s + first)); n < int(depths[s]) && s + first + n < depthCount; ++n)
      {
        const float share = (float(first + n) - from) * perSample;
        const ShownSample shown =
          shownSample(re[s + first + n], im[s + first + n], (share - 0.5f) * radPerSample, middleRe[s], middleIm[s]);
        nearRe[s] += (1.0f - share) * shown.re;
        nearIm[s] += (1.0f - share) * shown.im;
        farRe[s] += share * shown.re;
        farIm[s] += share * shown.im;
      }
    }
  }
  for (int s = 1; s < count; ++s)
  {
    nearRe[s] += farRe[s - 1];
    nearIm[s] += farIm[s - 1];
  }
}

SONO_SIMD_CLONES void addSpeckle(const std::complex<float>* const nodes[4], const float weights[4], const float* level,
                                 int count, std::complex<float>* iq)
{
  const auto* a = reinterpret_cast<const float*>(nodes[0]);
  const auto* b = reinterpret_cast<const float*>(nodes[1]);
  const auto* c = reinterpret_cast<const float*>(nodes[2]);
  const auto* d = reinterpret_cast<const float*>(nodes[3]);
  auto* out = reinterpret_cast<float*>(iq);
  for (int s = 0; s < count; ++s)
  {
    const float strength = level[s] > faintestReverberation ? level[s] : 0.0f;
    const int n = 2 * s;
    out[n] += strength * (weights[0] * a[n] + weights[1] * b[n] + weights[2] * c[n] + weights[3] * d[n]);
    out[n + 1] +=
      strength * (weights[0] * a[n + 1] + weights[1] * b[n + 1] + weights[2] * c[n + 1] + weights[3] * d[n + 1]);
  }
}

SONO_SIMD_CLONES __attribute__((flatten)) void exponentsAtSamples(const Downshift& downshift, const float* npByDepth,
                                                                  int depthCount, const float* offset, int count,
                                                                  float* out)
{
  const Downshift d = downshift;
  for (int s = 0; s < count; ++s)
  {
    const int shown = s + (offset ? int(std::floor(offset[s] + 0.5f)) : 0);
    const int held = shown < 0 ? 0 : (shown < depthCount ? shown : depthCount - 1);
    out[s] = shiftingExponent(d, npByDepth[held]);
  }
}

SONO_SIMD_CLONES __attribute__((flatten)) void applySinkGain(const Downshift& downshift, const float* exponent,
                                                             int count, SamplePair out)
{
  const Downshift d = downshift;
  float* re = out.re;
  float* im = out.im;
  for (int s = 0; s < count; ++s)
  {
    const float gain = downshiftGain(d, shiftingExponent(d, exponent[s]));
    re[s] *= gain;
    im[s] *= gain;
  }
}

SONO_SIMD_CLONES __attribute__((flatten)) void downshiftRotations(const Downshift& downshift, const float* exponent,
                                                                  int count, SamplePair out)
{
  // In parts of a turn that are whole numbers, so that the sum is exact, and whole turns fall out of it.
  constexpr float partsPerTurn = 4294967296.0f;
  const Downshift d = downshift;
  float* re = out.re;
  float* im = out.im;
  std::uint32_t parts = 0;
  for (int s = 0; s < count; ++s)
  {
    re[s] = float(std::int32_t(parts));
    const float mean = s + 1 < count ? 0.5f * (exponent[s] + exponent[s + 1]) : exponent[s];
    parts += std::uint32_t(std::int32_t(downshiftTurns(d, mean) * partsPerTurn));
  }
  for (int s = 0; s < count; ++s)
  {
    const DownshiftAt turned = downshiftRotation(re[s] * (1.0f / partsPerTurn));
    re[s] = turned.re;
    im[s] = turned.im;
  }
}

SONO_SIMD_CLONES void rotate(const float* turnRe, const float* turnIm, int count, SamplePair v)
{
  float* re = v.re;
  float* im = v.im;
  for (int s = 0; s < count; ++s)
  {
    const float a = re[s];
    const float b = im[s];
    re[s] = a * turnRe[s] - b * turnIm[s];
    im[s] = a * turnIm[s] + b * turnRe[s];
  }
}

SONO_SIMD_CLONES void rotateBack(const float* re, const float* im, const float* turnRe, const float* turnIm, int count,
                                 std::complex<float>* out)
{
  float* iq = reinterpret_cast<float*>(out);
  for (int s = 0; s < count; ++s)
  {
    iq[2 * s] = re[s] * turnRe[s] + im[s] * turnIm[s];
    iq[2 * s + 1] = im[s] * turnRe[s] - re[s] * turnIm[s];
  }
}

SONO_SIMD_CLONES void interleave(const float* re, const float* im, int count, std::complex<float>* out)
{
  float* iq = reinterpret_cast<float*>(out);
  for (int s = 0; s < count; ++s)
  {
    iq[2 * s] = re[s];
    iq[2 * s + 1] = im[s];
  }
}

} // namespace sono
