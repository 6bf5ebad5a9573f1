#pragma once

#include "Echo/FormRf.h"

#include <complex>

namespace sono::study {

/// Far-field amplitude |F| of a plane wave scattered straight back by a fluid cylinder, whose scattered pressure at a
/// distance r is sqrt(2 / (pi k r)) |F|: the exact series of cylindrical waves, with pressure and normal velocity
/// continuous on the surface. ka is the wave number outside times the radius; the ratios are inside over outside.
/// For ka << 1 it is (pi (ka)^2 / 4) |1 - kappa + 2 (rho - 1) / (rho + 1)| with the ratio kappa of the
/// compressibilities.
double cylinderBackscatter(double ka, double impedanceRatio, double speedRatio);

/// F of a nylon wire in the phantom's gel, with its phase, for the time factor exp(-i w t).
std::complex<double> nylonScattering(double waveNumberPerMm, double diameterMm);

/// Echo of a millimetre of a nylon wire of that diameter across the beam's focus, against a perfect plane reflector
/// there. By reciprocity a source of strength s per area echoes as the integral of s w with the beam's two-way weight
/// w; a plane reflector radiates as 2 k per area, the wire as 4 |F| per length.
double wireEchoPerMm(const EchoSettings& echo, double diameterMm);

/// EchoSettings::scattererLevelDb at which the phantom's gel, at the focus, has the backscatter of soft tissue: the
/// power of incoherent echoes is 4 pi^2 BSC (integral of w^2 over the beam) (integral of g^2 over the pulse) / (k
/// integral of w)^2 against the plane reflector. BSC = 5 10^-4 /(cm sr), of the order of liver at 3.6 MHz (chosen).
double gelLevelDb(const EchoSettings& echo);

} // namespace sono::study
