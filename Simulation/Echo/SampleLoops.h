#pragma once

#include "Kernel/Downshift.h"
#include "Kernel/Vec.h"

#include <complex>
#include <vector>

// The loops over a line's samples that LineFinisher is made of, in vectors. Tables along a line have bins of many
// samples: they are laid out at the samples piece by piece, without a look at the table for each. A piece is written in
// whole vectors, the next one over its end: what such a loop fills has samplePadding more than it says.

namespace sono {

struct RangeMap;

constexpr int samplePadding = 16;

/// Room for so many samples.
inline std::vector<float> sampleRoom(std::size_t count)
{
  return std::vector<float>(count + samplePadding, 0.0f);
}

/// Values that are known in the middles of bins, straight in between and beyond as at the ends, at samples
/// `binsPerSample` apart, the first where the first bin begins.
void linearAtSamples(const float* bins, int binCount, double binsPerSample, int count, float* out);

/// The value of the bin that a sample lies in.
void binAtSamples(const float* bins, int binCount, double binsPerSample, int count, float* out);

/// Depth less range, in samples, at each sample of range: RangeMap::depthOf.
void offsetsAtSamples(const RangeMap& map, float sampleMm, int count, float* out);

/// How many values there are up to the last that is not 0.
int lastOther(const float* values, int count);

/// re + i im, as two arrays, at the samples of a line.
struct SamplePair
{
  float* re;
  float* im;
};

/// `iq` (re, im of each) times `factor`, null: 1, plus `added` (the same), null: 0.
void scaleAndAdd(const float* iq, const float* factor, const float* added, int count, SamplePair out);

/// A carrier, exp(-i phase), at the samples and halfway between each and the next.
struct Carrier
{
  std::vector<float> re, im;
  std::vector<float> middleRe, middleIm;
  float radPerSample; ///< below pi

  Carrier(double radPerSample, std::size_t count);
};

/// What lies at the samples times the carrier there.
void demodulate(const SamplePair& in, const Carrier& carrier, int count, SamplePair out);

/// Adds the same of (re, im) of each.
void addDemodulated(const float* iq, const Carrier& carrier, int count, SamplePair out);

/// What lies at samples of depth, `depthCount`, demodulated where it is shown: between two samples of range, split
/// between both; `offset` is that of offsetsAtSamples for one sample more. `room` is for `count` samples more.
void showDepths(const SamplePair& byDepth, int depthCount, const float* offset, const Carrier& carrier, int count,
                SamplePair out, std::vector<float>& room);

/// The speckle of what reverberates: adds to each sample the blend of four nodes, times the level, unless it is not
/// worth it.
void addSpeckle(const std::complex<float>* const nodes[4], const float weights[4], const float* level, int count,
                std::complex<float>* iq);

/// B of the downshift at samples of range, from that by depth.
void exponentsAtSamples(const Downshift& downshift, const float* npByDepth, int depthCount, const float* offset,
                        int count, float* out);

/// Multiplies by F at B.
void applySinkGain(const Downshift& downshift, const float* exponent, int count, SamplePair out);

/// exp(i phi) of the downshift at each sample.
void downshiftRotations(const Downshift& downshift, const float* exponent, int count, SamplePair out);

/// v times the rotation.
void rotate(const float* turnRe, const float* turnIm, int count, SamplePair v);

/// The same the other way round, as complex numbers.
void rotateBack(const float* re, const float* im, const float* turnRe, const float* turnIm, int count,
                std::complex<float>* out);

/// As complex numbers.
void interleave(const float* re, const float* im, int count, std::complex<float>* out);

} // namespace sono
