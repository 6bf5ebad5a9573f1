#pragma once

#include <optional>

namespace sono {

struct TargetSurface;

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

/// A target as a rod, where it is one that rings (Echo/RodRing.h): fluids and soft rods are left to the paths.
/// Poisson's ratio is taken for a third, as of steel and titanium, so that shear runs at half the speed.
std::optional<Rod> ringingRod(const TargetSurface& target);

} // namespace sono
