#pragma once

#include "Image/ScanConvert.h"
#include "ImageSettings.h"
#include "Trace/Trace.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sono {

/// A point of the anatomy in an image. Column and row count from the middle of the first pixel and may lie beside the
/// picture.
struct ImagePoint
{
  Vec3d worldMm{ 0.0 };
  double column = 0.0; ///< of its projection onto the plane, where the picture shows it (see shownPlace)
  double row = 0.0;
  double offPlaneMm = 0.0;
  bool inSector = false;
  bool inShadow = false; ///< see ImageSight; of a point in the sector
};

/// Where of an image the sound arrives, and where it shows what. A place lies in a shadow where what arrives would echo
/// at less than -20 dB of what a soft tissue of 0.5 dB/(cm MHz) lets through to there: bone, lung and gas lie in front,
/// or no contact.
class ImageSight
{
public:
  /// That is no shadow at a depth, one way.
  static double leastIntensity(double frequencyMHz, double depthMm);

  /// `traced` are the geometry's lines and must live as long; `layout` is the picture's.
  ImageSight(const ImageSettings& settings, const ProbePose& pose, const PlaneImage& layout, const TracedLines& traced);

  /// Share of the scanned area, by depth, that lies in a shadow.
  double shareShadowed(const std::vector<ScanLine>& lines) const;
  /// Of the pixels with each of the values 1 to `count`, the share that shows what lies in no shadow; 0 without pixels.
  std::vector<double> visibleShares(const std::vector<std::uint8_t>& mask, std::size_t count) const;
  ImagePoint pointAt(const Vec3d& worldMm) const;

private:
  void findWholeCells();

  const TracedLines& traced_;
  ProbePose pose_;
  PlaneScan scan_; ///< of bins of range
  double rangeMm_;
  std::vector<double> leastIntensity_; ///< of each bin of depth, that is no shadow
  std::vector<float> clearByRange_;    ///< lines x bins: 1, in a shadow 0
  /// Lines x bins: whether this and the next bin, of this and the next line, all are 1 or all are 0; else, or where it
  /// is not known, any other value.
  std::vector<std::uint8_t> wholeCells_;
};

} // namespace sono
