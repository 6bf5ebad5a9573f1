#pragma once

#include "Kernel/GreyLevel.h"

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace sono {

/// Depth-dependent gain and log compression (Data/docs/physics.md section 6).
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

} // namespace sono
