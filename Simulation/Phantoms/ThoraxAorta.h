#pragma once

#include "Kernel/Vec.h"
#include "Phantoms/ThoraxLabels.h"

#include <array>

namespace sono {

/// At a phase of the beat, in the anatomy of the end of diastole that is carried there.
struct AortaPhase
{
  double valveOpening = 0.0; ///< of the leaflets, 0 (a disc) to 1 (a tube near the wall)
  double squeezedMm = 0.0;   ///< by which the wall is thicker, since the beat squeezes it
};

/// The aorta behind its valve: ascending part and arch, then down beside the spine (world LPS mm).
class ThoraxAorta
{
public:
  /// @param valveMm centre of the aortic valve
  /// @param axis unit direction of flow through it
  ThoraxAorta(const Vec3d& valveMm, const Vec3d& axis, const AortaPhase& phase);

  /// AortaLumen, AortaWall, AorticValve, or Background where there is no aorta.
  ThoraxLabel sample(const Vec3d& p) const;

private:
  bool isLeaflet(double radialMm, double alongMm) const;
  ThoraxLabel tube(double radialMm, double radiusMm) const;

  static constexpr int segments_ = 24;
  std::array<Vec3d, segments_ + 1> points_; ///< centre line from the valve to the end of the arch
  Vec3d lowMm_{ 0.0 };                      ///< box around the arch with its wall
  Vec3d highMm_{ 0.0 };
  AortaPhase phase_;
};

} // namespace sono
