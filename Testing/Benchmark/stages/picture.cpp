// beams: speckle widths in depth, the computed field between its nodes, the pulse's frequency at 12 cm
#include "BeamScenes.h"
#include "Stage.h"

#include "Echo/BeamModel.h"
#include "Probe/ArrayField.h"

#include <cmath>
#include <complex>
#include <memory>

namespace {

using namespace sono;
using namespace sono::test;

constexpr double depthMm = 135.0;

/// Against the beam's own width, of Gaussians; against the elements' sum, of the computed field.
void measureWidths()
{
  const EchoSettings gaussian = echoOf(p42(), depthMm);
  EchoSettings field = gaussian;
  field.arrayField = std::make_shared<ArrayField>(apertureOf(p42()), depthMm);
  const BeamModel model(gaussian, InterfaceModel::Acoustic);
  double ofGaussian = 0.0;
  double ofField = 0.0;
  double gaussianToElements = 0.0;
  for (const auto& [z, elementsMm] : elementSpeckleWidths)
  {
    const double widthMm = speckleWidthMm(gaussian, z);
    const double ownMm = std::sqrt(2.0) * halfWidth * model.widthAt(z).lateralSigmaMm;
    ofGaussian = std::max(ofGaussian, std::abs(widthMm / ownMm - 1.0));
    gaussianToElements = std::max(gaussianToElements, std::abs(widthMm / elementsMm - 1.0));
    ofField = std::max(ofField, std::abs(speckleWidthMm(field, z) / elementsMm - 1.0));
  }
  printFigure("lateral_width_error_percent", 100.0 * std::max(ofGaussian, ofField), "%");
  printFigure("lateral_width_gaussian_to_elements_percent", 100.0 * gaussianToElements, "%");
}

/// Largest error of the table where the beam is within 20 dB of its axis, at places that are no nodes.
void measureTable()
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
  printFigure("field_table_error_db", worstDb, "dB");
}

/// Centre frequency of a point's echo behind 12 cm of 0.5 dB/(cm MHz), against f0 - B s_f^2.
void measureDownshift()
{
  const EchoSettings s = echoOf(p42(), depthMm);
  const double perMm = 2.0 * 0.05 / 8.685889638065037; // B, Np/MHz
  TracedLines traced;
  traced.lineCount = 1;
  traced.binMm = 0.25;
  traced.binCount = int(depthMm / traced.binMm);
  for (int b = 0; b < traced.binCount; ++b)
  {
    const double exponent = perMm * (b + 0.5) * traced.binMm;
    traced.intensity.push_back(float(std::exp(-exponent * s.centreFrequencyMHz)));
    traced.attenuationNpPerMHz.push_back(float(exponent));
  }
  const PointScatterers point({ { { 0.0, 0.0, 120.0 }, 1.0f } });
  const RfLines rf = formRf({ nullptr, &traced, &point }, parallelLines(1, Vec3d(0.0), 1.0), s);
  const auto at = std::size_t(std::lround(120.0 / rf.sampleMm));
  const double turn = std::arg(std::complex<double>(rf.iq[at + 3]) * std::conj(std::complex<double>(rf.iq[at - 3])));
  const double frequencyMHz = s.centreFrequencyMHz + turn / (6.0 * rf.sampleMm) * 1.54 / (4.0 * M_PI);
  const double spectrumMHz = 1.54 / (4.0 * M_PI * pulseSigmaMm(s.centreFrequencyMHz, s.fractionalBandwidth));
  const double expectedMHz = s.centreFrequencyMHz - perMm * 120.0 * spectrumMHz * spectrumMHz;
  printFigure("downshift_error_percent", 100.0 * std::abs(frequencyMHz / expectedMHz - 1.0), "%");
}

void measurePicture()
{
  measureWidths();
  measureTable();
  measureDownshift();
}

const Stage picture("picture", measurePicture);

} // namespace
