#pragma once

#include "Kernel/BeamDeposit.h"
#include "Kernel/BentTable.h"
#include "Kernel/PathState.h"
#include "Kernel/ReverberationSpread.h"
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

/// How far off a boundary may lie by rounding, here and on the line's axis.
constexpr float roundedMm = 0.01f;

/// From a depth; what is lost at a boundary there or within the same step counts where the place is `behind` it.
SONO_HD inline StraightWayAt wayBackFrom(const StraightWay& way, float depthMm, bool behind)
{
  const float last = float(way.steps);
  const float position = larger(0.0f, smaller(depthMm / way.stepMm, last));
  const float rounded = roundedMm / way.stepMm;
  const int step = int(smaller(position, last - 1.0f));
  const float known = behind ? smaller(ceilf(position + rounded), last) : floorf(larger(position - rounded, 0.0f));
  return { bentAt(way.rangeMm, way.steps, step, position - float(step)), way.amplitude[int(known)],
           way.absorbedNp[int(known)] };
}

/// How wide a bundle of rays a line takes, a half width in mm, where the probe does not name its aperture. Chosen.
constexpr float unnamedHalfMm = 5.0f;

/// Echoes against the tissue that all levels of reverberation refer to: soft tissue's 5e-4 /(cm sr).
constexpr double reverberationPerMmSr = 5e-5;

/// How far the place of a path, `lengthMm` along it, is beside where it would have got to between mirrors across the
/// axis, which leave all but the depth as it was.
SONO_HD inline Vec3f placeAside(const TraceLine& axis, const TraceLine& own, const Vec3f& place, float lengthMm)
{
  const Vec3f aside = place - own.origin - own.axis * lengthMm;
  return aside - axis.axis * glm::dot(aside, axis.axis);
}

/// Exponent of how well it is heard there, of the amplitude: exp(-x).
SONO_HD inline float unheardAside(const Vec3f& aside)
{
  return glm::dot(aside, aside) / (2.0f * heardAsideMm * heardAsideMm);
}

/// The echo of tissue along a segment of a path that has been reflected, by range: r0 + mu s, an amplitude
/// level exp(-decay s) against that of the tissue that reverberation refers to.
struct TissueEcho
{
  float r0;
  float mu;
  float level;
  float decay;
  float absorbed; ///< what the media have taken at its start, two-way exponent of the amplitude
  Vec3f start;    ///< of its own way, in the scene; straight back, as seen from where mirrors would have taken the path
  Vec3f direction; ///< how either changes with s
};

/// Of the path's own way (13.5).
SONO_HD inline TissueEcho ownWayEcho(const TraceView& view, const PathSegment& s)
{
  return { s.rangeMm,  s.rangePerMm, s.intensity * s.scatter, s.decayPerMm, s.absorbed, s.start + view.cornerMm,
           s.direction };
}

/// Whether a segment is heard straight back as well: on its way into the body, after an even number of reflections.
SONO_HD inline bool isStraightBack(const TraceLine& axis, const PathSegment& s)
{
  return s.reflections % 2 == 0 && glm::dot(s.direction, axis.axis) >= 0.5f;
}

/// Straight back, less by what is not heard of it beside the axis.
SONO_HD inline TissueEcho straightBackEcho(const StraightWay& way, const TraceLine& axis, const TraceLine& own,
                                           const PathSegment& s)
{
  const StraightWayAt back = wayBackFrom(way, glm::dot(s.start - axis.origin, axis.axis), true);
  const float mean = 0.5f * (1.0f + glm::dot(s.direction, axis.axis));
  const Vec3f start = placeAside(axis, own, s.start, s.lengthMm);
  return { 0.5f * (s.rangeMm + back.rangeMm), s.rangePerMm * mean,
           // (13.6), for the two senses of the loop.
           2.0f * sqrtf(s.intensity) * back.amplitude * s.scatter, s.decayPerMm * mean,
           0.5f * (s.absorbed + back.absorbedNp), start,
           placeAside(axis, own, s.start + s.direction, s.lengthMm + 1.0f) - start };
}

/// The ranges, before `endMm`, in which what comes straight back from a segment so long is heard: up to five deviations
/// beside the axis, beyond which less than 4e-6 of its power is.
SONO_HD inline DepthSpan heardSpan(const TissueEcho& echo, float length, float endMm)
{
  constexpr float furthestMm = 5.0f * heardAsideMm;
  const float a = larger(glm::dot(echo.direction, echo.direction), 1e-12f);
  const float b = glm::dot(echo.start, echo.direction);
  const float rest = b * b - a * (glm::dot(echo.start, echo.start) - furthestMm * furthestMm);
  if (!(rest > 0.0f))
  {
    return { 0.0f, 0.0f };
  }
  const float reach = sqrtf(rest);
  const float from = larger(0.0f, (-b - reach) / a);
  const float to = smaller(length, (reach - b) / a);
  return to > from ? depthSpan(echo.r0 + echo.mu * from, echo.mu, to - from, endMm) : DepthSpan{ 0.0f, 0.0f };
}

/// What such an echo leaves in a bin: amplitudes of own ways add up within a resolution cell, with the sign of its
/// tissue (signInBin); of ways straight back powers do (13.6), of `level` times heardInBin.
struct BinEcho
{
  float share;      ///< of the bin that it covers
  float level;      ///< mean over that
  float absorbedNp; ///< in its middle
  Vec3f place;      ///< there
};

SONO_HD inline BinEcho echoInBin(const TissueEcho& echo, const DepthSpan& span, int bin, float binMm)
{
  const float from = larger(span.low, float(bin) * binMm);
  const float to = smaller(span.high, float(bin + 1) * binMm);
  const float inverseMu = 1.0f / echo.mu;
  const float s0 = (from - echo.r0) * inverseMu;
  const float s1 = (to - echo.r0) * inverseMu;
  const float near = larger(0.0f, smaller(s0, s1));
  const float step = larger(0.0f, larger(s0, s1) - near);
  const float middle = near + 0.5f * step;
  return { larger(0.0f, to - from) / binMm, echo.level * expNegative(-echo.decay * near) * meanDecay(echo.decay * step),
           echo.absorbed + echo.decay * middle, echo.start + echo.direction * middle };
}

SONO_HD inline float signInBin(const TissueEcho& echo, const BinEcho& inBin, std::uint32_t line, int bin, float cellMm)
{
  return cellSign(inBin.place, echo.direction, cellMm, signDraw(line, bin));
}

/// Of the amplitude, so that its square is what is heard of the power.
SONO_HD inline float heardInBin(const BinEcho& inBin)
{
  return expNegative(-0.5f * unheardAside(inBin.place));
}

/// An echo that arrives at a range, with its sign.
struct Arrival
{
  float rangeMm = 0.0f;
  float amplitude = 0.0f;  ///< against a perfect mirror's; 0: none
  float absorbedNp = 0.0f; ///< what the media have taken, two-way exponent of the amplitude
};

/// Echoes of tissue are kept by half a millimetre of range, of as many radial bins as that takes: a speckle's level
/// needs no more.
struct TissueBins
{
  int each; ///< radial bins in one of them
  int count;
  float mm;

  SONO_HD TissueBins(int binCount, float binMm)
    : each(binMm < 0.5f ? int(0.5f / binMm + 0.5f) : 1)
    , count((binCount + each - 1) / each)
    , mm(binMm * float(each))
  {
  }
  SONO_HD float endMm() const { return mm * float(count); }
  /// What the media have taken of them changes slowly: it is kept at one of four, that of its group.
  SONO_HD int absorptionBin(int bin) const
  {
    const int middle = bin / 4 * 4 + 2;
    return middle < count ? middle : count - 1;
  }
  /// The first bin of the next group.
  SONO_HD int nextGroup(int bin) const { return bin / 4 * 4 + 4; }
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
  const TraceMedium& from = view.media[boundary.before.medium];
  if (path.reflections < 1 || path.amplitude == 0.0f || glm::dot(n, axis.axis) < 0.5f || from.rings)
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
  const Vec3f aside = placeAside(axis, own, place, path.length + boundary.surface.t - boundary.restart);
  const float heard = expNegative(-unheardAside(aside) - 0.5f * shift * shift);
  if (heard < 1e-3f)
  {
    return arrival;
  }
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
