#pragma once

#include "Kernel/NestedCells.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace sono {

/// Candidates in a resolution cell: ten scatterers in soft tissue, whose candidates are there with probability 7/10.
/// Since all are of one strength, that keeps the envelope's SNR within 0.02 of Rayleigh's (Data/docs/physics.md eq.
/// 11.3).
constexpr double candidatesPerCell = 15.0;

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
