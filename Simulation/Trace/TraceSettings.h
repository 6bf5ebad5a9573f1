#pragma once

#include "Core/Device.h"
#include "Core/Parameters.h"
#include "Core/SoundSpeed.h"
#include "Kernel/Interface.h"
#include "Probe/ScanGeometry.h"

#include <cstdint>

namespace sono {

/// Where the random numbers of a path come from.
enum class Sampling
{
  Independent,   ///< Philox counters
  LowDiscrepancy ///< Owen-scrambled Sobol pairs, one per bounce
};

/// How boundaries are found. Both give the same image.
enum class March
{
  RegionCache, ///< dense cells of what the fan reaches, with a skip map: fast
  NanoVDB      ///< the scene's label grid itself: the reference, several times slower, on the CPU only
};

struct TraceSettings
{
  Device device = Device::Auto;
  March march = March::RegionCache;
  InterfaceModel model = InterfaceModel::Acoustic;
  Sampling sampling = Sampling::LowDiscrepancy;
  int pathsPerLine = 256; ///< levels within 0.7 dB (rms) in a chest, physics.md 9
  /// 0: all lines get pathsPerLine. Otherwise a Simulator traces in rounds until the picture is as exact, at most
  /// pathsPerLine (see RefinedTrace.h); trace() itself knows a number alone.
  double targetErrorDb = 0.0;
  double timeBudgetS = 0.0; ///< the same: rounds that would end later are not begun. 0: no limit
  int maxCollisions = 7;
  double coherenceMm =
    100.0; ///< C0 in w_R = C0 / (C0 + distance); the paper's 0.1, read in metres as its other lengths
  bool deterministic = false;       ///< no Monte-Carlo: the stronger branch along its coherent direction, no spreading
  double lobeMeanDeg = 0.0;         ///< mu of Amadou2024's truncated normal
  double lobeSigmaDeg = 45.0;       ///< sigma
  double lobeMinDeg = 0.0;          ///< a
  double lobeMaxDeg = 90.0;         ///< b, above a
  double frequencyMHz = 2.5;        ///< > 0; sets attenuation, how rough surfaces are, and the phase of boundary echoes
  double fractionalBandwidth = 0.6; ///< of what is received, at -6 dB, (0, 2): of the pulse in which the target error
                                    ///< shows; without one it counts for nothing
  /// Of the harmonic a Simulator traces that frequency and its double (see SecondHarmonic.h); trace() itself knows one.
  ImagingMode imagingMode = ImagingMode::Fundamental;
  double facePressureKPa = 1000.0; ///< of the harmonic, > 0
  double depthMm = 160.0;          ///< > 0
  BeamAperture aperture;           ///< of the probe: where it is named, paths start over it (see startApart)
  double radialBinMm = 0.25;
  double echoSampleMm = 0.0385; ///< radial sample of the boundary echoes, > 0: c0 / (2 fs) of the RF
  bool reverberation = true;    ///< of Acoustic: whether paths that have been reflected are heard
  bool intensityAlone = false;  ///< of Acoustic: paths end where they are reflected, though as many are as reverberate
                                ///< elsewhere, so that the intensity is the same to the bit
  double faceReflection = 0.3;  ///< of the amplitude, by the transducer's face: chosen, a matched one's
  double rouletteDb = -100.0;   ///< paths fainter than this play Russian roulette
  std::uint64_t seed = 1;
  bool interactive = false; ///< for a probe that moves: what is prepared of the scene serves the next poses as well.
                            ///< The image is the same but for rounding, and does not depend on the way there

  /// The parameters of the stage; depth, frequency, bandwidth, mode, aperture and echo samples
  /// come from the probe and the RF.
  template<class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor(self.pathsPerLine,
            Parameter{ "pathsPerLine", "Paths per Line", between(1, 1e7),
                       "Paths per scan line, 1 to 10,000,000, no unit; the noise falls with their square root. With a "
                       "target error or a time budget, the most that a line may get." });
    visitor(
      self.targetErrorDb,
      Parameter{ "targetErrorDb", "Target Error (dB)", between(0, 10),
                 "How exact the picture is to be, in dB, 0 to 10: lines get paths until its noise, the rms of "
                 "the B-mode level's error over what is shown above -60 dB of its peak, before any gain, is as "
                 "low, or until they have had all of Paths per Line. On a GPU each round begins anew. 0: they get "
                 "all." });
    visitor(self.timeBudgetS,
            Parameter{ "timeBudgetS", "Time Budget (s)", between(0, 3600),
                       "How long lines get paths, in seconds, 0 to 3600, as exactly as that can be foreseen: the same "
                       "settings then give another picture on another day. 0: as long as it takes." });
    visitor(self.maxCollisions, Parameter{ "maxCollisions", "Max Collisions", between(0, 1000),
                                           "Boundaries that a path may meet, 0 to 1000, no unit." });
    visitor(self.coherenceMm,
            Parameter{ "coherenceMm", "Coherence (mm)", atLeast(0),
                       "C0: a path at this distance from the main beam counts half; in mm, at least 0." });
    visitor(self.model, Parameter{ "interfaceModel",
                                   "Interface Model",
                                   {},
                                   "What happens at a boundary: fluid acoustics at rough surfaces, which conserves "
                                   "energy, or the equations of Amadou et al. 2024 to the letter, which do not.",
                                   { "Acoustic", "Amadou 2024" } });
    visitor(self.sampling,
            Parameter{ "sampling",
                       "Sampling",
                       {},
                       "Where a path's random numbers come from: independent ones, or scrambled Sobol points with less "
                       "noise.",
                       { "Independent", "Low Discrepancy" } });
    visitor(self.deterministic, Parameter{ "deterministic",
                                           "Deterministic",
                                           {},
                                           "Follow only the stronger of the mirrored and the refracted direction, "
                                           "without chance and without spreading." });
    visitor(self.lobeMeanDeg, Parameter{ "lobeMeanDeg", "Lobe Mean (deg)", between(-180, 180),
                                         "Of Amadou 2024 alone: mean angle between an outgoing direction and the "
                                         "mirrored or refracted one in degrees, -180 to 180." });
    visitor(self.lobeSigmaDeg, Parameter{ "lobeSigmaDeg", "Lobe Sigma (deg)", atLeast(0),
                                          "Of Amadou 2024 alone: standard deviation of that angle in degrees, at least "
                                          "0; 0 is a mirror." });
    visitor(self.lobeMinDeg, Parameter{ "lobeMinDeg", "Lobe Min (deg)", between(0, 90),
                                        "Of Amadou 2024 alone: least such angle in degrees, 0 to 90." });
    visitor(self.lobeMaxDeg,
            Parameter{ "lobeMaxDeg", "Lobe Max (deg)", between(0, 90),
                       "Of Amadou 2024 alone: largest such angle in degrees, above the least, up to 90." });
    visitor(self.radialBinMm, Parameter{ "radialBinMm", "Radial Bin (mm)", above(0),
                                         "Width of an intensity sample along a scan line in mm, above 0." });
    visitor(self.rouletteDb,
            Parameter{ "rouletteDb", "Roulette (dB)", between(-1000, 0),
                       "Paths fainter than this in dB, 20 log10 of the intensity, -1000 to 0, are ended by chance and "
                       "the others of their kind count more. Those that have been reflected already are where they "
                       "stand for less than a sixth of the sound. -1000: none is." });
    visitor(
      self.reverberation,
      Parameter{ "reverberation",
                 "Reverberation",
                 {},
                 "Whether sound that was reflected more than once is heard: multiple echoes between walls, mirror "
                 "images, A-lines of the lung. Not of the model Amadou 2024." });
    visitor(self.faceReflection,
            Parameter{ "faceReflection", "Face Reflection", between(0, 1),
                       "Part of the amplitude that the transducer's face reflects, 0 to 1, no unit: what repeats a "
                       "strong echo at multiples of its depth." });
    visitor(self.device, deviceParameter());
    visitor(self.seed, Parameter{ "pathSeed", "Path Seed", atLeast(0),
                                  "Seed of the paths, at least 0, no unit: the same seed gives the same result." });
  }

  /// Throws Error naming the parameter and its range.
  void validate() const;
  /// Whether each path starts at a place of its own on the aperture and aims at the focus (Data/docs/physics.md 3.1):
  /// otherwise, and always in Amadou2024 and without chance, all start at the line's origin, along its axis.
  bool startApart() const;
  /// Whether what an echo's time says is its range, with the speed of every tissue on the way: otherwise, in
  /// Amadou2024, its depth along the line.
  bool rangeIsTime() const { return model == InterfaceModel::Acoustic; }
  /// Whether paths that have been reflected are heard where their time says; in Amadou2024 they are where they cross
  /// the line.
  bool reverberates() const { return rangeIsTime() && reverberation && !intensityAlone; }
  /// Whether a Simulator traces in rounds. A single path has no error.
  bool refines() const { return !deterministic && (targetErrorDb > 0.0 || timeBudgetS > 0.0); }
  /// Paths that a line gets at most.
  int pathsAtMost() const { return deterministic ? 1 : pathsPerLine; }
  /// How deep paths are followed, mm: what is shown within the depth may lie deeper.
  double pathDepthMm() const { return rangeIsTime() ? depthMm * deepestPerRange : depthMm; }
  /// Samples of the intensity, to the paths' depth, and of the boundary echoes, to the image's, along a line.
  int binCount() const;
  int echoCount() const; ///< 0 for Acoustic without reverberation, whose surfaces echo by themselves
};

} // namespace sono
