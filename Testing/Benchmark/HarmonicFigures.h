#pragma once

namespace sono {

/// Largest error of a traced plane wave's second harmonic in liver, 1 to 100 mm deep, against the plane wave's solution
/// with attenuation, dB: physics.md (14.1) and the way back. At 100 kPa, since that solution is one of weak harmonics.
double harmonicGrowthErrorDb();

/// How much less clutter of the body wall a cyst shows in the harmonic picture than in the fundamental one, dB, each
/// against the liver beside it: a cyst of 16 mm in liver, its middle 15 mm behind a body wall of 10 mm (skin, fat,
/// muscle), C5-2 sending 2 MHz. The clutter is that of the default haze.
double cystClutterReductionDb();

} // namespace sono
