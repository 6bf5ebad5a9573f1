#pragma once

#include "BenchScenes.h"

#include "Echo/FormRf.h"

namespace sono::study {

/// What image formation leaves out, each of which can be switched off for this study alone. None but the last changes
/// the image, and that by up to a thousandth.
struct EchoSkips
{
  bool unseenBricks = true; ///< bricks of scatterers that no beam of a group sees
  bool madeTwice = true;    ///< a brick is made once for the eight neighbouring lines of a group
  bool absent = true;       ///< cells without a scatterer, which the sum does not visit
  bool dark = true;         ///< depths below the last intensity that can be seen
  bool faint = true;        ///< parts of a computed field too faint to count (FieldSight)
};

/// As formRf() by one thread.
RfLines formRfBySkipping(const BenchScene& bench, const TracedLines& traced, const EchoSkips& skips);

/// Scatterers of the whole scene, which are made where they are seen and never stored.
double scattererCount(const BenchScene& bench);

} // namespace sono::study
