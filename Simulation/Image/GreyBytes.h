#pragma once

#include <cstdint>
#include <vector>

namespace sono {

/// Grey levels from 0 to 1 as bytes: 1 (black) to 255 (white) where the mask is not 0, and 0 outside of it, so that a
/// colour map can leave out what was not scanned and still show black. Both arguments are of one size.
std::vector<std::uint8_t> greyBytes(const std::vector<float>& grey, const std::vector<std::uint8_t>& mask);

} // namespace sono
