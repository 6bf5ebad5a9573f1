#pragma once

#include "Echo/PointScatterers.h"
#include "PhantomImaging.h"

#include <vector>

namespace sono::study {

/// Rays from all over an aperture, side by side.
struct WireRays
{
  int places = 24;
  int directions = 2048;     ///< of each place, over the sector: no farther apart than a wire is wide
  double elevationMm = 24.0; ///< of the wires that the beam sees, at least
  double stepMm = 0.2;       ///< between scatterers along them
};

/// Surfaces thinner than a wavelength as a beam meets them that is wider than they: by rays from the whole aperture
/// instead of one along each scan line. Such a thing neither bends a ray nor throws a shadow, and all of its inside
/// scatters: a ray goes straight on and leaves a scatterer in the middle of what it passes, as strong as the area that
/// it stands for. All of a wire of `wireMm` echoes `amplitudePerMm` for each millimetre. The wires run along the
/// elevation axis, so what the rays of one plane meet is repeated along it.
std::vector<PointScatterer> scatterersMet(const Scene& scene, const std::vector<TargetSurface>& wires,
                                          const PhantomImaging& imaging, const ProbePose& pose, double apertureMm,
                                          double wireMm, double amplitudePerMm, const WireRays& rays = {});

} // namespace sono::study
