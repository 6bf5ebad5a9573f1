#pragma once

#include "Echo/BeamModel.h"
#include "Echo/EchoSettings.h"
#include "Kernel/SurfaceEcho.h"
#include "Labels/TissueTable.h"

#include <memory>
#include <vector>

namespace sono {

/// What of the beam the echoes of surfaces are measured by.
struct BeamExtent
{
  double areaMm2; ///< A_b: integral of |w| across the beam at its focus
  double lateralSigmaMm;
  double elevationalSigmaMm;
};

/// At the beam's focus.
BeamExtent beamExtent(const BeamModel& beams);

/// What surfaces lie between: a scene's tissues, then the media of targets.
struct SurfaceMedia
{
  std::vector<Tissue> all;
  int tissues;  ///< those of the scene
  int coupling; ///< beyond it nothing echoes as seen from there; -1: none
  /// Numbers of rods that ring: what comes from within them follows the echo of their front (RodRing.h).
  std::vector<int> rods = {};
};

/// The table of all boundaries between some media (Data/docs/physics.md sections 10.3 to 10.5).
class SurfaceRows
{
public:
  /// Pieces have blobs of `finestMm` to `widestMm`, and areas of about their squares.
  SurfaceRows(const SurfaceMedia& media, const EchoSettings& settings, const BeamExtent& beam, double finestMm,
              double widestMm);

  int count() const { return count_; } ///< of the media
  /// From medium a onto b.
  int row(int a, int b) const { return surfaceRow(count_, a, b); }
  const SurfaceRow& at(int row) const { return rows_[std::size_t(row)]; }
  const std::vector<SurfaceRow>& all() const { return rows_; }
  const std::vector<float>& diffuseL() const { return diffuseL_; }
  const std::vector<float>& diffuseE() const { return diffuseE_; }
  /// Of each profile, as long as those: the larger of the two from a node on.
  const std::vector<float>& diffuseMost() const { return diffuseMost_; }
  /// For lookups while this lives.
  SurfaceTable view(double slackMm) const;

private:
  int count_;
  double perBeamArea_;
  double pulseSigmaMm_;
  bool isShaped_;
  std::vector<SurfaceRow> rows_;
  std::vector<float> diffuseL_;
  std::vector<float> diffuseE_;
  std::vector<float> diffuseMost_;
};

/// The same; those made last are kept, since they take tens of milliseconds and the next image wants the same.
std::shared_ptr<const SurfaceRows> sharedSurfaceRows(const SurfaceMedia& media, const EchoSettings& settings,
                                                     const BeamExtent& beam, double finestMm, double widestMm);

} // namespace sono
