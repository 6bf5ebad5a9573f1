#pragma once

#include "Channels/ChannelSettings.h"
#include "Echo/PointScatterers.h"
#include "Probe/ScanGeometry.h"

#include <cstddef>
#include <vector>

namespace sono {

/// What echoes into the channels: points in the probe's frame (x lateral, y elevation, z into the body, mm).
struct ChannelPoints
{
  std::vector<float> x, y, z;
  std::vector<float> re, im; ///< amplitude at the centre frequency: the root of a cross-section, mm
  std::vector<float> lagMm;  ///< by so much longer the sound takes each way than the distance says at 1540 m/s
  std::vector<float> sinkNp; ///< two-way exponent of the amplitude, Np per MHz above the centre frequency
  std::vector<float> rise;   ///< the part of the amplitude that is in proportion to the frequency: 0 of scatterers, 1
                             ///< of surfaces, whose sum falls as their zones of equal phase widen

  std::size_t size() const { return x.size(); }
  void push(const Vec3f& place, float amplitudeRe, float amplitudeIm, float lag, float sink, float rising = 0.0f);
  void append(const ChannelPoints& other);
  /// In this order; a number may be missing.
  ChannelPoints ordered(const std::vector<std::size_t>& numbers) const;
};

/// A user's own, with `scale` times their amplitudes; those beside or behind the face are left out as they are heard.
ChannelPoints channelPoints(const PointScatterers& points, const ProbePose& pose, double scale = 1.0);

/// From the world to the probe's frame.
class ProbeFrame
{
public:
  explicit ProbeFrame(const ProbePose& pose);
  Vec3d fromWorld(const Vec3d& world) const;
  Vec3d toWorld(const Vec3d& place) const;
  /// World vectors of the frame's x, y and z.
  const Mat3d& axes() const { return axes_; }

private:
  Vec3d originMm_;
  Mat3d axes_;
};

} // namespace sono
