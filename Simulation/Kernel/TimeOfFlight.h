#pragma once

#include "Core/SoundSpeed.h"
#include "Kernel/BentTable.h"
#include "Kernel/LineStart.h"

// A scanner knows time alone: what lies at depth z of a line is shown at the range
//
//   r(z) = integral from 0 to z of c0 / c dz                      (Data/docs/physics.md 13.1)
//
// with c0 = 1540 m/s; a scanner that assumes another speed shows it to another scale. The integral runs along the
// line's axis, straight on, in steps much shorter than a bin, from medium to medium: where the two ends of a step
// differ, the boundary is looked for. What is known at multiples of a step or a bin thus bends in between at most where
// a boundary is, and there sharply.

namespace sono {

constexpr float longestFlightStepMm = 0.08f;
constexpr int boundaryHalvings = 7; ///< of a step, to find the boundary in it: 0.0006 mm

/// Steps of a bin.
SONO_HD inline int flightSteps(float binMm)
{
  const int steps = int(ceilf(binMm / longestFlightStepMm));
  return steps > 1 ? steps : 1;
}

/// At c0.
SONO_HD inline float wavelengthMm(const TraceView& view)
{
  return 6.2831853f * 1000.0f * float(assumedSoundSpeedMmPerUs) / view.waveNumberAtOne;
}

/// Where a line's axis runs inside targets, which count instead of the cells there. Not where it does for less than a
/// wavelength at c0, or in a rod that rings: the beam is wider, and its wave closes behind a wire unchanged.
struct TargetSpans
{
  static constexpr int most = 8;
  int count;
  float fromMm[most];
  float toMm[most];
  int medium[most];
};

template<class Space>
SONO_HD inline TargetSpans targetSpans(const TraceView& view, const Space& space, const TraceLine& line)
{
  TargetSpans spans;
  spans.count = 0;
  if (!space.targets.any())
  {
    return spans;
  }
  const float shortest = wavelengthMm(view);
  float from = 0.0f;
  while (spans.count < TargetSpans::most && from < view.depthMm)
  {
    const Vec3f start = line.origin + line.axis * from;
    const TargetHit entered = space.targets.nearest(start, line.axis, view.depthMm - from, false);
    const TargetHit left = space.targets.nearest(start, line.axis, 3e38f, true);
    const bool inside = left.target >= 0 && (entered.target < 0 || left.t < entered.t);
    if (!inside && entered.target < 0)
    {
      break;
    }
    const float in = inside ? 0.0f : entered.t;
    const TargetHit out = inside ? left : space.targets.nearest(start + line.axis * in, line.axis, 3e38f, true);
    if (out.target < 0)
    {
      break;
    }
    if (out.t >= shortest && !view.media[view.firstTargetMedium + out.target].rings)
    {
      spans.fromMm[spans.count] = from + in;
      spans.toMm[spans.count] = from + in + out.t;
      spans.medium[spans.count] = view.firstTargetMedium + out.target;
      ++spans.count;
    }
    from += in + out.t + 1e-3f;
  }
  return spans;
}

/// The medium of the cell at a place; -1 in coupling in front of the body, and in what lies outside of it behind, from
/// which nothing comes: both have c0.
template<class Space>
SONO_HD inline int mediumAt(const TraceView& view, const Space& space, const Vec3f& place)
{
  const Vec3i cell = space.cellAt(place);
  const int tissue = space.contains(cell) ? space.tissueAt(cell) : -1;
  return tissue == view.outsideTissue ? -1 : tissue;
}

constexpr float strandWavelengths = 2.0f; ///< a wave closes behind a body of labels that is no wider
constexpr float strandRangePerMm = 0.1f;  ///< |c0 / c - 1|: softer ones shift by less than a fifth of a wavelength
constexpr int strandPlaces = 24;  ///< around the axis: one lies in a wall as thin as a quarter of their distance
constexpr int placesTogether = 8; ///< of these: a GPU waits for its memory, once for so many

/// Whether none of a medium lies on the circle around a place of which these are two radii.
template<class Space>
SONO_HD inline bool isNoneAround(const TraceView& view, const Space& space, const Vec3f& place, const Vec3f& across,
                                 const Vec3f& along, int medium)
{
  // Turned from one to the next: a call of sine and cosine has a GPU's kernel keep numbers in memory.
  constexpr float stepCosine = 0.96592583f; // of a 24th of a turn
  constexpr float stepSine = 0.25881905f;
  float cosine = 1.0f;
  float sine = 0.0f;
  for (int first = 0; first < strandPlaces; first += placesTogether)
  {
    int found = 0;
    for (int i = 0; i < placesTogether; ++i)
    {
      found += mediumAt(view, space, place + across * cosine + along * sine) == medium ? 1 : 0;
      const float before = cosine;
      cosine = before * stepCosine - sine * stepSine;
      sine = sine * stepCosine + before * stepSine;
    }
    if (found > 0)
    {
      return false;
    }
  }
  return true;
}

/// What counts where the axis is in a medium: the one beside it where the body is a strand, as a wire is, of which most
/// of the aperture sees nothing. It is one where in a plane through the axis none of its medium lies around the place:
/// of a wall, however aslant, some does.
template<class Space>
SONO_HD inline int mediumAround(const TraceView& view, const Space& space, const TraceLine& line, const Vec3f& place,
                                int medium)
{
  const float aroundMm = strandWavelengths * wavelengthMm(view);
  const Vec3f along = line.axis * aroundMm;
  // Ahead and behind lie on both circles. What is as thick needs no further look: nearly all that sound runs through.
  if (mediumAt(view, space, place + along) == medium || mediumAt(view, space, place - along) == medium)
  {
    return medium;
  }
  for (int plane = 0; plane < 2; ++plane)
  {
    const Vec3f across = glm::normalize(plane == 0 ? line.lateral : line.elevation) * aroundMm;
    if (isNoneAround(view, space, place, across, along, medium))
    {
      return mediumAt(view, space, place + across);
    }
  }
  return medium;
}

/// The medium at a depth of the axis, as mediumAt, and whether it is that of a target.
struct AxisMedium
{
  int medium;
  bool ofTarget;
};

template<class Space>
SONO_HD inline AxisMedium mediumThere(const TraceView& view, const Space& space, const TraceLine& line,
                                      const TargetSpans& spans, float depthMm)
{
  for (int s = 0; s < spans.count; ++s)
  {
    if (depthMm >= spans.fromMm[s] && depthMm < spans.toMm[s])
    {
      return { spans.medium[s], true };
    }
  }
  return { mediumAt(view, space, line.origin + line.axis * depthMm), false };
}

/// The medium that counts there, of the one that is there.
template<class Space>
SONO_HD inline int mediumOnAxis(const TraceView& view, const Space& space, const TraceLine& line,
                                const AxisMedium& there, float depthMm)
{
  // Without an aperture there is no beam that is wider than the axis.
  const bool mayBeStrand = view.startsApart && !there.ofTarget && there.medium >= 0 &&
                           fabsf(view.media[there.medium].rangePerMm - 1.0f) > strandRangePerMm;
  return mayBeStrand ? mediumAround(view, space, line, line.origin + line.axis * depthMm, there.medium) : there.medium;
}

template<class Space>
SONO_HD inline int mediumOnAxis(const TraceView& view, const Space& space, const TraceLine& line,
                                const TargetSpans& spans, float depthMm)
{
  return mediumOnAxis(view, space, line, mediumThere(view, space, line, spans, depthMm), depthMm);
}

/// What a piece of the way along the axis adds to it: its range, and the exponent of the intensity that is left of what
/// goes straight on, across boundaries as if they lay across the axis.
struct FlightStep
{
  float rangeMm;
  float lostNp;
  float absorbedNp; ///< of that, by the medium
};

SONO_HD inline void addMedium(const TraceView& view, int medium, float mm, FlightStep& sum)
{
  sum.rangeMm += mm * (medium < 0 ? 1.0f : view.media[medium].rangePerMm);
  const float taken = mm * (medium < 0 ? 0.0f : view.media[medium].decayPerMm);
  sum.lostNp += taken;
  sum.absorbedNp += taken;
}

/// Between two media that count, at the step's start and at its end.
template<class Space>
SONO_HD inline FlightStep flightStep(const TraceView& view, const Space& space, const TraceLine& line,
                                     const TargetSpans& spans, float stepMm, int step, int before, int medium)
{
  FlightStep sum{ 0.0f, 0.0f, 0.0f };
  if (medium == before)
  {
    addMedium(view, medium, stepMm, sum);
    return sum;
  }
  float low = 0.0f;
  float high = 1.0f;
  for (int halving = 0; halving < boundaryHalvings; ++halving)
  {
    // Which half it is nobody can guess: both are chosen, none is jumped to.
    const float middle = 0.5f * (low + high);
    const bool isBefore = mediumThere(view, space, line, spans, (float(step) + middle) * stepMm).medium == before;
    low = isBefore ? middle : low;
    high = isBefore ? high : middle;
  }
  const float share = 0.5f * (low + high);
  addMedium(view, before, share * stepMm, sum);
  addMedium(view, medium, (1.0f - share) * stepMm, sum);
  if (before >= 0 && medium >= 0)
  {
    const float z = view.media[before].impedance;
    const float r = (view.media[medium].impedance - z) / (view.media[medium].impedance + z);
    sum.lostNp -= logf(larger(1.0f - r * r, 1e-12f));
  }
  return sum;
}

/// `medium` is that at the step's start, and becomes that at its end.
template<class Space>
SONO_HD inline FlightStep flightStepOn(const TraceView& view, const Space& space, const TraceLine& line,
                                       const TargetSpans& spans, float stepMm, int step, int& medium)
{
  const int before = medium;
  medium = mediumOnAxis(view, space, line, spans, float(step + 1) * stepMm);
  return flightStep(view, space, line, spans, stepMm, step, before, medium);
}

/// Depth at a range, by the ranges at multiples of a step of depth, [0, steps], which rise; the range lies between
/// those of a step and the next.
SONO_HD inline float depthAfterStep(const float* rangeMm, int steps, float stepMm, int step, float wantedMm)
{
  const int next = step + 1;
  const float own = 1.0f / (rangeMm[next] - rangeMm[step]);
  const float before = step > 0 ? 1.0f / (rangeMm[step] - rangeMm[step - 1]) : own;
  const float behind = next < steps ? 1.0f / (rangeMm[next + 1] - rangeMm[next]) : own;
  const float depth =
    bentBetween(float(step), float(next), wantedMm - rangeMm[step], rangeMm[next] - wantedMm, { before, own, behind });
  return depth * stepMm;
}

/// The same of any range; beyond the last c0 holds.
SONO_HD inline float depthOfRange(const float* rangeMm, int steps, float stepMm, float wantedMm)
{
  if (wantedMm >= rangeMm[steps])
  {
    return float(steps) * stepMm + (wantedMm - rangeMm[steps]);
  }
  int low = 0;
  int high = steps;
  while (high - low > 1)
  {
    const int middle = (low + high) / 2;
    (rangeMm[middle] <= wantedMm ? low : high) = middle;
  }
  return depthAfterStep(rangeMm, steps, stepMm, low, wantedMm);
}

/// How a line's depths lie on its ranges: depth less range, mm, at multiples of a bin of range, in between as bentAt().
struct RangeMap
{
  const float* offsetMm = nullptr; ///< null: range is depth
  int bins = 0;
  float perBinMm = 0.0f; ///< 1 / mm

  SONO_HD float depthOf(float rangeMm) const
  {
    const float position = rangeMm * perBinMm;
    const int bin = int(smaller(position, float(bins - 1)));
    return rangeMm + (bin + 1 < bins ? bentAt(offsetMm, bins - 1, bin, position - float(bin)) : offsetMm[bin]);
  }
};

/// The sample of depth, whole, that is shown at a sample of range.
SONO_HD inline int depthSample(const RangeMap& map, float sampleMm, int s, int sumCount)
{
  const int d = map.offsetMm ? int(map.depthOf(float(s) * sampleMm) / sampleMm + 0.5f) : s;
  return d < 0 ? 0 : (d < sumCount ? d : sumCount - 1);
}

/// The samples of depth [first, end) that are shown between two neighbouring samples of range.
struct RangeStep
{
  float from; ///< the depth of the earlier sample, in samples
  float perSample;
  int first;
  int end;

  /// How far towards the later one.
  SONO_HD float shareOf(int d) const { return (float(d) - from) * perSample; }
};

SONO_HD inline RangeStep stepBetween(float from, float to)
{
  return { from, 1.0f / larger(to - from, 1e-6f), int(ceilf(from)), int(ceilf(to)) };
}

SONO_HD inline float depthInSamples(const RangeMap& map, float sampleMm, int s)
{
  return map.depthOf(float(s) * sampleMm) / sampleMm;
}

/// A demodulated sample of depth where it is shown: `rad` behind a place with this carrier, at most 1.6 to either side,
/// as a turn between two samples is from its middle.
struct ShownSample
{
  float re;
  float im;
};

SONO_HD inline ShownSample shownSample(float a, float b, float rad, float carrierRe, float carrierIm)
{
  const float cosine = cosSmall(rad);
  const float sine = sinSmall(rad);
  const float re = carrierRe * cosine + carrierIm * sine;
  const float im = carrierIm * cosine - carrierRe * sine;
  return { a * re - b * im, a * im + b * re };
}

} // namespace sono
