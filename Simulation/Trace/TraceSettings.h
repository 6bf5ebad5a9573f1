#pragma once

#include "Core/Device.h"
#include "Kernel/Interface.h"

#include <cstdint>

namespace sono {

/// Where the random numbers of a path come from, and which lines it serves.
enum class Sampling
{
  Independent,    ///< Philox counters
  LowDiscrepancy, ///< Owen-scrambled Sobol pairs, one per bounce
  SharedPaths     ///< LowDiscrepancy, and eight neighbouring lines share their paths: a path costs two to four times
                  ///< the time and says more than ten times as much. The lines' errors become alike. A mirror lobe,
                  ///< Amadou2024 and `deterministic` leave nothing to share.
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
  int pathsPerLine = 1000; ///< 1 to 10^7
  int maxCollisions = 7;   ///< boundaries a path may meet, 0 to 1000
  double coherenceMm =
    100.0; ///< C0 in w_R = C0 / (C0 + distance), >= 0; the paper's 0.1, read in metres as its other lengths are
  bool deterministic = false;     ///< no Monte-Carlo: transmitted along the refracted direction, no spreading
  double lobeMeanRad = 0.0;       ///< mu of the truncated normal
  double lobeSigmaRad = 0.785398; ///< sigma, >= 0
  double lobeMinRad = 0.0;        ///< a
  double lobeMaxRad = 1.570796;   ///< b, in (a, pi/2]
  double frequencyMHz = 2.5;      ///< > 0; sets attenuation and the phase of boundary echoes
  double depthMm = 160.0;         ///< > 0
  double radialBinMm = 0.25;      ///< width of an intensity sample along a line, > 0
  double echoSampleMm = 0.0154;   ///< radial sample of the boundary echoes, > 0: c0 / (2 fs) of the RF
  double rouletteDb = -100.0;     ///< paths fainter than this (20 log10 of the intensity) play Russian roulette, <= 0
  std::uint64_t seed = 1;
  bool interactive = false; ///< for a probe that moves: what is prepared of the scene serves the next poses as well.
                            ///< The image is the same but for rounding, and does not depend on the way there

  /// Throws Error naming the parameter and its range.
  void validate() const;
  /// Samples of the intensity and of the boundary echoes along a line.
  int binCount() const;
  int echoCount() const;
};

} // namespace sono
