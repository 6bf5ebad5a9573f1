#pragma once

#include "Kernel/NestedCells.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

namespace sono {

/// Candidates in the cell A_2 E_r (Data/docs/physics.md eq. 4.7): 14 in the box of the beam's and the pulse's widths at
/// half their height, 2.3548^3 s_L s_E s_r. Since all are of one strength, and one lies in each cell of space, that
/// keeps the envelope's SNR within 0.02 of Rayleigh's (eq. 11.3).
constexpr double candidatesPerCell = 6.0;

/// Scatterers in it of a tissue with mu1 = 1, where there are as many candidates.
constexpr double scatterersAtFullMu1 = 15.0;

/// With which probability a candidate is there: where mu1 asks for more scatterers than candidates, all are.
inline double candidateProbability(double mu1)
{
  return std::min(1.0, mu1 * (scatterersAtFullMu1 / candidatesPerCell));
}

/// How many candidates a line needs at each depth, and which bricks give them. What a line costs then does not depend
/// on beam, pulse or frequency: it is proportional to the number of resolution cells along it.
class ScattererDensity
{
public:
  /// `cellMm3` is the volume of the resolution cell at a depth, asked for from 0 to `depthMm`; it gets so many
  /// candidates.
  ScattererDensity(double depthMm, const std::function<double(double)>& cellMm3, double perCell = candidatesPerCell);

  /// For lookups while this lives.
  DensityView view() const;
  int finest() const { return finest_; }
  int coarsest() const { return coarsest_; }
  /// Depths between which a line may take bricks of a level (their scatterers lie there); empty when from >= to.
  struct Range
  {
    float fromMm;
    float toMm;
  };
  Range range(int level) const;

private:
  double stepMm_;
  std::vector<float> perMm3_;
  std::vector<std::uint8_t> level_; // the coarsest that is dense enough at each depth
  std::vector<std::uint8_t> coarseEnough_;
  int finest_ = 0;
  int coarsest_ = 0;
};

} // namespace sono
