#include "Probe/ArrayField.h"

#include "Core/ParallelFor.h"
#include "Probe/ApertureElements.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int stepsToWidth = 12; // of the table, to lambda z / D: linear between them, 0.3 dB at -20 dB
constexpr int widthsAcross = 16; // lambda z / D on either side of the axis
constexpr int rangeCount = 320;
constexpr double mmPerHalfWidth = 0.62; // of a lens near the face, in heights: what it covers, and some more

double sinc(double x)
{
  return std::abs(x) < 1e-4 ? 1.0 - x * x / 6.0 : std::sin(x) / x;
}

double beamFrequencyMHz(const ArrayAperture& aperture)
{
  // s_f of the Gaussian whose echo is b f wide at -6 dB
  const double share = aperture.fractionalBandwidth / (2.0 * std::sqrt(2.0 * 0.3 * std::log(10.0)));
  return aperture.centreFrequencyMHz / (1.0 + share * share);
}

} // namespace

ArrayField::Axis ArrayField::lateralAxis(const ArrayAperture& aperture, double wavelengthMm)
{
  Axis axis;
  const Elements elements = makeElements(aperture, wavelengthMm);
  for (const Piece& p : elements.pieces)
  {
    const Place& element = elements.centre[std::size_t(p.element)];
    axis.pieces.push_back({ p.centre.lateralMm, p.centre.axialMm, p.normal.lateralMm, p.normal.axialMm, p.weight,
                            element.lateralMm, element.axialMm });
  }
  axis.pieceMm = elements.pieceWidthMm;
  axis.apertureMm = aperture.widthMm();
  axis.transmitFocusMm = aperture.transmitFocusMm;
  axis.nearMm = axis.apertureMm;
  axis.perUnit = stepsToWidth * axis.apertureMm / wavelengthMm;
  axis.count = std::min(stepsToWidth * widthsAcross, int(axis.perUnit)) + 1;
  return axis;
}

ArrayField::Axis ArrayField::elevationalAxis(const ArrayAperture& aperture, double wavelengthMm)
{
  ArrayAperture across = aperture;
  across.faceRadiusMm = 0.0;
  across.apodization = Apodization::Boxcar;
  if (aperture.elevationCount > 1)
  {
    across.elementCount = aperture.elevationCount;
    across.elementWidthMm = aperture.elementHeightMm;
    return lateralAxis(across, wavelengthMm);
  }
  // A lens delays each strip by itself.
  across.elementCount = std::max(1, int(std::ceil(aperture.elementHeightMm / (0.5 * wavelengthMm) - 1e-9)));
  across.elementWidthMm = aperture.elementHeightMm / across.elementCount;
  across.kerfMm = 0.0;
  Axis axis = lateralAxis(across, wavelengthMm);
  axis.transmitFocusMm = aperture.elevationFocusMm;
  axis.isArray = false;
  axis.count = std::max(axis.count, int(std::ceil(mmPerHalfWidth * axis.perUnit)) + 1);
  return axis;
}

ArrayField::ArrayField(const ArrayAperture& aperture, double depthMm, const Progress& progress)
  : depthMm_(depthMm)
  , mode_(aperture.imagingMode)
{
  aperture.validate();
  if (!(depthMm > 0.0 && depthMm <= 1000.0))
  {
    throw Error("the field's depth is " + std::to_string(depthMm) + " mm; choose more than 0 and at most 1000.");
  }
  frequencyMHz_ = beamFrequencyMHz(aperture);
  wavelengthMm_ = aperture.soundSpeedMmPerUs / frequencyMHz_;
  focusMm_ =
    std::min({ aperture.transmitFocusMm, depthMm,
               std::isinf(aperture.transmitFocusMm)
                 ? 0.25 * aperture.widthMm() * aperture.widthMm() * sentMHz(mode_, 1.0 / wavelengthMm_) + wavelengthMm_
                 : aperture.transmitFocusMm });
  lateralAxis_ = lateralAxis(aperture, wavelengthMm_);
  elevationalAxis_ = elevationalAxis(aperture, wavelengthMm_);
  normalise(lateralAxis_);
  normalise(elevationalAxis_);
  lateral_ = tabulate(lateralAxis_, partOf(progress, 0.0, 0.6));
  elevational_ = tabulate(elevationalAxis_, partOf(progress, 0.6, 1.0));
  sight_.emplace(view(), depthMm);
}

void ArrayField::normalise(Axis& axis) const
{
  axis.atFocus = twoWay(axis, 0.0, focusMm_, onAxis(axis, focusMm_));
  if (!(std::abs(axis.atFocus) > 0.0))
  {
    throw Error("the field is zero at its focus; correct the foci.");
  }
}

ArrayField::Ways ArrayField::waysTo(const Axis& axis, double alongMm, double rangeMm) const
{
  const bool isHarmonic = mode_ == ImagingMode::Harmonic;
  const double k = 2.0 * pi / wavelengthMm_;
  const double sentK = sentMHz(mode_, k); // goes with the frequency
  const double nearestMm = 0.25 * wavelengthMm_;
  const double axialMm = std::sqrt(rangeMm * rangeMm - alongMm * alongMm);
  const double stepMm = axis.apertureMm / double(axis.pieces.size());
  const double halfOpenMm = 0.5 * std::max(rangeMm, 2.0 * stepMm);
  std::complex<double> transmit;
  std::complex<double> receive;
  double all = 0.0;
  double open = 0.0;
  for (const AxisPiece& p : axis.pieces)
  {
    const double dx = alongMm - p.alongMm;
    const double dz = axialMm - p.axialMm;
    const double share = std::clamp((halfOpenMm - std::abs(p.alongMm)) / stepMm + 0.5, 0.0, 1.0);
    all += p.weight;
    open += p.weight * share;
    if (dx * p.normalAlong + dz * p.normalAxial < 0.0)
    {
      continue; // behind a convex face
    }
    const double r = std::max(std::sqrt(dx * dx + dz * dz), nearestMm);
    const double sine = (dx * p.normalAxial - dz * p.normalAlong) / r;
    const auto sizeAt = [&](double number) {
      return p.weight * sinc(0.5 * number * axis.pieceMm * sine) / std::sqrt(r);
    };
    const double size = sizeAt(k);
    const auto lengthMm = [&](double focusMm) { // of path that the delay makes up for
      return std::isinf(focusMm) ? -p.delayAxialMm : std::hypot(p.delayAlongMm, focusMm - p.delayAxialMm) - focusMm;
    };
    const double transmitMm = lengthMm(axis.transmitFocusMm);
    transmit += std::polar(isHarmonic ? sizeAt(sentK) : size, sentK * (r - rangeMm - transmitMm));
    if (axis.isArray)
    {
      receive += std::polar(size * share, k * (r - rangeMm - lengthMm(rangeMm)));
    }
    else if (isHarmonic)
    {
      receive += std::polar(size, k * (r - rangeMm - transmitMm));
    }
  }
  return { transmit, receive, std::sqrt(all / open) };
}

double ArrayField::onAxis(const Axis& axis, double rangeMm) const
{
  return mode_ == ImagingMode::Harmonic ? std::abs(waysTo(axis, 0.0, rangeMm).transmit) : 1.0;
}

std::complex<double> ArrayField::twoWay(const Axis& axis, double alongMm, double rangeMm, double onAxis) const
{
  if (std::abs(alongMm) > rangeMm)
  {
    return 0.0;
  }
  const Ways w = waysTo(axis, alongMm, rangeMm);
  if (mode_ == ImagingMode::Harmonic)
  {
    return w.transmit * w.transmit / onAxis * w.receive * (axis.isArray ? w.opening : 1.0) / axis.atFocus;
  }
  return (axis.isArray ? w.transmit * w.receive * w.opening : w.transmit * w.transmit) / axis.atFocus;
}

std::complex<double> ArrayField::lateralAt(double lateralMm, double rangeMm) const
{
  return twoWay(lateralAxis_, lateralMm, rangeMm, onAxis(lateralAxis_, rangeMm));
}

std::complex<double> ArrayField::elevationalAt(double elevationalMm, double rangeMm) const
{
  return twoWay(elevationalAxis_, elevationalMm, rangeMm, onAxis(elevationalAxis_, rangeMm));
}

std::vector<float> ArrayField::tabulate(const Axis& axis, const Progress& progress) const
{
  std::vector<float> values(2 * std::size_t(rangeCount) * std::size_t(axis.count));
  parallelFor(rangeCount, progress, [&](int n) {
    const double rangeMm = std::max(n * depthMm_ / (rangeCount - 1), 0.25 * wavelengthMm_);
    const double atAxis = onAxis(axis, rangeMm);
    float* to = values.data() + 2 * std::size_t(n) * std::size_t(axis.count);
    for (int i = 0; i < axis.count; ++i)
    {
      const std::complex<double> w = twoWay(axis, i / axis.perUnit * std::max(rangeMm, axis.nearMm), rangeMm, atAxis);
      *to++ = float(w.real());
      *to++ = float(w.imag());
    }
  });
  return values;
}

ArrayBeamView ArrayField::view(const float* lateral, const float* elevational) const
{
  const auto axisOf = [](const Axis& axis, const float* values) {
    return ArrayBeamAxis{ values, axis.count, float(axis.perUnit), float(axis.nearMm) };
  };
  return { axisOf(lateralAxis_, lateral), axisOf(elevationalAxis_, elevational), float((rangeCount - 1) / depthMm_),
           rangeCount };
}

} // namespace sono
