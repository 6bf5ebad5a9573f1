#include "Image/ScanConvertVolume.h"

#include "Core/ParallelFor.h"
#include "Kernel/PixelMath.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace sono {
namespace {

constexpr double maxVoxels = 268435456.0;    // 2^28
constexpr double fittingVoxels = 33554432.0; // 2^25
constexpr double radPerDeg = 0.017453292519943295;
constexpr float lineSlack = 1e-3f; // rounding must not cut the voxels on the border

/// (angle - first) perRad is a line's index; a single line stands for every angle.
struct AngleMap
{
  AngleMap(int count, double extentDeg)
    : firstRad(float(-0.5 * extentDeg * radPerDeg))
    , perRad(float((count - 1) / (extentDeg * radPerDeg)))
    , last(float(count - 1))
  {
  }
  float line(float angle) const { return (angle - firstRad) * perRad; }
  bool contains(float line) const { return line >= -lineSlack && line <= last + lineSlack; }

  float firstRad;
  float perRad;
  float last;
};

/// The value before a position on an axis of `count` values, the step to the next one, and its share.
struct Cell
{
  std::size_t index;
  std::size_t step;
  float share;
};

Cell cellOf(float position, int count)
{
  const float inside = std::clamp(position, 0.0f, float(count - 1));
  const auto index = std::size_t(inside);
  return { index, int(index) + 1 < count ? std::size_t(1) : std::size_t(0), inside - float(index) };
}

/// Elevations x lines x samples with trilinear lookup.
struct BeamVolume
{
  const float* values;
  int elevationCount;
  int lineCount;
  int sampleCount;

  float at(const Cell& elevation, float line, float sample) const
  {
    const Cell l = cellOf(line, lineCount);
    const Cell s = cellOf(sample, sampleCount);
    const std::size_t plane = std::size_t(lineCount) * std::size_t(sampleCount);
    const float* low = values + elevation.index * plane + l.index * std::size_t(sampleCount) + s.index;
    const std::size_t next = l.step * std::size_t(sampleCount);
    const float a = inPlane(low, next, s, l.share);
    const float b = inPlane(low + elevation.step * plane, next, s, l.share);
    return a + elevation.share * (b - a);
  }

private:
  static float inPlane(const float* v, std::size_t nextLine, const Cell& s, float lineShare)
  {
    const float near = v[0] + s.share * (v[s.step] - v[0]);
    const float far = v[nextLine] + s.share * (v[nextLine + s.step] - v[nextLine]);
    return near + lineShare * (far - near);
  }
};

void requirePositive(const char* parameter, double value)
{
  if (!(value > 0.0) || !std::isfinite(value))
  {
    std::ostringstream message;
    message << parameter << " is " << value << " but must be positive and finite.";
    throw Error(message.str());
  }
}

void requireFits(const ScanGeometry& geometry, const std::vector<float>& values, int sampleCount, double sampleMm)
{
  requirePositive("sampleCount", sampleCount);
  requirePositive("sampleMm", sampleMm);
  const std::size_t wanted = std::size_t(geometry.totalLineCount()) * std::size_t(sampleCount);
  if (values.size() != wanted)
  {
    throw Error("The lines have " + std::to_string(values.size()) +
                " values but must have elevations x lines x sampleCount = " + std::to_string(wanted) + ".");
  }
}

/// In voxels.
struct VolumeSize
{
  double width;
  double height;
  double depth;

  double voxels() const { return width * height * depth; }
};

VolumeSize sizeOf(const ScanGeometry& geometry, double voxelMm)
{
  geometry.validate();
  if (!geometry.isVolume())
  {
    throw Error("the scan kind fills a plane, not a volume; convert its lines with scanConvert.");
  }
  requirePositive("voxelMm", voxelMm);
  // The widest position of a line is at its end, with the other angle at 0.
  const auto halfWidthMm = [&](int lines, double extentDeg) {
    return lines > 1 ? geometry.depthMm * std::sin(0.5 * extentDeg * radPerDeg) : 0.0;
  };
  const auto voxelsOver = [&](double lengthMm) { return std::ceil(lengthMm / voxelMm - 1e-6) + 1.0; };
  return { voxelsOver(2.0 * halfWidthMm(geometry.lineCount, geometry.sectorDeg)),
           voxelsOver(2.0 * halfWidthMm(geometry.elevationLineCount, geometry.elevationSectorDeg)),
           voxelsOver(geometry.depthMm) };
}

} // namespace

VolumeImage volumeImageLayout(const ScanGeometry& geometry, double voxelMm)
{
  const VolumeSize size = sizeOf(geometry, voxelMm);
  if (size.voxels() > maxVoxels)
  {
    std::ostringstream message;
    message << "voxelMm is " << voxelMm << ", which asks for " << size.width << " x " << size.height << " x "
            << size.depth << " voxels; choose larger voxels, for at most 2^28 of them.";
    throw Error(message.str());
  }
  VolumeImage image;
  image.size = { int(size.width), int(size.height), int(size.depth) };
  image.voxelMm = voxelMm;
  image.minMm = { -0.5 * (size.width - 1.0) * voxelMm, -0.5 * (size.height - 1.0) * voxelMm, 0.0 };
  return image;
}

double voxelMmThatFits(const ScanGeometry& geometry, double wishedMm)
{
  double voxelMm = wishedMm;
  for (VolumeSize size = sizeOf(geometry, voxelMm); size.voxels() > fittingVoxels; size = sizeOf(geometry, voxelMm))
  {
    // Sides are whole voxels, so that the root alone may leave some too many.
    voxelMm *= std::max(1.001, std::cbrt(size.voxels() / fittingVoxels));
  }
  return voxelMm;
}

VolumeImage scanConvertVolume(const ScanGeometry& geometry, const std::vector<float>& values, int sampleCount,
                              double sampleMm, double voxelMm, const Progress& progress)
{
  VolumeImage image = volumeImageLayout(geometry, voxelMm);
  requireFits(geometry, values, sampleCount, sampleMm);
  image.value.resize(image.voxelCount());
  image.mask.resize(image.voxelCount());
  const AngleMap azimuth(geometry.lineCount, geometry.sectorDeg);
  const AngleMap elevation(geometry.elevationLineCount, geometry.elevationSectorDeg);
  const BeamVolume beams{ values.data(), geometry.elevationLineCount, geometry.lineCount, sampleCount };
  const double shownMm = sampleMm * geometry.shownPerRange();
  const auto lastMm = float(std::min(geometry.depthMm, sampleCount * shownMm) + 1e-4 * voxelMm);
  const auto samplesPerMm = float(1.0 / shownMm);

  const auto convertRow = [&](int j, int k, std::size_t row) {
    const auto y = float(image.minMm.y + j * voxelMm);
    const auto z = float(image.minMm.z + k * voxelMm);
    const float e = elevation.line(fastAtan2(y, z > 0.0f ? z : 1e-20f)); // the face: only the apex is scanned
    if (!elevation.contains(e))
    {
      return;
    }
    const Cell cell = cellOf(e, geometry.elevationLineCount);
    const float forward = std::max(std::sqrt(y * y + z * z), 1e-20f);
    for (int i = 0; i < image.size.x; ++i)
    {
      const auto x = float(image.minMm.x + i * voxelMm);
      const float r = std::sqrt(x * x + forward * forward);
      const float line = azimuth.line(fastAtan2(x, forward));
      if (azimuth.contains(line) && r <= lastMm)
      {
        image.value[row + std::size_t(i)] = beams.at(cell, line, r * samplesPerMm);
        image.mask[row + std::size_t(i)] = 1;
      }
    }
  };
  parallelFor(image.size.z, progress, [&](int k) {
    for (int j = 0; j < image.size.y; ++j)
    {
      convertRow(j, k, std::size_t(image.size.x) * (std::size_t(j) + std::size_t(image.size.y) * std::size_t(k)));
    }
  });
  return image;
}

} // namespace sono
