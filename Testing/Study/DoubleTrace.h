#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace sono::study {

/// What the tracer needs, in double precision. It names no type of the kernels, which are compiled twice (see
/// KernelsInDouble.h).
struct DoubleInput
{
  struct Medium
  {
    double impedance;
    double speed;
    double rangePerMm;
    double decayPerMm;
    double tau;
    double gamma;
    double roughnessMm;
    double correlationMm;
  };
  struct Line
  {
    std::array<double, 3> origin;
    std::array<double, 3> axis;
  };
  /// The targets' triangles and the tree over them, as the kernels have them.
  struct Node
  {
    std::array<double, 3> low;
    std::array<double, 3> high;
    std::int32_t first;
    std::int32_t count;
  };
  struct Triangle
  {
    std::array<std::array<double, 3>, 3> corner;
    std::int32_t target;
  };
  const std::uint16_t* cell;
  const std::uint32_t* firstRecord;
  const std::uint32_t* record;
  std::array<int, 3> size;
  std::array<double, 3> spacing;
  std::vector<Medium> media; ///< of the tissues, then of the targets
  int firstTargetMedium;
  std::vector<Node> nodes;
  std::vector<Triangle> triangles;
  std::vector<Line> lines;
  int outsideTissue;
  std::map<std::string, double> settings; ///< the tracer's parameters by their names
  bool lowDiscrepancy;
  double depthMm; ///< of the paths
  bool rangeIsTime;
  int binCount;
  double echoSampleMm;
  int echoCount;
  double frequencyMHz;
  int paths;
};

struct DoubleTraced
{
  std::vector<double> intensity;          ///< by line and bin
  std::vector<double> absorbed;           ///< the same: the sum of A I, see LineTally
  std::vector<double> depthOffsetMm;      ///< the same, by range: TracedLines::depthOffsetMm
  std::vector<std::complex<double>> echo; ///< by line and echo sample
};

/// As trace() gives it with the same random numbers.
DoubleTraced traceInDouble(const DoubleInput& input);

} // namespace sono::study
