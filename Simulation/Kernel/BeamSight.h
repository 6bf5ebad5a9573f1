#pragma once

#include "Kernel/HostDevice.h"

#include <cstddef>
#include <cstdint>

namespace sono {

/// The blocks of a beam's culling map (see FieldSight) along one axis.
struct SightBlocks
{
  float lowMm;
  float highMm; ///< of the last block; depths beyond it belong to it
  float perMm;
  int count;
  bool mirrored;
  bool endless;

  /// Furthest position in a block.
  SONO_HD float furthest(int block) const
  {
    const float low = lowMm + float(block) / perMm;
    const float high = low + 1.0f / perMm;
    return -low > high ? -low : high;
  }
  /// -1: outside.
  SONO_HD int blockAt(float mm) const
  {
    const float p = mirrored && mm < 0.0f ? -mm : mm;
    if (!(p >= lowMm) || (p >= highMm && !endless))
    {
      return -1;
    }
    const int block = int((p < highMm ? p - lowMm : highMm - lowMm) * perMm);
    return block < count ? block : count - 1;
  }
};

/// A view of a field's culling map (see FieldSight) for one brick size. Trivially copyable.
struct BeamSightView
{
  SightBlocks lateral;
  SightBlocks elevational;
  SightBlocks depth;
  const std::uint8_t* seen = nullptr; ///< lateral fastest, then elevational, then depth

  std::size_t size() const { return std::size_t(lateral.count) * elevational.count * depth.count; }
  /// Whether a brick with this centre may hold scatterers that count.
  SONO_HD bool sees(float lateralMm, float elevationalMm, float depthMm) const
  {
    const int l = lateral.blockAt(lateralMm);
    const int e = elevational.blockAt(elevationalMm);
    const int d = depth.blockAt(depthMm);
    return l >= 0 && e >= 0 && d >= 0 && seen[std::size_t(l + lateral.count * (e + elevational.count * d))];
  }
};

} // namespace sono
