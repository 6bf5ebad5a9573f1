#include "Probe/ArrayAperture.h"

#include "Core/Progress.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <tuple>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;

void require(const char* parameter, double value, bool good, const char* range)
{
  if (!good)
  {
    std::ostringstream message;
    message << parameter << " is " << value << "; choose " << range << ".";
    throw Error(message.str());
  }
}

auto tied(const ArrayAperture& a)
{
  return std::tie(a.elementCount, a.elementWidthMm, a.elementHeightMm, a.kerfMm, a.faceRadiusMm, a.transmitFocusMm,
                  a.elevationFocusMm, a.apodization, a.imagingMode, a.centreFrequencyMHz, a.fractionalBandwidth,
                  a.attenuationDbPerCmMHz, a.soundSpeedMmPerUs, a.elevationCount);
}

} // namespace

bool ArrayAperture::operator==(const ArrayAperture& other) const
{
  return tied(*this) == tied(other);
}

void ArrayAperture::validate() const
{
  const auto positive = [](double v) { return v > 0.0 && v <= 1e4; };
  require("elementCount", elementCount, elementCount >= 1 && elementCount <= 4096, "1 to 4096");
  require("elevationCount", elevationCount, elevationCount >= 1 && elevationCount <= 4096, "1 to 4096");
  require("elementWidthMm", elementWidthMm, positive(elementWidthMm), "more than 0 and at most 10^4 mm");
  require("elementHeightMm", elementHeightMm, positive(elementHeightMm), "more than 0 and at most 10^4 mm");
  require("kerfMm", kerfMm, kerfMm >= 0.0 && kerfMm <= 1e4, "0 to 10^4 mm");
  require("faceRadiusMm", faceRadiusMm,
          faceRadiusMm == 0.0 || (positive(faceRadiusMm) && faceRadiusMm > widthMm() / pi),
          "0 (flat), or a radius whose half circle is longer than the aperture");
  require("transmitFocusMm", transmitFocusMm, transmitFocusMm > 0.0, "more than 0, or infinity for none");
  require("elevationFocusMm", elevationFocusMm, elevationFocusMm > 0.0, "more than 0, or infinity for none");
  require("centreFrequencyMHz", centreFrequencyMHz, centreFrequencyMHz > 0.0 && centreFrequencyMHz <= 1000.0,
          "more than 0 and at most 1000 MHz");
  require("fractionalBandwidth", fractionalBandwidth, fractionalBandwidth >= 0.0 && fractionalBandwidth < 2.0,
          "0 (one frequency) or more, below 2");
  require("attenuationDbPerCmMHz", attenuationDbPerCmMHz,
          attenuationDbPerCmMHz >= 0.0 && attenuationDbPerCmMHz <= 100.0, "0 to 100 dB/(cm MHz)");
  require("soundSpeedMmPerUs", soundSpeedMmPerUs, soundSpeedMmPerUs > 0.0 && soundSpeedMmPerUs <= 20.0,
          "more than 0 and at most 20 mm/us");
  const double longest = 1000.0 * wavelengthMm();
  require("the aperture's width (mm)", widthMm(), widthMm() <= longest,
          "fewer or narrower elements, at most 1000 wavelengths together");
  require("elementHeightMm", elementHeightMm, elevationWidthMm() <= longest,
          "at most 1000 wavelengths, all rows together");
}

ArrayAperture apertureOf(const ProbePreset& preset)
{
  ArrayAperture aperture;
  aperture.elementCount = preset.elementCount;
  aperture.elementWidthMm = preset.elementWidthMm;
  aperture.elementHeightMm = preset.elementHeightMm;
  aperture.kerfMm = preset.kerfMm;
  aperture.transmitFocusMm = preset.transmitFocusMm;
  aperture.elevationFocusMm = preset.elevationFocusMm;
  aperture.centreFrequencyMHz = preset.centreFrequencyMHz;
  aperture.fractionalBandwidth = preset.fractionalBandwidth;
  if (preset.geometry.isMatrix())
  {
    aperture.elementCount = std::max(1, int(std::lround(std::sqrt(double(preset.elementCount)))));
    aperture.elevationCount = aperture.elementCount;
  }
  if (traitsOf(preset.geometry.kind).takesPart)
  {
    const double halfFocus = 0.5 * preset.transmitFocusMm / aperture.pitchMm();
    aperture.elementCount = std::max(1, int(std::min(double(preset.elementCount), std::round(halfFocus))));
  }
  if (preset.geometry.lineOrigin() == LineOrigin::ConvexFace)
  {
    aperture.faceRadiusMm = preset.geometry.radiusMm;
  }
  return aperture;
}

FieldGrid suggestedFieldGrid(const ArrayAperture& aperture, double depthMm)
{
  aperture.validate();
  require("depthMm", depthMm, depthMm > 0.0 && std::isfinite(depthMm), "more than 0");
  // Without a focus, the natural one, where the far field begins.
  const auto quarterWidthMm = [&](double sizeMm, double focusMm) {
    const double naturalMm = 0.25 * sizeMm * sizeMm / aperture.wavelengthMm();
    return 0.25 * aperture.wavelengthMm() * std::max(1.0, std::min({ focusMm, depthMm, naturalMm }) / sizeMm);
  };
  FieldGrid grid;
  grid.lateral = { 0.0, quarterWidthMm(aperture.widthMm(), aperture.transmitFocusMm), 64 };
  grid.elevational = { 0.0, quarterWidthMm(aperture.elementHeightMm, aperture.elevationFocusMm), 32 };
  grid.depth = { 0.0, depthMm / 127.0, 128 };
  return grid;
}

} // namespace sono
