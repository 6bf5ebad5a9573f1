#pragma once

#include "Echo/BrickWalk.h"
#include "Echo/EchoSettings.h"
#include "Kernel/EchoSplat.h"
#include "Kernel/Interface.h"

#include <optional>

namespace sono {

/// Of a beam at a depth, straight ahead: that of a Gaussian with the same integrals of |W| and |W|^2 along each axis.
struct BeamWidth
{
  double lateralSigmaMm;
  double elevationalSigmaMm;
  double amplitude; ///< of the Gaussian on its axis
};

/// The beam that the settings ask for, as scatterers and surfaces are weighted by it. W is 1 for a point at the focus,
/// on the axis of a line straight ahead; a beam of one width is in focus at each depth.
class BeamModel
{
public:
  /// `model` is what lines are traced with: Amadou2024 has the beam of one width. The settings must outlive this.
  /// Throws Error when a field is zero on its whole axis.
  BeamModel(const EchoSettings& settings, InterfaceModel model);

  BeamKind kind() const { return kind_; }
  /// A_b, the integral of |W| across the beam at its focus: a perfect mirror there has the echo 1, a scatterer of
  /// cross-section q has sqrt(q) lambda / A_b.
  double focusAreaMm2() const { return focusAreaMm2_; }
  /// At the focus, the integral of W^2.
  double focusPowerAreaMm2() const { return focusPowerAreaMm2_; }
  /// Of a Field or an Array it takes some thousand look-ups: ask once a depth, not once a scatterer.
  BeamWidth widthAt(double depthMm) const;
  /// Of the resolution cell at a depth, however strong the beam is there: pi s_L s_E.
  double cellAreaMm2(double depthMm) const;
  double focusMm() const { return focusMm_; }
  BeamWidth focusWidth() const { return widthAt(focusMm_); }
  /// For bricks; null where the kind of beam has none.
  const BeamReachTable* reachTable() const { return sight_ ? &sight_->reach() : reach_ ? &*reach_ : nullptr; }
  const ArraySight* arraySight() const { return sight_; }

  /// In coordinates that are turned by `rotation`, from `origin` there. For lookups while this lives.
  Beam beamOf(const ScanLine& line, const Vec3d& origin, const Mat3d& rotation) const;

  /// One of these beams and the depth to which it is needed; `sight` is a field's, as above for lookups while it lives.
  BeamReach reachOf(const Beam& beam, float depthMm, const FieldSight* sight = nullptr) const
  {
    return { beam, depthMm, sight, reachTable(), arraySight() };
  }

private:
  void tabulateReach();

  const EchoSettings& settings_;
  BeamKind kind_;
  ApertureProfile straight_{}; // of an Aperture
  std::optional<BeamFieldView> field_;
  std::optional<ArrayBeamView> array_;
  std::optional<BeamReachTable> reach_; // of an Aperture
  const ArraySight* sight_ = nullptr;   // of an Array
  std::optional<ArraySightView> sightView_;
  double focusMm_ = 0.0;
  double focusAreaMm2_ = 0.0;
  double focusPowerAreaMm2_ = 0.0;
};

} // namespace sono
