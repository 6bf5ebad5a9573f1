#pragma once

namespace sono {

/// Speed of sound that turns depth into time, as a scanner assumes it, mm per microsecond.
constexpr double assumedSoundSpeedMmPerUs = 1.54;

} // namespace sono
