#include "Probe/BeamAperture.h"

#include "Core/SoundSpeed.h"

#include <cmath>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double sigmaOfAperture = 0.376; // s = 0.376 lambda z / D of the product of two ways (12.1)

ApertureAxis axisOf(double apertureMm, double focusMm, double wavelengthMm, bool lens)
{
  const double waistMm = apertureMm / (sigmaOfAperture * 2.0 * pi); // (12.3)
  const double spread = wavelengthMm / (pi * waistMm);
  const double narrowestMm = sigmaOfAperture * std::sqrt(2.0) * wavelengthMm;
  ApertureAxis axis{};
  axis.waist2 = float(waistMm * waistMm);
  axis.perFocus = focusMm > 0.0 ? float(1.0 / focusMm) : 0.0f;
  axis.spread2 = float(spread * spread);
  axis.aperture2 = float(apertureMm * apertureMm);
  axis.perNarrowest2 = float(1.0 / (narrowestMm * narrowestMm));
  axis.lens = lens;
  axis.cosine2 = 1.0f;
  return axis;
}

double sinc(double x)
{
  return std::abs(x) < 1e-6 ? 1.0 : std::sin(pi * x) / (pi * x);
}

} // namespace

double focusDepthMm(const BeamAperture& aperture, double frequencyMHz)
{
  const double naturalMm = 0.25 * aperture.apertureMm * aperture.apertureMm * frequencyMHz / assumedSoundSpeedMmPerUs;
  return aperture.transmitFocusMm > 0.0    ? aperture.transmitFocusMm
         : aperture.elevationFocusMm > 0.0 ? aperture.elevationFocusMm
                                           : naturalMm;
}

ApertureProfile apertureProfile(const BeamAperture& aperture, double frequencyMHz)
{
  const double wavelengthMm = assumedSoundSpeedMmPerUs / frequencyMHz;
  ApertureProfile profile{};
  profile.lateral = axisOf(aperture.apertureMm, aperture.transmitFocusMm, wavelengthMm, false);
  profile.elevational =
    axisOf(aperture.elevationApertureMm, aperture.focusAcrossMm(), wavelengthMm, !aperture.elevationIsArray);
  profile.gain = 1.0f;
  profile.gain = 1.0f / profileAt(profile, float(focusDepthMm(aperture, frequencyMHz))).amplitude;
  return profile;
}

ApertureProfile steeredProfile(const ApertureProfile& straight, const BeamAperture& aperture, double frequencyMHz,
                               const ScanLine& line)
{
  ApertureProfile profile = straight;
  const Vec2d cosine2 = apertureCosines2(line);
  profile.lateral.cosine2 = float(cosine2.x);
  profile.elevational.cosine2 = float(cosine2.y);
  profile.gain *= float(directivity(aperture, frequencyMHz, line));
  return profile;
}

Vec2d apertureCosines2(const ScanLine& line)
{
  const double lateral2 = 1.0 - line.steeringLateral * line.steeringLateral;
  // A matrix's line points to (sin theta, cos theta sin phi): the elevational aperture is seen at phi.
  return { lateral2, 1.0 - line.steeringElevational * line.steeringElevational / lateral2 };
}

double directivity(const BeamAperture& aperture, double frequencyMHz, const ScanLine& line)
{
  const double perWavelength = aperture.elementWidthMm * frequencyMHz / assumedSoundSpeedMmPerUs;
  const double across = aperture.elevationIsArray ? sinc(perWavelength * line.steeringElevational) : 1.0;
  const double cosine2 =
    1.0 - line.steeringLateral * line.steeringLateral - line.steeringElevational * line.steeringElevational;
  return std::pow(sinc(perWavelength * line.steeringLateral) * across, 2) * std::fmax(cosine2, 0.0);
}

} // namespace sono
