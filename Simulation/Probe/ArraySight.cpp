#include "Probe/ArraySight.h"

#include <algorithm>
#include <cmath>

namespace sono {

namespace {

constexpr float stepMm = ArraySightView::stepMm;

} // namespace

ArraySight::ArraySight(const ArrayBeamView& view, double depthMm)
  : steps_(int(std::ceil(depthMm / double(stepMm))) + 1)
{
  lateral_ = envelopeOf(view.lateral, view);
  elevational_ = envelopeOf(view.elevational, view);
  const auto furthest = [&](const Envelope& envelope, int step) {
    const float* row = envelope.values.data() + std::size_t(step) * std::size_t(envelope.count);
    const auto places =
      std::partition_point(row, row + envelope.count, [](float v) { return v > ArraySightView::faintest; }) - row;
    return float(places) / envelope.perUnit * std::max(float(step + 1) * stepMm, envelope.nearMm);
  };
  for (int n = 0; n < steps_; ++n)
  {
    reach_.add(Vec2f(furthest(lateral_, n), furthest(elevational_, n)));
  }
  for (std::size_t n = 0; n < lateral_.largest.size(); ++n)
  {
    largestWeight_ = std::max(largestWeight_, lateral_.largest[n] * elevational_.largest[n]);
    largestAreaMm2_ = std::max(largestAreaMm2_, lateral_.integral[n] * elevational_.integral[n]);
  }
}

Vec2f ArraySight::furthest(float fromMm, float toMm) const
{
  const auto atEnd = [toMm](const Envelope& envelope, int step) { // places widen with the range
    return std::max(toMm, envelope.nearMm) / std::max(float(step + 1) * stepMm, envelope.nearMm);
  };
  const int last = std::clamp(int(toMm / stepMm), 0, steps_ - 1);
  Vec2f most(0.0f);
  for (int n = std::clamp(int(fromMm / stepMm), 0, last); n <= last; ++n)
  {
    most = glm::max(most, reach_.step(n) * Vec2f(atEnd(lateral_, n), atEnd(elevational_, n)));
  }
  return most;
}

ArraySight::Envelope ArraySight::envelopeOf(const ArrayBeamAxis& axis, const ArrayBeamView& view) const
{
  Envelope envelope{ axis.count, axis.perUnit, axis.nearMm, {}, {}, {} };
  envelope.values.assign(std::size_t(steps_) * std::size_t(axis.count), 0.0f);
  for (int n = 0; n < view.rangeCount; ++n)
  {
    // A row of the table counts for the steps beside it, too: values are interpolated between rows.
    const float rangeMm = float(n) / view.rangesPerMm;
    const float* row = axis.values + 2 * std::size_t(n) * std::size_t(axis.count);
    std::vector<float> further(static_cast<std::size_t>(axis.count));
    float largest = 0.0f;
    float sum = 0.0f;
    for (int i = axis.count - 1; i >= 0; --i)
    {
      const float modulus = std::hypot(row[2 * i], row[2 * i + 1]);
      sum += modulus;
      largest = std::max(largest, modulus);
      further[std::size_t(i)] = largest;
    }
    envelope.largest.push_back(largest);
    envelope.integral.push_back(2.0f * sum / axis.perUnit * std::max(rangeMm, axis.nearMm)); // of both halves
    const int middle = int(rangeMm / stepMm);
    for (int step = std::max(0, middle - 1); step <= std::min(steps_ - 1, middle + 1) && largest > 0.0f; ++step)
    {
      float* to = envelope.values.data() + std::size_t(step) * std::size_t(axis.count);
      for (std::size_t i = 0; i < further.size(); ++i)
      {
        to[i] = std::max(to[i], further[i] / largest);
      }
    }
  }
  return envelope;
}

ArraySightView ArraySight::view(const float* lateral, const float* elevational) const
{
  return { { lateral, lateral_.count, lateral_.perUnit, lateral_.nearMm },
           { elevational, elevational_.count, elevational_.perUnit, elevational_.nearMm },
           steps_ };
}

} // namespace sono
