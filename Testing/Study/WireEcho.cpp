#include "WireEcho.h"
#include "Core/SoundSpeed.h"

#include "Echo/FieldLevel.h"
#include "Echo/Pulse.h"
#include "PhantomImaging.h"

#include <cmath>
#include <complex>

namespace sono::study {
namespace {

double besselSlope(int n, double x)
{
  return n == 0 ? -std::cyl_bessel_j(1.0, x) : std::cyl_bessel_j(n - 1.0, x) - n / x * std::cyl_bessel_j(double(n), x);
}

double neumannSlope(int n, double x)
{
  return n == 0 ? -std::cyl_neumann(1.0, x) : std::cyl_neumann(n - 1.0, x) - n / x * std::cyl_neumann(double(n), x);
}

double waveNumberPerMm(const EchoSettings& echo)
{
  return 2.0 * M_PI * echo.centreFrequencyMHz / assumedSoundSpeedMmPerUs;
}

/// Integral of the two-way weight over the plane of the focus, mm^2: where the weight on the axis is largest.
double focusWeightMm2(const PulseEchoField& field)
{
  const FieldGrid& grid = field.grid();
  const BeamFieldView view = field.view();
  int focus = 0;
  const auto onAxis = [&](int d) { return beamWeight(view, 0.0f, 0.0f, float(grid.depth.at(d))); };
  for (int d = 1; d < grid.depth.count; ++d)
  {
    focus = onAxis(d) > onAxis(focus) ? d : focus;
  }
  const double step = 0.05;
  double sum = 0.0;
  for (double x = 0.5 * step; x < field.lateralReachMm(); x += step)
  {
    for (double y = 0.5 * step; y < field.elevationalReachMm(); y += step)
    {
      sum += beamWeight(view, float(x), float(y), float(grid.depth.at(focus)));
    }
  }
  return 4.0 * sum * step * step; // a quarter of a symmetric beam
}

std::complex<double> scatteredBack(double ka, double impedanceRatio, double speedRatio)
{
  const double inside = ka / speedRatio;
  std::complex<double> sum = 0.0;
  for (int n = 0; n <= int(ka) + 12; ++n)
  {
    const double j0 = std::cyl_bessel_j(double(n), ka);
    const double j1 = std::cyl_bessel_j(double(n), inside);
    const std::complex<double> h0(j0, std::cyl_neumann(double(n), ka));
    const std::complex<double> h0Slope(besselSlope(n, ka), neumannSlope(n, ka));
    const double j1Slope = besselSlope(n, inside) / impedanceRatio;
    const std::complex<double> coefficient = -(besselSlope(n, ka) * j1 - j0 * j1Slope) / (h0Slope * j1 - h0 * j1Slope);
    sum += (n == 0 ? 1.0 : 2.0) * (n % 2 == 0 ? 1.0 : -1.0) * coefficient;
  }
  return sum;
}

} // namespace

double cylinderBackscatter(double ka, double impedanceRatio, double speedRatio)
{
  return std::abs(scatteredBack(ka, impedanceRatio, speedRatio));
}

std::complex<double> nylonScattering(double waveNumberPerMm, double diameterMm)
{
  static const TissueTable tissues = bundledTissues(); // asked for tone by tone
  const Tissue& gel = *tissues.find("phantom_gel");
  const Tissue& nylon = *tissues.find("phantom_nylon");
  return scatteredBack(0.5 * waveNumberPerMm * diameterMm, nylon.impedanceMRayl / gel.impedanceMRayl,
                       nylon.soundSpeedMPerS / gel.soundSpeedMPerS);
}

double wireEchoPerMm(const EchoSettings& echo, double diameterMm)
{
  const double k = waveNumberPerMm(echo);
  return 2.0 * std::abs(nylonScattering(k, diameterMm)) / (k * focusWeightMm2(*echo.field));
}

double gelLevelDb(const EchoSettings& echo)
{
  constexpr double backscatterPerMmSr = 5e-5;
  const Tissue gel = *bundledTissues().find("phantom_gel");
  const double seen = waveNumberPerMm(echo) * focusWeightMm2(*echo.field);
  const double power = 4.0 * M_PI * M_PI * backscatterPerMmSr * FieldLevel(*echo.field).focusAreaMm2() *
                       pulseEnergyMm(echo) / (seen * seen);
  // The level is that of a tissue whose scatterers are all there and of amplitude 1.
  const double ofGel =
    gel.scattererProbability * (gel.scattererMean * gel.scattererMean + gel.scattererSigma * gel.scattererSigma);
  return 10.0 * std::log10(power / ofGel);
}

} // namespace sono::study
