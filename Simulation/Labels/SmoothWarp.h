#pragma once

#include "Labels/LabelVolume.h"

#include <array>
#include <cstdint>

namespace sono {

/// A smooth deformation of space at random that folds nowhere, in mm. What is now at x stood at
///   g(x) = x - u(x),  u(x) = sum of a_n cos(k_n . x + phi_n),  |k_n| = 2 pi / wavelength,  sum of |a_n| = amplitude,
/// six waves whose directions and phases follow from the seed. So nothing moves farther than the amplitude (its root
/// mean square is 0.29 of it), and no difference of u over a distance is more than s = 2 pi amplitude / wavelength of
/// it. With s < 1 g is one to one and onto (Banach), its Jacobian at least (1 - s)^3.
class SmoothWarp
{
public:
  /// The wavelength over the amplitude must be at least this: s is at most 0.45.
  static constexpr double leastWavelengths = 14.0;

  /// The amplitude is at least 0; 0: everything stays. Throws Error where it could fold.
  SmoothWarp(double amplitudeMm, double wavelengthMm, std::uint64_t seed);

  double amplitudeMm() const { return amplitudeMm_; }
  /// g.
  Vec3d originalPlaceMm(const Vec3d& place) const;
  /// The reverse, by iteration to 10^-10 mm.
  Vec3d placeMm(const Vec3d& original) const;
  /// Derivatives of g; a column for each axis.
  Mat3d originalSlope(const Vec3d& place) const;

private:
  struct Wave
  {
    Vec3d amplitudeMm;
    Vec3d radPerMm;
    double phaseRad;
  };
  double amplitudeMm_;
  std::array<Wave, 6> waves_{};
};

/// The label map deformed: each voxel gets the label of the voxel that is nearest to where it stood, beyond the box
/// that of the box's border; where labels would touch that do not touch in the map, that of another one nearby
/// (keepApart), so that thin walls stay closed. The box grows by the amplitude where its face is of one label, as of
/// the air around a body. Labels that are left without voxels are dropped.
LabelVolume warped(const LabelVolume& volume, const SmoothWarp& warp);

} // namespace sono
