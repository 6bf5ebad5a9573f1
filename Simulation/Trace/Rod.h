#pragma once

namespace sono {

struct Tissue;

/// A solid round rod, as a needle, in soft tissue, met across its axis.
struct Rod
{
  double radiusMm;
  double impedanceMRayl;
  double soundSpeedMPerS; ///< of compression
  double shearSpeedMPerS;
};

/// What a rod lies in, MRayl. Whether it is fat or muscle changes what rings by a decibel.
inline constexpr double aroundRodsMRayl = 1.63;

/// Of a target's tissue; Poisson's ratio is taken for a third, as of steel and titanium, so that shear runs at half the
/// speed.
Rod rodOf(const Tissue& tissue, double diameterMm);

/// Whether it rings (Echo/RodRing.h): fluids and soft rods are left to the paths.
bool rings(const Rod& rod);

} // namespace sono
