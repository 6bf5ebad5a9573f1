#pragma once

#include "Core/Parameters.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sono {

/// A row of sliders, dB: each stands in the middle of its eighth of the depth, or of the lines; straight in between,
/// constant beyond the first and the last.
using GainSliders = std::array<double, 8>;

/// Receiver noise, haze, gains, log compression and grey map (Data/docs/physics.md sections 6 and 14.1).
struct BModeSettings
{
  double tgcDbPerCm = 5.0;         ///< evens out tissue under the widest lobe
  GainSliders tgcDb{};             ///< added to the slope, over the depth of the lines
  GainSliders lateralGainDb{};     ///< from the first line to the last; added after the reference was found
  double gainDb = 0.0;             ///< the same
  bool automaticReference = true;  ///< found without gainDb, which would cancel
  double referenceAmplitude = 1.0; ///< a normal, finite float where it is used
  double dynamicRangeDb = 60.0;
  double rejectDb = 0.0; ///< below the range
  /// Applied last: the grey of levels from 0 to 1 at equal steps, straight in between; see readGreyMap. Empty: linear.
  std::vector<float> greyMap;
  bool addNoise = false; ///< before any gain, so it does not follow the picture's content, and the gains lift it
  double noiseDb = -130.0;
  bool addHaze = false; ///< the same
  double hazeDb = -90.0;
  double hazeFallDbPerCmMHz = 1.4;
  double hazeVariationDb = 3.0;
  std::uint64_t noiseSeed = 1;
  double axialSmoothingMm = 0.0;      ///< of the envelope, before any gain
  double lateralSmoothingLines = 0.0; ///< the same, behind it
  bool smoothCompressed = false;      ///< both of the compressed levels instead, before the grey map
  double frequencyMHz = 2.5;          ///< centre of the band that is received, > 0
  double pulseSigmaMm = 0.2;    ///< standard deviation of the receive filter's pulse: the noise's grain along a line
  double hazeGrowthPerMm = 0.0; ///< of a harmonic picture, see bodyWallGrowthPerMm; 0: the haze is the fundamental's
  int linesAcross = 0;          ///< lines side by side; those that follow lie in other planes. 0: all
  double shownPerRange = 1.0;   ///< see ScanGeometry: TGC and smoothing are by what is shown

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
                                     "RMS of that noise in dB to the strongest echo there is, that of a perfect plane "
                                     "reflector at the transducer, up to 200. The TGC lifts it with depth." });
    visitor(self.addHaze, Parameter{ "addHaze",
                                     "Add Haze",
                                     {},
                                     "Add the clutter that reverberates in the body wall, before any "
                                     "gain." });
    visitor(self.hazeDb, Parameter{ "hazeDb", "Haze (dB)", atMost(200),
                                    "Level of the haze at the transducer, in dB to the echo of a perfect plane "
                                    "reflector, up to 200." });
    visitor(self.hazeFallDbPerCmMHz,
            Parameter{ "hazeFallDbPerCmMHz", "Haze Fall (dB per cm MHz)", between(0, 100),
                       "How the haze falls with depth, in dB/cm for each MHz of the centre frequency, 0 to 100; less "
                       "than the TGC and it grows brighter." });
    visitor(self.hazeVariationDb, Parameter{ "hazeVariationDb", "Haze Variation (dB)", between(0, 20),
                                             "Standard deviation of the haze's level from place to place, in dB, 0 to "
                                             "20." });
    visitor(self.noiseSeed, Parameter{ "noiseSeed", "Noise Seed", atLeast(0),
                                       "Seed of the noise and of the haze, at least 0, no unit." });
    visitor(self.axialSmoothingMm,
            Parameter{ "axialSmoothingMm", "Axial Smoothing (mm)", between(0, 20),
                       "Width at half height of the Gaussian that smooths the envelope along each line, in mm, 0 to "
                       "20. 0: none." });
    visitor(self.lateralSmoothingLines,
            Parameter{ "lateralSmoothingLines", "Lateral Smoothing (lines)", between(0, 50),
                       "Width at half height of the Gaussian that smooths the envelope across the lines of a plane, in "
                       "lines (no unit), 0 to 50: a sector's speckle gets the wider the deeper it lies. 0: none." });
    visitor(
      self.smoothCompressed,
      Parameter{ "smoothCompressed",
                 "Smooth Compressed",
                 {},
                 "Let the smoothing act on the compressed levels, as a scanner's speckle reduction may, instead of "
                 "the envelope: strong points stay narrow while speckle grows wide." });
    visitSliders(self.tgcDb, visitor,
                 { "tgc1Db", "tgc2Db", "tgc3Db", "tgc4Db", "tgc5Db", "tgc6Db", "tgc7Db", "tgc8Db" },
                 { "TGC 1 (dB)", "TGC 2 (dB)", "TGC 3 (dB)", "TGC 4 (dB)", "TGC 5 (dB)", "TGC 6 (dB)", "TGC 7 (dB)",
                   "TGC 8 (dB)" },
                 "Gain in the middle of an eighth of the depth, 1 at the transducer, in dB, -40 to 40; straight "
                 "between the sliders, added to the TGC's slope.");
    visitSliders(self.lateralGainDb, visitor,
                 { "lateralGain1Db", "lateralGain2Db", "lateralGain3Db", "lateralGain4Db", "lateralGain5Db",
                   "lateralGain6Db", "lateralGain7Db", "lateralGain8Db" },
                 { "Lateral Gain 1 (dB)", "Lateral Gain 2 (dB)", "Lateral Gain 3 (dB)", "Lateral Gain 4 (dB)",
                   "Lateral Gain 5 (dB)", "Lateral Gain 6 (dB)", "Lateral Gain 7 (dB)", "Lateral Gain 8 (dB)" },
                 "Gain in the middle of an eighth of the lines, 1 at the lateral beginning, in dB, -40 to 40; straight "
                 "between the sliders.");
  }

  /// Throws Error naming the parameter and its range.
  void validate() const;

private:
  using SliderTexts = std::array<const char*, std::tuple_size_v<GainSliders>>;
  template<class Sliders, class Visitor>
  static void visitSliders(Sliders& sliders, Visitor& visitor, const SliderTexts& names, const SliderTexts& labels,
                           const char* sentence)
  {
    for (std::size_t i = 0; i < sliders.size(); ++i)
    {
      visitor(sliders[i], Parameter{ names[i], labels[i], between(-40, 40), sentence });
    }
  }
};

} // namespace sono
