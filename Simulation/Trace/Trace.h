#pragma once

#include "Device.h"
#include "Kernel/Interface.h"
#include "Probe/ScanGeometry.h"
#include "Progress.h"
#include "Scene/Scene.h"
#include "Trace/Targets.h"

#include <complex>
#include <cstdint>
#include <vector>

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
  bool onTheWay = false; ///< for a probe that moves: what is prepared of the scene serves the next poses as well. The
                         ///< image is the same but for rounding, and does not depend on the way there

  /// Throws Error naming the parameter and its range.
  void validate() const;
  /// Samples of the intensity and of the boundary echoes along a line.
  int binCount() const;
  int echoCount() const;
};

/// What the tracer gives: for each line and radial bin the mean one-way intensity (1 at the transducer) and its
/// Monte-Carlo standard error, and the boundary echoes as complex amplitudes on the echo grid: an echo of amplitude
/// A at depth r adds A exp(-i 2 k (r - r_s)), split linearly between the two nearest samples s, k = 2 pi f / c0.
struct TracedLines
{
  int lineCount = 0;
  int binCount = 0;
  double binMm = 0.0;               ///< bin b covers [b, b+1) * binMm
  std::vector<float> intensity;     ///< lineCount x binCount
  std::vector<float> standardError; ///< lineCount x binCount
  int echoCount = 0;
  double echoSampleMm = 0.0;                     ///< sample s lies at s * echoSampleMm
  std::vector<std::complex<float>> boundaryEcho; ///< lineCount x echoCount
  std::uint64_t segments = 0;                    ///< path segments traced
};

/// Speed of sound that turns depth into time, as a scanner assumes it, mm per microsecond.
constexpr double assumedSoundSpeedMmPerUs = 1.54;

/// Traces every line. The result depends on the arguments and the device alone, to the bit, not on the threads; CPU and
/// GPU differ by rounding.
/// Throws Error when no line meets the volume or a target is not closed, Aborted when asked to stop.
TracedLines trace(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings,
                  const Progress& progress = {}, const std::vector<TargetSurface>& targets = {});

/// Begins to prepare, in the background, what trace() wants of the scene for a probe that goes on its way from here.
void prepareForTheWay(const Scene& scene, const std::vector<ScanLine>& lines, const TraceSettings& settings);

} // namespace sono
