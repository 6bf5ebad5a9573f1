#pragma once

#include "Core/Progress.h"
#include "Kernel/ArrayBeam.h"
#include "Probe/ArrayAperture.h"
#include "Probe/ArraySight.h"

#include <complex>
#include <optional>
#include <vector>

namespace sono {

/// The complex two-way beam of an array (Data/docs/physics.md section 12.2): transmit and receive keep their
/// wavefronts, whose product narrows the speckle where the beam is not in focus. Lateral and elevational axis are a
/// factor each (Fresnel's approximation): elements or, across the plane, strips of at most half a wavelength, summed
/// with their delays and a rigid baffle's directivity; a matrix's rows as its columns.
///
/// Reception is focused at each depth, with min(D, z) of an array's width D open; per area of what is open its
/// sensitivity is kept, as that of the Gaussians (12.1). One frequency stands for the whole band: that whose wavelength
/// is the band's mean one, each tone weighted by the energy of its beam, which is wider the lower it is:
///   f_e = f0 / (1 + (s_f / f0)^2)                                                                              (12.6)
/// The lateral autocorrelation of speckle is then within 7 % of that of the elements' broadband sum.
///
/// Of a harmonic, half the frequency is sent and its square counts, over its modulus on the axis: along the axis the
/// harmonic goes as what is sent and as J of SecondHarmonic.h says.
///
/// Values lie at depths from 0 to the last one, and at shares of the depth across: at most lambda / (12 D).
class ArrayField
{
public:
  /// Throws Error naming the parameter, Aborted.
  ArrayField(const ArrayAperture& aperture, double depthMm, const Progress& progress = {});

  /// For lookups while this lives. The weight of the axis at the transmit focus (within the depth) is 1.
  ArrayBeamView view() const { return view(lateral_.data(), elevational_.data()); }
  /// The same for copies of the values that lie elsewhere.
  ArrayBeamView view(const float* lateral, const float* elevational) const;
  const std::vector<float>& lateral() const { return lateral_; }
  const std::vector<float>& elevational() const { return elevational_; }
  /// Where it counts.
  const ArraySight& sight() const { return *sight_; }
  double depthMm() const { return depthMm_; }
  double focusMm() const { return focusMm_; }
  /// f_e of (12.6).
  double frequencyMHz() const { return frequencyMHz_; }

  /// The exact sums at a place, without the table: those of either axis, relative to the focus.
  std::complex<double> lateralAt(double lateralMm, double rangeMm) const;
  std::complex<double> elevationalAt(double elevationalMm, double rangeMm) const;

private:
  /// A piece of the aperture, as one axis sees it.
  struct AxisPiece
  {
    double alongMm;
    double axialMm;
    double normalAlong;
    double normalAxial;
    double weight;
    double delayAlongMm; ///< of the place whose delay it has
    double delayAxialMm;
  };
  struct Axis
  {
    std::vector<AxisPiece> pieces;
    double apertureMm = 0.0;
    double transmitFocusMm = 0.0;
    double pieceMm = 0.0;
    bool isArray = true; ///< receives focused at each depth
    std::complex<double> atFocus{ 1.0, 0.0 };
    int count = 0;
    double perUnit = 0.0;
    double nearMm = 0.0;
  };

  static Axis lateralAxis(const ArrayAperture& aperture, double wavelengthMm);
  static Axis elevationalAxis(const ArrayAperture& aperture, double wavelengthMm);
  struct Ways
  {
    std::complex<double> transmit;
    std::complex<double> receive;
    double opening; ///< of the reception, for what of the array is shut
  };
  Ways waysTo(const Axis& axis, double alongMm, double rangeMm) const;
  /// What is sent along the axis, where twoWay wants it; 1 where it does not.
  double onAxis(const Axis& axis, double rangeMm) const;
  std::complex<double> twoWay(const Axis& axis, double alongMm, double rangeMm, double onAxis) const;
  void normalise(Axis& axis) const;
  std::vector<float> tabulate(const Axis& axis, const Progress& progress) const;

  double depthMm_;
  double frequencyMHz_;
  double wavelengthMm_;
  ImagingMode mode_;
  double focusMm_;
  Axis lateralAxis_;
  Axis elevationalAxis_;
  std::vector<float> lateral_; // re, im
  std::vector<float> elevational_;
  std::optional<ArraySight> sight_; // once the values are there
};

} // namespace sono
