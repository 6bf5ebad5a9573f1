#include "Image/ScanConvert.h"

#include "Image/PixelMath.h"
#include "Progress.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace sono {
namespace {

constexpr double maxPixels = 268435456.0; // 2^28

/// The beam's coordinates of a plane position, (line, r) = ((u - u0) linesPerUnit, rho - faceRadius), where u is the
/// angle about the lines' common centre, or the lateral position when they are parallel. The twin of
/// beamFromPlane in single precision, without a branch per pixel.
struct BeamMap
{
  explicit BeamMap(const ScanGeometry& geometry)
    : parallel(geometry.kind == ScanKind::Linear || geometry.lineCount == 1)
    , faceRadiusMm(geometry.faceRadiusMm())
    , centreAxialMm(geometry.kind == ScanKind::Radial ? 0.0 : -faceRadiusMm)
  {
    constexpr double radPerDeg = 0.017453292519943295;
    const double extent = parallel ? geometry.widthMm : geometry.sectorDeg * radPerDeg;
    firstUnit = -extent / 2.0;
    linesPerUnit = (geometry.closesCircle() ? geometry.lineCount : geometry.lineCount - 1) / extent;
  }

  /// Lines and depths of a row of pixels.
  void row(float axialMm, const std::vector<float>& lateralMm, float* line, float* depthMm) const
  {
    const auto u0 = static_cast<float>(firstUnit);
    const auto scale = static_cast<float>(linesPerUnit);
    const auto radius = static_cast<float>(faceRadiusMm);
    const float x = axialMm - static_cast<float>(centreAxialMm);
    const std::size_t count = lateralMm.size();
    if (parallel)
    {
      for (std::size_t i = 0; i < count; ++i)
      {
        line[i] = (lateralMm[i] - u0) * scale;
        depthMm[i] = x - radius;
      }
      return;
    }
    const float forward = x != 0.0f ? x : 1e-20f; // at the centre, where every line passes
    for (std::size_t i = 0; i < count; ++i)
    {
      line[i] = (fastAtan2(lateralMm[i], forward) - u0) * scale;
      depthMm[i] = std::sqrt(lateralMm[i] * lateralMm[i] + x * x) - radius;
    }
  }

  bool parallel;
  double faceRadiusMm;
  double centreAxialMm; ///< where the lines of a fan come from
  double firstUnit = 0.0;
  double linesPerUnit = 0.0;
};

struct Extent
{
  double halfWidthMm = 0.0;
  double axialMinMm = 0.0;
  double axialMaxMm = 0.0;
};

/// Bounding box of the scanned area. A single line has no area: it is drawn one pixel wide.
Extent boundingBox(const ScanGeometry& geometry)
{
  const BeamMap map(geometry);
  const double inner = map.faceRadiusMm;
  const double outer = inner + geometry.depthMm;
  if (map.parallel)
  {
    const double halfWidth = geometry.lineCount == 1 ? 0.0 : geometry.widthMm / 2.0;
    return { halfWidth, map.centreAxialMm + inner, map.centreAxialMm + outer };
  }
  const double half = -map.firstUnit;
  const double widest = std::min(half, 1.5707963267948966);
  const double backMm = half < widest + 1e-9 ? inner * std::cos(half) : outer * std::cos(half);
  return { outer * std::sin(widest), map.centreAxialMm + backMm, map.centreAxialMm + outer };
}

/// Lines x samples with bilinear lookup; on a closed circle, the first line follows the last.
struct BeamSamples
{
  const float* values;
  int lineCount;
  int sampleCount;
  bool closed;

  float at(float line, float sample) const
  {
    const float turned = line < static_cast<float>(lineCount) ? line : line - static_cast<float>(lineCount);
    const float wanted = closed ? turned : std::min(line, static_cast<float>(lineCount - 1));
    const float lineInside = std::max(wanted, 0.0f);
    const float sampleInside = std::clamp(sample, 0.0f, static_cast<float>(sampleCount - 1));
    const int l = static_cast<int>(lineInside);
    const int s = static_cast<int>(sampleInside);
    const float fl = lineInside - static_cast<float>(l);
    const float fs = sampleInside - static_cast<float>(s);
    const float* near = values + std::size_t(l) * sampleCount + s;
    const float* last = values + std::size_t(lineCount - 1) * sampleCount;
    const float* far = near < last ? near + sampleCount : closed ? values + s : near;
    const int deeper = s + 1 < sampleCount ? 1 : 0;
    const float nearValue = near[0] + fs * (near[deeper] - near[0]);
    const float farValue = far[0] + fs * (far[deeper] - far[0]);
    return nearValue + fl * (farValue - nearValue);
  }
};

/// What the lines cover, with some slack: rounding must not cut the pixels that lie on the sector's edge.
struct ScannedArea
{
  ScannedArea(const ScanGeometry& geometry, int sampleCount, double sampleMm, double pixelMm)
    : lastLine(static_cast<float>(geometry.closesCircle() ? geometry.lineCount : geometry.lineCount - 1) + lineSlack)
    , firstMm(static_cast<float>(-1e-4 * pixelMm))
    , lastMm(static_cast<float>(std::min(geometry.depthMm, sampleCount * sampleMm) + 1e-4 * pixelMm))
  {
  }

  bool contains(float line, float depthMm) const
  {
    return line >= -lineSlack && line <= lastLine && depthMm >= firstMm && depthMm <= lastMm;
  }

  static constexpr float lineSlack = 1e-3f;
  float lastLine;
  float firstMm;
  float lastMm;
};

void validateSizes(const ScanGeometry& geometry, const std::vector<float>& values, int sampleCount, double sampleMm)
{
  geometry.validate();
  std::ostringstream message;
  if (geometry.kind == ScanKind::Matrix)
  {
    message << "the lines of a matrix fill a volume, not a plane; convert them with scanConvertVolume.";
  }
  else if (sampleCount < 1)
  {
    message << "sampleCount is " << sampleCount << " but must be at least 1.";
  }
  else if (!(sampleMm > 0.0) || !std::isfinite(sampleMm))
  {
    message << "sampleMm is " << sampleMm << " but must be positive and finite.";
  }
  else if (values.size() != std::size_t(geometry.lineCount) * sampleCount)
  {
    message << "The lines have " << values.size()
            << " values but must have lineCount x sampleCount = " << std::size_t(geometry.lineCount) * sampleCount
            << ".";
  }
  else
  {
    return;
  }
  throw Error(message.str());
}

} // namespace

PlaneImage planeImageLayout(const ScanGeometry& geometry, double pixelMm)
{
  geometry.validate();
  if (!(pixelMm > 0.0) || !std::isfinite(pixelMm))
  {
    std::ostringstream message;
    message << "pixelMm is " << pixelMm << " but must be positive and finite.";
    throw Error(message.str());
  }
  const Extent box = boundingBox(geometry);
  const auto pixelsOver = [&](double lengthMm) { return std::ceil(lengthMm / pixelMm - 1e-6) + 1.0; };
  const double width = pixelsOver(2.0 * box.halfWidthMm);
  const double height = pixelsOver(box.axialMaxMm - box.axialMinMm);
  if (width * height > maxPixels)
  {
    std::ostringstream message;
    message << "pixelMm is " << pixelMm << ", which asks for " << width << " x " << height
            << " pixels; choose larger pixels, for at most 2^28 of them.";
    throw Error(message.str());
  }

  PlaneImage image;
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  image.pixelMm = pixelMm;
  image.lateralMinMm = -0.5 * (width - 1.0) * pixelMm; // centred, so that a mirrored scan gives a mirrored image
  image.axialMinMm = box.axialMinMm;
  return image;
}

PlaneImage scanConvert(const ScanGeometry& geometry, const std::vector<float>& values, int sampleCount, double sampleMm,
                       double pixelMm)
{
  validateSizes(geometry, values, sampleCount, sampleMm);
  PlaneImage image = planeImageLayout(geometry, pixelMm);
  image.value.resize(std::size_t(image.width) * image.height);
  image.mask.resize(image.value.size());

  const BeamMap map(geometry);
  const BeamSamples samples{ values.data(), geometry.lineCount, sampleCount, geometry.closesCircle() };
  const ScannedArea area(geometry, sampleCount, sampleMm, pixelMm);
  const auto samplesPerMm = static_cast<float>(1.0 / sampleMm);
  std::vector<float> lateralMm(image.width);
  for (int i = 0; i < image.width; ++i)
  {
    lateralMm[i] = static_cast<float>(image.lateralMinMm + i * pixelMm);
  }
  tbb::parallel_for(tbb::blocked_range<int>(0, image.height, 8), [&](const tbb::blocked_range<int>& rows) {
    std::vector<float> line(image.width);
    std::vector<float> depthMm(image.width);
    for (int j = rows.begin(); j < rows.end(); ++j)
    {
      map.row(static_cast<float>(image.axialMinMm + j * pixelMm), lateralMm, line.data(), depthMm.data());
      float* value = image.value.data() + std::size_t(j) * image.width;
      std::uint8_t* mask = image.mask.data() + std::size_t(j) * image.width;
      for (int i = 0; i < image.width; ++i)
      {
        if (area.contains(line[i], depthMm[i]))
        {
          value[i] = samples.at(line[i], depthMm[i] * samplesPerMm);
          mask[i] = 1;
        }
      }
    }
  });
  return image;
}

} // namespace sono
