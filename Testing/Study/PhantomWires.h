#pragma once

#include "PhantomImaging.h"

#include <string>
#include <utility>
#include <vector>

namespace sono::study {

/// Where a wire was seen along the line that should hold it: depth for the vertical group, lateral for the others.
struct WirePlace
{
  bool found = false; ///< a peak 10 dB above the line's median that is not at the end of the searched window
  double expectedMm = 0.0;
  double pixelMm = 0.0;  ///< of the brightest pixel
  double fittedMm = 0.0; ///< of the vertex of the paraboloid through the echo's pixels, in dB, beside the line or on it
  double aboveMedianDb = 0.0;
};

/// How far to either side of its expected place a wire is looked for, mm.
struct WireWindow
{
  double beforeMm = 4.9;
  double behindMm = 4.9;
};

/// Looks along the expected line, as the seed does, in a scan-converted image in dB. Of an echo beside the line its own
/// place is told: on the line an echo that lies slanted, as all beside the middle of a sector do, is brightest
/// elsewhere.
WirePlace locateWire(const PlaneImage& decibels, const PhantomTarget& wire, const WireWindow& window = {});

/// Mean and standard deviation of an error's absolute value.
struct Spread
{
  int count = 0;
  double mean = 0.0;
  double deviation = 0.0;
};

struct WireErrors
{
  std::vector<std::pair<PhantomTarget, WirePlace>> wires;

  /// Of the wires found, of a view (0: all) and a group (empty: all), fitted or of the brightest pixel.
  Spread spread(int view, const std::string& group, bool fitted) const;
};

/// How the phantom is imaged with its wires in this way. Surfaces echo by their phases, so for them the beam keeps its
/// own.
PhantomImaging imagingOf(WireModel wires, int lines);

/// Images all views and locates their wires.
WireErrors measureWires(const PhantomBench& bench, const PhantomImaging& imaging, unsigned seed);

} // namespace sono::study
