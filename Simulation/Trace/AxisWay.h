#pragma once

#include "Kernel/Reverberation.h"
#include "Kernel/TimeOfFlight.h"
#include "Trace/AxisMedia.h"

#include <vector>

// A line's way straight on along its axis by time (Data/docs/physics.md 13.1): for what comes straight back, and for
// where ranges lie. Within a medium each step takes the same, so that the steps of one are known at once.

namespace sono {

/// At multiples of a step of depth; empty: not asked for.
struct AxisWay
{
  std::vector<float> rangeMm;
  std::vector<float> amplitude;  ///< root of the intensity
  std::vector<float> absorbedNp; ///< what the media have taken of the intensity
  float stepMm = 1.0f;

  int steps() const { return int(rangeMm.size()) - 1; }
  StraightWay view() const { return { rangeMm.data(), amplitude.data(), absorbedNp.data(), steps(), stepMm }; }
  /// Depth less range, mm, at multiples of a bin of range: `bins` of them.
  void writeOffsets(int bins, double binMm, float* offsetMm) const;
};

/// What has been left behind on the way so far.
struct AxisSums
{
  double rangeMm = 0.0;
  double amplitude = 1.0;
  double absorbedNp = 0.0;
};

/// Writes the way at `first` and the `count - 1` steps behind it, all of which are alike, and takes the sums past them.
void goOn(const FlightStep& each, int first, int count, AxisSums& sums, AxisWay& way);

/// mediaOnAxis of a space of cells; of any other nothing, which is asked place by place.
template<class Targets, class Cells>
std::vector<int> mediaAtOnce(const CellSpace<Targets, Cells>& space, const TraceView& view, const TraceLine& axis,
                             float stepMm, int count)
{
  return mediaOnAxis(view, space.cells, axis, stepMm, count);
}

template<class Space>
std::vector<int> mediaAtOnce(const Space&, const TraceView&, const TraceLine&, float, int)
{
  return {};
}

/// The media that count at multiples of a step along the axis.
template<class Space>
std::vector<int> followMedia(const Space& space, const TraceView& view, const TraceLine& axis, const TargetSpans& spans,
                             float stepMm, int count)
{
  std::vector<int> media = spans.count == 0 ? mediaAtOnce(space, view, axis, stepMm, count) : std::vector<int>();
  const bool isKnown = !media.empty();
  media.resize(std::size_t(count));
  for (int s = 0; s < count; ++s)
  {
    int& medium = media[std::size_t(s)];
    const float depthMm = float(s) * stepMm;
    const AxisMedium there = isKnown ? AxisMedium{ medium, false } : mediumThere(view, space, axis, spans, depthMm);
    medium = mediumOnAxis(view, space, axis, there, depthMm);
  }
  return media;
}

/// The way of a line in steps of which `bins` bins have so many each.
template<class Space>
AxisWay followAxis(const TraceView& view, const Space& space, const TraceLine& axis, int bins, double binMm)
{
  AxisWay way;
  const int inBin = flightSteps(float(binMm));
  const int steps = bins * inBin;
  way.stepMm = float(binMm) / float(inBin);
  const TargetSpans spans = targetSpans(view, space, axis);
  const std::vector<int> media = followMedia(space, view, axis, spans, way.stepMm, steps + 2);
  for (std::vector<float>* values : { &way.rangeMm, &way.amplitude, &way.absorbedNp })
  {
    values->resize(std::size_t(steps) + 1);
  }
  AxisSums sums;
  const int* const medium = media.data();
  for (int s = 0; s <= steps;)
  {
    int next = s + 1;
    while (medium[s] == medium[s + 1] && next <= steps && medium[next] == medium[next + 1])
    {
      ++next;
    }
    goOn(flightStep(view, space, axis, spans, way.stepMm, s, medium[s], medium[s + 1]), s, next - s, sums, way);
    s = next;
  }
  return way;
}

} // namespace sono
