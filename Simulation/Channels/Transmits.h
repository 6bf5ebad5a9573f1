#pragma once

#include "Channels/ChannelSettings.h"
#include "Probe/ArrayElements.h"

#include <cstddef>
#include <vector>

namespace sono {

/// What is sent at once, in the image plane.
struct Transmit
{
  TransmitKind kind = TransmitKind::PlaneWaves;
  double angleRad = 0.0;   ///< from z towards x: where it goes
  double distanceMm = 0.0; ///< of the virtual source behind the middle of the face, or of the focus before it
};

/// When and how strongly the elements send. Time 0 is the same for all transmits: each wave passes the middle of the
/// face, the probe's origin, at `passUs`, and no element sends before 0.
struct Transmits
{
  std::vector<Transmit> each;
  std::vector<double> delaysUs; ///< transmits x elements
  std::vector<float> weights;   ///< transmits x elements
  double passUs = 0.0;

  double delayUs(std::size_t transmit, std::size_t element) const
  {
    return delaysUs[transmit * (delaysUs.size() / each.size()) + element];
  }
};

/// The settings' transmits, for the speed of sound that the probe's scanner assumes. Throws Error for a focus or a
/// source that cannot be.
Transmits makeTransmits(const ChannelSettings& settings, const ProbeSettings& probe, const ArrayElements& elements);

/// Transmits that are given. With v the wave's direction and d its distance, an element at x sends at passUs plus
///   plane      x . v / c
///   diverging  (|x + d v| - d) / c
///   focused    (d - |d v - x|) / c                                                                            (15.3)
Transmits timeTransmits(std::vector<Transmit> each, Apodization apodization, const ArrayElements& elements,
                        double mmPerUs);

} // namespace sono
