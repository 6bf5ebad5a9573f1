#pragma once

#include "Echo/MovingScatterers.h"
#include "Echo/PointScatterers.h"
#include "ImageResult.h"
#include "SameSettings.h"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace sono {

// What the stages of a Simulator made last, and what they made it from.

/// What a stage made last, and from what. Another result replaces it when it is there.
template<class From, class Result>
struct LastResult
{
  std::optional<From> from;
  Result result;

  template<class Make>
  const Result& get(From wanted, const Make& make)
  {
    if (!from || !from->same(wanted))
    {
      result = make();
      from = std::move(wanted);
    }
    return result;
  }
};

struct FieldFrom
{
  ArrayAperture aperture;
  double depthMm;

  bool same(const FieldFrom& o) const { return aperture == o.aperture && depthMm == o.depthMm; }
};

struct TraceFrom
{
  std::vector<ScanLine> lines;
  TraceSettings settings;
  std::vector<TargetSurface> targets;

  bool same(const TraceFrom& o) const
  {
    return sono::same(settings, o.settings) && sono::same(lines, o.lines) && sono::same(targets, o.targets);
  }
};

/// Of the user's scatterers together with those of the scene that move.
struct MovingFrom
{
  MovingStatistics statistics;
  MovingPart part;
  std::shared_ptr<const PointScatterers> points;

  /// Whether what was made from this does for another.
  bool holds(const MovingFrom& o) const
  {
    return points == o.points && statistics == o.statistics && part.holds(o.part);
  }
};

/// Of the device's numbers for image formation, which do not depend on traced lines that lie on the device.
struct EchoJobFrom
{
  std::vector<ScanLine> lines;
  EchoSettings settings;
  std::shared_ptr<const PointScatterers> points;
  InterfaceModel model;
  std::shared_ptr<const std::vector<TargetSurface>> targets;

  bool same(const EchoJobFrom& o) const
  {
    const bool sameTargets = targets == o.targets || (targets && o.targets && sono::same(*targets, *o.targets));
    return sameTargets && points == o.points && model == o.model && sono::same(settings, o.settings) &&
           sono::same(lines, o.lines);
  }
};

struct RfFrom
{
  EchoJobFrom echo;
  TracedResult traced;

  bool same(const RfFrom& o) const { return traced == o.traced && echo.same(o.echo); }
};

struct BModeJobFrom
{
  BModeSettings settings;
  int lineCount;
  int sampleCount;
  double sampleMm;

  bool same(const BModeJobFrom& o) const
  {
    return lineCount == o.lineCount && sampleCount == o.sampleCount && sampleMm == o.sampleMm &&
           sono::same(settings, o.settings);
  }
};

struct BModeFrom
{
  RfResult rf;
  BModeSettings settings;

  bool same(const BModeFrom& o) const { return rf == o.rf && sono::same(settings, o.settings); }
};

struct ImageFrom
{
  ScanGeometry geometry;
  BModeResult bmode;
  double pixelMm;

  bool same(const ImageFrom& o) const
  {
    return bmode == o.bmode && pixelMm == o.pixelMm && sono::same(geometry, o.geometry);
  }
};

struct ErrorFrom
{
  ScanGeometry geometry;
  TracedResult traced;
  bool interactive;
  double pixelMm;

  bool same(const ErrorFrom& o) const
  {
    return traced == o.traced && interactive == o.interactive && pixelMm == o.pixelMm &&
           sono::same(geometry, o.geometry);
  }
};

struct PathsFrom
{
  TraceFrom trace;
  int count;

  bool same(const PathsFrom& o) const { return count == o.count && trace.same(o.trace); }
};

} // namespace sono
