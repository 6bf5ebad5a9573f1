#pragma once

#include "Kernel/LeaveBoundary.h"
#include "Kernel/LineStart.h"

// The path: one packet of sound from the transducer's face until nothing of it can be heard any more. This is the
// centre of the simulator; everything that follows paths (the tracer on either device, recorded paths, the
// study, in single and in double precision) steps them by the functions at the end of this file.
//
//                                                              end: too deep, too late, out of the volume,
//      face      skin                                               too faint, or too many boundaries
//       |         :                                                                ^
//       o- - - - -:=========#===========.========#===========.=====#===========....'
//       |         :         |           |        |           |     |
//       | coupling  1st piece boundary  piece  boundary    piece  boundary
//       |         :         |           |
//       |         :         |           '-- another attenuation, the same impedance and speed: no echo, no bend
//       |         :         |
//       |'startPath'------- tracePath: step by step; a step is a piece and what is at its end ----------'
//       |                   |
//       '---- startLine ----'---------- the same steps, but those up to here once a line, for all its paths
//
// Where the probe names its aperture, each path starts at a place of its own there and aims at the focus: pathLine,
// then startPath. Elsewhere all paths of a line start along its axis and share the way to the first boundary:
// startLine.
//
//   stepPath                           done by                 tells the sink
//     walkPiece                        (PathPiece.h)
//       how far may the piece go?      limitPiece              -
//       march to where it ends         marchPastStairs         -
//       lose intensity on the way,     endPiece                segment: the piece
//         reflection at its end
//     arriveAtBoundary                                         meets: the path in front of it
//       echo                           depositBoundary         echo: place and amplitude
//     passBoundary                     (LeaveBoundary.h)
//       which branch, where to         leaveBoundary           left: the path behind it
//       still loud enough?             survivesRoulette        -
//
// Who decides what:
//   Space   what the volume is made of: where a march meets another tissue, which way the surface faces there, which
//           targets are in it. CellSpace (dense cells, either device) or NanoSpace (the scene's own grid).
//   Beam    who listens. It says how far a path can be heard, by a remainingLength(view, beam, path): a TraceLine hears
//           what comes back to its own face in time. A path that starts apart has a line of its own, and depths,
//           weights and ends are seen from that.
//   Sink    what is kept. See PathSink: a tally adds pieces and echoes to its line, a recorder keeps corners and hits.
//   view    the settings, the same for all paths; key the path's random numbers (PathKey.h), which are functions of
//           (seed, line, batch, path, bounce) and of nothing else, so that it does not matter who follows a path, or
//           when.
//
// The loop around the steps belongs to whoever has the threads. A CPU follows one path to its end: tracePath(). A GPU
// has a path in every lane of a warp and lets the lanes of a block take the parts of stepPath() together; a lane whose
// path ends takes up the next (Cuda/TraceKernels.cuh). Between steps PathState says all about a path.
//
// Lengths in mm and positions in the region's local coordinates (see CellSpace); intensity 1 at the face; frequencies
// are in the media's decay already. Nothing here allocates, throws or knows a global.

namespace sono {

/// Below this intensity a path plays Russian roulette. What reverberates adds up from paths of one weight best: those
/// that stand for a tenth of the others, by the boundaries they were drawn at, take as long.
SONO_HD inline float rouletteIntensity(const TraceView& view, const PathState& path)
{
  if (path.reflections == 0 || view.model != InterfaceModel::Acoustic || view.rouletteIntensity == 0.0f)
  {
    return view.rouletteIntensity;
  }
  return larger(view.rouletteIntensity, reflectedRoulette * expNegative(-view.usualDecayPerMm * path.rangeMm));
}

/// Russian roulette: a path too faint to be seen lives on with a probability in proportion, at the intensity it then
/// stands for. The mean is unchanged.
SONO_HD inline bool survivesRoulette(const TraceView& view, const PathKey& key, PathState& path)
{
  const float least = rouletteIntensity(view, path);
  if (path.intensity >= least)
  {
    return true;
  }
  const float u =
    uniformFrom(philox(key.seed, key.line, key.path, std::uint32_t(path.collisions), key.batch | 0x80000000u).v[0]);
  if (path.reflections == 0 || view.model != InterfaceModel::Acoustic)
  {
    const bool survives = u * least < path.intensity;
    path.amplitude *= path.intensity > 0.0f ? least / path.intensity : 0.0f;
    path.intensity = least;
    return survives;
  }
  // What comes straight back is heard by its amplitude.
  const float heard = larger(path.intensity / least, fabsf(path.amplitude) / sqrtf(least));
  const float chance = smaller(1.0f, heard);
  path.intensity /= chance;
  path.amplitude /= chance;
  return u < chance;
}

/// In front of a boundary: its echo. Returns false when the path ends there instead, having met as many as it may.
template<class Sink>
SONO_HD inline bool arriveAtBoundary(const TraceView& view, const PathState& path, const PathBoundary& boundary,
                                     Sink& sink)
{
  sink.meets(path, boundary);
  if (path.collisions >= view.maxCollisions)
  {
    return false;
  }
  if (!boundary.isFace)
  {
    depositBoundary(view, path, boundary, sink);
  }
  return true;
}

/// Leaves a boundary as the path's random numbers have it. Returns whether the path lives on.
template<class Sink>
SONO_HD inline bool passBoundary(const TraceView& view, const PathBoundary& boundary, const PathKey& key,
                                 PathState& path, Sink& sink)
{
  leaveBoundary(view, boundary, drawBounce(view, key, path), path);
  sink.left(path, boundary);
  return path.intensity > 0.0f && survivesRoulette(view, key, path);
}

/// One step: through the piece ahead and, where that ends at a boundary, past it. Returns whether the path goes on.
template<class Space, class Beam, class Sink>
SONO_HD inline bool stepPath(const TraceView& view, const Space& space, const Beam& beam, const PathKey& key,
                             PathState& path, Sink& sink)
{
  PathBoundary boundary;
  const PieceEnd end = walkPiece(view, space, beam, path, boundary, sink);
  if (end != PieceEnd::Boundary)
  {
    return end == PieceEnd::Medium;
  }
  return arriveAtBoundary(view, path, boundary, sink) && passBoundary(view, boundary, key, path, sink);
}

/// One path, from the first boundary to its end: its steps, cut where it leaves a boundary, which the first one is as
/// well.
template<class Space, class Beam, class Sink>
SONO_HD inline void tracePath(const TraceView& view, const Space& space, const Beam& beam, const LineStart& start,
                              const PathKey& key, Sink& sink)
{
  PathState path = start.path;
  PathBoundary boundary = start.boundary;
  while (passBoundary(view, boundary, key, path, sink) && advanceToBoundary(view, space, beam, path, boundary, sink) &&
         arriveAtBoundary(view, path, boundary, sink))
  {
  }
}

/// One path of its own line, from the face to its end.
template<class Space, class Sink>
SONO_HD inline void tracePath(const TraceView& view, const Space& space, const TraceLine& own, const PathKey& key,
                              Sink& sink)
{
  PathState path;
  bool goesOn = startPath(view, space, own, path, sink);
  while (goesOn)
  {
    goesOn = stepPath(view, space, own, key, path, sink);
  }
}

} // namespace sono
