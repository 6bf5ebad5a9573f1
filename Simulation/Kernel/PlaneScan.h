#pragma once

#include "Kernel/PixelMath.h"

#include <cstddef>

// Scan conversion of one pixel of the probe's plane.

namespace sono {

/// The beam's coordinates of a plane position, (line, r) = ((u - firstUnit) linesPerUnit, rho - faceRadius), where u is
/// the angle about the lines' common centre, or the lateral position when they are parallel. The twin of
/// beamFromPlane in single precision, without a branch per pixel.
struct PlaneBeams
{
  bool parallel;
  float faceRadiusMm;
  float centreAxialMm; ///< where the lines of a fan come from
  float firstUnit;
  float linesPerUnit;

  SONO_HD float axialFromCentre(float axialMm) const { return axialMm - centreAxialMm; }
  SONO_HD float lineOfParallel(float lateralMm) const { return (lateralMm - firstUnit) * linesPerUnit; }
  /// `forward` is x, the axial distance from the centre, but not 0: at the centre every line passes.
  SONO_HD float lineOfFan(float lateralMm, float forward) const
  {
    return (fastAtan2(lateralMm, forward) - firstUnit) * linesPerUnit;
  }
  SONO_HD float depthInFan(float lateralMm, float x) const
  {
    return sqrtf(lateralMm * lateralMm + x * x) - faceRadiusMm;
  }
  SONO_HD static float notZero(float x) { return x != 0.0f ? x : 1e-20f; }

  /// Line and depth of a place, `x` as axialFromCentre.
  SONO_HD void beamAt(float lateralMm, float x, float& line, float& depthMm) const
  {
    line = parallel ? lineOfParallel(lateralMm) : lineOfFan(lateralMm, notZero(x));
    depthMm = parallel ? x - faceRadiusMm : depthInFan(lateralMm, x);
  }
  /// The same in a fan that is steered by an angle. On a convex face, of radius R, the start of the line, the place, at
  /// rho from the centre, and the centre form a triangle: rho^2 = R^2 + r^2 + 2 R r cos(angle).
  SONO_HD void steeredBeamAt(float lateralMm, float x, float sine, float cosine, float& line, float& depthMm) const
  {
    if (parallel)
    {
      depthMm = (x - faceRadiusMm) / cosine;
      line = lineOfParallel(lateralMm - depthMm * sine);
      return;
    }
    const float across = faceRadiusMm * sine;
    const float rest = lateralMm * lateralMm + x * x - across * across;
    depthMm = sqrtf(rest > 0.0f ? rest : 0.0f) - faceRadiusMm * cosine;
    const float turned = fastAtan2(depthMm * sine, notZero(faceRadiusMm + depthMm * cosine));
    line = lineOfFan(lateralMm, notZero(x)) - turned * linesPerUnit;
  }
  /// Unit direction of the unsteered line through a place.
  SONO_HD void directionAt(float lateralMm, float x, float& lateral, float& axial) const
  {
    const float length = sqrtf(lateralMm * lateralMm + x * x);
    lateral = parallel || length == 0.0f ? 0.0f : lateralMm / length;
    axial = parallel || length == 0.0f ? 1.0f : x / length;
  }
  bool operator==(const PlaneBeams& other) const
  {
    return parallel == other.parallel && faceRadiusMm == other.faceRadiusMm && centreAxialMm == other.centreAxialMm &&
           firstUnit == other.firstUnit && linesPerUnit == other.linesPerUnit;
  }
};

/// Lines x samples with bilinear lookup; on a closed circle, the first line follows the last.
struct BeamSamples
{
  const float* values;
  int lineCount;
  int sampleCount;
  bool closed;

  static constexpr float largestLine = 3e38f; // which no line is beyond
  SONO_HD static float within(float x, float low, float high) { return x < low ? low : (x > high ? high : x); }
  /// Without a branch, and by numbers instead of pointers, so that host loops vectorise; fewer than 2^31 values.
  SONO_HD float at(float line, float sample) const
  {
    const float turn = closed ? float(lineCount) : largestLine;
    const float last = closed ? float(lineCount) : float(lineCount - 1);
    const float lineInside = within(line < turn ? line : line - turn, 0.0f, last);
    const float sampleInside = within(sample, 0.0f, float(sampleCount - 1));
    const int l = int(lineInside) < lineCount ? int(lineInside) : lineCount - 1;
    const int s = int(sampleInside);
    const float fl = lineInside - float(l);
    const float fs = sampleInside - float(s);
    const int afterLast = closed ? 0 : lineCount - 1;
    const int near = l * sampleCount + s;
    const int far = (l + 1 < lineCount ? l + 1 : afterLast) * sampleCount + s;
    const int deeper = s + 1 < sampleCount ? 1 : 0;
    const float nearValue = values[near] + fs * (values[near + deeper] - values[near]);
    const float farValue = values[far] + fs * (values[far + deeper] - values[far]);
    return nearValue + fl * (farValue - nearValue);
  }
};

/// What the lines cover, with some slack: rounding must not cut the pixels that lie on the sector's edge.
struct ScannedArea
{
  static constexpr float lineSlack = 1e-3f;
  float lastLine;
  float firstMm;
  float lastMm;

  SONO_HD bool contains(float line, float depthMm) const
  {
    return (line >= -lineSlack) & (line <= lastLine) & (depthMm >= firstMm) & (depthMm <= lastMm);
  }
};

/// Fans that can be compounded.
constexpr int maxCompoundFans = 15;

/// All that a pixel needs but the samples.
struct PlaneScan
{
  struct Steering
  {
    float sine;
    float cosine;
  };

  PlaneBeams beams;
  ScannedArea area;
  float samplesPerMm;
  float rangePerMm; ///< range at 1540 m/s of a millimetre that is shown
  int lineCount;
  int sampleCount;
  bool closed;
  int width;
  int height;
  double pixelMm;
  double lateralMinMm;
  double axialMinMm;
  int fanCount; ///< 1: not steered, and the steering below not used
  Steering steering[maxCompoundFans];

  SONO_HD float lateralMm(int i) const { return float(lateralMinMm + i * pixelMm); }
  SONO_HD float axialMm(int j) const { return float(axialMinMm + j * pixelMm); }
  SONO_HD BeamSamples samples(const float* values) const { return { values, lineCount, sampleCount, closed }; }
  SONO_HD std::size_t valueCount() const
  {
    return std::size_t(fanCount) * std::size_t(lineCount) * std::size_t(sampleCount);
  }

  /// Of a place, `x` as axialFromCentre: 0 where it is not scanned.
  SONO_HD float levelAt(const float* values, float lateral, float x) const
  {
    float level = 0.0f;
    if (fanCount > 1)
    {
      compound(values, lateral, x, level);
      return level;
    }
    float line;
    float depth;
    beams.beamAt(lateral, x, line, depth);
    return area.contains(line, depth) ? samples(values).at(line, depth * samplesPerMm) : 0.0f;
  }

  /// Of a place within the area: the mean over the fans that see it, in `level`, where `values` is not null. Whether
  /// one does.
  SONO_HD bool compound(const float* values, float lateral, float x, float& level) const
  {
    float sum = 0.0f;
    int count = 0;
    for (int fan = 0; fan < fanCount; ++fan)
    {
      float line;
      float depth;
      beams.steeredBeamAt(lateral, x, steering[fan].sine, steering[fan].cosine, line, depth);
      if (area.contains(line, depth))
      {
        const std::size_t first = std::size_t(fan) * std::size_t(lineCount) * std::size_t(sampleCount);
        sum += values ? samples(values + first).at(line, depth * samplesPerMm) : 0.0f;
        ++count;
      }
    }
    level = count > 0 ? sum / float(count) : 0.0f;
    return count > 0;
  }
};

} // namespace sono
