#pragma once

#include "Kernel/GreyLevel.h"

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace sono {

/// Depth-dependent gain and log compression (PHYSICS section 6).
struct BModeSettings
{
  double tgcDbPerCm = 5.0; ///< gain slope per cm of depth, [-100, 100]; evens out tissue under the widest lobe
  /// (depth mm, gain dB in [-300, 300]) at strictly ascending depths, added to the slope; linear between the points,
  /// constant beyond the ends.
  std::vector<std::pair<double, double>> tgcCurve;
  double gainDb = 0.0;               ///< added everywhere, after the reference was found, [-300, 300]
  bool automaticReference = true;    ///< reference = 99.9th percentile of the depth-gained envelope (without gainDb,
                                     ///< which would cancel)
  double referenceAmplitude = 1.0;   ///< envelope at 0 dB when not automatic, > 0
  double dynamicRangeDb = 60.0;      ///< (0, 300]: the reference is white, reference - range is black
  double rejectDb = 0.0;             ///< levels less than this above the bottom of the range are black, [0, range)
  GreyMap greyMap = GreyMap::Linear; ///< applied last
  /// Root mean square of the receiver's noise, dB to an envelope of 1 (the echo of a perfect plane reflector), at most
  /// 200; minus infinity: none. It is added before any gain, so it does not follow the picture's content, and the gains
  /// lift it.
  double noiseDb = -std::numeric_limits<double>::infinity();
  std::uint64_t noiseSeed = 1;

  /// Throws Error naming the parameter and its range.
  void validate() const;
};

/// Grey levels in beam space.
struct BModeLines
{
  int lineCount = 0;
  int sampleCount = 0;
  double sampleMm = 0.0;
  double referenceAmplitude = 0.0; ///< that was used
  std::vector<float> grey;         ///< lineCount x sampleCount, 0 (black) to 1 (white)
};

/// The gain of each sample, dB: slope and curve.
std::vector<double> depthGainDb(const BModeSettings& settings, int sampleCount, double sampleMm);
/// The same as a factor, at most the largest finite float.
float gainFactor(double decibels);

/// Time-gain compensation, log compression, reject:
/// x = 1 + (20 log10(envelope + noise) + tgc(depth) + gain - 20 log10(reference)) / range, clamped to [0, 1], within
/// 1e-4 dB, then grey = greyMap(x). `envelope` is lineCount x sampleCount. NaN, negative and subnormal envelopes are
/// black, +infinity is white. The automatic reference is the envelope of rank ceil(0.999 n); where that is zero, the
/// largest finite one; where all are zero, 1. Throws Error for settings out of range, counts below 1 and sizes that do
/// not match.
BModeLines makeBMode(const std::vector<float>& envelope, int lineCount, int sampleCount, double sampleMm,
                     const BModeSettings& settings);

} // namespace sono
