#pragma once

#include "Image/BMode.h"
#include "Kernel/PlaneScan.h"
#include "Probe/ScanGeometry.h"

#include <cstdint>
#include <vector>

namespace sono {

/// An image in the probe's plane: pixel (i, j) lies at lateral = lateralMinMm + i pixelMm, axial = axialMinMm + j
/// pixelMm.
struct PlaneImage
{
  int width = 0;
  int height = 0;
  double pixelMm = 0.0;
  double lateralMinMm = 0.0;
  double axialMinMm = 0.0;
  std::vector<float> value;       ///< width x height, lateral fastest; 0 outside the sector
  std::vector<std::uint8_t> mask; ///< 1 inside the sector
};

/// Size and place of the image that scanConvert makes, without values. Throws as it does.
PlaneImage planeImageLayout(const ScanGeometry& geometry, double pixelMm);

/// The same with the way from a pixel to the lines' samples, for any device.
PlaneScan planeScan(const ScanGeometry& geometry, int sampleCount, double sampleMm, double pixelMm);

/// Bilinear scan conversion of lines x samples (`sampleMm` of range apart, the first at 0) onto square pixels that
/// cover the sector's bounding box, centred laterally. The last sample holds for up to one sample more; depths that no
/// sample reaches, and what lies beyond the geometry's depth, are outside. A single line is drawn one pixel wide.
/// A closed circle is interpolated across its seam. Where fans are compounded, `values` holds them one after the other,
/// and a pixel that an unsteered fan covers is the mean of those that see it, outside where none does. Throws Error
/// when pixelMm is not positive or asks for more than 2^28 pixels, when `values` is not totalLineCount x sampleCount,
/// and for a matrix, whose lines fill a volume.
PlaneImage scanConvert(const ScanGeometry& geometry, const std::vector<float>& values, int sampleCount, double sampleMm,
                       double pixelMm);

} // namespace sono
