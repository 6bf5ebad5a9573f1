#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace sono::study {

/// What the tracer needs, in double precision. It names no type of the kernels, which are compiled twice (see
/// DoubleTrace.cpp).
struct DoubleInput
{
  struct Medium
  {
    double impedance;
    double speed;
    double decayPerMm;
    double tau;
    double gamma;
  };
  struct Line
  {
    std::array<double, 3> origin;
    std::array<double, 3> axis;
  };
  const std::uint16_t* cell;
  const std::uint32_t* firstRecord;
  const std::uint32_t* record;
  std::array<int, 3> size;
  std::array<double, 3> spacing;
  std::vector<Medium> media;
  std::vector<Line> lines;
  int outsideTissue;
  int model; ///< InterfaceModel
  double lobeMean;
  double lobeSigma;
  double lobeMin;
  double lobeMax;
  bool lowDiscrepancy;
  bool deterministic;
  int maxCollisions;
  double rouletteIntensity;
  double coherenceMm;
  double depthMm;
  double binMm;
  std::uint64_t seed;
  int paths;
};

/// Intensity by line and bin, as trace() gives it with the same random numbers, without targets.
std::vector<double> traceInDouble(const DoubleInput& input);

} // namespace sono::study
