#pragma once

#include "Core/Device.h"
#include "Echo/EchoSettings.h"
#include "Image/BModeSettings.h"
#include "Probe/ScanGeometry.h"
#include "Trace/TraceSettings.h"

namespace sono {

/// Whether two distances, times or frequencies are the same but for rounding.
bool agree(double a, double b);

/// Every stage's settings. Depth and frequency of tracing and image formation must agree with the geometry's range and
/// with each other, the apertures and the tracer's echo samples with the RF's: see matchStages.
struct ImageSettings
{
  ScanGeometry geometry;
  TraceSettings tracing;
  EchoSettings echo;
  BModeSettings bmode;
  double pixelMm = 0.23;

  /// Takes range and lines from the geometry, and mode, frequency, bandwidth, aperture and sampling from the RF, for
  /// all stages.
  void matchStages();
  /// Throws Error, naming it, when the stages disagree about one of these.
  void requireMatch() const;
  /// Computes tracing and image formation there; the stages after them work where their input lies.
  void setDevice(Device device);
};

} // namespace sono
