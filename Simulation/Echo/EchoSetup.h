#pragma once

#include "Echo/BeamModel.h"
#include "Echo/FieldLevel.h"
#include "Echo/FieldSight.h"
#include "Echo/FormRf.h"
#include "Echo/LineFinisher.h"
#include "Echo/NestedScatterers.h"
#include "Echo/ScattererDensity.h"
#include "Echo/SurfaceEchoes.h"
#include "Echo/TissueScatterers.h"

#include <optional>
#include <vector>

namespace sono {

/// Amadou2024's amplitude of a unit scatterer such that a tissue full of them (one a cell) has the wanted rms echo: the
/// expected sum of squares over the beam is density * integral of w^2 g^2 = (1 / h^3) * A * integral of g^2, with the
/// beam's area A = pi sL sE for a Gaussian, at the focus where it has one (Data/docs/physics.md eq. 4.7).
double tissueScattererScale(const EchoSettings& settings, double areaMm2);

/// How much of the scene is listened to.
enum class EchoDetail
{
  Full,
  Moving ///< what a moving probe's picture needs
};

/// Everything that image formation needs, made once from the sources and the settings and held while lines are formed.
/// The arguments must outlive it.
struct EchoSetup
{
  /// The lines are those of images one after the other, which all have `linesPerImage`; 0: of one. Throws Error naming
  /// what is out of range or does not fit together.
  EchoSetup(const EchoSources& sources, const std::vector<ScanLine>& lines, const EchoSettings& settings,
            int linesPerImage = 0, EchoDetail detail = EchoDetail::Full);
  EchoSetup(const EchoSetup&) = delete;
  EchoSetup& operator=(const EchoSetup&) = delete;

  /// The beam of a line in the coordinates of the scene, and in those of the explicit scatterers.
  Beam sceneBeam(int line) const;
  Beam pointBeam(int line) const;
  RfLines emptyRf() const;

  const EchoSources& sources;
  const std::vector<ScanLine>& lines;
  const EchoSettings& settings;
  InterfaceModel model; ///< that the lines are traced with
  std::optional<FieldLevel> level;
  BeamModel beams;
  LineFinisher finisher;
  std::optional<TissueScatterers> tissues; ///< of Amadou2024
  std::optional<FieldSight> tissueSight;   ///< where the field matters to the tissues' bricks; nothing for a Gaussian
  /// Of Acoustic: scatterers, how dense they are over depth, and where the field matters to bricks of each level.
  std::optional<NestedScatterers> nested;
  std::optional<ScattererDensity> density;
  std::vector<FieldSight> nestedSight; ///< from the density's finest level on; empty for a Gaussian
  std::optional<FieldSight> pointSight;
  std::optional<SurfaceEchoes> surfaces; ///< of the scene; nothing in Amadou2024, whose paths bring them
};

} // namespace sono
