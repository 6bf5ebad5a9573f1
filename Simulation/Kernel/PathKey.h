#pragma once

#include "Kernel/PathState.h"
#include "Kernel/Rng.h"
#include "Kernel/TraceView.h"

// A path's random numbers: functions of (seed, line, batch, path, bounce) and of nothing else.

namespace sono {

/// Identifies a path's random stream.
struct PathKey
{
  std::uint32_t line;
  std::uint32_t batch;
  std::uint32_t path;                        ///< within its batch
  std::uint64_t seed = 1;                    ///< of the image
  const BounceScramble* scrambles = nullptr; ///< of the batch, scrambleCount() of them, or null to make them
};

/// A batch has one scramble a bounce up to maxCollisions, and one for where its paths start.
SONO_HD inline int scrambleCount(const TraceView& view)
{
  return view.maxCollisions + 1;
}

/// Stands for the bounce number of a path's start, since no bounce has it.
constexpr std::uint32_t startBounce = 0xffffffffu;

SONO_HD inline BounceScramble makeScramble(const TraceView& view, std::uint64_t seed, std::uint32_t line,
                                           std::uint32_t batch, int slot)
{
  return makeBounceScramble(seed, line, batch, slot < view.maxCollisions ? std::uint32_t(slot) : startBounce);
}

SONO_HD inline BounceSample drawFrom(const TraceView& view, const PathKey& key, int slot, std::uint32_t bounce)
{
  if (view.lowDiscrepancy)
  {
    return lowDiscrepancySample(
      key.scrambles ? key.scrambles[slot] : makeBounceScramble(key.seed, key.line, key.batch, bounce), key.path);
  }
  return independentSample(key.seed, key.line, key.batch, key.path, bounce);
}

/// What the boundary in front of a path consumes. Where all have transmitted it coherently so far, one number decides
/// how far that goes on: paths that leave the way at a boundary are then as evenly many as the numbers lie, however
/// many boundaries there are before it.
SONO_HD inline BounceSample drawBounce(const TraceView& view, const PathKey& key, const PathState& path)
{
  BounceSample u = drawFrom(view, key, path.collisions, std::uint32_t(path.collisions));
  if (path.collisions > 0 && isOnCoherentWay(path))
  {
    u.choice = path.choice;
  }
  return u;
}

/// What the start consumes: its place on the aperture is (polar, azimuth).
SONO_HD inline BounceSample drawStart(const TraceView& view, const PathKey& key)
{
  return drawFrom(view, key, view.maxCollisions, startBounce);
}

} // namespace sono
