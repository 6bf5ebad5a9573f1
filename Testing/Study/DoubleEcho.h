#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <vector>

namespace sono::study {

/// What image formation needs for the scatterers of a scene, a Gaussian beam and a Gaussian pulse, in double precision.
/// It names no type of the kernels, which are compiled twice (see KernelsInDouble.h).
struct DoubleEchoInput
{
  struct Medium
  {
    double mean; ///< of the amplitude, scaled
    double sigma;
    double probability;
  };
  struct Line
  {
    std::array<double, 3> origin; ///< in the scene's coordinates
    std::array<double, 3> axis;
    std::array<double, 3> lateral;
    std::array<double, 3> elevation;
  };
  const std::uint8_t* tissues; ///< of each voxel
  std::array<int, 3> size;
  std::array<double, 3> spacing;
  std::vector<Medium> media; ///< by tissue
  double cellMm;
  std::uint64_t seed;
  std::vector<Line> lines;
  double lateralSigmaMm;
  double elevationalSigmaMm;
  double sampleMm;
  int sampleCount;
  double radPerMm; ///< 2 k
  double pulseSigmaMm;
  const double* intensity; ///< by line and bin
  double binMm;
  int binCount;
  const std::complex<double>* echo; ///< by line and sample
  int echoCount;
};

/// The demodulated lines that formRf() gives, as a plain sum over all cells of the scatterers. The boundary echoes must
/// lie on the grid of the samples.
std::vector<std::complex<double>> formRfInDouble(const DoubleEchoInput& input);

} // namespace sono::study
