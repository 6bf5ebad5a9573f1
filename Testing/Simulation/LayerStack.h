#pragma once

#include "Core/SoundSpeed.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

// Plane waves across a stack of fluid layers, exactly (Data/docs/physics.md section 13): in the frequency domain, and
// as the list of all that comes back.

namespace sono::test {

struct StackLayer
{
  double impedanceMRayl;
  double speedMPerS;
  double attenuationDbPerCmMHz;
  double thicknessMm; ///< of the last one, which has no end, unused
};

/// The transducer's face lies on the first layer and reflects this much of the pressure.
struct LayerStack
{
  std::vector<StackLayer> layers;
  double faceReflection = 0.0;

  int boundaries() const { return int(layers.size()) - 1; }
  /// Of the pressure, going away from the transducer; in the other direction its negative.
  double reflection(int boundary) const
  {
    const double before = layers[std::size_t(boundary)].impedanceMRayl;
    const double behind = layers[std::size_t(boundary) + 1].impedanceMRayl;
    return (behind - before) / (behind + before);
  }
  double depthMm(int boundary) const
  {
    double depth = 0.0;
    for (int layer = 0; layer <= boundary; ++layer)
    {
      depth += layers[std::size_t(layer)].thicknessMm;
    }
    return depth;
  }
  /// c0 / 2 times the time there and back through a layer.
  double rangeMm(int layer) const
  {
    const StackLayer& l = layers[std::size_t(layer)];
    return l.thicknessMm * 1000.0 * assumedSoundSpeedMmPerUs / l.speedMPerS;
  }
  /// Of the pressure, there and back through a layer, in Np/MHz.
  double exponent(int layer) const
  {
    const StackLayer& l = layers[std::size_t(layer)];
    return 2.0 * l.attenuationDbPerCmMHz * l.thicknessMm / 10.0 * std::log(10.0) / 20.0;
  }
};

/// What the stack answers to exp(i 2 pi f t), and what goes on behind it, both as pressures against what was sent.
struct StackResponse
{
  std::complex<double> heard;
  std::complex<double> behind;
};

/// By recursion from the last boundary to the first.
inline StackResponse stackResponse(const LayerStack& stack, double frequencyMHz)
{
  using Complex = std::complex<double>;
  Complex back = 0.0;
  Complex on = 1.0;
  for (int b = stack.boundaries() - 1; b >= 0; --b)
  {
    const double r = stack.reflection(b);
    const Complex multiple = 1.0 / (1.0 + r * back);
    const double phase = 2.0 * M_PI * frequencyMHz * stack.rangeMm(b) / assumedSoundSpeedMmPerUs; // one way
    const Complex way = std::exp(Complex(-0.5 * stack.exponent(b) * frequencyMHz, -phase));
    on *= (1.0 + r) * multiple * way;
    back = (r + back) * multiple * way * way;
  }
  const Complex again = 1.0 / (1.0 - stack.faceReflection * back);
  return { back * again, on * again };
}

/// Sound that arrives at the face: at frequency f `amplitude exp(-f exponent)` of the pressure that was sent, whose
/// echo from a perfect mirror at the face would be 1.
struct Arrival
{
  double rangeMm;          ///< shown: c0 / 2 times its time
  double amplitude;        ///< with its sign, as if nothing were absorbed
  double exponentNpPerMHz; ///< absorbed on its way
  bool primary;            ///< a boundary's own echo
  double routes;           ///< orders of the same pieces, which arrive at once

  double at(double frequencyMHz) const { return amplitude * std::exp(-frequencyMHz * exponentNpPerMHz); }
};

/// All that arrives, nearest first. Ways of the same pieces in another order are followed together; they end where they
/// are fainter than `faintest` at that frequency or later than `deepestMm`.
inline std::vector<Arrival> everyArrival(const LayerStack& stack, double frequencyMHz, double faintest,
                                         double deepestMm)
{
  /// Ways that have crossed each layer so often and stand at one end of `layer`, ahead of them `layer` itself.
  struct Place
  {
    std::vector<int> crossings;
    int layer;
    bool away; ///< from the transducer

    bool operator<(const Place& o) const
    {
      return std::tie(crossings, layer, away) < std::tie(o.crossings, o.layer, o.away);
    }
  };
  struct Ways
  {
    double amplitude = 0.0;
    double count = 0.0; ///< more than fit into an integer
  };
  std::vector<Arrival> arrivals;
  const auto add = [](std::map<Place, Ways>& places, const Place& place, const Ways& from, double factor) {
    Ways& to = places[place];
    to.amplitude += from.amplitude * factor;
    to.count += from.count;
  };
  std::map<Place, Ways> here{ { { std::vector<int>(std::size_t(stack.boundaries()), 0), 0, true }, { 1.0, 1.0 } } };
  while (!here.empty())
  {
    std::map<Place, Ways> next;
    for (const auto& [before, ways] : here)
    {
      Place place = before;
      ++place.crossings[std::size_t(place.layer)];
      Arrival arrival{ 0.0, ways.amplitude, 0.0, *std::max_element(place.crossings.begin(), place.crossings.end()) <= 2,
                       ways.count };
      for (int layer = 0; layer < stack.boundaries(); ++layer)
      {
        arrival.rangeMm += 0.5 * place.crossings[std::size_t(layer)] * stack.rangeMm(layer);
        arrival.exponentNpPerMHz += 0.5 * place.crossings[std::size_t(layer)] * stack.exponent(layer);
      }
      if (std::abs(arrival.at(frequencyMHz)) < faintest || arrival.rangeMm > deepestMm)
      {
        continue;
      }
      if (!place.away && place.layer == 0)
      {
        arrivals.push_back(arrival);
        add(next, { place.crossings, 0, true }, ways, stack.faceReflection);
        continue;
      }
      const double r = place.away ? stack.reflection(place.layer) : -stack.reflection(place.layer - 1);
      add(next, { place.crossings, place.layer, !place.away }, ways, r);
      const int beyond = place.layer + (place.away ? 1 : -1);
      if (beyond < stack.boundaries())
      {
        add(next, { place.crossings, beyond, place.away }, ways, 1.0 + r);
      }
    }
    here = std::move(next);
  }
  std::sort(arrivals.begin(), arrivals.end(), [](const Arrival& a, const Arrival& b) { return a.rangeMm < b.rangeMm; });
  return arrivals;
}

/// Those of them at least this strong at that frequency.
inline std::vector<Arrival> stackArrivals(const LayerStack& stack, double frequencyMHz, double faintest,
                                          double deepestMm)
{
  // A faint way may be one of many that arrive at once.
  std::vector<Arrival> all = everyArrival(stack, frequencyMHz, 1e-3 * faintest, deepestMm);
  all.erase(
    std::remove_if(all.begin(), all.end(), [&](const Arrival& a) { return std::abs(a.at(frequencyMHz)) < faintest; }),
    all.end());
  return all;
}

/// The stack of Data/docs/physics.md 13.3.
inline LayerStack namedStack()
{
  return { { { 1.50, 1480.0, 0.3, 20.0 },
             { 1.90, 1650.0, 0.8, 12.0 },
             { 1.30, 1450.0, 0.6, 18.0 },
             { 2.40, 1800.0, 1.0, 0.0 } } };
}

} // namespace sono::test
