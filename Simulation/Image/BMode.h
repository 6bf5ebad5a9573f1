#pragma once

#include "Image/BModeSettings.h"

#include <cstdint>
#include <vector>

namespace sono {

/// Grey levels in beam space.
struct BModeLines
{
  int lineCount = 0;
  int sampleCount = 0;
  double sampleMm = 0.0;
  double referenceAmplitude = 0.0; ///< that was used
  std::vector<float> grey;         ///< lineCount x sampleCount, 0 (black) to 1 (white)
};

/// The gain of each sample, dB: slope and sliders.
std::vector<double> depthGainDb(const BModeSettings& settings, int sampleCount, double sampleMm);
/// The lateral gain of each line, dB.
std::vector<float> lateralGainDb(const BModeSettings& settings, int lineCount);
/// The weights of the envelope's smoothing, 0, 1, ... samples away along a line; empty where there is none.
std::vector<float> axialSmoothing(const BModeSettings& settings, double sampleMm);
/// The same across the lines, 0, 1, ... lines away.
std::vector<float> lateralSmoothing(const BModeSettings& settings);
/// Of an image's lines those that lie side by side in a plane.
int linesAcross(const BModeSettings& settings, int lineCount);
/// The same as a factor, at most the largest finite float.
float gainFactor(double decibels);

/// Which of n envelopes, in ascending order from 1 on, the automatic reference goes by: ceil(0.9 n).
constexpr std::uint64_t referenceRank(std::uint64_t n)
{
  return n - n / 10;
}
/// White lies 25 dB above: in real four-chamber views the 90th percentile is about two fifths of 60 dB below white
/// (computed from the percentiles in physics.md section 6).
constexpr double whiteOverRank = 17.7827941;

/// The sample of a line from which on the automatic reference looks: what lies above is the skin.
int firstReferenceSample(int sampleCount, double sampleMm);

/// Noise, haze, smoothing, time-gain compensation, log compression, reject:
/// x = 1 + (20 log10(a) + tgc(depth) + gain(line) - 20 log10(reference)) / range, clamped to [0, 1], within 1e-4 dB,
/// then grey = greyMap(x), where a is the smoothed sqrt(|envelope + noise|^2 + haze), or x is smoothed instead.
/// `envelope` is lineCount x sampleCount. NaN, negative and subnormal envelopes are black, +infinity is white. The
/// automatic reference is whiteOverRank times the envelope of referenceRank among those from 6 mm on (among all, where
/// the lines end there): tissue keeps its grey whether or not a wall shines beside it. Where that envelope is zero it
/// is the largest finite one; where all are zero, 1. Throws Error for settings out of range, counts below 1 and sizes
/// that do not match.
BModeLines makeBMode(const std::vector<float>& envelope, int lineCount, int sampleCount, double sampleMm,
                     const BModeSettings& settings);

} // namespace sono
