#include "WireRange.h"

#include "Echo/Pulse.h"
#include "WireEcho.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

namespace sono::study {
namespace {

using Complex = std::complex<double>;

std::vector<double> middles(int count, double from, double to)
{
  std::vector<double> places;
  for (int i = 0; i < count; ++i)
  {
    places.push_back(from + (i + 0.5) * (to - from) / count);
  }
  return places;
}

/// What is sent to a piece of the wire and heard from it, at one tone, over the phase of the way along the axis.
Complex thereAndBack(const ArrayAperture& aperture, double depthMm, double pieceMm, double perMm)
{
  constexpr int strips = 28;
  Complex sent = 0.0;
  Complex heard = 0.0;
  for (double x : middles(aperture.elementCount, -0.5 * aperture.widthMm(), 0.5 * aperture.widthMm()))
  {
    const double inPlane = std::hypot(x, depthMm);
    const double slope = 0.5 * perMm * aperture.elementWidthMm * x / inPlane;
    const double directivity = (std::fabs(slope) < 1e-9 ? 1.0 : std::sin(slope) / slope) * depthMm / inPlane;
    Complex element = 0.0;
    for (double y : middles(strips, -0.5 * aperture.elementHeightMm, 0.5 * aperture.elementHeightMm))
    {
      const double way = std::hypot(inPlane, pieceMm - y);
      const double lens = std::hypot(aperture.elevationFocusMm, y) - aperture.elevationFocusMm;
      element += std::polar(directivity / way, perMm * (way - lens - depthMm));
    }
    const double focus = aperture.transmitFocusMm;
    sent += element * std::polar(1.0, -perMm * (std::hypot(focus, x) - focus));
    if (2.0 * std::fabs(x) <= depthMm)
    {
      heard += element * std::polar(1.0, -perMm * (inPlane - depthMm));
    }
  }
  return sent * heard;
}

/// Middle of where the echo of these tones is above half of its height, of ranges relative to the depth.
double middleOf(const std::vector<double>& perMm, const std::vector<Complex>& tones)
{
  constexpr double step = 0.002;
  constexpr int reach = 600;
  std::vector<double> echo;
  for (int i = -reach; i <= reach; ++i)
  {
    Complex sum = 0.0;
    for (std::size_t n = 0; n < tones.size(); ++n)
    {
      sum += tones[n] * std::polar(1.0, -2.0 * perMm[n] * i * step);
    }
    echo.push_back(std::abs(sum));
  }
  const double half = 0.5 * *std::max_element(echo.begin(), echo.end());
  const auto isAbove = [half](double e) { return e >= half; };
  const auto first = std::find_if(echo.begin(), echo.end(), isAbove) - echo.begin();
  const auto last = echo.rend() - std::find_if(echo.rbegin(), echo.rend(), isAbove) - 1;
  return (0.5 * double(first + last) - reach) * step;
}

} // namespace

double wireRangeShiftMm(const ArrayAperture& aperture, double depthMm, double diameterMm, double attenuationDbPerCmMHz)
{
  const double c = aperture.soundSpeedMmPerUs;
  const double sigmaMm = pulseSigmaMm(aperture.centreFrequencyMHz, aperture.fractionalBandwidth);
  const double deviationMHz = c / (4.0 * M_PI * sigmaMm);
  const std::vector<double> pieces = diameterMm > 0.0 ? middles(100, 0.0, 20.0) : std::vector<double>{ 0.0 };
  std::vector<double> perMm;
  std::vector<Complex> tones;
  for (double share : middles(80, -3.0, 3.0))
  {
    const double f = aperture.centreFrequencyMHz + share * deviationMHz;
    if (f <= 0.0)
    {
      continue;
    }
    const double k = 2.0 * M_PI * f / c;
    Complex tone = std::exp(-0.5 * share * share) * std::pow(10.0, -0.1 * attenuationDbPerCmMHz * f * depthMm / 10.0);
    tone *= diameterMm > 0.0 ? nylonScattering(k, diameterMm) : Complex(1.0);
    Complex beam = 0.0;
    for (double y : pieces)
    {
      beam += thereAndBack(aperture, depthMm, y, k);
    }
    perMm.push_back(k);
    tones.push_back(tone * beam);
  }
  return middleOf(perMm, tones);
}

} // namespace sono::study
