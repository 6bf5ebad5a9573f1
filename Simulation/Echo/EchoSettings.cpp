#include "Echo/EchoSettings.h"

#include "Core/Error.h"
#include "Core/Require.h"

#include <cmath>
#include <sstream>
#include <string>

namespace sono {

namespace {

void requireReaches(const PulseEchoField& field, double depthMm)
{
  const BeamFieldAxis depth = field.view().depth;
  const double slackMm = 1e-3; // for rounded steps
  if (depth.highMm < depthMm - slackMm || depth.lowMm > depthMm)
  {
    throw Error("the pulse-echo field covers depths of " + std::to_string(depth.lowMm) + " to " +
                std::to_string(depth.highMm) + " mm but the image is " + std::to_string(depthMm) +
                " mm deep: give a field that reaches there, or lower the depth");
  }
}

void requireReaches(const ArrayField& field, double depthMm)
{
  if (field.depthMm() < depthMm - 1e-3)
  {
    throw Error("the array's field is " + std::to_string(field.depthMm()) + " mm deep but the image is " +
                std::to_string(depthMm) + " mm deep: compute it to there, or lower the depth");
  }
}

} // namespace

void EchoSettings::validate() const
{
  requireInRange(*this);
  requireInRange(centreFrequencyMHz > 0.0 && std::isfinite(centreFrequencyMHz), "centre frequency (MHz)",
                 centreFrequencyMHz, "more than 0");
  requireInRange(fractionalBandwidth > 0.0 && fractionalBandwidth < 2.0, "fractional bandwidth", fractionalBandwidth,
                 "more than 0 and below 2");
  if (!(samplingInMHz() > 2.0 * centreFrequencyMHz))
  {
    const bool isHarmonic = imagingMode == ImagingMode::Harmonic;
    std::ostringstream sentence;
    if (isHarmonic)
    {
      sentence << "the second harmonic lies at " << centreFrequencyMHz
               << " MHz, not below half the sampling frequency of " << samplingMHz << " MHz";
    }
    else
    {
      sentence << "the sampling frequency of " << samplingMHz << " MHz is not above twice the centre frequency of "
               << centreFrequencyMHz << " MHz";
    }
    sentence << ": raise Sampling (MHz) above " << 2.0 * centreFrequencyMHz << (isHarmonic ? ", " : ", or ")
             << "lower the probe's Centre Frequency" << (isHarmonic ? ", or set its Imaging Mode to Fundamental" : "");
    throw Error(sentence.str());
  }
  requireInRange(samplingMHz <= 1000.0, "sampling frequency (MHz)", samplingMHz, "at most 1000");
  requireInRange(depthMm > 0.0 && depthMm <= 1000.0, "depth (mm)", depthMm, "more than 0 and at most 1000");
  requireInRange(aperture);
  if (arrayField)
  {
    requireReaches(*arrayField, depthMm);
  }
  if (field && arrayField)
  {
    throw Error("there are a pulse-echo field and an array's field: give one of them");
  }
  if (field)
  {
    requireReaches(*field, depthMm);
  }
}

int EchoSettings::sampleCount() const
{
  return int(std::floor(depthMm / sampleMm())) + 1;
}

} // namespace sono
