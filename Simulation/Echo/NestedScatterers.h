#pragma once

#include "Echo/BrickWalk.h"
#include "Echo/ScattererView.h"
#include "Kernel/NestedCells.h"
#include "Kernel/Scatterer.h"
#include "Scene/FibreField.h"
#include "Scene/Scene.h"

#include <array>
#include <cstdint>

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

  /// Room for the scatterers of one brick.
  struct Buffer
  {
    std::array<float, cellCount> x, y, z, amplitude;
    std::array<float, cellCount> fibreX, fibreY, fibreZ; ///< only where `hasFibres`
    std::array<float, cellCount> along;                  ///< amplitudes as one beam sees them
    std::array<int, cellCount + 1> before; ///< scatterers among the first n candidates, up to those that were made
    bool hasFibres = false;
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
  /// Fills the buffer with the scatterers among the first so many candidates of a brick, ascending by number;
  /// amplitudes for one candidate a mm^3.
  void generate(int level, const Vec3i& brick, int candidates, Buffer& buffer) const;
  /// The scatterers of a share as a beam along `axis` (local, unit) sees them. In the buffer until its next use.
  static ScattererView seen(Buffer& buffer, const NestedShare& share, const Vec3f& axis);

private:
  const Scene& scene_;
  std::uint64_t seed_;
  bool any_ = false;
  const FibreField* fibres_ = nullptr;
  std::array<NestedMedium, 256> media_; // those that are no tissue of the scene hold nothing
  std::array<float, 256> fibreScale_{};
};

} // namespace sono
