#pragma once

#include "Core/Device.h"
#include "Echo/EchoSettings.h"
#include "Image/BModeSettings.h"
#include "Probe/ScanGeometry.h"
#include "Trace/TraceSettings.h"

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

  /// Takes depth from the geometry, and frequency and sampling from the RF, for all stages.
  void matchStages();
  /// Computes tracing and image formation there; the stages after them work where their input lies.
  void setDevice(Device device);
};

} // namespace sono
