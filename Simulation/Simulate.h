#pragma once

#include "Core/Device.h"
#include "Echo/FormRf.h"
#include "Image/BMode.h"
#include "Image/ScanConvert.h"
#include "Trace/Trace.h"

#include <vector>

namespace sono {

/// Every stage's settings. Depth and frequency of tracing and image formation must agree with the geometry's depth and
/// with each other, and the tracer's echo samples with the RF's: see matchStages.
struct ImageSettings
{
  ScanGeometry geometry;
  TraceSettings tracing;
  EchoSettings echo;
  BModeSettings bmode;
  double pixelMm = 0.23;
  Device device = Device::Auto; ///< of all stages

  /// Takes depth from the geometry, and frequency and sampling from the RF, for all stages.
  void matchStages();
};

/// An image of each pose, from the label map's own tissues: tracing, RF, B-mode, scan conversion. On a GPU all poses go
/// through the stages together and only the images come back; they differ from one by one by rounding at
/// most, since all share one region of the scene. Throws Error as the
/// stages do, and for a matrix, whose lines fill a volume.
std::vector<PlaneImage> simulateImages(const Scene& scene, const std::vector<ProbePose>& poses,
                                       const ImageSettings& settings, const Progress& progress = {},
                                       const std::vector<TargetSurface>& targets = {});

} // namespace sono
