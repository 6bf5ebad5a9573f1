#pragma once

#include "Image/ScanConvert.h"
#include "Image/ScanConvertVolume.h"
#include "Trace/Trace.h"

namespace sono {

/// The tracer's Monte-Carlo error in the image: percent of the mean intensity of what is shown there, at most 100, and
/// 100 where there is no intensity. Pixels are those of scanConvert, and it throws as that.
PlaneImage errorPlane(const ScanGeometry& geometry, const TracedLines& traced, double pixelMm);
/// The same for a matrix, as scanConvertVolume.
VolumeImage errorVolume(const ScanGeometry& geometry, const TracedLines& traced, double voxelMm,
                        const Progress& progress = {});

} // namespace sono
