#pragma once

#include "BeamScenes.h"

#include "Echo/BeamModel.h"
#include "Probe/ArrayField.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <vector>

// How wide beams are and what attenuation does to the pulse (Data/docs/physics.md section 12), as tests judge it and
// `measure picture` prints it.

namespace sono::test {

/// Widths of speckle against what they ought to be, largest relative errors at 30 to 120 mm.
struct WidthErrors
{
  double gaussian = 0.0;           ///< against the beam's own
  double field = 0.0;              ///< of the computed field, against the elements' sum
  double gaussianToElements = 0.0; ///< of the Gaussians, against the elements' sum
};

inline WidthErrors widthErrors(double depthMm = 135.0)
{
  const EchoSettings gaussian = echoOf(p42(), depthMm);
  EchoSettings field = gaussian;
  field.arrayField = std::make_shared<ArrayField>(apertureOf(p42()), depthMm);
  const BeamModel model(gaussian, InterfaceModel::Acoustic);
  WidthErrors worst;
  for (const auto& [z, elementsMm] : elementSpeckleWidths)
  {
    // That of a Gaussian is wider than the beam by the root of 2.
    const double widthMm = speckleWidthMm(gaussian, z);
    const double ownMm = std::sqrt(2.0) * halfWidth * model.widthAt(z).lateralSigmaMm;
    worst.gaussian = std::max(worst.gaussian, std::abs(widthMm / ownMm - 1.0));
    worst.gaussianToElements = std::max(worst.gaussianToElements, std::abs(widthMm / elementsMm - 1.0));
    worst.field = std::max(worst.field, std::abs(speckleWidthMm(field, z) / elementsMm - 1.0));
  }
  return worst;
}

/// Largest error of the computed field's table where the beam is within 20 dB of its axis, at places that are no nodes.
inline double fieldTableErrorDb(double depthMm = 135.0)
{
  const ArrayField field(apertureOf(p42()), depthMm);
  const ArrayBeamView view = field.view();
  double worstDb = 0.0;
  for (const double z : { 20.3, 30.1, 47.7, 65.2, 90.4, 119.9 })
  {
    const double stepMm = 1.54 / field.frequencyMHz() * z / 20.455 / 31.0;
    const std::complex<double> axis = field.lateralAt(0.0, z);
    const std::complex<double> across = field.elevationalAt(0.0, z);
    for (int n = 0; n < 62; ++n)
    {
      const std::complex<double> exact = field.lateralAt(n * stepMm, z);
      const ComplexWeight w = arrayBeamWeight(view, float(n * stepMm), 0.0f, float(z));
      if (std::abs(exact) > 0.1 * std::abs(axis))
      {
        worstDb = std::max(worstDb, std::abs(20.0 * std::log10(std::hypot(w.re, w.im) / std::abs(exact * across))));
      }
    }
  }
  return worstDb;
}

/// B of 0.5 dB/(cm MHz), Np/MHz.
inline double uniformExponentAt(double depthMm)
{
  return 2.0 * 0.5 * depthMm / 10.0 / 8.685889638065037;
}

/// A line through a uniform phantom of that attenuation.
inline TracedLines uniformPhantom(double depthMm, double frequencyMHz)
{
  TracedLines traced;
  traced.lineCount = 1;
  traced.binMm = 0.25;
  traced.binCount = int(std::ceil(depthMm / traced.binMm));
  for (int b = 0; b < traced.binCount; ++b)
  {
    const double exponent = uniformExponentAt((b + 0.5) * traced.binMm);
    traced.intensity.push_back(float(std::exp(-exponent * frequencyMHz)));
    traced.attenuationNpPerMHz.push_back(float(exponent));
  }
  return traced;
}

/// RF of a line on whose axis a point lies at this depth.
inline RfLines pointEcho(const TracedLines& traced, const EchoSettings& s, double depthMm)
{
  const PointScatterers point({ { { 0.0, 0.0, depthMm }, 1.0f } });
  return formRf({ nullptr, &traced, &point }, parallelLines(1, Vec3d(0.0), 1.0), s);
}

/// Of the first line's echo at a depth, by how its phase turns there.
inline double frequencyAtMHz(const RfLines& rf, double depthMm)
{
  const auto at = std::size_t(std::lround(depthMm / rf.sampleMm));
  const double turn = std::arg(std::complex<double>(rf.iq[at + 3]) * std::conj(std::complex<double>(rf.iq[at - 3])));
  return rf.centreFrequencyMHz + turn / (6.0 * rf.sampleMm) * 1.54 / (4.0 * M_PI);
}

/// Centre frequency of a point's echo behind 12 cm of 0.5 dB/(cm MHz), against f0 - B s_f^2: relative.
inline double downshiftError()
{
  const EchoSettings s = echoOf(p42(), 135.0);
  const double frequencyMHz =
    frequencyAtMHz(pointEcho(uniformPhantom(s.depthMm, s.centreFrequencyMHz), s, 120.0), 120.0);
  const double spectrumMHz = 1.54 / (4.0 * M_PI * pulseSigmaMm(s.centreFrequencyMHz, s.fractionalBandwidth));
  const double expectedMHz = s.centreFrequencyMHz - uniformExponentAt(120.0) * spectrumMHz * spectrumMHz;
  return std::abs(frequencyMHz / expectedMHz - 1.0);
}

} // namespace sono::test
