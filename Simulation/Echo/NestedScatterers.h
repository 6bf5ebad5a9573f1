#pragma once

#include "Echo/BrickWalk.h"
#include "Echo/NestedBricks.h"
#include "Kernel/NestedCells.h"
#include "Kernel/Scatterer.h"
#include "Scene/FibreField.h"
#include "Scene/Scene.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sono {

/// The scatterers of a scene's tissues at the levels of their backscatter coefficients, generated brick by brick where
/// they are needed; nothing is stored. Positions are local to the scene.
///
/// A tissue's cross-section per volume is mu_b = b1 f^n; mu0, sigma0 and mu1 shape its statistics alone. A tissue
/// without scatterers (mu1 = 0, or mu0 = sigma0 = 0) echoes nothing.
class NestedScatterers
{
public:
  static constexpr int cellCount = nestedBrickCells * nestedBrickCells * nestedBrickCells;

  /// The candidates of bricks, brick by brick, ascending by their number, which are scatterers where their amplitude is
  /// not 0: of most tissues each one is, so that sorting the others out would take longer than adding nothing. The
  /// arrays hold a vector more, of anything.
  struct Generated
  {
    std::vector<float> x, y, z, amplitude;
    std::vector<float> fibreX, fibreY, fibreZ; ///< times the root of the anisotropy; only of bricks with fibres
    std::vector<int> first;                    ///< candidate of each brick, and how many there are
    std::vector<char> echoes;                  ///< whether any of a brick is a scatterer
    std::vector<char> hasFibres;               ///< whether any of a brick echoes by its angle

    int count() const { return first.back(); }

    // On the way there.
    std::vector<std::int32_t> brick, number; ///< among the bricks, in the brick
    std::vector<std::int32_t> i, j, k;       ///< cell, then voxel
    std::vector<std::uint32_t> hash, brickHash;
    std::vector<float> presence;
    std::vector<std::uint8_t> tissue;
  };

  /// A cross-section dq, mm^2/sr, echoes `amplitudePerRoot` sqrt(dq): lambda / A_b. The scene must outlive this. Its
  /// fibres are made here, where a tissue has any.
  NestedScatterers(const Scene& scene, double frequencyMHz, double amplitudePerRoot, std::uint64_t seed);

  /// Bricks of a level that may hold scatterers: none when no tissue has any.
  BrickGrid grid(int level) const;
  /// By tissue index; amplitudes for one candidate a mm^3.
  const std::array<NestedMedium, 256>& media() const { return media_; }
  /// Root of a tissue's anisotropy in Np: along `axis` it echoes exp(-(scale fibre . axis)^2) of its amplitude.
  const std::array<float, 256>& fibreScale() const { return fibreScale_; }
  /// Null where no tissue has any.
  const FibreField* fibres() const { return fibres_; }
  /// The first candidates of each brick, as many as `wanted` says of it; amplitudes for one candidate a mm^3.
  void generate(int level, const NestedBricks& bricks, const int* wanted, Generated& out) const;

private:
  template<bool hasDetail, bool hasFibres>
  void findTissues(Generated& out) const;
  void findFibres(Generated& out) const;

  const Scene& scene_;
  std::uint64_t seed_;
  bool any_ = false;
  const FibreField* fibres_ = nullptr;
  std::array<NestedMedium, 256> media_; // those that are no tissue of the scene hold nothing
  std::array<float, 256> amplitudes_{}; // of the media
  std::array<float, 256> probabilities_{};
  std::array<float, 256> fibreScale_{};
};

} // namespace sono
