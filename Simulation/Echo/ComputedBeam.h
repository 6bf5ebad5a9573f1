#pragma once

#include "Echo/EchoSettings.h"
#include "Probe/ArrayAperture.h"

namespace sono {

/// The elements of a line's active aperture: as wide as the probe says, side by side without gaps, or half a wavelength
/// where it says nothing of them; a matrix's rows as its columns. Throws Error when the aperture is not named.
ArrayAperture elementsOf(const EchoSettings& settings);

} // namespace sono
