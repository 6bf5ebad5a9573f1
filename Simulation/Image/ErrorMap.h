#pragma once

#include "Image/ScanConvert.h"
#include "Image/ScanConvertVolume.h"

#include <vector>

namespace sono {

/// The tracer's Monte-Carlo error in the image: percent of the mean intensity, at most 100, and 100 where there is no
/// intensity; lineCount x binCount of each, bins `binMm` wide. Pixels are those of scanConvert, and it throws as that.
PlaneImage errorPlane(const ScanGeometry& geometry, const std::vector<float>& intensity,
                      const std::vector<float>& standardError, int binCount, double binMm, double pixelMm);
/// The same for a matrix, as scanConvertVolume.
VolumeImage errorVolume(const ScanGeometry& geometry, const std::vector<float>& intensity,
                        const std::vector<float>& standardError, int binCount, double binMm, double voxelMm,
                        const Progress& progress = {});

} // namespace sono
