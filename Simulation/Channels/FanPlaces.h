#pragma once

#include "Kernel/Downshift.h"
#include "Probe/ScanGeometry.h"
#include "Trace/Trace.h"

#include <optional>

namespace sono {

/// Where a point lies among a fan's lines, and what the tracer knows of it there.
class FanPlaces
{
public:
  /// `traced` may be null: intensity 1, sound at 1540 m/s. Both must outlive this. Attenuation lowers the frequency as
  /// far as `downshift` says, as it does in the picture; nothing: it stays.
  FanPlaces(const ScanGeometry& geometry, const TracedLines* traced, const std::optional<Downshift>& downshift);

  /// Depth along the lines of a place of the image plane, whether inside of the fan or not.
  double depthMm(double lateralMm, double axialMm) const;

  struct Place
  {
    int line;    ///< and the next one
    float share; ///< how far towards the next
    float depthMm;

    int nearest() const { return share < 0.5f ? line : line + 1; }
  };
  /// Nothing outside of the fan.
  std::optional<Place> at(double lateralMm, double axialMm) const;

  struct Arrival
  {
    float intensity;
    float lagMm; ///< see ChannelPoints
    float sinkNp;
  };
  Arrival arrival(const Place& place) const;
  /// Without the intensity: lag and sink alone are asked for.
  float lagMm(int line, float depthMm) const;

private:
  float binAt(const std::vector<float>& values, int line, float depthMm) const;

  const ScanGeometry& geometry_;
  const TracedLines* traced_;
  std::optional<Downshift> downshift_;
  PlaneBeams beams_;
};

} // namespace sono
