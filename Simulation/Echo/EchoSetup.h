#pragma once

#include "Echo/FieldLevel.h"
#include "Echo/FieldSight.h"
#include "Echo/FormRf.h"
#include "Echo/LineFinisher.h"
#include "Echo/SurfaceEchoes.h"
#include "Echo/TissueScatterers.h"

#include <optional>
#include <vector>

namespace sono {

/// Everything that image formation needs, made once from the sources and the settings and held while lines are formed.
/// The arguments must outlive it.
struct EchoSetup
{
  /// Throws Error naming what is out of range or does not fit together.
  EchoSetup(const EchoSources& sources, const std::vector<ScanLine>& lines, const EchoSettings& settings);
  EchoSetup(const EchoSetup&) = delete;
  EchoSetup& operator=(const EchoSetup&) = delete;

  /// The beam of a line in the coordinates of the scene, and in those of the explicit scatterers.
  Beam sceneBeam(int line) const;
  Beam pointBeam(int line) const;
  RfLines emptyRf() const;

  const EchoSources& sources;
  const std::vector<ScanLine>& lines;
  const EchoSettings& settings;
  std::optional<FieldLevel> level;
  LineFinisher finisher;
  std::optional<BeamFieldView> field;
  std::optional<TissueScatterers> tissues;
  std::optional<FieldSight> tissueSight; ///< where the field matters to the tissues' bricks; nothing for a Gaussian
  std::optional<FieldSight> pointSight;
  std::optional<SurfaceEchoes> surfaces; ///< of the scene; nothing in Amadou2024, whose paths bring them

private:
  Beam beam(const ScanLine& line, const Vec3d& origin, const Mat3d& rotation) const;
};

} // namespace sono
