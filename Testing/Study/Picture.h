#pragma once

#include "Image/ScanConvert.h"
#include "Labels/LabelVolume.h"
#include "Probe/ScanGeometry.h"
#include "Trace/Trace.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace sono::study {

/// 8-bit red, green and blue, rows from the top.
struct Picture
{
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Grey levels 0 to 1; outside of the sector dark blue, so that it differs from black inside.
Picture pictureOf(const PlaneImage& grey);

/// The labels of what the traced lines show in the probe's plane, in their colours, or in a palette of our own where
/// the map has none.
Picture pictureOfLabels(const LabelVolume& labels, const ScanGeometry& geometry, const ProbePose& pose,
                        const PlaneImage& layout, const TracedLines& traced);

/// Pictures in rows, all as high as the highest, each column as wide as its widest; smaller ones stand in the middle.
Picture montage(const std::vector<Picture>& panels, int columns);

/// The first channel of a picture file as levels 0 to 1, all of it inside; the first pixel lies at the place given.
/// Throws Error when it cannot be read.
PlaneImage readGrey(const std::filesystem::path& path, double pixelMm, double lateralMinMm, double axialMinMm);

/// Writes a PNG. Throws Error when that fails.
void writePicture(const Picture& picture, const std::filesystem::path& path);

} // namespace sono::study
