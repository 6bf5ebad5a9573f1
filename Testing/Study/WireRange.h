#pragma once

#include "Probe/ArrayAperture.h"

namespace sono::study {

/// How much nearer or further than `depthMm` an array with its lens shows what lies on its axis there: the middle of
/// the echo above half its height, by a sum over elements, strips of their height, pieces of the wire and the band's
/// tones in double precision, with nothing of the simulator in it. Sent with delays for the aperture's transmit focus,
/// received with those for the depth, attenuated by `attenuationDbPerCmMHz` there and back. A nylon wire of that
/// diameter across the plane, 20 mm long to either side, scatters as the exact series of a fluid cylinder has it; one
/// without a diameter is a point.
double wireRangeShiftMm(const ArrayAperture& aperture, double depthMm, double diameterMm, double attenuationDbPerCmMHz);

} // namespace sono::study
