#pragma once

#include "Echo/FormRf.h"
#include "ImageSettings.h"
#include "Scene/Scene.h"
#include "Trace/Trace.h"

#include <vector>

namespace sono {

/// What the paths' chance does to a picture: how far one of few paths lies from one of many, the scatterers being the
/// same.
class PictureNoise
{
public:
  /// Traces the reference, of 40,000 paths a line, whose own noise is a tenth of a decibel.
  PictureNoise(const Scene& scene, const ImageSettings& settings);

  /// RMS difference in dB of the envelopes, before they are compressed, over what lies above -60 dB in one of the two
  /// and with nothing below that counted; 0 dB is what one of 200 samples of the reference exceeds. Of four seeds, of
  /// the paths and of the scatterers: those alone move it by a twentieth.
  double decibels(int paths) const;
  /// The fewest paths a line with which that is `db`, by a power law between counts a factor of sqrt(2) apart.
  int pathsWithin(double db) const;

  /// The same measure of the settings' sampling against one ten times as fine, without what reverberates, whose speckle
  /// is drawn sample by sample.
  static double samplingDb(const Scene& scene, const ImageSettings& settings);

private:
  static constexpr std::uint64_t seeds = 4;

  std::vector<float> envelope(const TracedLines& traced, std::uint64_t seed) const;

  const Scene& scene_;
  ImageSettings settings_;
  std::vector<ScanLine> lines_;
  std::vector<double> zeroDb_;                ///< envelope, by seed
  std::vector<std::vector<float>> reference_; ///< dB, by seed
};

} // namespace sono
