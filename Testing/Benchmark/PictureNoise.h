#pragma once

#include "Echo/FormRf.h"
#include "ImageSettings.h"
#include "Scene/Scene.h"

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
  /// and with nothing below that counted; 0 dB is what one of 200 samples of the reference exceeds. Of four seeds.
  double decibels(int paths) const;
  /// The fewest paths a line with which that is `db`, by a power law between counts a factor of sqrt(2) apart.
  int pathsWithin(double db) const;

private:
  RfLines image(int paths, std::uint64_t seed) const;

  const Scene& scene_;
  ImageSettings settings_;
  std::vector<ScanLine> lines_;
  std::vector<float> reference_; ///< dB
  double zeroDb_ = 1.0;          ///< envelope
};

} // namespace sono
