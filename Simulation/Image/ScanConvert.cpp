#include "Image/ScanConvert.h"

#include "Core/ParallelFor.h"
#include "Core/Simd.h"
#include "Image/RowBeams.h"
#include "Kernel/PlaneScan.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace sono {
namespace {

constexpr double maxPixels = 268435456.0; // 2^28

/// A row of pixels: the level of each that is scanned, and 1 in its mask.
SONO_SIMD_CLONES __attribute__((flatten)) void convertRow(const PlaneScan& of, const float* values,
                                                          const float* __restrict lateralMm, float axialMm, int count,
                                                          float* __restrict line, float* __restrict depthMm,
                                                          float* __restrict level, std::uint8_t* __restrict mask)
{
  const PlaneBeams beams = of.beams;
  const ScannedArea area = of.area;
  const BeamSamples samples = of.samples(values);
  const float samplesPerMm = of.samplesPerMm;
  const float x = beams.axialFromCentre(axialMm);
  beamsOfRow(beams, lateralMm, x, count, line, depthMm);
  for (int i = 0; i < count; ++i)
  {
    mask[i] = area.contains(line[i], depthMm[i]) ? 1 : 0;
  }
  // Nothing is looked up beside what is scanned: four tenths of a sector's rectangle.
  int first = 0;
  while (first < count && mask[first] == 0)
  {
    ++first;
  }
  int end = count;
  while (end > first && mask[end - 1] == 0)
  {
    --end;
  }
  first = first / vectorWidth * vectorWidth;
  end = std::min(count, inWholeVectors(end));
  std::fill(level, level + first, 0.0f);
  std::fill(level + end, level + count, 0.0f);
  for (int i = first; i < end; ++i)
  {
    level[i] = samples.at(line[i], depthMm[i] * samplesPerMm);
  }
  for (int i = first; i < end; ++i)
  {
    level[i] = mask[i] != 0 ? level[i] : 0.0f;
  }
}

void validateSizes(const ScanGeometry& geometry, const std::vector<float>& values, int sampleCount, double sampleMm)
{
  geometry.validate();
  std::ostringstream message;
  if (sampleCount < 1)
  {
    message << "sampleCount is " << sampleCount << " but must be at least 1.";
  }
  else if (!(sampleMm > 0.0) || !std::isfinite(sampleMm))
  {
    message << "sampleMm is " << sampleMm << " but must be positive and finite.";
  }
  else if (values.size() != std::size_t(geometry.totalLineCount()) * sampleCount)
  {
    message << "The lines have " << values.size() << " values but must have lineCount x sampleCount = "
            << std::size_t(geometry.totalLineCount()) * sampleCount << ".";
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
  if (geometry.isVolume())
  {
    throw Error("the lines of a matrix fill a volume, not a plane; convert them with scanConvertVolume.");
  }
  if (!(pixelMm > 0.0) || !std::isfinite(pixelMm))
  {
    std::ostringstream message;
    message << "pixelMm is " << pixelMm << " but must be positive and finite.";
    throw Error(message.str());
  }
  const PlaneExtent box = planeExtent(geometry);
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

PlaneScan planeScan(const ScanGeometry& geometry, int sampleCount, double sampleMm, double pixelMm)
{
  const PlaneImage layout = planeImageLayout(geometry, pixelMm);
  const double shownMm = sampleMm * geometry.shownPerRange();
  const int lastLine = geometry.closesCircle() ? geometry.lineCount : geometry.lineCount - 1;
  const ScannedArea area{ float(lastLine) + ScannedArea::lineSlack, float(-1e-4 * pixelMm),
                          float(std::min(geometry.depthMm, sampleCount * shownMm) + 1e-4 * pixelMm) };
  PlaneScan scan{ planeBeams(geometry), area,        float(1.0 / shownMm),    float(1.0 / geometry.shownPerRange()),
                  geometry.lineCount,   sampleCount, geometry.closesCircle(), layout.width,
                  layout.height,        pixelMm,     layout.lateralMinMm,     layout.axialMinMm,
                  geometry.fanCount(),  {} };
  for (int fan = 0; fan < scan.fanCount; ++fan)
  {
    const double radians = geometry.steeringDeg(fan) * 3.14159265358979323846 / 180.0;
    scan.steering[fan] = { float(std::sin(radians)), float(std::cos(radians)) };
  }
  return scan;
}

PlaneImage scanConvert(const ScanGeometry& geometry, const std::vector<float>& values, int sampleCount, double sampleMm,
                       double pixelMm)
{
  PlaneImage image = planeImageLayout(geometry, pixelMm);
  validateSizes(geometry, values, sampleCount, sampleMm);
  const PlaneScan scan = planeScan(geometry, sampleCount, sampleMm, pixelMm);
  image.value.resize(std::size_t(image.width) * image.height);
  image.mask.resize(image.value.size());

  std::vector<float> lateralMm(image.width);
  for (int i = 0; i < image.width; ++i)
  {
    lateralMm[i] = scan.lateralMm(i);
  }
  constexpr int rowsTogether = 8; // share their buffers
  parallelFor((image.height + rowsTogether - 1) / rowsTogether, {}, [&](int part) {
    std::vector<float> line(image.width);
    std::vector<float> depthMm(image.width);
    for (int j = part * rowsTogether; j < std::min((part + 1) * rowsTogether, image.height); ++j)
    {
      float* level = image.value.data() + std::size_t(j) * image.width;
      std::uint8_t* mask = image.mask.data() + std::size_t(j) * image.width;
      if (scan.fanCount == 1)
      {
        convertRow(scan, values.data(), lateralMm.data(), scan.axialMm(j), image.width, line.data(), depthMm.data(),
                   level, mask);
        continue;
      }
      const float x = scan.beams.axialFromCentre(scan.axialMm(j));
      for (int i = 0; i < image.width; ++i)
      {
        float unsteered = 0.0f;
        float depth = 0.0f;
        scan.beams.beamAt(lateralMm[i], x, unsteered, depth);
        mask[i] = scan.area.contains(unsteered, depth) && scan.compound(values.data(), lateralMm[i], x, level[i]);
      }
    }
  });
  return image;
}

} // namespace sono
