#pragma once

#include "Phantoms/ThoraxParameters.h"

#include <cstdint>

namespace sono {

/// A body drawn at random, the same on every platform: a third with a normal left heart, and a third each with a
/// dilated left ventricle and atrium, and with a thick wall, at any phase of the cycle. Numbers are uniform within
/// their ranges. Those of the normal left ventricle (70 to 140 ml), of its wall (7 to 10 mm) and of what it and a thick
/// one eject (52 to 62 %; a dilated one 20 to 45 %) lie within the published ones (see ThoraxParameters); all others
/// are chosen, as far as bodies stay valid (checkThorax): diseases, right heart, atria, habitus, ribs, lungs and
/// breath. They lie as in an echo laboratory: more or less on the left side, 2 of 100 nearly on their backs.
ThoraxParameters drawThoraxParameters(std::uint64_t seed);

} // namespace sono
