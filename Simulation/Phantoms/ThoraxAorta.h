#pragma once

#include "Kernel/Vec.h"
#include "Phantoms/ThoraxLabels.h"
#include "Phantoms/ThoraxShapes.h"

#include <vector>

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
  /// No more than the distance to it.
  double leastOutsideMm(const Vec3d& p) const;

private:
  /// Of the centre line, where it comes nearest to a point.
  struct Nearest
  {
    double distanceMm2;
    double along; ///< in segments
  };
  Nearest nearest(const Vec3d& p) const;
  bool isLeaflet(double radialMm, double alongMm) const;
  ThoraxLabel tube(double radialMm, double radiusMm) const;

  static constexpr int segments_ = 24;
  std::vector<shapes::Capsule> line_; ///< the centre line from the valve to the end of the arch
  shapes::Capsule descending_;
  Vec3d lowMm_{ 0.0 }; ///< box around the arch with its wall
  Vec3d highMm_{ 0.0 };
  AortaPhase phase_;
};

} // namespace sono
