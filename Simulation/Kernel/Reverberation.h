#pragma once

#include "Kernel/BeamDeposit.h"
#include "Kernel/PathState.h"
#include "Kernel/TraceView.h"

#include <cmath>

// What a path that has been reflected lets the line hear (Data/docs/physics.md 13.2): at a boundary that it meets on
// its way into the body, an echo straight back to the aperture; at tissue, its own way back (mirror images) or, on its
// way into the body, straight back as well.

namespace sono {

/// The way straight back along a line's axis, by depth, at multiples of a step: [0, steps].
struct StraightWay
{
  const float* rangeMm = nullptr;    ///< see TimeOfFlight.h
  const float* amplitude = nullptr;  ///< root of the intensity that arrives unreflected
  const float* absorbedNp = nullptr; ///< what the media have taken of the intensity
  int steps = 0;
  float stepMm = 1.0f;
};

struct StraightWayAt
{
  float rangeMm;
  float amplitude;
  float absorbedNp;
};

/// From a depth; what is lost at a boundary within the same step counts where the place is `behind` it.
SONO_HD inline StraightWayAt wayBackFrom(const StraightWay& way, float depthMm, bool behind)
{
  const float position = larger(0.0f, smaller(depthMm / way.stepMm, float(way.steps)));
  const int step = int(smaller(position, float(way.steps - 1)));
  const float share = position - float(step);
  const int known = behind ? step + 1 : step;
  return { way.rangeMm[step] + (way.rangeMm[step + 1] - way.rangeMm[step]) * share, way.amplitude[known],
           way.absorbedNp[known] };
}

/// How far beside its axis a line hears what comes straight back, standard deviation in mm, and how wide a bundle of
/// rays it takes, a half width in mm, where the probe does not name its aperture. Chosen: about a beam's width.
constexpr float heardAsideMm = 1.5f;
constexpr float unnamedHalfMm = 5.0f;

/// Echoes against the tissue that all levels of reverberation refer to: soft tissue's 5e-4 /(cm sr).
constexpr double reverberationPerMmSr = 5e-5;

/// How well what is at a place of a path, `lengthMm` along it, is heard by the line: 1 where it has got to where it
/// would between mirrors across the axis, which leave all but the depth as it was.
SONO_HD inline float heardAside(const TraceLine& axis, const TraceLine& own, const Vec3f& place, float lengthMm)
{
  Vec3f aside = place - own.origin - own.axis * lengthMm;
  aside -= axis.axis * glm::dot(aside, axis.axis);
  return expNegative(-glm::dot(aside, aside) / (2.0f * heardAsideMm * heardAsideMm));
}

/// The echo of tissue along a segment of a path that has been reflected, by range: r0 + mu s, level I exp(-decay s)
/// times that of the tissue. A path shows either its own way or, of an even number of reflections, the way straight
/// back, at twice the level that it stands for.
SONO_HD inline BeamSegment tissueEcho(const StraightWay& way, const TraceLine& axis, const TraceLine& own,
                                      const PathSegment& s)
{
  BeamSegment echo{};
  echo.r0 = s.rangeMm;
  echo.mu = s.rangePerMm;
  echo.intensity = s.intensity * s.scatter;
  echo.decay = s.decayPerMm;
  echo.absorbed = s.absorbed;
  const float cosine = glm::dot(s.direction, axis.axis);
  if (s.reflections % 2 != 0 || cosine < 0.5f)
  {
    return echo;
  }
  if (!s.straightBack)
  {
    echo.intensity *= 2.0f;
    return echo;
  }
  const StraightWayAt back = wayBackFrom(way, glm::dot(s.start - axis.origin, axis.axis), true);
  const float mean = 0.5f * (1.0f + cosine);
  echo.r0 = 0.5f * (s.rangeMm + back.rangeMm);
  echo.mu = s.rangePerMm * mean;
  // Twice for the two senses of the loop, twice for the paths that show their own way.
  echo.intensity = 4.0f * fabsf(s.amplitude) * back.amplitude * s.scatter * heardAside(axis, own, s.start, s.lengthMm);
  echo.decay = s.decayPerMm * mean;
  echo.absorbed = 0.5f * (s.absorbed + back.absorbedNp);
  return echo;
}

/// An echo that arrives at a range, with its sign.
struct Arrival
{
  float rangeMm = 0.0f;
  float amplitude = 0.0f;  ///< against a perfect mirror's; 0: none
  float absorbedNp = 0.0f; ///< what the media have taken, two-way exponent of the amplitude
};

/// A boundary's echo of so much weighs as the speckle of level 1 where it is asked how much its sound was attenuated.
constexpr float boundaryPerSpeckle = 1e-3f;

/// The echo of a boundary straight back, for a path that has been reflected: (13.2) with (13.3). A line takes it where
/// a path comes back nearly as it would from mirrors across the axis.
SONO_HD inline Arrival boundaryArrival(const TraceView& view, const StraightWay& way, const TraceLine& axis,
                                       const TraceLine& own, const PathState& path, const PathBoundary& boundary)
{
  Arrival arrival;
  const Vec3f& n = boundary.surface.normal;
  if (path.reflections < 1 || path.amplitude == 0.0f || glm::dot(n, axis.axis) < 0.5f)
  {
    return arrival;
  }
  const Vec3f& d = path.ray.direction;
  const Vec3f place = path.ray.position + d * boundary.surface.t;
  const float depthMm = glm::dot(place - axis.origin, axis.axis);
  const Vec3f mirrored = d - n * (2.0f * boundary.cosine);
  const Vec3f straight = own.axis - axis.axis * (2.0f * glm::dot(own.axis, axis.axis));
  const Vec3f turned = mirrored - straight;
  const float halfMm = larger(glm::length(axis.lateral), axis.lateral == Vec3f(0.0f) ? unnamedHalfMm : 0.0f);
  const float shift = glm::length(turned) * larger(depthMm, 5.0f) / halfMm;
  const float heard = heardAside(axis, own, place, path.length + boundary.surface.t - boundary.restart) *
                      expNegative(-0.5f * shift * shift);
  if (heard < 1e-3f)
  {
    return arrival;
  }
  const TraceMedium& from = view.media[boundary.before.medium];
  const TraceMedium& to = view.media[boundary.after.medium];
  const RoughBoundary rough = roughBoundary(view, from, to);
  const float coherent =
    rough.alpha > 0.0f ? sqrtf(coherentShare(rough, boundary.cosine, boundary.reflection.cosRefracted, true)) : 1.0f;
  const StraightWayAt back = wayBackFrom(way, depthMm, false);
  const float late = (boundary.surface.t - boundary.restart) * from.rangePerMm;
  arrival.rangeMm = 0.5f * (path.rangeMm + late + back.rangeMm);
  arrival.absorbedNp = 0.5f * (path.absorbed + back.absorbedNp);
  arrival.amplitude = path.amplitude * back.amplitude * boundary.reflection.amplitude * coherent * heard;
  return arrival;
}

/// Where the transducer's face lies in front of a path that comes back, through coupling at most: how far away, mm. The
/// face is taken for a disc across its normal. A path's own line is tilted, and its start may lie beside that disc's
/// plane: a little behind it counts as well.
struct FaceAhead
{
  bool isThere;
  float mm;
};

SONO_HD inline FaceAhead faceAhead(const TraceView& view, const TraceLine& own, const Vec3f& position,
                                   const Vec3f& direction)
{
  constexpr float thickestCouplingMm = 20.0f;
  constexpr float behindMm = 2.0f;
  const float towards = -glm::dot(direction, own.face);
  const float above = glm::dot(position - own.origin, own.face);
  if (towards < 0.2f || above > thickestCouplingMm || above < -behindMm)
  {
    return { false, 0.0f };
  }
  const float mm = above / towards;
  const Vec3f aside = position + direction * mm - own.origin;
  return { glm::dot(aside, aside) <= view.faceRadiusMm * view.faceRadiusMm, mm };
}

} // namespace sono
