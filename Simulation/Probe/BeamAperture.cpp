#include "Probe/BeamAperture.h"

#include "Core/SoundSpeed.h"

#include <cmath>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double sigmaOfAperture = 0.376; // s = 0.376 lambda z / D of the product of two ways (12.1)

double waistMmOf(double apertureMm)
{
  return apertureMm / (sigmaOfAperture * 2.0 * pi); // (12.3)
}

ApertureAxis axisOf(double apertureMm, double focusMm, double wavelengthMm, bool lens, ImagingMode mode)
{
  const double waistMm = waistMmOf(apertureMm);
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
  if (mode == ImagingMode::Harmonic)
  {
    // Sent: half of W^2 (12.2) at twice the wavelength, that is W_a^2/2 and twice the spread here. A lens gives each
    // way half of what both have together: 4/W_a^2 and 2/W_a^2 at the face, 1/s^2 and 2/s^2 at the focus, s its spread.
    axis.waist2 *= lens ? 2.0f / 3.0f : 0.5f;
    axis.spread2 *= lens ? 4.0f / 3.0f : 2.0f;
  }
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

ApertureProfile apertureProfile(const BeamAperture& aperture, double frequencyMHz, ImagingMode mode)
{
  const double wavelengthMm = assumedSoundSpeedMmPerUs / frequencyMHz;
  ApertureProfile profile{};
  profile.lateral = axisOf(aperture.apertureMm, aperture.transmitFocusMm, wavelengthMm, false, mode);
  profile.elevational =
    axisOf(aperture.elevationApertureMm, aperture.focusAcrossMm(), wavelengthMm, !aperture.elevationIsArray, mode);
  profile.gain = 1.0f;
  profile.gain = 1.0f / profileAt(profile, float(focusDepthMm(aperture, sentMHz(mode, frequencyMHz)))).amplitude;
  return profile;
}

ApertureProfile steeredProfile(const ApertureProfile& straight, const BeamAperture& aperture, double frequencyMHz,
                               const ScanLine& line, ImagingMode mode)
{
  ApertureProfile profile = straight;
  const Vec2d cosine2 = apertureCosines2(line);
  profile.lateral.cosine2 = float(cosine2.x);
  profile.elevational.cosine2 = float(cosine2.y);
  profile.gain *= float(directivity(aperture, frequencyMHz, line, mode));
  return profile;
}

std::complex<double> sentGain(const BeamAperture& aperture, double frequencyMHz, double depthMm)
{
  if (!aperture.isNamed())
  {
    return 1.0;
  }
  const double wavelengthMm = assumedSoundSpeedMmPerUs / frequencyMHz;
  const auto along = [&](double apertureMm, double focusMm) {
    const double waistMm = waistMmOf(apertureMm);
    const double bend = focusMm > 0.0 ? 1.0 - depthMm / focusMm : 1.0;
    return 1.0 / std::sqrt(std::complex<double>(bend, -wavelengthMm * depthMm / (pi * waistMm * waistMm)));
  };
  return along(aperture.apertureMm, aperture.transmitFocusMm) *
         along(aperture.elevationApertureMm, aperture.focusAcrossMm());
}

Vec2d apertureCosines2(const ScanLine& line)
{
  const double lateral2 = 1.0 - line.steeringLateral * line.steeringLateral;
  // A matrix's line points to (sin theta, cos theta sin phi): the elevational aperture is seen at phi.
  return { lateral2, 1.0 - line.steeringElevational * line.steeringElevational / lateral2 };
}

double directivity(const BeamAperture& aperture, double frequencyMHz, const ScanLine& line, ImagingMode mode)
{
  if (mode == ImagingMode::Harmonic)
  {
    return directivity(aperture, sentMHz(mode, frequencyMHz), line) *
           std::sqrt(directivity(aperture, frequencyMHz, line));
  }
  const double perWavelength = aperture.elementWidthMm * frequencyMHz / assumedSoundSpeedMmPerUs;
  const double across = aperture.elevationIsArray ? sinc(perWavelength * line.steeringElevational) : 1.0;
  const double cosine2 =
    1.0 - line.steeringLateral * line.steeringLateral - line.steeringElevational * line.steeringElevational;
  return std::pow(sinc(perWavelength * line.steeringLateral) * across, 2) * std::fmax(cosine2, 0.0);
}

} // namespace sono
