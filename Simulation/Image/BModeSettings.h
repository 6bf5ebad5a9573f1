#pragma once

#include "Core/Parameters.h"
#include "Kernel/GreyLevel.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace sono {

/// Depth-dependent gain and log compression (Data/docs/physics.md section 6).
struct BModeSettings
{
  double tgcDbPerCm = 5.0; ///< evens out tissue under the widest lobe
  /// (depth mm, gain dB in [-300, 300]) at strictly ascending depths, added to the slope; linear between the points,
  /// constant beyond the ends.
  std::vector<std::pair<double, double>> tgcCurve;
  double gainDb = 0.0;             ///< added after the reference was found
  bool automaticReference = true;  ///< found without gainDb, which would cancel
  double referenceAmplitude = 1.0; ///< a normal, finite float where it is used
  double dynamicRangeDb = 60.0;
  double rejectDb = 0.0;             ///< below the range
  GreyMap greyMap = GreyMap::Linear; ///< applied last
  bool addNoise = false; ///< before any gain, so it does not follow the picture's content, and the gains lift it
  double noiseDb = -80.0;
  std::uint64_t noiseSeed = 1;

  template<class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor(self.gainDb, Parameter{ "gainDb", "Gain (dB)", between(-300, 300), "Gain everywhere in dB, -300 to 300." });
    visitor(self.dynamicRangeDb, Parameter{ "dynamicRangeDb", "Dynamic Range (dB)", aboveUpTo(0, 300),
                                            "Levels shown in dB, above 0 up to 300: the reference is white, this much "
                                            "below it is black." });
    visitor(self.tgcDbPerCm, Parameter{ "tgcDbPerCm", "TGC (dB per cm)", between(-100, 100),
                                        "Gain that grows with depth in dB/cm, -100 to 100." });
    visitor(self.rejectDb, Parameter{ "rejectDb", "Reject (dB)", between(0, 300),
                                      "Levels less than this above the bottom of the range are black too, in dB, from "
                                      "0 to below the range." });
    visitor(self.greyMap, Parameter{ "greyMap",
                                     "Grey Map",
                                     {},
                                     "What turns the compressed level into grey: the level itself, its square root, "
                                     "which lifts weak echoes, or an S-shaped curve with more contrast in the middle.",
                                     { "Linear", "Square Root", "Sigmoid" } });
    visitor(self.automaticReference,
            Parameter{ "automaticReference",
                       "Automatic Reference",
                       {},
                       "Take 25 dB above the 90th percentile of the depth-gained envelope, the first 6 mm left "
                       "out, as the reference." });
    visitor(self.referenceAmplitude,
            Parameter{ "referenceAmplitude", "Reference Amplitude", atLeast(0),
                       "Envelope that is white, above 0, no unit: 1 is the echo of a perfect plane reflector; used "
                       "where the reference is not automatic." });
    visitor(self.addNoise, Parameter{ "addNoise", "Add Noise", {}, "Let the receiver add noise, before any gain." });
    visitor(self.noiseDb, Parameter{ "noiseDb", "Noise (dB)", atMost(200),
                                     "RMS of that noise in dB to the echo of a perfect plane reflector, up to 200." });
    visitor(self.noiseSeed,
            Parameter{ "noiseSeed", "Noise Seed", atLeast(0), "Seed of the noise, at least 0, no unit." });
  }

  /// Throws Error naming the parameter and its range.
  void validate() const;
};

} // namespace sono
