#pragma once

#include "Core/Progress.h"
#include "Labels/ReadIntensities.h"

#include <string>

namespace sono {

/// Reads the DICOM series in a folder, or that of one of its files, as readIntensities has it. Files of other series
/// beside it are passed over when a file is named; segmentations and reports always are.
IntensityVolume readDicomSeries(const std::string& path, const Progress& progress = {});

} // namespace sono
